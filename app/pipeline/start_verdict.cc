#include "app/pipeline/start_verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "app/grasp/verdict_store.h"

namespace pregrasp {

StartReport FindStartReport(const Scene& scene, std::uint64_t seed, ThreadPool& pool) {
  StartCertificateConfig config;
  config.seed = seed;
  const SurfacePointsConfig surface;
  const HandModel& hand = ShadowHand();
  const std::filesystem::path folder = DefaultVerdictFolder();
  const std::string key = StartVerdictKey(scene, hand, surface, config);
  if (auto stored = LoadStartVerdict(folder, key)) return {std::move(*stored), true};
  const GraspWorld world(scene, hand, surface);
  StartReport report{CertifyStart(world, config, pool), false};
  StoreStartVerdict(folder, key, report.certificate);
  return report;
}

std::string DescribeStart(const StartReport& report) {
  const StartCertificate& certificate = report.certificate;
  switch (certificate.verdict) {
    case StartVerdict::kCertified:
      return fmt::format(
          "ungraspable at the start, certified: no forces at the {} surface points that a "
          "fingertip can reach balance the weight at friction {:g}; {}",
          certificate.reachable_points, certificate.mu,
          std::isinf(certificate.mu_star)
              ? "nor would they at any"
              : fmt::format("that would take {:g}", certificate.mu_star));
    case StartVerdict::kSearched:
      return fmt::format(
          "ungraspable at the start as far as a search can tell: 0 of {} contact sets are feasible "
          "({} hold, {} of them within reach)",
          certificate.search.tried, certificate.search.held, certificate.search.reached);
    case StartVerdict::kGraspable:
      break;
  }
  std::string fingers;
  for (const GraspContact& contact : certificate.example->contacts) {
    fingers += (fingers.empty() ? "" : ", ") + std::string(FingerName(contact.finger));
  }
  return fmt::format("graspable at the start: {} close on it, found after {} contact sets", fingers,
                     certificate.search.drawn);
}

}  // namespace pregrasp
