#pragma once

#include <filesystem>
#include <vector>

#include "app/scene/settings.h"
#include "app/studies/ladder.h"

namespace pregrasp {

/// Runs a ladder's file, which ends with
///   return ladder{ scene = "scenes/book.lua",
///                  poses = { { p = .., rpy_deg = .., press = { finger = .., p_OC = .. } }, .. } }
/// with the limits of a scene file, and loads its scene: looked for beside the file, then in the
/// working directory, then among the program's own. A pose's p and rpy_deg are the object's, as in
/// a scene file. Applies the settings that name a part of the scene, and takes them out of the
/// list.
/// @throws InputError with file:line.
Ladder LoadLadderFile(const std::filesystem::path& file, std::vector<Setting>& settings);

}  // namespace pregrasp
