#include "app/core/interrupt.h"

#include <atomic>
#include <csignal>

namespace pregrasp {
namespace {

std::atomic<bool> interrupt_requested{false}, termination_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the signal handler needs a lock-free flag");

void HandleSignal(int signal) {
  if (signal != SIGINT) termination_requested = true;
  if (interrupt_requested.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void InstallInterruptHandler() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    // nohup: whoever started this does not want it to end with the terminal.
    if (signal == SIGHUP && sigaction(SIGHUP, nullptr, &action) == 0 &&
        action.sa_handler == SIG_IGN) {
      continue;
    }
    action = {};
    action.sa_handler = HandleSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

bool InterruptRequested() { return interrupt_requested.load(std::memory_order_relaxed); }

bool TerminationRequested() { return termination_requested.load(std::memory_order_relaxed); }

void RequestInterrupt() { interrupt_requested = true; }

void ClearInterrupt() { interrupt_requested = false; }

void ThrowIfInterrupted() {
  if (InterruptRequested()) throw Interrupted();
}

}  // namespace pregrasp
