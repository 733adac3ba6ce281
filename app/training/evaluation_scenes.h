#pragma once

#include <filesystem>
#include <vector>

namespace pregrasp {

/// The scene files whose objects no training object may resemble, sorted: those of `scenes/` under
/// the program's data folder.
/// @throws InputError if the folder is missing or holds no scene: then nothing would be excluded.
std::vector<std::filesystem::path> FindEvaluationScenes(const std::filesystem::path& data);

}  // namespace pregrasp
