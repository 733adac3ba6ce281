#pragma once

#include <cstdint>
#include <string>

#include "app/core/thread_pool.h"
#include "app/grasp/start_certificate.h"

namespace pregrasp {

/// Whether the object can be grasped where it stands, and where the answer comes from.
struct StartReport {
  StartCertificate certificate;
  bool stored = false;  ///< found among earlier verdicts, not computed now
};

/// Looks the verdict up by the scene's hash, else finds it (design, section 4: by proof, else by
/// search) and stores it for the next time.
/// @param scene  loaded.
StartReport FindStartReport(const Scene& scene, std::uint64_t seed, ThreadPool& pool);

/// One sentence with the numbers that decided.
std::string DescribeStart(const StartReport& report);

}  // namespace pregrasp
