#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/geometry/contact_mesh.h"
#include "app/graph/learned_scorer.h"
#include "app/graph/placement_search.h"
#include "app/grasp/grasp_completion.h"
#include "app/grasp/grasp_search.h"
#include "app/grasp/lift.h"
#include "app/motion/hand_motion.h"
#include "app/trajectory/certify.h"
#include "app/trajectory/mppi.h"

namespace pregrasp {

/// How many paths are given a few rollouts before any is optimised, by successive halving: in each
/// round the paths that are left are given the same number of iterations more, then the better half
/// of them goes on. Where `enough` paths are `clear`ly worth it already, no others are tried. The
/// paper's order is not screened.
struct ScreenConfig {
  int paths = 24;      ///< in the first round; 1 does not screen
  int samples = 16;    ///< rollouts an iteration
  int iterations = 4;  ///< a path and round; with 2 the keyboard at the wall is given up at times
  int rounds = 3;
  int enough = 4;      ///< paths after which screening ends, if they are clear
  double clear = 0.5;  ///< worth so much more than doing nothing; a plan can be worth 6
};

/// The settings of all stages: the same defaults for every scene.
struct PlannerConfig {
  int cloud_points = 512;  ///< of the object cloud O
  ContactMeshConfig mesh;
  ContactGraphConfig graph;
  int stages = 2;  ///< N, nodes in a path
  PathOrder order = PathOrder::kExplore;
  ScreenConfig screen;
  MppiConfig mppi;
  CertifyConfig certify;
  PlacementSearchConfig placements;
  /// For each sample so many placements of the best score, of which those with the most room for
  /// the rest of a grasp are tried.
  int placement_pool = 10;
  /// And of these for each sample so many are tried with a generated grasp or two: the samples
  /// complete those in which that was feasible.
  int pilots = 3;
  CompletionConfig completion;
  int grasp_samples = 20;  ///< on a certified trajectory
  int grasp_draws = 24;    ///< of a sample at most: GeneratedGrasp::further
  /// The second source of grasps, after the generator; bounded so that it takes about 0.3 s.
  GraspSearchConfig search = MakeSecondSourceConfig();
  LiftConfig lift;
  MotionTiming motion_timing;
  MotionConfig motion;

  /// @throws InputError for a setting out of its range (planner_settings.h), or settings that do
  /// not go together.
  void Validate() const;
};

/// What is left of a certified trajectory when the fingers let go, and so which of them must stay.
struct ReleaseResult : Released {
  /// The contacts that press at the end of the trajectory. If the object does not stay without
  /// them, every grasp keeps them where they are.
  std::vector<GraspContact> pressing;
  /// What the grasp generator may be asked to complete, best first: of the placements with the best
  /// learned score where the object is now, those of the highest score times GraspRoom::CalcWith.
  /// If the object does not stay, all of them hold `pressing`. Empty if there is no place for a
  /// fingertip.
  std::vector<Placement> conditions;
};

/// One grasp to be generated: what it completes, and the numbers that it is drawn and refined with.
struct GraspRequest {
  Placement condition;
  Rng latent, completion;
};

/// The grasps to choose from on a certified trajectory, tested: those generated, by sample, then
/// those that a search found.
struct GraspSet {
  std::vector<CompletedGrasp> grasps;
  std::vector<int> feasible;  ///< indices of the feasible ones, ascending

  /// How many a source has, and how many of them are feasible.
  int count(GraspSource source) const;
  int count_feasible(GraspSource source) const;
  /// Share of the generated ones that is feasible, with refinement and without; 0 of none.
  double r_suc() const;
  double r_suc_raw() const;
};

/// The stages of one scene bound together: builds what they share once, and hands each stage its
/// inputs. No mathematics of its own. Immutable after construction; a copy shares what was built.
class Planner {
 public:
  /// @param hand     outlives this.
  /// @param start    of every plan, fingers off.
  /// @param pool     for what runs in parallel; outlives this.
  /// @param weights  the folder with score.safetensors and generator.safetensors.
  /// @throws InputError for a bad configuration, or weights that are missing or damaged.
  Planner(std::shared_ptr<const World> world, const HandModel& hand, WorldState start,
          const PlannerConfig& config, std::uint64_t seed, ThreadPool& pool,
          const std::filesystem::path& weights);
  ~Planner();

  /// The same with other settings. @throws InputError for bad ones, or a cloud of another size,
  /// which all of them share.
  Planner WithConfig(const PlannerConfig& config) const;

