#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace pregrasp {

/// What is at `path` where a file should be, for the "got" of a message: "nothing of that name", "a
/// folder", "a pipe", "a device"; empty for a plain file. Links are followed.
std::string DescribeNonFile(const std::filesystem::path& path);

/// The same as a clause behind the file's name: "which does not exist", "which is a folder".
std::string NonFileClause(const std::filesystem::path& path);

/// Whether a path that the user gave, or one below it, is such that nothing can be looked at there.
bool IsOutOfReach(const std::error_code& code);

}  // namespace pregrasp
