#include <fmt/core.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "app/batch/item_folder.h"
#include "app/batch/job_files.h"
#include "app/batch/job_status.h"
#include "app/batch/run_items.h"
#include "app/batch/shell_words.h"
#include "app/commands/commands.h"
#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/studies/study.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A task is asked for the time of the longest item known, for each of its items, and for the memory
// of the largest, times these: of the 65 runs of docs/results.md the longest took 2.5 times their
// mean. What a limit cuts off is made when the task is submitted again.
constexpr double kTimeMargin = 3.0, kMemoryMargin = 1.5;
constexpr int kStartMinutes = 5;  // besides, for a machine and file system under load

struct JobsOptions {
  std::string study;
  std::vector<std::string> words;  // that follow it
  std::int64_t tasks = 0;
  fs::path out;
  int cpus = 1, minutes = 0, memory_mb = 0, first_index = 1;
  bool dry_run = false;
};

struct StatusOptions {
  fs::path folder;
  bool incomplete = false, complete = false;
  std::int64_t max_array = 1001;  // Slurm's default
};

struct ChildResult {
  int code = 0;
  std::string out;
};

// Runs a command to its end; its stderr is ours.
ChildResult RunCommand(const std::vector<std::string>& words) {
  std::fflush(nullptr);
  std::FILE* const pipe = popen(ShellWords(words).c_str(), "r");
  if (pipe == nullptr) throw std::system_error(errno, std::generic_category(), words[0]);
  ChildResult result;
  std::array<char, 4096> buffer{};
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    result.out.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

bool IsOption(const std::string& word, const std::string& option) {
  return word == option || word.rfind(option + "=", 0) == 0;
}

// The command that STUDY stands for, and where it leaves its items.
JobPlan ResolveStudy(const JobsOptions& options) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  JobPlan plan;
  plan.program = program.string();
  plan.command = {plan.program};
  plan.items_in = fs::path("made") / "items";
  plan.extension = ".json";
  std::vector<std::string> words = options.words;
  words.insert(words.begin(), options.study);
  const auto& studies = Studies();
  const bool named = std::any_of(studies.begin(), studies.end(),
                                 [&](const StudyInfo& info) { return info.name == words[0]; });
  if (named) words.insert(words.begin(), {"eval", "--study"});
  const std::array<std::string, 3> sets{"grasps", "labels", "states"};
  const bool set = words.size() > 1 && words[0] == "dataset" &&
                   std::find(sets.begin(), sets.end(), words[1]) != sets.end();
  if (words[0] == "train" && words.size() > 1) {
    plan.command = {(program.parent_path() / "pregrasp-train").string()};
    if (!fs::exists(plan.command[0])) {
      throw InputError("STUDY", "",
                       "pregrasp-train beside the program, which is built with "
                       "-DPREGRASP_TRAINER=ON",
                       "none");
    }
    words.erase(words.begin());
    plan.takes_threads = false;
  } else if (set) {
    plan.items_in = "made";
    plan.extension = ".safetensors";
  } else if (words[0] == "eval") {
    plan.merge = {plan.program, "eval", "merge"};
  } else {
    std::vector<std::string> names = {"eval", "train"};
    for (const StudyInfo& info : studies) names.push_back(info.name);
    for (const std::string& name : sets) names.push_back("dataset " + name);
    const bool two = words[0] == "dataset" && words.size() > 1;
    const std::string got = two ? words[0] + ' ' + words[1] : words[0];
    throw InputError(
        "STUDY", "",
        "the name of a study, or eval, dataset grasps, dataset labels, dataset states or train",
        '"' + got + '"' + FormatHint(FindNearest(got, names)));
  }
  for (const std::string& word : words) {
    for (const char* option : {"--shard", "--out", "--threads", "--dry-run"}) {
      if (!IsOption(word, option)) continue;
      throw InputError("STUDY", "", "a command without it, as each task gets its own (--cpus)",
                       option);
    }
  }
  plan.command.insert(plan.command.end(), words.begin(), words.end());
  return plan;
}

// The first item that is missing; none when all are there.
std::optional<std::int64_t> FindMissing(const JobPlan& plan) {
  for (const JobItem& item : FindJobItems(plan)) {
    if (item.verdict != "done") return item.item;
  }
  return std::nullopt;
}

struct Measured {
  int items = 0;
  double seconds = 0.0, peak_rss_mb = 0.0;  // of the longest, of the largest
};

Measured MeasureItems(const JobPlan& plan) {
  Measured measured;
  for (const JobItem& item : FindJobItems(plan)) {
    if (!item.record || item.record->verdict != "done") continue;
    ++measured.items;
    measured.seconds = std::max(measured.seconds, item.record->seconds);
    measured.peak_rss_mb = std::max(measured.peak_rss_mb, item.record->peak_rss_mb);
  }
  return measured;
}

