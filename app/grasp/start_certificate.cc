#include "app/grasp/start_certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/grasp/edge_contacts.h"

namespace pregrasp {

namespace {

void CountPoints(const GraspWorld& world, const std::vector<EdgePoint>& edges,
                 const std::vector<GraspContact>& touched, StartCertificate& certificate) {
  certificate.surface_points = static_cast<int>(world.surface().P.rows());
  certificate.edge_points = static_cast<int>(edges.size());
  const GraspContact* last = nullptr;
  for (const GraspContact& contact : touched) {
    if (!contact.on_edge) {
      ++certificate.reachable_points;
    } else if (last == nullptr || last->p_OC != contact.p_OC) {
      ++certificate.reachable_edge_points;
    }
    if (contact.on_edge) last = &contact;
  }
}

}  // namespace

const char* StartVerdictName(StartVerdict verdict) {
  constexpr const char* kNames[] = {"certified", "searched", "graspable"};
  return kNames[static_cast<int>(verdict)];
}

StartCertificateConfig::StartCertificateConfig() {
  search.max_sets = 20000000;  // a minute or two, where hardly any set is within reach
  search.max_plausible = kLeastWithinReach;
  search.max_solves = 5000;  // a minute or two on two cores, where none of them is within reach
  search.grasp.kinematics.ik.max_starts = 20;
  search.grasp.kinematics.reach_starts = 20;
  search.sampler.slack.environment = search.grasp.kinematics.ik.tip_tolerance;
}

void StartCertificateConfig::Validate() const {
  search.Validate();
  if (search.max_plausible < kLeastWithinReach) {
    throw InputError("start_certificate", "search.max_plausible",
                     fmt::format("at least {}", kLeastWithinReach),
                     std::to_string(search.max_plausible));
  }
}

std::vector<GraspContact> FindReachableContacts(const GraspWorld& world, const IkConfig& kinematics,
                                                const std::vector<EdgePoint>& edges,
                                                const std::vector<RigidTransform>& X_WB,
                                                ThreadPool& pool) {
  // A feasible grasp may hold a tip this far from where it touches, and a contacting link this deep
  // in the object: what a tip cannot reach even so, no grasp touches.
  TouchSlack slack;
  slack.environment = kinematics.tip_tolerance;
  slack.object = kinematics.tip_tolerance + kinematics.contact_depth;
  const TipSpheres& tips = world.tips();
  const double radius = *std::min_element(tips.radii.begin(), tips.radii.begin() + tips.count);
  const SurfacePoints& surface = world.surface();
  std::vector<GraspContact> contacts;
  for (int i = 0; i < surface.P.rows(); ++i) {
    ThrowIfInterrupted();
    const Vector3 p = surface.P.row(i);
    const Vector3 nhat = surface.N.row(i);
    if (CanTouch(p, nhat, radius, slack, world.object(), world.environment(), X_WB)) {
      contacts.push_back({Finger::kIndex, p, nhat});
    }
  }
  // No grasp uses these, so nothing that it tolerates in the surroundings has to be allowed here.
  const std::vector<GraspContact> on_edges =
      FindOuterEdgeContacts(world, edges, radius, kinematics.tip_tolerance, X_WB, pool);
  contacts.insert(contacts.end(), on_edges.begin(), on_edges.end());
  return contacts;
}

StartCertificate CertifyStart(const GraspWorld& world, const StartCertificateConfig& config,
                              const GraspProposer& proposer, ThreadPool& pool,
                              const std::function<void(const GraspSearchStats&)>& progress) {
  config.Validate();
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const IkConfig& kinematics = config.search.grasp.kinematics.ik;
  const std::vector<EdgePoint> edges =
      FindEdgePoints(world.scene().object().shape, world.surface().spacing, kLeastFan);
  const std::vector<GraspContact> touched =
      FindReachableContacts(world, kinematics, edges, X_WB, pool);
  const std::vector<WrenchContact> reachable = world.ToWrenchContacts(touched);
  const WrenchConfig wrench = world.MakeWrenchConfig(0.0, X_WB.at(0).linear());

  StartCertificate certificate;
  certificate.mu = wrench.mu;
  certificate.spacing = world.surface().spacing;
  CountPoints(world, edges, touched, certificate);
  const auto is_proof = [&](const BalanceProof& proof) {
    certificate.proof_slack =
        CalcProofSlack(reachable, wrench.mu, wrench.gravity, wrench.torque_scale, proof.direction);
    // Between the samples of a face the proof must hold too.
    return certificate.proof_slack > 0.0 && proof.covered >= certificate.spacing;
  };
  if (wrench.gravity.norm() > 0.0) {  // without weight there is nothing to prove
    const ProofLimit limit =
        FindProofLimit(reachable, wrench.gravity, wrench.torque_scale, certificate.spacing);
    certificate.mu_star = limit.mu;
    certificate.proof = FindBalanceProof(reachable, wrench.mu, wrench.gravity, wrench.torque_scale);
    if (!(certificate.proof.impossible && is_proof(certificate.proof)) && wrench.mu <= limit.mu) {
      certificate.proof = limit.proof;
    }
  }
  if (certificate.proof.impossible && is_proof(certificate.proof)) {
    certificate.verdict = StartVerdict::kCertified;
    return certificate;
  }
  std::optional<GraspResult> example;
  if (proposer.propose) {
    ProposedGrasps proposed = proposer.propose();
    certificate.proposed_nodes = proposed.nodes;
    certificate.proposed_samples = proposed.samples;
    example = std::move(proposed.feasible);
  }
  if (!example) {
    const ContactPlaces places(world, X_WB, config.search.sampler.slack, edges,
                               kinematics.tip_tolerance);
    GraspSearchResult search = SearchGrasps(places, config.search, {}, config.seed, pool, progress);
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
