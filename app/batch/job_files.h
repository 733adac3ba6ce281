#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pregrasp {

/// A batch cut into tasks for an engine that runs them; each task is a shard, made by an ordinary
/// command line of ours. In `folder`:
///   jobs.json    this plan                    task.sh, merge.sh  one task; the merge of all items
///   made/        the items, of all tasks      logs/              what each task said
///   result/      the merged batch             runs.csv           a row an item (job_status.h)
/// and what the engine takes (WriteJobFiles).
struct JobPlan {
  std::string engine;               ///< "slurm", "parallel" or "snakemake"
  std::filesystem::path folder;     ///< absolute
  std::filesystem::path directory;  ///< where the command's relative names begin
  std::vector<std::string>
      command;                     ///< the program and its words, but for --shard, --out, --threads
  std::vector<std::string> merge;  ///< what puts `made` together at `result`; empty: nothing does
  std::string program;             ///< pregrasp
  bool takes_threads = true;       ///< the command knows --threads
  std::filesystem::path items_in;  ///< of the item files, in `folder`: "made/items"
  std::string extension;           ///< of an item's file
  std::int64_t items = 1, tasks = 1;
  int cpus = 1;                    ///< of each task
  int first_index = 1;             ///< the array index of the first task: 0 or 1 (slurm)
  int minutes = 0, memory_mb = 0;  ///< asked for each task; 0: nothing is asked

  std::filesystem::path made() const { return folder / "made"; }
  /// The task that makes an item, from 1.
  std::int64_t TaskOf(std::int64_t item) const { return item % tasks + 1; }
};

struct JobFile {
  std::string name, text;
  bool executable = false;
};

/// The files of the plan, jobs.json among them; the text of jobs.json alone decides the others.
std::vector<JobFile> MakeJobFiles(const JobPlan& plan);

/// Writes them. @throws InputError.
void WriteJobFiles(const JobPlan& plan);

/// The plan that a folder holds. @throws InputError.
JobPlan ReadJobPlan(const std::filesystem::path& folder);

/// The command line of one task, or of all.
std::vector<std::string> TaskCommand(const JobPlan& plan, const std::string& shard);

}  // namespace pregrasp
