#pragma once

#include <stdexcept>

namespace pregrasp {

/// The user asked to stop (Ctrl-C, or a polite kill). Long work polls for it and unwinds, leaving
/// what is finished valid; the program then exits with code 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// From now on SIGINT, SIGTERM and, unless it is ignored, SIGHUP only raise the flag that the
/// functions below read; a second one ends the program at once.
void InstallInterruptHandler();

bool InterruptRequested();

/// Whether one of them was not SIGINT: even a prompt that survives Ctrl-C then ends.
bool TerminationRequested();

/// Raises the flag as Ctrl-C does, or takes it back (for a prompt that goes on, and for tests).
void RequestInterrupt();
void ClearInterrupt();

/// @throws Interrupted if the flag is up. Cheap: call it once per physics step or row.
void ThrowIfInterrupted();

}  // namespace pregrasp
