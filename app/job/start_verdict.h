#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "app/core/thread_pool.h"
#include "app/grasp/start_certificate.h"

namespace pregrasp {

/// Whether the object can be grasped where it stands (design, section 4: by proof, else by search):
/// the verdict stored under the scene's hash, else found now and stored for the next time.
/// @param scene    loaded.
/// @param weights  the folder of the networks' weights; read only where there is no proof.
/// @throws InputError for weights that are missing or damaged where they are needed.
StartCertificate FindSceneVerdict(const Scene& scene, const HandModel& hand, std::uint64_t seed,
                                  const std::filesystem::path& weights, ThreadPool& pool);

/// One sentence with the numbers that decided.
std::string DescribeStart(const StartCertificate& certificate);

}  // namespace pregrasp
