#include "app/core/thread_pool.h"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "app/core/check.h"
#include "app/core/interrupt.h"

namespace pregrasp {

struct ThreadPool::Impl {
  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(int, int)>* body = nullptr;
  std::uint64_t generation = 0;
  int count = 0, next = 0, busy = 0;
  bool stop = false;
  int failed_index = std::numeric_limits<int>::max();
  std::exception_ptr failure;
  std::vector<std::thread> threads;

  // Takes indices until none is left. Called with the lock held; released while the body runs.
  void Drain(std::unique_lock<std::mutex>& lock, int worker) {
    while (next < count) {
      const int index = next++;
      lock.unlock();
      std::exception_ptr error;
      try {
        ThrowIfInterrupted();
        (*body)(index, worker);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error && index < failed_index) {
        failed_index = index;
        failure = error;
      }
    }
  }

  void Work(int worker) {
    std::unique_lock lock(mutex);
    std::uint64_t seen = 0;
    while (true) {
      wake.wait(lock, [&] { return stop || generation != seen; });
      if (stop) return;
      seen = generation;
      ++busy;
      Drain(lock, worker);
      if (--busy == 0) done.notify_all();
    }
  }
};

ThreadPool::ThreadPool(int num_threads) : impl_(std::make_unique<Impl>()) {
  PREGRASP_CHECK(kThreads.Contains(num_threads), num_threads);
  if (num_threads == 0) num_threads = std::max(1U, std::thread::hardware_concurrency());
  for (int worker = 1; worker < num_threads; ++worker) {
    impl_->threads.emplace_back([this, worker] { impl_->Work(worker); });
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->wake.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
}

int ThreadPool::num_threads() const { return static_cast<int>(impl_->threads.size()) + 1; }

void ThreadPool::ParallelFor(int count, const std::function<void(int, int)>& body) {
  std::unique_lock lock(impl_->mutex);
  impl_->body = &body;
  impl_->count = count;
  impl_->next = 0;
  impl_->failure = nullptr;
  impl_->failed_index = std::numeric_limits<int>::max();
  ++impl_->generation;
  impl_->wake.notify_all();
  impl_->Drain(lock, 0);
  impl_->done.wait(lock, [&] { return impl_->busy == 0; });
  impl_->count = 0;
  if (impl_->failure) std::rethrow_exception(impl_->failure);
}

}  // namespace pregrasp
