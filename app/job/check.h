#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace pregrasp {

/// Something about a scene that its author should know.
struct CheckFinding {
  enum class Severity {
    kNote,     ///< worth knowing, and no reason to change anything
    kWarning,  ///< it runs, but perhaps not as meant
    kError,    ///< nothing can be planned from it
  };
  Severity severity = Severity::kWarning;
  std::string where;    ///< file:line of the body it is about, or of the scene
  std::string message;  ///< one sentence, with numbers and units
};

/// What of a body's mesh files was mended when they were loaded (`repair = true`), as notes.
std::vector<CheckFinding> ListRepairs(const Scene& scene);

/// Looks for what validation cannot see: bodies that overlap (by 0.05 mm or more), that float or do
/// not stay at rest for 1 s, physics that does not converge there, sizes and densities that look
/// like another unit, clouds whose points end along a rim, departures from the project's physical
/// rules; and lists repairs. Errors first.
/// @param scene  loaded.
std::vector<CheckFinding> CheckScene(const Scene& scene);

}  // namespace pregrasp
