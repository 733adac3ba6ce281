#pragma once

#include <map>
#include <string>

namespace pregrasp {

/// "0.1.0": the project's version, which is the planner's.
const char* ProgramVersion();

/// The commit this was built from, 40 hex digits, with "-dirty" when tracked files differed from
/// it; "unknown" outside git.
const char* GitHash();

/// "gcc 12.2.0", "clang 14.0.6".
std::string Compiler();

/// What the processor can do of what results depend on: "avx avx2 fma"; the kernels that are chosen
/// at run time, and the C library's, follow from it.
std::string ProcessorFeatures();

/// Versions of the libraries that a result depends on, by lower-case name: of those built from
/// headers what was compiled in, of shared ones that of the file that is loaded, where it names
/// one. Whoever composes a run adds those that cannot be found so.
std::map<std::string, std::string> BuildLibraries();

}  // namespace pregrasp
