#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pregrasp {

/// SHA-256 as 64 lower-case hex digits.
std::string Sha256(std::string_view bytes);

/// Of a whole file. @throws InputError if it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& file);

/// Of the running program's own file, read once.
const std::string& Sha256OfProgram();

}  // namespace pregrasp
