#include "app/batch/job_files.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/batch/item_folder.h"
#include "app/batch/shell_words.h"
#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPlanFile = "jobs.json";

// Where a script finds itself: the folder may have moved since it was written.
constexpr const char* kHere = R"text(here=$(cd "$(dirname "$(readlink -f "$0")")" && pwd))text";

constexpr const char* kTask = R"text(#!/usr/bin/env bash
# task.sh I: task I of {tasks}; makes those of its items that are missing, and can be given again as often as needed.
set -euo pipefail
{here}
exec >>"$here/logs/task-$1.txt" 2>&1
cd {directory}
echo "$(date -Is) $(hostname): task $1 of {tasks}"
exec {command} --shard "$1/{tasks}"{threads} --out "$here/made"
)text";

constexpr const char* kMerge = R"text(#!/usr/bin/env bash
# merge.sh: says what became of each item (runs.csv), and puts all together; items of another build or configuration are refused.
set -euo pipefail
{here}
cd {directory}
{program} jobs status "$here"
{merge}
)text";

constexpr const char* kSlurmTask = R"text(#!/usr/bin/env bash
# One task of the array: index {first} is task 1 of {tasks}. Any part can be submitted again, as with --array=3. An argument is
# added to the index: arrays above the cluster's MaxArraySize are submitted in windows (submit.sh).
#SBATCH --job-name="{name}"
#SBATCH --array={first}-{last}
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={cpus}
{asked}#SBATCH --output="{logs}/slurm-%A.txt"
#SBATCH --open-mode=append
: "${{SLURM_ARRAY_TASK_ID:?submit this as an array}}"
exec {folder}/task.sh "$((SLURM_ARRAY_TASK_ID - {first} + 1 + ${{1:-0}}))"
)text";

constexpr const char* kSlurmMerge = R"text(#!/usr/bin/env bash
#SBATCH --job-name="{name}-merge"
#SBATCH --nodes=1
#SBATCH --ntasks=1
{asked}#SBATCH --output="{logs}/merge.txt"
exec {folder}/merge.sh
)text";

constexpr const char* kSlurmSubmit = R"text(#!/usr/bin/env bash
# submit.sh [SBATCH OPTION]..: submits the tasks that have items to make, and their merge, which waits for them. Options are for
# both: --partition, --account, ..
set -euo pipefail
{here}
max_array=$(scontrol show config | awk '$1 == "MaxArraySize" {{print $3}}')
windows=$({program} jobs status "$here" --incomplete --max-array "$max_array")
after=
while read -r offset array; do
  [[ -n $array ]] || continue
  id=$(sbatch --parsable "$@" --array="$array" "$here/task.sbatch" "$offset")
  after+=:${{id%%;*}}
  echo "array $array from task $((offset + 1)): job ${{id%%;*}}"
done <<<"$windows"
id=$(sbatch --parsable "$@" ${{after:+--dependency=afterany$after}} "$here/merge.sbatch")
echo "merge: job ${{id%%;*}}"
)text";

constexpr const char* kParallelRun = R"text(#!/usr/bin/env bash
# run.sh [PARALLEL OPTION]..: makes all that is missing on this machine, or on those of --sshlogin, which must see this folder;
# again, it takes up the tasks that failed or were not begun. Then it merges.
set -euo pipefail
{here}
failed=0
parallel --jobs {percent}% --joblog "$here/joblog-{tasks}.tsv" --resume-failed "$@" "$here/task.sh" {{}} ::: $(seq {tasks}) || failed=$?
"$here/merge.sh"
exit "$failed"
)text";

constexpr const char* kSnakefile = R"text(# snakemake --snakefile Snakefile --cores 4 --keep-going
workdir: workflow.basedir

rule merge:
    input: expand("tasks-{tasks}/{{task}}", task=range(1, {tasks} + 1))
    output: touch("tasks-{tasks}/merged")
    shell: "./merge.sh"

rule task:
    output: touch("tasks-{tasks}/{{task}}")
    wildcard_constraints: task="[0-9]+"
    threads: {cpus}
{asked}    shell: "./task.sh {{wildcards.task}}"
)text";

std::string Quoted(const fs::path& path) { return ShellWord(path.string()); }

Json ToJson(const JobPlan& plan) {
  return {{"engine", plan.engine},
          {"folder", plan.folder.string()},
          {"directory", plan.directory.string()},
          {"command", plan.command},
          {"merge", plan.merge},
          {"program", plan.program},
          {"takes_threads", plan.takes_threads},
          {"items_in", plan.items_in.string()},
          {"extension", plan.extension},
          {"items", plan.items},
          {"tasks", plan.tasks},
          {"cpus", plan.cpus},
          {"first_index", plan.first_index},
          {"minutes", plan.minutes},
          {"memory_mb", plan.memory_mb}};
}

std::string AskedOfSlurm(const JobPlan& plan) {
  std::string asked;
  if (plan.minutes > 0) asked += fmt::format("#SBATCH --time={}\n", plan.minutes);
  if (plan.memory_mb > 0) asked += fmt::format("#SBATCH --mem={}M\n", plan.memory_mb);
  return asked;
}

