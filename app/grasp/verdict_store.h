#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/grasp/start_certificate.h"

namespace pregrasp {

/// What a start verdict depends on, as 64 hex digits: shapes, poses, the object's mass and centre
/// of mass, gravity, fingertips, the hand, the configuration, who proposes grasps, and the program
/// itself (the SHA-256 of its file). Names, cameras, friction between bodies and anything else may
/// change without a new verdict.
std::string StartVerdictKey(const Scene& scene, const HandModel& hand,
                            const SurfacePointsConfig& surface,
                            const StartCertificateConfig& config,
                            const GraspProposer& proposer = {});

/// Where verdicts are kept between runs: $XDG_CACHE_HOME/pregrasp/verdicts, or
/// ~/.cache/pregrasp/verdicts; empty when neither variable is set.
std::filesystem::path DefaultVerdictFolder();

/// The verdict stored under `key`; none if there is none, or if the file is damaged, of another
/// key.
std::optional<StartCertificate> LoadStartVerdict(const std::filesystem::path& folder,
                                                 const std::string& key);

/// Writes folder/KEY.json, which appears at once and whole, so that any number of programs may
/// store and load at the same time. The cache is a convenience: where it cannot be written, false.
bool StoreStartVerdict(const std::filesystem::path& folder, const std::string& key,
                       const StartCertificate& certificate);

/// CertifyStart, unless one of `folders` knows the verdict; a new one is stored in the last.
StartCertificate FindStartVerdict(
    const GraspWorld& world, const StartCertificateConfig& config, const GraspProposer& proposer,
    const std::vector<std::filesystem::path>& folders, ThreadPool& pool,
    const std::function<void(const GraspSearchStats&)>& progress = {});

}  // namespace pregrasp
