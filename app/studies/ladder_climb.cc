#include "app/studies/ladder_climb.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "app/core/interrupt.h"
#include "app/geometry/mesh_distance.h"
#include "app/geometry/overlap.h"
#include "app/grasp/grasp_room.h"
#include "app/job/job.h"
#include "app/studies/holding_press.h"
#include "app/studies/ladder_oracle.h"

namespace pregrasp {
namespace {

// Of the cloud about the origin, root mean square [m].
double CalcRadius(const PointCloud& cloud) {
  return std::sqrt(cloud.P.rowwise().squaredNorm().mean());
}

// One ladder with one seed.
class Climb {
 public:
  Climb(const Ladder& ladder, std::uint64_t seed, const StudySetup& setup)
      : ladder_(ladder),
        job_({ladder.scene, seed, setup.planner, setup.weights}, setup.threads),
        planner_(job_.GetPlanner(job_.world().InitialState(), setup.planner)),
        graph_(planner_->BuildGraph(setup.planner.mesh, setup.planner.graph)) {
    planner_->ScoreGraph(graph_);
  }

  LadderFacts Run() {
    LadderFacts facts;
    facts.ladder = ladder_.name;
    facts.scene = ladder_.scene.name;
    facts.seed = planner_->seed();
    for (std::size_t i = 0; i < ladder_.poses.size(); ++i) {
      ThrowIfInterrupted();
      facts.poses.push_back(Judge(static_cast<int>(i)));
    }
    for (const ContactPath& path : FindPaths()) {
      ThrowIfInterrupted();
      facts.oracle.push_back(FollowOracle(path));
    }
    return facts;
  }

 private:
  PoseFacts Judge(int number) {
    const LadderPose& pose = ladder_.poses[number];
    const RigidTransform& first = ladder_.poses.front().X_WO;
    PoseFacts facts;
    facts.pose = number + 1;
    facts.moved_mm = 1e3 * (pose.X_WO.translation() - first.translation()).norm();
    facts.turned_deg =
        RadToDeg(Quaternion(first.linear()).angularDistance(Quaternion(pose.X_WO.linear())));
    facts.overlap_mm = 1e3 * CalcOverlap(pose.X_WO);
    const HeldState held = FindHoldingPress(job_.world(), pose, job_.pool());
    facts.holds = held.holds;
    facts.hold_shift_mm = 1e3 * held.shift;
    facts.hold_turn_deg = held.turn_deg;

    // What the planner makes of a trajectory that ends here.
    Certificate end;
    end.full.end = held.state;
    const ReleaseResult release = planner_->Release(graph_, end);
    facts.stays_when_released = release.stays;
    const std::vector<RigidTransform> X_WB = job_.world().GetPoses(held.state);
    AskNetworks(held.state, release, X_WB, facts);
    const GraspSet grasps = planner_->CompleteGrasps(end, release, facts.pose);
    facts.generated = grasps.count(GraspSource::kGenerator);
    facts.generated_feasible = grasps.count_feasible(GraspSource::kGenerator);
    for (const CompletedGrasp& grasp : grasps.grasps) {
      facts.generated_raw += grasp.source == GraspSource::kGenerator && grasp.raw.feasible();
    }
    Search(release, X_WB, facts);
    if (held.holds) CountLifts(end, grasps, facts.lift_tried.emplace(), facts.lifted.emplace());
    return facts;
  }

  void AskNetworks(const WorldState& state, const ReleaseResult& release,
                   const std::vector<RigidTransform>& X_WB, PoseFacts& facts) const {
    const auto mean = [&](ScoreOutput output) {
      const auto scores = planner_->scorer().At(X_WB, output)->Score(release.conditions);
      return std::accumulate(scores.begin(), scores.end(), 0.0) /
             std::max<double>(1.0, static_cast<double>(scores.size()));
    };
    facts.score = mean(ScoreOutput::kProgress);
    facts.probability = mean(ScoreOutput::kLifted);
    PlanOutcome outcome;
    outcome.end = state;
    const ScoredState end = EndToScore(job_.world(), outcome);
    facts.final_score = planner_->scorer().ScoreGraspable(std::span(&end, 1)).front();
    facts.room = planner_->room().Calc(X_WB, KeptContacts(end));
  }

