#pragma once

#include <filesystem>

#include "app/recording/loaded_run.h"

namespace pregrasp {

/// Writes the hand motion of a finished run as an animation in binary glTF: every body of the scene
/// by its name, every part of the hand as hand.N, at the times of motion.csv.
/// @throws InputError for a run without a motion, or a file that cannot be written.
void WriteMotionFilm(const LoadedRun& run, const std::filesystem::path& file);

}  // namespace pregrasp
