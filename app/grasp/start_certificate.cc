#include "app/grasp/start_certificate.h"

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

namespace {

// The first of the generated sets that is a grasp.
std::optional<GraspResult> FindFeasible(const GraspWorld& world,
                                        const StartCertificateConfig& config,
                                        const std::vector<std::vector<GraspContact>>& generated,
                                        const std::vector<RigidTransform>& X_WB, ThreadPool& pool,
                                        GraspSearchStats* stats) {
  const int count = static_cast<int>(generated.size());
  std::vector<std::optional<GraspResult>> results(count);
  pool.ParallelFor(count, [&](int i, int) {
    const Rng rng(config.seed, RngStream::kProposedGraspIk, i);
    GraspResult result = TestGrasp(world, config.search.grasp, generated[i], X_WB, rng);
    if (result.feasible()) results[i] = std::move(result);
  });
  stats->tried += count;
  for (std::optional<GraspResult>& result : results) {
    if (!result) continue;
    stats->feasible = 1;
    return std::move(result);
  }
  return std::nullopt;
}

}  // namespace

const char* StartVerdictName(StartVerdict verdict) {
  constexpr const char* kNames[] = {"certified", "searched", "graspable"};
  return kNames[static_cast<int>(verdict)];
}

StartCertificateConfig::StartCertificateConfig() {
  search.max_sets = 200000;
  search.max_solves = 500;
  search.grasp.kinematics.ik.max_starts = 20;
  search.grasp.kinematics.reach_starts = 20;
  search.sampler.slack.environment = search.grasp.kinematics.ik.tip_tolerance;
}

void StartCertificateConfig::Validate() const {
  search.Validate();
  if (search.max_sets < kLeastTried) {
    throw InputError("start_certificate", "search.max_sets", "at least 700",
                     std::to_string(search.max_sets));
  }
}

std::vector<WrenchContact> FindReachableContacts(const GraspWorld& world,
                                                 const IkConfig& kinematics,
                                                 const std::vector<RigidTransform>& X_WB) {
  // A feasible grasp may hold a tip this far from where it touches, and a contacting link this deep
  // in the object: what a tip cannot reach even so, no grasp touches.
  TouchSlack slack;
  slack.environment = kinematics.tip_tolerance;
  slack.object = kinematics.tip_tolerance + kinematics.contact_depth;
  const double radius = FingertipRadius(Finger::kIndex);
  static_assert(FingertipRadius(Finger::kIndex) < FingertipRadius(Finger::kThumb));
  const SurfacePoints& surface = world.surface();
  std::vector<GraspContact> contacts;
  for (int i = 0; i < surface.P.rows(); ++i) {
    const Vector3 p = surface.P.row(i);
    const Vector3 nhat = surface.N.row(i);
    if (CanTouch(p, nhat, radius, slack, world.object(), world.environment(), X_WB)) {
      contacts.push_back({Finger::kIndex, p, nhat});
    }
  }
  return world.ToWrenchContacts(contacts);
}

StartCertificate CertifyStart(const GraspWorld& world, const StartCertificateConfig& config,
                              const std::vector<std::vector<GraspContact>>& generated,
                              ThreadPool& pool,
                              const std::function<void(const GraspSearchStats&)>& progress) {
  config.Validate();
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const IkConfig& kinematics = config.search.grasp.kinematics.ik;
  const std::vector<WrenchContact> reachable = FindReachableContacts(world, kinematics, X_WB);
  const WrenchConfig wrench = world.MakeWrenchConfig(0.0, X_WB.at(0).linear());

  StartCertificate certificate;
  certificate.mu = wrench.mu;
  certificate.surface_points = static_cast<int>(world.surface().P.rows());
  certificate.reachable_points = static_cast<int>(reachable.size());
  certificate.spacing = world.surface().spacing;
  if (wrench.gravity.norm() > 0.0) {  // without weight there is nothing to prove
    certificate.mu_star = FindLeastFriction(reachable, wrench.gravity, wrench.torque_scale);
    certificate.proof = FindBalanceProof(reachable, wrench.mu, wrench.gravity, wrench.torque_scale);
  }
  if (certificate.proof.impossible) {
    certificate.proof_slack = CalcProofSlack(reachable, wrench.mu, wrench.gravity,
                                             wrench.torque_scale, certificate.proof.direction);
    if (certificate.proof_slack > 0.0) {
      certificate.verdict = StartVerdict::kCertified;
      return certificate;
    }
  }
  std::optional<GraspResult> example =
      FindFeasible(world, config, generated, X_WB, pool, &certificate.search);
  if (!example) {
    GraspSearchResult search =
        SearchGrasps(world, config.search, {}, X_WB, config.seed, pool, progress);
    search.stats.tried += certificate.search.tried;
    certificate.search = search.stats;
    if (!search.found.empty()) example = std::move(search.found.front());
  }
  if (example) {
    certificate.verdict = StartVerdict::kGraspable;
    certificate.example = std::move(example);
  }
  return certificate;
}

}  // namespace pregrasp
