#include "app/job/planner.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/grasp/grasp_room.h"
#include "app/job/planner_settings.h"
#include "app/motion/touches.h"
#include "app/trajectory/robust.h"

namespace pregrasp {
namespace {

StepConfig HalfStep(StepConfig config) {
  config.dt *= 0.5;
  return config;
}

std::vector<GraspContact> PressingContacts(const WorldState& state) {
  std::vector<GraspContact> pressing;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    const FingertipState& tip = state.fingers[f];
    if (tip.on && tip.touching) {
      pressing.push_back({static_cast<Finger>(f), tip.p_OC, tip.nhat_O});
    }
  }
  return pressing;
}

// What ScoreGraspable tries: placements that are good without surroundings, spread over the object.
std::vector<Placement> FindProbes(const Shape& object, const ContactMeshConfig& mesh_config,
                                  const SignedDistance& shape, const LearnedScorer& scorer,
                                  std::uint64_t seed) {
  constexpr int kProbes = 256;
  PlacementSearchConfig config;
  config.spacing = 0.02;
  return FindPlacements(BuildContactMesh(object, mesh_config), shape, *scorer.Free(), {}, kProbes,
                        config, Rng(seed, RngStream::kScoreProbes));
}

// What no setting alone shows: that the scene's fingers can give the force asked of them.
void RequireForces(const PlannerConfig& config, const Scene& scene) {
  const double f_max = scene.fingertips.max_force;
  if (!(config.completion.grasp.f_min <= f_max)) {
    throw InputError("", "grasps.f_min",
                     fmt::format("at most fingertips.max_force, {} N", FormatDouble(f_max)),
                     FormatDouble(config.completion.grasp.f_min));
  }
}

}  // namespace

void PlannerConfig::Validate() const {
  CheckPlannerSettings(*this);
  constexpr int kMaxNumbers = 1'000'000;  // in the plans of one iteration: 8 MB
  const int per_plan = stages * kNumPlanningFingers * (3 + 6 * mppi.timing.knots);
  if (mppi.samples > kMaxNumbers / per_plan) {
    throw InputError("", "mppi.samples",
                     fmt::format("at most {} with paths.stages {} and mppi.knots {}",
                                 kMaxNumbers / per_plan, stages, mppi.timing.knots),
                     std::to_string(mppi.samples));
  }
  placements.Validate();
  completion.Validate();
  search.Validate();
  lift.Validate();
  motion.ik.Validate();
}

int GraspSet::count(GraspSource source) const {
  return static_cast<int>(
      std::count_if(grasps.begin(), grasps.end(),
                    [&](const CompletedGrasp& grasp) { return grasp.source == source; }));
}

int GraspSet::count_feasible(GraspSource source) const {
  return static_cast<int>(std::count_if(
      grasps.begin(), grasps.end(),
      [&](const CompletedGrasp& grasp) { return grasp.source == source && grasp.feasible(); }));
}

double GraspSet::r_suc() const {
  const int generated = count(GraspSource::kGenerator);
  return generated == 0 ? 0.0
                        : static_cast<double>(count_feasible(GraspSource::kGenerator)) / generated;
}

double GraspSet::r_suc_raw() const {
  const int generated = count(GraspSource::kGenerator);
  const auto raw = std::count_if(grasps.begin(), grasps.end(), [](const CompletedGrasp& grasp) {
    return grasp.source == GraspSource::kGenerator && grasp.raw.feasible();
  });
  return generated == 0 ? 0.0 : static_cast<double>(raw) / generated;
}

