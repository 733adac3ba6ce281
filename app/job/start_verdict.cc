#include "app/job/start_verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "app/grasp/verdict_store.h"

namespace pregrasp {

StartCertificate FindSceneVerdict(const Scene& scene, std::uint64_t seed, ThreadPool& pool) {
  StartCertificateConfig config;
  config.seed = seed;
  const GraspWorld world(scene, ShadowHand());
  return FindStartVerdict(world, config, {}, {DefaultVerdictFolder()}, pool);
}

std::string DescribeStart(const StartCertificate& certificate) {
  switch (certificate.verdict) {
    case StartVerdict::kCertified:
      return fmt::format(
          "ungraspable at the start, certified for contacts on faces: no forces at the {} points "
          "that a fingertip can reach balance the weight at friction {:g}{}",
          certificate.reachable_points, certificate.mu,
          std::isinf(certificate.mu_star)
              ? ""
              : fmt::format("; that would take {:g}", certificate.mu_star));
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
