#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "app/recording/loaded_run.h"
#include "app/session/picture_file.h"

namespace pregrasp {

/// Whether a file's name asks for a film: .mp4, .webm, .gif.
bool IsFilmFile(const std::filesystem::path& file);

/// The hand motion of a finished run as a film, each frame drawn, all by one camera, and encoded by
/// the program ffmpeg: H.264 for .mp4, VP9 for .webm; a .gif shows every third frame. The same run
/// and the same ffmpeg give the same bytes. The file appears when it is whole.
/// @param shot      what every frame shows; its size is made even.
/// @param view    towards the camera; unset takes the automatic one.
/// @param progress  called with the frames that are done and that there are.
/// @throws InputError for a run without a motion, without ffmpeg, or if ffmpeg fails.
void WriteFilm(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
               const std::filesystem::path& file, const std::function<void(int, int)>& progress);

}  // namespace pregrasp
