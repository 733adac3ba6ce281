#include "app/geometry/read_in_child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "app/core/interrupt.h"
#include "app/geometry/read_mesh.h"

namespace pregrasp {
namespace {

using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;  // the sanitizers map terabytes
#else
constexpr bool kLimitMemory = true;
#endif

// What the child sends first.
struct AnswerHeader {
  char kind = 0;  // 'm': a mesh of first x 3 doubles and second x 3 ints; 'e': two texts
  std::int64_t first = 0, second = 0;
};

void Limit(int resource, rlim_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

void LimitThisProcess(const ReadLimits& limits) {
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(limits.seconds)));
  if (!kLimitMemory) return;
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto now = static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  Limit(RLIMIT_AS, now + (static_cast<rlim_t>(limits.megabytes) << 20U));
}

bool Send(int descriptor, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(descriptor, at, size);
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool SendMesh(int descriptor, const TriangleMesh& mesh) {
  const AnswerHeader header{'m', mesh.V.rows(), mesh.F.rows()};
  return Send(descriptor, &header, sizeof header) &&
         Send(descriptor, mesh.V.data(),
              sizeof(double) * static_cast<std::size_t>(mesh.V.size())) &&
         Send(descriptor, mesh.F.data(), sizeof(int) * static_cast<std::size_t>(mesh.F.size()));
}

bool SendProblem(int descriptor, const std::string& expected, const std::string& got) {
  const AnswerHeader header{'e', static_cast<std::int64_t>(expected.size()),
                            static_cast<std::int64_t>(got.size())};
  return Send(descriptor, &header, sizeof header) &&
         Send(descriptor, expected.data(), expected.size()) &&
         Send(descriptor, got.data(), got.size());
}

[[noreturn]] void RunChild(int descriptor, const std::function<TriangleMesh()>& read,
                           const ReadLimits& limits) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  LimitThisProcess(limits);
  bool sent = false;
  try {
    sent = SendMesh(descriptor, read());
  } catch (const UnreadableFile& error) {
    sent = SendProblem(descriptor, error.expected, error.got);
  } catch (const std::bad_alloc&) {
    sent = SendProblem(descriptor, "a file that can be read in limited memory",
                       fmt::format("which takes more than {} MB", limits.megabytes));
  } catch (const std::exception& error) {
    sent = SendProblem(descriptor, "a mesh that can be read",
                       std::string("of which its reader says: ") + error.what());
  }
  _exit(sent ? 0 : 1);  // the parent's buffers are its own
}

// The child, and what comes from it.
class Child {
 public:
  Child(const std::function<TriangleMesh()>& read, const ReadLimits& limits)
      : end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                std::chrono::duration<double>(3.0 * limits.seconds))) {
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0) {
      throw std::system_error(errno, std::generic_category(), "a pipe");
    }
    pid_ = fork();
    const int reason = errno;
    if (pid_ == 0) {
      close(ends[0]);
      RunChild(ends[1], read, limits);
    }
    close(ends[1]);
    descriptor_ = ends[0];
    if (pid_ < 0) {
      close(descriptor_);
      throw std::system_error(reason, std::generic_category(), "a process to read a mesh");
    }
  }
  ~Child() {
    if (!status_) kill(pid_, SIGKILL);
    Await();
    close(descriptor_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // False where the child sends no more: it ended, or is out of time.
  bool Receive(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      ThrowIfInterrupted();
      if (Clock::now() > end_) return false;
      pollfd waiting{descriptor_, POLLIN, 0};
      if (poll(&waiting, 1, 50) <= 0) continue;
      const ssize_t got = ::read(descriptor_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

  // How it ended; ends it if it still runs.
  int Await() {
    if (status_) return *status_;
    if (Clock::now() > end_) kill(pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    status_ = status;
    return status;
  }

 private:
  Clock::time_point end_;
  pid_t pid_ = -1;
  int descriptor_ = -1;
  std::optional<int> status_;
};

std::string ReceiveText(Child& child, std::int64_t size) {
  std::string text(static_cast<std::size_t>(size), '\0');
  return child.Receive(text.data(), text.size()) ? text : "";
}

[[noreturn]] void ThrowForEnd(int status, const ReadLimits& limits) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGKILL) {
    throw UnreadableFile("a file that can be read in limited time",
                         fmt::format("which takes more than {:g} s", limits.seconds));
  }
  throw UnreadableFile("a mesh that can be read", "on which its reader fails");
}

}  // namespace

TriangleMesh ReadInChild(const std::function<TriangleMesh()>& read, const ReadLimits& limits) {
  Child child(read, limits);
  AnswerHeader header;
  if (!child.Receive(&header, sizeof header)) ThrowForEnd(child.Await(), limits);
  if (header.kind == 'e') {
    const std::string expected = ReceiveText(child, header.first);
    throw UnreadableFile(expected, ReceiveText(child, header.second));
  }
  TriangleMesh mesh;
  mesh.V.resize(header.first, 3);
  mesh.F.resize(header.second, 3);
  const bool whole =
      child.Receive(mesh.V.data(), sizeof(double) * static_cast<std::size_t>(mesh.V.size())) &&
      child.Receive(mesh.F.data(), sizeof(int) * static_cast<std::size_t>(mesh.F.size()));
  if (!whole) ThrowForEnd(child.Await(), limits);
  return mesh;
}

}  // namespace pregrasp