  void Search(const ReleaseResult& release, const std::vector<RigidTransform>& X_WB,
              PoseFacts& facts) {
    GraspSearchConfig config;  // longer than the planner's, so that shares mean something
    config.max_sets = 40'000;
    config.max_solves = 400;
    config.max_found = 20;
    const std::vector<GraspContact> fixed =
        release.stays ? std::vector<GraspContact>{} : release.pressing;
    const GraspSearchResult result =
        SearchGrasps(planner_->grasp_world(), config, fixed, X_WB, planner_->seed(), job_.pool());
    facts.sets = result.stats.plausible;
    facts.sets_hold = result.stats.held;
    facts.solved = result.stats.solved;
    facts.sets_reach = result.stats.reached;
    facts.found = result.stats.feasible;
  }

  void CountLifts(const Certificate& end, const GraspSet& grasps, int& tried, int& lifted) const {
    for (const auto& lift : planner_->LiftGrasps(end, grasps)) {
      tried += lift.has_value();
      lifted += lift && lift->held;
    }
  }

  // The deepest of the object with another body, at a pose.
  double CalcOverlap(const RigidTransform& X_WO) const {
    Scene scene = ladder_.scene;
    scene.object().X_WB = X_WO;
    double deepest = 0.0;
    for (const Overlap& overlap : FindOverlaps(scene)) {
      if (overlap.body_a == 0 || overlap.body_b == 0) deepest = std::max(deepest, overlap.depth);
    }
    return deepest;
  }

  // For each contact that the ladder presses with, the node with its triangle and the best s_c, in
  // every stage.
  std::vector<ContactPath> FindPaths() const {
    const MeshDistance mesh(graph_.mesh());
    std::vector<ContactPath> paths;
    for (const LadderPose& pose : ladder_.poses) {
      if (!pose.press) continue;
      const bool thumb = pose.press->finger == Finger::kThumb;
      const int triangle = mesh.FindNearest(pose.press->p_OC).triangle;
      const ContactNode* best = nullptr;
      for (const ContactNode& node : graph_.nodes()) {
        if ((thumb ? node.thumb : node.index) != triangle) continue;
        if (best == nullptr || node.s_c > best->s_c) best = &node;
      }
      ContactPath path;
      path.nodes.assign(planner_->config().stages, best->id);
      path.rank = static_cast<int>(paths.size()) + 1;
      const bool known = std::any_of(paths.begin(), paths.end(), [&](const ContactPath& other) {
        return other.nodes == path.nodes;
      });
      if (!known) paths.push_back(std::move(path));
    }
    return paths;
  }

  OracleFacts FollowOracle(const ContactPath& path) const {
    const LadderOracle oracle({ladder_.poses, CalcRadius(planner_->scorer().cloud())});
    MppiProblem problem;
    problem.world = &job_.world();
    problem.environment = &planner_->environment();
    problem.shape = &planner_->shape();
    problem.graph = &graph_;
    problem.scorer = &oracle;
    problem.start = planner_->start();
    problem.path = path;
    problem.seed = planner_->seed();
    const Mppi mppi(problem, planner_->config().mppi);
    MppiState state = mppi.Start();
    OracleFacts facts;
    while (!state.ended()) {
      ThrowIfInterrupted();
      mppi.Step(state, planner_->pool());
      facts.rollouts += static_cast<int>(state.samples.size());
    }
    facts.iterations = state.iteration;
    const ContactNode& node = graph_.nodes().at(path.nodes.front());
    facts.thumb = node.thumb;
    facts.index = node.index;
    const Certificate certificate = planner_->Certify(mppi, state.plans.front());
    const auto X_WB = job_.world().GetPoses(certificate.full.end);
    facts.progress = oracle.Score(std::vector<ScoredState>{{X_WB, {}}}).front();
    facts.certified = certificate.certified;
    for (const CertifyReason reason : certificate.reasons) {
      facts.reasons.emplace_back(CertifyReasonText(reason));
    }
    if (!certificate.certified) return facts;
    const ReleaseResult release = planner_->Release(graph_, certificate);
    const GraspSet grasps = planner_->CompleteGrasps(certificate, release, path.rank);
    facts.feasible = static_cast<int>(grasps.feasible.size());
    int tried = 0;
    CountLifts(certificate, grasps, tried, facts.lifted);
    return facts;
  }

  const Ladder& ladder_;
  Job job_;
  std::shared_ptr<const Planner> planner_;
  ContactGraph graph_;
};

}  // namespace

LadderFacts ClimbLadder(const Ladder& ladder, std::uint64_t seed, const StudySetup& setup) {
  return Climb(ladder, seed, setup).Run();
}

}  // namespace pregrasp
