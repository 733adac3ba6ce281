#include "app/batch/job_status.h"

#include <fmt/format.h>

#include "app/batch/item_folder.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

std::string CsvText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::vector<JobItem> FindJobItems(const JobPlan& plan) {
  std::vector<JobItem> items;
  for (std::int64_t i = 0; i < plan.items; ++i) {
    JobItem item;
    item.item = i;
    item.task = plan.TaskOf(i);
    item.record = ReadRecord(plan.made() / "records", i);
    const bool made =
        std::filesystem::exists(ItemPath(plan.folder / plan.items_in, i, plan.extension));
    item.verdict = made ? "done" : item.record ? item.record->verdict : "waiting";
    if (!made && item.verdict == "done") item.verdict = "waiting";  // its file was taken away
    items.push_back(std::move(item));
  }
  return items;
}

std::string TabulateJobItems(const std::vector<JobItem>& items) {
  std::string table = "item,task,verdict,seconds,peak_rss_mb,host,log,text,directory,command\n";
  for (const JobItem& item : items) {
    const ItemRecord record = item.record.value_or(ItemRecord());
    const bool ended = item.record && record.verdict != "begun";
    table += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", item.item, item.task, item.verdict,
                         ended ? fmt::format("{:.2f}", record.seconds) : "",
                         ended ? fmt::format("{:.0f}", record.peak_rss_mb) : "",
                         CsvText(record.host), CsvText(record.log), CsvText(record.text),
                         CsvText(record.directory), CsvText(record.command));
  }
  return table;
}

std::vector<JobArray> FindJobArrays(const std::vector<std::int64_t>& tasks, int first_index,
                                    std::int64_t max_array) {
  const std::int64_t window = max_array - first_index;
  if (window < 1) {
    throw InputError("--max-array", "", "a number above the first index",
                     std::to_string(max_array));
  }
  std::vector<JobArray> arrays;
  std::int64_t previous = -1;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const std::int64_t offset = (tasks[k] - 1) / window * window;
    const std::int64_t index = tasks[k] - 1 - offset + first_index;
    if (arrays.empty() || arrays.back().offset != offset) {
      arrays.push_back({offset, std::to_string(index)});
    } else if (index != previous + 1) {
      arrays.back().indices += fmt::format(",{}", index);
    } else {
      // The end of a range, written when the range ends.
      const bool ends = k + 1 == tasks.size() || tasks[k + 1] != tasks[k] + 1 ||
                        (tasks[k + 1] - 1) / window * window != offset;
      if (ends) arrays.back().indices += fmt::format("-{}", index);
    }
    previous = index;
  }
  return arrays;
}

}  // namespace pregrasp