  const Scene& scene() const { return world_->scene(); }
  const PlannerConfig& config() const { return config_; }
  std::uint64_t seed() const { return seed_; }
  ThreadPool& pool() const { return pool_; }
  const World& world() const { return *world_; }
  const WorldState& start() const { return start_; }
  const EnvironmentDistance& environment() const { return *environment_; }
  const SignedDistance& shape() const { return *shape_; }
  const LearnedScorer& scorer() const { return *scorer_; }
  const GraspRoom& room() const { return *room_; }
  const GraspWorld& grasp_world() const { return *grasp_world_; }
  const Forearm& forearm() const { return *forearm_; }

  /// The contact mesh as an unscored graph.
  ContactGraph BuildGraph(const ContactMeshConfig& mesh, const ContactGraphConfig& graph) const;
  void ScoreGraph(ContactGraph& graph) const;

  /// The optimisation of one path; `graph` outlives it.
  Mppi MakeMppi(const ContactGraph& graph, const ContactPath& path, const MppiConfig& config) const;

  /// Re-simulates a plan of `state.plans` through Simbody, and again at half the step, and looks
  /// whether the hand reaches its contacts (FindOutOfReach).
  Certificate Certify(const Mppi& mppi, const MppiPlan& plan) const;
  /// The same for any plan in the world, with the timing of that optimisation.
  Certificate Certify(const Mppi& mppi, const WorldPlan& plan) const;

  /// @param graph  whose mesh says where fingers may touch.
  ReleaseResult Release(const ContactGraph& graph, const Certificate& certificate) const;

  /// The configured number of generated grasps on a certified trajectory, and those that a search
  /// finds; none if there is no condition to complete. Where the search finds none, the generated
  /// ones are tested as they are and not refined.
  /// @param path_rank  keys the latent samples. @throws Interrupted.
  GraspSet CompleteGrasps(const Certificate& certificate, const ReleaseResult& release,
                          int path_rank) const;

  /// The simulated lifts of the feasible ones, by sample; none for the others. @throws Interrupted.
  std::vector<std::optional<LiftResult>> LiftGrasps(const Certificate& certificate,
                                                    const GraspSet& grasps) const;

  /// @param lift  the simulated lift of the grasp.
  HandMotion MakeMotion(const Certificate& certificate, const GraspResult& grasp,
                        const LiftResult& lift, const MotionConfig& config) const;

  /// What the generator makes of each request; not tested.
  /// @param X_WB  of all bodies, the object first. @throws Interrupted.
  std::vector<GeneratedGrasp> GenerateGrasps(const std::vector<RigidTransform>& X_WB,
                                             const std::vector<GraspRequest>& requests) const;

 private:
  // ReleaseResult::conditions. @param fixed, pressing  empty where the object stays.
  std::vector<Placement> FindConditions(const TriangleMesh& mesh,
                                        const std::vector<RigidTransform>& X_WB,
                                        const Placement& fixed,
                                        const std::vector<GraspContact>& pressing) const;

  // Of `conditions`, at most half as many as there are samples: those in which pilots, generated
  // grasps that count for nothing else, are feasible; where none is, those whose forces hold.
  std::vector<Placement> ChooseConditions(const ContactPlaces& places,
                                          const std::vector<Placement>& conditions,
                                          const std::vector<GraspContact>& fixed,
                                          const std::vector<HandConfiguration>& known,
                                          int path_rank) const;
  GraspRequest MakeRequest(const Placement& condition, int path_rank, int number) const;
  // LiftResult::forearm_free, of a lift from `end`.
  bool IsForearmFree(const WorldState& end, const GraspResult& grasp, const LiftResult& lift) const;

  std::shared_ptr<const World> world_;
  WorldState start_;
  PlannerConfig config_;
  std::uint64_t seed_;
  ThreadPool& pool_;
  std::shared_ptr<const World> half_world_;
  std::shared_ptr<const std::vector<World>> extreme_worlds_;
  std::shared_ptr<const EnvironmentDistance> environment_;
  std::shared_ptr<const SignedDistance> shape_;
  std::shared_ptr<const ScoreFunction> score_;
  std::shared_ptr<const GraspGenerator> generator_;
  std::shared_ptr<const LearnedScorer> scorer_;
  std::shared_ptr<const CloudStructure> generator_structure_;
  std::shared_ptr<const GraspWorld> grasp_world_;
  std::shared_ptr<const Forearm> forearm_;
  std::shared_ptr<const GraspRoom> room_;  // refers to grasp_world_
};

}  // namespace pregrasp
