#include "app/batch/run_items.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <vector>

#include "app/batch/item_record.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/peak_memory.h"
#include "app/core/thread_pool.h"

namespace pregrasp {
namespace {

// Makes an item with its record. @returns why it failed, if that was our bug.
std::optional<std::string> MakeWithRecord(const BatchRun& run, std::int64_t index,
                                          const std::function<std::string(std::int64_t)>& make) {
  ItemRecord record = BeginRecord(index, run.items);
  if (!run.records.empty()) WriteRecord(run.records, record);
  const auto start = std::chrono::steady_clock::now();
  const auto end_with = [&](const char* verdict, const std::string& text) {
    record.verdict = verdict;
    record.text = text;
    record.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    record.peak_rss_mb = PeakMegabytes();
    if (!run.records.empty()) WriteRecord(run.records, record);
  };
  try {
    end_with("done", make(index));
    return std::nullopt;
  } catch (const Interrupted& error) {
    end_with("interrupted", "");
    throw;
  } catch (const InternalError& error) {
    end_with("failed", error.what());
    return fmt::format("item {}: {}; again: {}", index, error.what(), record.command);
  } catch (const std::exception& error) {
    end_with("failed", error.what());
    throw;
  }
}

}  // namespace

void BatchRun::Validate() const {
  if (items < 1) throw InputError("", "items", "at least 1", std::to_string(items));
  shard.Validate();
}

std::string DescribeCounts(const std::string& folder, const BatchProgress& counts) {
  return fmt::format("{}: {} items, {} in this shard, {} of them made", folder, counts.items,
                     counts.total, counts.done);
}

std::optional<std::int64_t> ParseItemCount(const std::string& text) {
  const std::regex end(R"((\d{1,18}) items, \d+ in this shard, \d+ of them made\n?$)");
  std::smatch match;
  if (!std::regex_search(text, match, end)) return std::nullopt;
  return std::stoll(match[1]);
}

void RunItems(const BatchRun& run, const ItemFolder& folder,
              const std::function<std::string(std::int64_t)>& make,
              const std::function<void(const BatchProgress&)>& progress) {
  run.Validate();
  BatchProgress state;
  state.items = run.items;
  std::vector<std::int64_t> missing;
  for (std::int64_t i = 0; i < run.items; ++i) {
    if (!run.shard.Holds(i)) continue;
    ++state.total;
    if (folder.Has(i)) {
      ++state.done;
    } else {
      missing.push_back(i);
    }
  }
  if (progress) progress(state);
  if (run.only_count) return;
  if (!run.records.empty()) MakeFolders(run.records);
  ThreadPool pool(run.threads);
  std::mutex mutex;
  std::atomic<bool> stopped = false;
  std::map<std::int64_t, std::string> failures;
  pool.ParallelFor(static_cast<int>(missing.size()), [&](int k, int) {
    if (stopped) return;
    try {
      ThrowIfInterrupted();
      const std::optional<std::string> failure = MakeWithRecord(run, missing[k], make);
      const std::lock_guard lock(mutex);
      if (failure) {
        failures.emplace(missing[k], *failure);
        return;
      }
      ++state.done;
      if (progress) progress(state);
    } catch (...) {
      stopped = true;
      throw;
    }
  });
  if (failures.empty()) return;
  throw InternalError(fmt::format("{} of {} items failed; {}", failures.size(), state.total,
                                  failures.begin()->second));
}

}  // namespace pregrasp
