#pragma once

#include <filesystem>
#include <string>

namespace pregrasp {

/// What is at `path` where a file should be, for the "got" of a message: "nothing of that name", "a
/// folder", "a pipe", "a device"; empty for a plain file. Links are followed.
std::string DescribeNonFile(const std::filesystem::path& path);

/// The same as a clause behind the file's name: "which does not exist", "which is a folder".
std::string NonFileClause(const std::filesystem::path& path);

}  // namespace pregrasp
