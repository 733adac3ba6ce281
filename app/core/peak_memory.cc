#include "app/core/peak_memory.h"

#include <sys/resource.h>

namespace pregrasp {

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace pregrasp
