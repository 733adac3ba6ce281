#pragma once

#include <filesystem>

namespace pregrasp {

/// The folder that holds assets/, lua/ and scenes/: beside the program (two folders up, as in a
/// build folder, or
/// ../share/pregrasp, as installed), else where the program was built.
std::filesystem::path DataFolder();

}  // namespace pregrasp
