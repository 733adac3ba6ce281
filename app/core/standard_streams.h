#pragma once

namespace pregrasp {

/// Gives standard input, output and error that are closed to /dev/null: files that are opened later
/// must not become them, or progress would be written into those. Ends the program with exit code 1
/// where even that cannot be had.
void OpenStandardStreams();

/// Whether what was printed has arrived: what is left is written out. errno says why it has not,
/// 0 where nothing does.
bool FlushStandardOutput();

}  // namespace pregrasp
