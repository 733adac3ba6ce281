#pragma once

#include <filesystem>
#include <memory>

#include "app/session/session.h"

namespace pregrasp {

/// What a finished run was made with: its seed and its settings before any command. Pictures are
/// not asked for. @throws InputError for a manifest that does not say so.
SessionConfig RunSessionConfig(const std::filesystem::path& run, int threads,
                               const std::filesystem::path& weights);

/// A session as it was when its run directory was written.
struct ResumedSession {
  std::shared_ptr<Session> session;
  const Timeline::Node* node = nullptr;  ///< where it stood: that the run's summary is of
};

/// Goes on from a finished run: all its steps are there under their ids, and any of them can be
/// acted on. Nothing is computed before a step is acted on or its state is asked for; what then
/// comes out is held against the record, to the last bit where the same build made it.
/// @param run  its hashes are checked. @throws InputError for a run that this program cannot
/// recompute (FindProvenance), that was changed, or that cannot be read.
ResumedSession ResumeSession(const std::filesystem::path& run, int threads,
                             const std::filesystem::path& weights);

}  // namespace pregrasp