void Ask(const Measured& measured, JobPlan& plan) {
  const double items = std::ceil(static_cast<double>(plan.items) / static_cast<double>(plan.tasks));
  if (plan.minutes == 0) {
    plan.minutes =
        kStartMinutes + static_cast<int>(std::ceil(kTimeMargin * items * measured.seconds / 60.0));
  }
  if (plan.memory_mb == 0) {
    constexpr double kStep = 100.0;
    plan.memory_mb =
        static_cast<int>(kStep * std::ceil(kMemoryMargin * measured.peak_rss_mb / kStep));
  }
}

// A folder of this plan's, whose tasks may be cut otherwise; or a new one.
void RequireFolder(const JobPlan& plan) {
  if (!fs::exists(plan.folder) || fs::is_empty(plan.folder)) return;
  const JobPlan there = ReadJobPlan(plan.folder);
  if (there.command == plan.command && there.directory == plan.directory) return;
  throw InputError(plan.folder.string(), "", "a new folder, or one of the same command",
                   ShellWords(there.command) + " in " + there.directory.string());
}

void ShowPlan(const JobPlan& plan) {
  const std::vector<JobItem> items = FindJobItems(plan);
  for (std::int64_t task = 1; task <= plan.tasks; ++task) {
    std::int64_t all = 0, done = 0;
    for (const JobItem& item : items) {
      if (item.task != task) continue;
      ++all;
      done += item.verdict == "done";
    }
    fmt::print("task {}: {} items, {} of them made: {}\n", task, all, done,
               ShellWords(TaskCommand(plan, fmt::format("{}/{}", task, plan.tasks))));
  }
  for (const JobFile& file : MakeJobFiles(plan)) {
    fmt::print("\n--- {}\n{}", (plan.folder / file.name).string(), file.text);
  }
}

const char* NextStep(const std::string& engine) {
  if (engine == "slurm") return "submit them with {0}/submit.sh";
  if (engine == "parallel") return "run them with {0}/run.sh";
  return "run them with snakemake --snakefile {0}/Snakefile --cores N --keep-going";
}

int Jobs(const std::string& engine, const JobsOptions& options) {
  JobPlan plan = ResolveStudy(options);
  plan.engine = engine;
  plan.folder = fs::absolute(options.out).lexically_normal();
  if (!plan.folder.has_filename()) plan.folder = plan.folder.parent_path();
  plan.directory = fs::current_path();
  plan.tasks = options.tasks;
  plan.cpus = options.cpus;
  plan.minutes = options.minutes;
  plan.memory_mb = options.memory_mb;
  plan.first_index = options.first_index;
  RequireFolder(plan);
  std::vector<std::string> count = TaskCommand(plan, "");
  count.emplace_back("--dry-run");
  const ChildResult counted = RunCommand(count);
  if (counted.code != 0) return counted.code;
  const auto items = ParseItemCount(counted.out);
  PREGRASP_CHECK(items, counted.out);
  plan.items = *items;
  if (plan.tasks > plan.items) {
    throw InputError("--tasks", "", fmt::format("1 to {}, the number of items", plan.items),
                     std::to_string(plan.tasks));
  }
  if (plan.command[1] == "dataset") {
    plan.merge = {plan.program, "dataset", "merge", "--items", std::to_string(plan.items)};
  }
  if (!options.dry_run) WriteJobFiles(plan);  // whose folder it is, should measuring be cut off
  if (engine != "parallel" && (plan.minutes == 0 || plan.memory_mb == 0)) {
    Measured measured = MeasureItems(plan);
    const auto missing = FindMissing(plan);
    if (measured.items == 0 && missing && !options.dry_run) {
      fmt::print("making one item, to know what to ask for\n");
      const ChildResult made =
          RunCommand(TaskCommand(plan, fmt::format("{}/{}", *missing + 1, plan.items)));
      if (made.code != 0) return made.code;
      measured = MeasureItems(plan);
    }
    if (measured.items > 0) {
      fmt::print("longest of {} items: {:.1f} s; largest: {:.0f} MB\n", measured.items,
                 measured.seconds, measured.peak_rss_mb);
      Ask(measured, plan);
    }
  }
  if (options.dry_run) {
    ShowPlan(plan);
    return 0;
  }
  WriteJobFiles(plan);
  fmt::print("{} items in {} tasks; ", plan.items, plan.tasks);
  fmt::print(fmt::runtime(NextStep(engine)), options.out.string());
  fmt::print("\n");
  return 0;
}

