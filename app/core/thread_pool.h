#pragma once

#include <functional>
#include <memory>

#include "app/core/number_range.h"

namespace pregrasp {

/// A fixed set of workers for loops whose iterations are independent. Iterations may run in any
/// order on any worker, so each must write only to its own slot; reductions are the caller's, in
/// index order.
class ThreadPool {
 public:
  /// How many threads a user may ask for.
  static constexpr NumberRange kThreads{0, 256, 1};

  /// @param num_threads  workers including the calling thread; 0 means one per hardware thread.
  explicit ThreadPool(int num_threads = 0);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int num_threads() const;

  /// Calls body(index, worker) for index in [0, count), worker in [0, num_threads()), and returns
  /// when all are done. The exception of the lowest failing index is rethrown, after all others
  /// have ended. Where the user asked to stop, indices that are not begun yet throw Interrupted in
  /// place of body. Not reentrant.
  void ParallelFor(int count, const std::function<void(int index, int worker)>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
