#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/page/picture_grid.h"
#include "app/page/run_steps.h"
#include "app/recording/loaded_run.h"
#include "app/session/picture_file.h"

namespace pregrasp {

/// A step to be drawn, of a finished run or of a session.
struct StripStep {
  const StepFacts* step = nullptr;  ///< null: there is none, and its place stays empty
  const FactsSource* steps = nullptr;
  PictureDrawer* drawer = nullptr;
};

/// What the words of a finished run's pictures say beside its steps.
PictureLabels LabelsOf(const LoadedRun& run);

/// A cell for each of them: all seen by one camera, each with its id, its time and what it says in
/// a sentence. @param steps  at least one that is not empty; what it points to outlives the cells.
/// @param shot   what the pictures show; without a camera of its own one is framed over all steps,
///               looking from `view` if that is given.
std::vector<PictureGrid::Cell> MakeCells(const std::vector<StripStep>& steps, const Shot& shot,
                                         const std::optional<Vector3>& view);

/// Steps side by side in their order; up to four are one row. @param shot  its size is that of the
/// whole strip, whose height is only an upper limit. @throws InputError for a strip too small.
Image DrawStrip(const std::vector<StripStep>& steps, const Shot& shot,
                const std::optional<Vector3>& view);

/// Steps of a finished run by their ids, likewise. @throws InputError with the nearest id.
Image DrawStripOfRun(const LoadedRun& run, const std::vector<std::string>& ids, const Shot& shot,
                     const std::optional<Vector3>& view);

/// The steps that a run is told by (RunSteps::FindStory) as one sheet, likewise.
Image DrawContactSheet(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
                       std::size_t most = 20);
Image DrawContactSheet(const RunSteps& steps, const FactsSource& source, PictureDrawer& drawer,
                       const Shot& shot, const std::optional<Vector3>& view, std::size_t most = 20);

}  // namespace pregrasp