Planner::Planner(std::shared_ptr<const World> world, const HandModel& hand, WorldState start,
                 const PlannerConfig& config, std::uint64_t seed, ThreadPool& pool,
                 const std::filesystem::path& weights)
    : world_(std::move(world)),
      start_(std::move(start)),
      config_(config),
      seed_(seed),
      pool_(pool) {
  config.Validate();
  RequireForces(config, scene());
  half_world_ = std::make_shared<const World>(scene(), HalfStep(world_->config()));
  extreme_worlds_ =
      std::make_shared<const std::vector<World>>(MakeExtremeWorlds(scene(), world_->config()));
  environment_ = std::make_shared<const EnvironmentDistance>(scene());
  shape_ = std::make_shared<const SignedDistance>(scene().object().shape);
  score_ =
      std::make_shared<const ScoreFunction>(ScoreFunction::Load(weights / "score.safetensors"));
  generator_ = std::make_shared<const GraspGenerator>(
      GraspGenerator::Load(weights / "generator.safetensors"));
  PointCloud cloud = SamplePointCloud(scene().object().shape, config.cloud_points,
                                      Rng(seed, RngStream::kObjectCloud));
  generator_structure_ = std::make_shared<const CloudStructure>(
      generator_->BuildStructure(cloud.P, scene().object().X_WB.linear()));
  const auto scorer =
      std::make_shared<LearnedScorer>(*score_, scene(), std::move(cloud), *environment_, pool_);
  scorer->SetProbes(FindProbes(scene().object().shape, config.mesh, *shape_, *scorer, seed));
  scorer_ = scorer;
  grasp_world_ = std::make_shared<const GraspWorld>(scene(), hand);
  forearm_ = std::make_shared<const Forearm>(scene(), hand);
  room_ = std::make_shared<const GraspRoom>(*grasp_world_, GraspRoomConfig{}, seed);
}

Planner::~Planner() = default;

Planner Planner::WithConfig(const PlannerConfig& config) const {
  config.Validate();
  RequireForces(config, scene());
  if (config.cloud_points != config_.cloud_points) {
    throw InputError("", "points", std::to_string(config_.cloud_points) + ", as in the first graph",
                     std::to_string(config.cloud_points));
  }
  Planner planner = *this;
  planner.config_ = config;
  return planner;
}

ContactGraph Planner::BuildGraph(const ContactMeshConfig& mesh,
                                 const ContactGraphConfig& graph) const {
  return {BuildContactMesh(scene().object().shape, mesh), graph};
}

void Planner::ScoreGraph(ContactGraph& graph) const {
  const auto context = scorer_->InContext();
  const auto free = scorer_->Free();
  graph.Score(*shape_, *context, *free, seed_);
}

Mppi Planner::MakeMppi(const ContactGraph& graph, const ContactPath& path,
                       const MppiConfig& config) const {
  MppiProblem problem;
  problem.world = world_.get();
  problem.environment = environment_.get();
  problem.shape = shape_.get();
  problem.graph = &graph;
  problem.scorer = scorer_.get();
  problem.others = extreme_worlds_.get();
  problem.room = config.weights.room > 0.0 ? room_.get() : nullptr;
  problem.start = start_;
  problem.path = path;
  problem.seed = seed_;
  return {problem, config};
}

Certificate Planner::Certify(const Mppi& mppi, const MppiPlan& plan) const {
  return Certify(mppi, mppi.Simulate(plan.action).plan);
}

Certificate Planner::Certify(const Mppi& mppi, const WorldPlan& plan) const {
  Certificate certificate = CertifyPlan(*world_, *half_world_, *environment_, mppi.problem().start,
                                        plan, mppi.config().timing, config_.certify);
  if (!certificate.certified) return certificate;
  certificate.out_of_reach_t =
      FindOutOfReach(grasp_world_->ik(), config_.motion.ik, *world_, certificate.trace,
                     Rng(seed_, RngStream::kMotionKey, 1, mppi.problem().path.rank));
  if (certificate.out_of_reach_t) {
    certificate.certified = false;
    certificate.reasons.push_back(CertifyReason::kOutOfReach);
  }
  return certificate;
}

ReleaseResult Planner::Release(const ContactGraph& graph, const Certificate& certificate) const {
  ReleaseResult result;
  const WorldState& end = certificate.full.end;
  static_cast<Released&>(result) = SimulateRelease(*world_, end);
  result.pressing = PressingContacts(end);

  Placement fixed;
  for (const GraspContact& contact : result.pressing) {
    if (result.stays) break;
    fixed.fingers[static_cast<int>(contact.finger)] = {true, contact.p_OC, contact.nhat_O};
  }
  result.conditions = FindConditions(graph.mesh(), world_->GetPoses(end), fixed,
                                     result.stays ? std::vector<GraspContact>{} : result.pressing);
  return result;
}

