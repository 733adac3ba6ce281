#include "app/job/start_proposals.h"

#include <algorithm>

namespace pregrasp {
namespace {

constexpr int kRestarts = 20;  // of inverse kinematics, as for searched sets
constexpr int kScenarios = 3;  // thumb, index, both
constexpr int kDraws = 16;     // of a placement, for one whose tips can be there

bool Uses(int scenario, Finger finger) {
  return scenario == 2 || scenario == static_cast<int>(finger);
}

// Of what a sample of a node is made: its placement, the generator's latent numbers, those that
// refine it. Each has a stream of its own.
enum Part { kPlacement, kLatent, kCompletion, kNumParts };

// What the generator is asked of one node.
class NodeRequests {
 public:
  NodeRequests(const Planner& planner, const ContactGraph& graph)
      : planner_(planner), graph_(graph), context_(planner.scorer().InContext()) {}

  std::vector<GraspRequest> Draw(const ContactNode& node) const {
    std::vector<GraspRequest> requests;
    for (int sample = 0; sample < kProposedPerNode; ++sample) {
      const auto rng = [&](Part part) {
        return Rng(planner_.seed(), RngStream::kProposedGraspIk, node.id,
                   kNumParts * sample + part);
      };
      Rng draws = rng(kPlacement);
      Placement placement = DrawOne(node, sample % kScenarios, draws);
      for (int i = 1; i < kDraws && !IsFree(placement); ++i) {
        const Placement other = DrawOne(node, sample % kScenarios, draws);
        if (IsFree(other)) placement = other;
      }
      requests.push_back({placement, rng(kLatent), rng(kCompletion)});
    }
    return requests;
  }

 private:
  Placement DrawOne(const ContactNode& node, int scenario, Rng& rng) const {
    Placement placement;
    for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
      if (!Uses(scenario, finger)) continue;
      const int triangle = finger == Finger::kThumb ? node.thumb : node.index;
      const double u = rng.Uniform();
      const double v = rng.Uniform();
      placement.fingers[static_cast<int>(finger)] =
          ContactOnTriangle(graph_.mesh(), triangle, BarycentricFromSquare(u, v), planner_.shape());
    }
    return placement;
  }

  bool IsFree(const Placement& placement) const {
    for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
      const Placement::Contact& contact = placement.fingers[static_cast<int>(finger)];
      if (!contact.on) continue;
      if (context_->IsOccluded(finger, contact)) return false;
      if (!HasRoom(planner_.scene().tips.radius(finger), contact, planner_.shape())) return false;
    }
    const bool both = placement.thumb().on && placement.index().on;
    return !both || CalcTipGap(planner_.scene().tips, placement) >= 0.0;
  }

  const Planner& planner_;
  const ContactGraph& graph_;
  std::unique_ptr<PlacementScorer> context_;
};

std::vector<ContactNode> FindBestNodes(const ContactGraph& graph) {
  std::vector<ContactNode> best;
  for (const ContactNode& node : graph.nodes()) {
    if (node.rank_c <= kProposedNodes) best.push_back(node);
  }
  std::sort(best.begin(), best.end(),
            [](const ContactNode& a, const ContactNode& b) { return a.rank_c < b.rank_c; });
  return best;
}

}  // namespace

ProposedGrasps ProposeAtStart(const Planner& planner) {
  ContactGraph graph = planner.BuildGraph(planner.config().mesh, planner.config().graph);
  planner.ScoreGraph(graph);
  CompletionConfig completion = planner.config().completion;
  completion.grasp.kinematics.ik.max_starts = kRestarts;
  completion.max_probes = 0;           // refine whatever there is: the verdict is about all of it
  completion.max_stiffness_tests = 0;  // what is feasible counts, whether it would lift or not
  const std::vector<RigidTransform> X_WB = planner.world().GetPoses(planner.start());
  const ContactPlaces places(planner.grasp_world(), X_WB);
  const NodeRequests requests(planner, graph);
  ProposedGrasps proposed;
  for (const ContactNode& node : FindBestNodes(graph)) {
    const std::vector<GeneratedGrasp> generated = planner.GenerateGrasps(X_WB, requests.Draw(node));
    CompletionResult result = CompleteGrasps(places, completion, generated, {}, planner.pool());
    ++proposed.nodes;
    proposed.samples += static_cast<int>(result.grasps.size());
    for (CompletedGrasp& grasp : result.grasps) {
      if (!grasp.feasible()) continue;
      proposed.feasible = std::move(grasp.result);
      return proposed;
    }
  }
  return proposed;
}

}  // namespace pregrasp