std::string AskedOfSnakemake(const JobPlan& plan) {
  if (plan.minutes == 0 && plan.memory_mb == 0) return "";
  return fmt::format("    resources: runtime={}, mem_mb={}\n", plan.minutes, plan.memory_mb);
}

std::string MergeLine(const JobPlan& plan) {
  if (plan.merge.empty()) return ShellWord(plan.program) + " jobs status \"$here\" --complete";
  return "exec " + ShellWords(plan.merge) + " \"$here/made\" --out \"$here/result\"";
}

}  // namespace

std::vector<std::string> TaskCommand(const JobPlan& plan, const std::string& shard) {
  std::vector<std::string> words = plan.command;
  if (!shard.empty()) words.insert(words.end(), {"--shard", shard});
  if (plan.takes_threads) words.insert(words.end(), {"--threads", std::to_string(plan.cpus)});
  words.insert(words.end(), {"--out", plan.made().string()});
  return words;
}

std::vector<JobFile> MakeJobFiles(const JobPlan& plan) {
  const bool slurm = plan.engine == "slurm";
  fmt::dynamic_format_arg_store<fmt::format_context> values;
  const auto set = [&](const char* name, const std::string& value) {
    values.push_back(fmt::arg(name, value));
  };
  set("here", kHere);
  set("tasks", std::to_string(plan.tasks));
  set("cpus", std::to_string(plan.cpus));
  set("percent", std::to_string(std::max(1, 100 / plan.cpus)));
  set("command", ShellWords(plan.command));
  set("directory", Quoted(plan.directory));
  set("program", ShellWord(plan.program));
  set("threads", plan.takes_threads ? fmt::format(" --threads {}", plan.cpus) : "");
  set("merge", MergeLine(plan));
  set("name", plan.folder.filename().string());
  set("folder", Quoted(plan.folder));
  set("logs", (plan.folder / "logs").string());
  set("first", std::to_string(plan.first_index));
  set("last", std::to_string(plan.first_index + plan.tasks - 1));
  set("asked", slurm ? AskedOfSlurm(plan) : AskedOfSnakemake(plan));
  std::vector<JobFile> files;
  const auto add = [&](const std::string& name, const char* text, bool executable) {
    files.push_back({name, fmt::vformat(text, values), executable});
  };
  add("task.sh", kTask, true);
  add("merge.sh", kMerge, true);
  if (slurm) {
    add("task.sbatch", kSlurmTask, false);
    add("merge.sbatch", kSlurmMerge, false);
    add("submit.sh", kSlurmSubmit, true);
  } else if (plan.engine == "parallel") {
    add("run.sh", kParallelRun, true);
  } else {
    add("Snakefile", kSnakefile, false);
  }
  files.push_back({kPlanFile, ToJson(plan).dump(1) + "\n", false});
  return files;
}

void WriteJobFiles(const JobPlan& plan) {
  MakeFolders(plan.folder / "logs");
  for (const JobFile& file : MakeJobFiles(plan)) {
    const fs::path path = plan.folder / file.name;
    WriteWholeFile(path, file.text);
    std::error_code ignored;  // bash reads a script that it may not execute
    using fs::perms;
    if (file.executable) {
      fs::permissions(path, perms::owner_exec | perms::group_exec | perms::others_exec,
                      fs::perm_options::add, ignored);
    }
  }
}

JobPlan ReadJobPlan(const fs::path& folder) {
  const fs::path file = folder / kPlanFile;
  if (!fs::is_regular_file(file)) {
    throw InputError(folder.string(), "", "a folder that pregrasp jobs wrote", "none");
  }
  const nlohmann::json json = ParseJson(ReadWholeFile(file), file.string());
  const JsonReader fields(json, file.string());
  const auto words = [&](const char* name) {
    std::vector<std::string> list;
    const JsonReader field = fields[name];
    for (std::size_t i = 0; i < field.size(); ++i) list.push_back(field[i].Text());
    return list;
  };
  const auto count = [&](const char* name, double least) {
    const double number = fields[name].Number();
    if (!(number >= least && number <= 1e9)) fields[name].Fail("a count");
    return static_cast<int>(number);
  };
  JobPlan plan;
  plan.engine = fields["engine"].Text();
  plan.folder = fs::absolute(folder).lexically_normal();
  plan.directory = fields["directory"].Text();
  plan.command = words("command");
  plan.merge = words("merge");
  plan.program = fields["program"].Text();
  plan.takes_threads = fields["takes_threads"].Bool();
  plan.items_in = fields["items_in"].Text();
  plan.extension = fields["extension"].Text();
  plan.items = count("items", 1);
  plan.tasks = count("tasks", 1);
  plan.cpus = count("cpus", 1);
  plan.first_index = count("first_index", 0);
  plan.minutes = count("minutes", 0);
  plan.memory_mb = count("memory_mb", 0);
  return plan;
}

}  // namespace pregrasp