GraspSet Planner::CompleteGrasps(const Certificate& certificate, const ReleaseResult& release,
                                 int path_rank) const {
  GraspSet set;
  if (release.conditions.empty()) return set;
  const std::vector<RigidTransform> X_WB = world_->GetPoses(certificate.full.end);
  const std::vector<GraspContact> fixed =
      release.stays ? std::vector<GraspContact>{} : release.pressing;
  const ContactPlaces places(*grasp_world_, X_WB);
  GraspSearchConfig search = config_.search;
  search.grasp.f_min = config_.completion.grasp.f_min;
  const std::uint64_t seed = Rng(seed_, RngStream::kSecondSource, path_rank).NextU64();
  const GraspSearchResult searched = SearchGrasps(places, search, fixed, seed, pool_);
  // Where twenty thousand sets hold no grasp, refining twenty would take most of a run's time.
  CompletionConfig completion = config_.completion;
  completion.forces = config_.lift.forces;
  if (search.max_sets > 0 && searched.found.empty()) {
    completion.max_solves = completion.max_probes = 0;
  }
  std::vector<HandConfiguration> known;
  for (const GraspResult& found : searched.found) {
    known.push_back(found.kinematics->ik.configuration());
  }
  const std::vector<Placement> conditions =
      ChooseConditions(places, release.conditions, fixed, known, path_rank);
  std::vector<GraspRequest> requests;
  for (int sample = 0; sample < config_.grasp_samples; ++sample) {
    requests.push_back(MakeRequest(conditions[sample % conditions.size()], path_rank, sample));
  }
  set.grasps = pregrasp::CompleteGrasps(places, completion, GenerateGrasps(X_WB, requests), fixed,
                                        pool_, std::move(known))
                   .grasps;
  int number = 0;
  for (const GraspResult& found : searched.found) {
    set.grasps.push_back(MakeSearchedGrasp(found, ++number));
  }
  const int count = static_cast<int>(set.grasps.size());
  for (int sample = 0; sample < count; ++sample) {
    if (set.grasps[sample].feasible()) set.feasible.push_back(sample);
  }
  return set;
}

std::vector<std::optional<LiftResult>> Planner::LiftGrasps(const Certificate& certificate,
                                                           const GraspSet& grasps) const {
  std::vector<std::optional<LiftResult>> lifts(grasps.grasps.size());
  if (grasps.feasible.empty()) return lifts;
  const WorldState& end = certificate.full.end;
  const LiftWay way = FindLiftWay(world_->GetPoses(end), scorer_->cloud(), *environment_,
                                  -scene().gravity.normalized(), config_.lift.way);
  pool_.ParallelFor(static_cast<int>(grasps.feasible.size()), [&](int i, int) {
    ThrowIfInterrupted();
    const int sample = grasps.feasible[i];
    const GraspResult& grasp = grasps.grasps[sample].result;
    LiftResult lift =
        LiftGrasp({*world_, *half_world_, *grasp_world_}, end, grasp, way, config_.lift);
    lift.forearm_free = IsForearmFree(end, grasp, lift);
    lifts[sample] = std::move(lift);
  });
  return lifts;
}

bool Planner::IsForearmFree(const WorldState& end, const GraspResult& grasp,
                            const LiftResult& lift) const {
  const std::vector<RigidTransform> X_WB = world_->GetPoses(end);
  const RigidTransform& X_WH = grasp.kinematics->ik.X_WH;
  if (!forearm_->IsFree(X_WB, X_WH)) return false;
  if (lift.trace.empty()) return true;
  const std::vector<RigidTransform> X_WB_lifted = world_->GetPoses(lift.trace.back().state);
  return forearm_->IsFree(X_WB_lifted, X_WB_lifted.front() * X_WB.front().inverse() * X_WH);
}

HandMotion Planner::MakeMotion(const Certificate& certificate, const GraspResult& grasp,
                               const LiftResult& lift, const MotionConfig& config) const {
  PREGRASP_CHECK(grasp.kinematics.has_value());
  MotionTask task = BuildMotionTask(
      *world_, certificate.trace, {lift.trace, lift.closing_t, lift.lift_t}, config_.motion_timing);
  return {grasp_world_->ik(), std::move(task), grasp.kinematics->ik.configuration(), config, seed_};
}

}  // namespace pregrasp
