#pragma once

#include <cstddef>
#include <optional>

#include "app/recording/loaded_run.h"
#include "app/session/picture_file.h"
#include "render/image.h"

namespace pregrasp {

/// The steps that a run is told by (RunSteps::FindStory) in a grid, in their order, all seen by one
/// camera, each with its id, its time and what it says in a sentence.
/// @param shot    what the pictures show; its size is that of the whole sheet, whose height is only
///                an upper limit. @param view  towards the camera; unset takes the automatic one.
/// @throws InputError for a sheet too small to hold a picture that can be seen.
Image DrawContactSheet(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
                       std::size_t most = 20);

}  // namespace pregrasp
