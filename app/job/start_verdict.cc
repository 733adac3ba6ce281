#include "app/job/start_verdict.h"

#include <fmt/format.h>

#include <cmath>

#include "app/core/sha256.h"
#include "app/grasp/verdict_store.h"
#include "app/job/start_proposals.h"

namespace pregrasp {

namespace {

// What the generator's answer depends on beyond scene, seed and program.
std::string HashWeights(const std::filesystem::path& weights) {
  std::string key = "weights";
  for (const char* name : {"score.safetensors", "generator.safetensors"}) {
    std::error_code none;
    key += ' ';
    key += std::filesystem::exists(weights / name, none) ? Sha256OfFile(weights / name) : "none";
  }
  return key;
}

}  // namespace

StartCertificate FindSceneVerdict(const Scene& scene, const HandModel& hand, std::uint64_t seed,
                                  const std::filesystem::path& weights, ThreadPool& pool) {
  StartCertificateConfig config;
  config.seed = seed;
  GraspProposer proposer;
  proposer.key = HashWeights(weights);
  proposer.propose = [&] {
    const auto world = std::make_shared<const World>(scene);
    return ProposeAtStart(
        {world, hand, world->InitialState(), PlannerConfig(), seed, pool, weights});
  };
  const GraspWorld world(scene, hand);
  return FindStartVerdict(world, config, proposer, {DefaultVerdictFolder()}, pool);
}

namespace {

// How far the proof goes, whatever the scene's friction is.
std::string DescribeProof(const StartCertificate& start) {
  if (std::isinf(start.mu_star)) {
    return fmt::format("the proof holds even at {:g}, the largest friction tried",
                       kMostProofFriction);
  }
  if (!(start.mu_star > 0.0)) return "no proof at any friction, mu* 0";
  return fmt::format("the proof holds up to friction {:.3f} (mu*){}", start.mu_star,
                     start.thin() ? ", a thin margin" : "");
}

std::string DescribeSearch(const StartCertificate& start) {
  const GraspSearchStats& search = start.search;
  const bool enough = search.plausible >= kLeastWithinReach;
  return fmt::format(
      "of {} generated grasps for the {} best nodes none is feasible; {}{} contact sets with tips "
      "as near and far as a hand brings them were put to the forces, {} of them with an edge or "
      "corner: {} hold, {} of these were put to inverse kinematics, the hand reaches {}, and none "
      "is feasible",
      start.proposed_samples, start.proposed_nodes,
      enough ? "" : fmt::format("in {} draws only ", search.drawn), search.plausible,
      search.on_edges, search.held, search.solved, search.reached);
}

std::string DescribeExample(const StartCertificate& start) {
  std::string fingers;
  bool on_edge = false;
  for (const GraspContact& contact : start.example->contacts) {
    fingers += (fingers.empty() ? "" : ", ") + std::string(FingerName(contact.finger));
    on_edge = on_edge || contact.on_edge;
  }
  const std::string source =
      start.search.tried > 0 ? fmt::format("found after {} contact sets", start.search.tried)
                             : fmt::format("one of {} generated grasps", start.proposed_samples);
  return fmt::format("{} close on it{}, {}", fingers, on_edge ? " by edges or corners" : "",
                     source);
}

}  // namespace

std::string DescribeStart(const StartCertificate& start) {
  switch (start.verdict) {
    case StartVerdict::kCertified:
      return fmt::format(
          "ungraspable at the start, certified: no forces at the {} points of faces and {} of "
          "edges "
          "and corners that a fingertip can reach balance the weight at friction {:g}; {}",
          start.reachable_points, start.reachable_edge_points, start.mu, DescribeProof(start));
    case StartVerdict::kSearched:
      return fmt::format(
          "ungraspable at the start as far as a search can tell; there is no proof at friction "
          "{:g} "
          "({}); {}",
          start.mu, DescribeProof(start), DescribeSearch(start));
    case StartVerdict::kGraspable:
      return fmt::format("graspable at the start ({}): {}", DescribeProof(start),
                         DescribeExample(start));
  }
  return "";
}

}  // namespace pregrasp