int Status(const StatusOptions& options) {
  const JobPlan plan = ReadJobPlan(options.folder);
  const std::vector<JobItem> items = FindJobItems(plan);
  std::vector<std::int64_t> tasks;
  std::map<std::string, int> counts;
  double seconds = 0.0, megabytes = 0.0;
  for (const JobItem& item : items) {
    ++counts[item.verdict];
    if (item.verdict != "done") tasks.push_back(item.task);
    if (!item.record) continue;
    seconds += item.record->seconds;
    megabytes = std::max(megabytes, item.record->peak_rss_mb);
  }
  std::sort(tasks.begin(), tasks.end());
  tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
  if (options.incomplete) {
    for (const JobArray& array : FindJobArrays(tasks, plan.first_index, options.max_array)) {
      fmt::print("{} {}\n", array.offset, array.indices);
    }
    return 0;
  }
  if (options.complete) {
    if (tasks.empty()) return 0;
    throw InputError(options.folder.string(), "", fmt::format("all {} items", items.size()),
                     fmt::format("{} of them", counts["done"]));
  }
  const fs::path table = plan.folder / "runs.csv";
  WriteWholeFile(table, TabulateJobItems(items));
  fmt::print("{} items:", items.size());
  for (const auto& [verdict, count] : counts) fmt::print(" {} {}", count, verdict);
  fmt::print("; {:.0f} s in all, at most {:.0f} MB; {}\n", seconds, megabytes, table.string());
  for (const JobItem& item : items) {
    if (item.verdict == "done" || !item.record) continue;
    const ItemRecord& record = *item.record;
    fmt::print("item {} of task {}: {}{}{} on {}, log {}; alone: cd {} && {}\n", item.item,
               item.task, item.verdict, record.text.empty() ? "" : ": ", record.text, record.host,
               record.log.empty() ? "none" : record.log, ShellWord(record.directory),
               record.command);
  }
  return 0;
}

void AddEngine(const Subcommand& jobs, const std::string& engine, const std::string& text,
               Action& action) {
  auto options = std::make_shared<JobsOptions>();
  const Subcommand command = jobs.AddCommand(engine, text);
  command
      .Add("STUDY", options->study,
           "A study's name, or a command: eval, dataset grasps, dataset labels, dataset states, "
           "train (with --seeds)")
      .Required();
  command.Add("WORDS", options->words, "More words of it");
  command.AddRest("ITS_OPTIONS", "After --: options of it, or all of it");
  command.AddNote("options of the study follow --, as in: pregrasp jobs " + engine +
                  " --tasks 8 --out out/jobs -- eval --seeds 5");
  command.Add("--tasks", options->tasks, "Tasks to cut it into").Within({1, 1e6, 1}).Required();
  command.Add("--out", options->out, "Folder of the job files, items, logs and result").Required();
  command.Add("--cpus", options->cpus, "Threads of each task").Within({1, 256, 1}).ShowDefault();
  command.AddFlag("--dry-run", options->dry_run, "Write nothing: show what would run");
  if (engine != "parallel") {
    command
        .Add("--time", options->minutes,
             "Minutes to ask for each task; without it, what measured items say")
        .Within({1, 1e6, 1});
    command.Add("--memory", options->memory_mb, "MB to ask for each task; without it, likewise")
        .Within({1, 1e7, 1});
  }
  if (engine == "slurm") {
    command.Add("--first-index", options->first_index, "Array index of the first task")
        .Within({0, 1, 1})
        .ShowDefault();
  }
  command.OnChosen([options, engine, &action] {
    action = [options, engine] { return Jobs(engine, *options); };
  });
}

}  // namespace

void AddJobs(const Subcommand& app, Action& action) {
  const Subcommand jobs =
      app.AddCommand("jobs", "Write the files that run a study or a data set on many machines");
  jobs.RequireCommand();
  AddEngine(jobs, "slurm", "A Slurm array, and a merge that waits for it", action);
  AddEngine(jobs, "parallel", "A script for GNU parallel", action);
  AddEngine(jobs, "snakemake", "A Snakefile", action);
  auto options = std::make_shared<StatusOptions>();
  const Subcommand status =
      jobs.AddCommand("status", "What became of each item, as a table; how to make one alone");
  status.Add("DIR", options->folder, "Folder that jobs wrote").Required();
  status.AddFlag("--complete", options->complete,
                 "Only check that all items are made: else bad input");
  status.AddFlag("--incomplete", options->incomplete,
                 "Print the tasks with items to make as Slurm arrays: offset, indices");
  status.Add("--max-array", options->max_array, "The cluster's MaxArraySize")
      .Within({2, 1e9, 1})
      .ShowDefault();
  status.OnChosen([options, &action] { action = [options] { return Status(*options); }; });
}

}  // namespace pregrasp
