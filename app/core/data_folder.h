#pragma once

#include <filesystem>

namespace pregrasp {

/// The folder that holds assets/, lua/ and scenes/: what the environment's PREGRASP_DATA says; else
/// beside the program (two folders up, as in a build folder, or ../share/pregrasp, as installed);
/// else where the program was built. @throws InputError if PREGRASP_DATA is no such folder.
std::filesystem::path DataFolder();

}  // namespace pregrasp
