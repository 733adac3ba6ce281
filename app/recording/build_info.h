#pragma once

#include <map>
#include <string>

namespace pregrasp {

/// "0.1.0": the project's version, which is the planner's.
const char* ProgramVersion();

/// The commit this was built from, 40 hex digits, with "-dirty" when tracked files differed from
/// it; "unknown" outside git.
const char* GitHash();

/// Versions of the libraries that this folder uses, by lower-case name. Whoever composes a run adds
/// those that other folders own.
std::map<std::string, std::string> BuildLibraries();

}  // namespace pregrasp
