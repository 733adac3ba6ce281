#pragma once

#include <filesystem>
#include <optional>

#include "bindings/script.h"

namespace pregrasp {

/// Reads Lua from stdin, runs it piece by piece, and shows the values of expressions: at a terminal
/// with a prompt, history, completion and help(x); from a pipe without, like a script whose values
/// are shown. `pg` is require "pregrasp"; with a scene, `s` is its session.
///
/// At a terminal an error is shown with its traceback, and the next line is read; Ctrl-C ends what
/// runs and leaves all values as they are. From a pipe the first error ends it, as in RunScript.
/// Recordings that are open at the end are finished.
/// @throws InputError for a scene that cannot be opened, or the first error from a pipe;
/// Interrupted.
void RunRepl(const std::optional<std::filesystem::path>& scene, const ScriptConfig& config);

}  // namespace pregrasp
