#pragma once

#include <filesystem>
#include <vector>

#include "app/recording/loaded_run.h"
#include "app/recording/motion_table.h"
#include "app/recording/rollout_table.h"

namespace pregrasp {

/// A frame of a finished run's hand motion, with where the movable bodies are then, the object
/// first.
struct FilmFrame {
  MotionRecord motion;
  std::vector<RigidTransform> X_WB;
  std::vector<BodyRow::Contact> contacts;  ///< of the fingers that press
};
/// All of them; none for a run without motion.csv. @throws InputError for tables that cannot be
/// read.
std::vector<FilmFrame> ReadFilm(const LoadedRun& run);

/// The same. @throws InputError that names the run, if there is none.
std::vector<FilmFrame> RequireFilm(const LoadedRun& run);

/// Frame `index` (from 0) of a film as what a step of it would say, for pictures and words: the
/// step that the run ends in led to it.
StepFacts FrameStep(const LoadedRun& run, const std::vector<FilmFrame>& film, int index);

/// Writes the hand motion of a finished run as an animation in binary glTF: every body of the scene
/// by its name, every part of the hand as hand.N, at the times of motion.csv.
/// @throws InputError for a run without a motion, or a file that cannot be written.
void WriteMotionFilm(const LoadedRun& run, const std::filesystem::path& file);

}  // namespace pregrasp
