#include "app/batch/run_items.h"

#include <mutex>
#include <string>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/thread_pool.h"

namespace pregrasp {

void BatchRun::Validate() const {
  if (items < 1) throw InputError("", "items", "at least 1", std::to_string(items));
  shard.Validate();
}

void RunItems(const BatchRun& run, const ItemFolder& folder,
              const std::function<void(std::int64_t)>& make,
              const std::function<void(const BatchProgress&)>& progress) {
  run.Validate();
  BatchProgress state;
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
  ThreadPool pool(run.threads);
  std::mutex mutex;
  pool.ParallelFor(static_cast<int>(missing.size()), [&](int k, int) {
    ThrowIfInterrupted();
    make(missing[k]);
    const std::lock_guard lock(mutex);
    ++state.done;
    if (progress) progress(state);
  });
}

}  // namespace pregrasp
