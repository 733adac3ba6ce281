#pragma once

#include <functional>

#include "app/scene/shape.h"

namespace pregrasp {

/// What a reader of untrusted files may take.
struct ReadLimits {
  double seconds = 20.0;        ///< of the processor; three times as much of the clock
  std::size_t megabytes = 800;  ///< beside what the process has already
};

/// Runs `read` in a process of its own and gives its triangles: a library that crashes, loops or
/// swells on a bad file takes nothing else with it. Under the address sanitizer memory is not
/// limited. The child ends with the caller's Ctrl-C.
/// @throws UnreadableFile as `read` does, or if it crashed or went beyond a limit; Interrupted.
TriangleMesh ReadInChild(const std::function<TriangleMesh()>& read, const ReadLimits& limits = {});

}  // namespace pregrasp
