#include "app/core/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace pregrasp {

void OpenStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    if (open("/dev/null", O_RDWR) != stream) std::_Exit(1);  // the lowest that is free
  }
}

bool FlushStandardOutput() {
  errno = 0;
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

}  // namespace pregrasp
