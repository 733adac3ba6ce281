#pragma once

#include <cstdint>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/trajectory/action.h"
#include "app/trajectory/cost.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

class GraspRoom;

/// Model-predictive path integral optimisation of one path (Williams et al., ICRA 2017), as a
/// one-shot optimiser.
struct MppiConfig {
  int samples = 48;     ///< rollouts an iteration, at least 2
  int iterations = 15;  ///< at most
  double sigma = 1.2;   ///< standard deviation of the noise in the first iteration, so wide that
                        ///< squashing by tanh reaches the ends of each range
  double final_sigma = 0.3;  ///< and in the last; geometric in between
  double temperature = 0.5;  ///< lambda over the standard deviation of the better half's costs
  int patience = 5;          ///< iterations without progress after which it has ended; they count
                             ///< from the first rise on
  double rise = 0.02;        ///< the first rise: the best reward is above that of doing nothing by
                             ///< this much
  double proposals = 0.5;    ///< share of the samples that are proposals, until the first rise; a
                             ///< quarter of that afterwards
  double progress = 0.1;     ///< what counts as progress: the best cost falls by this share of
                             ///< the path's score scale
  double max_travel = 0.03;  ///< range of a target's own movement in a knot, each axis [m]
  PlanTiming timing;
  CostWeights weights;
};

/// One sampled plan of the last iteration.
struct MppiSample {
  std::vector<double> action;
  PlanCost cost;
  double weight = 0.0;  ///< in the new mean, by cost without fragility
  RigidTransform X_WO_end = RigidTransform::Identity();
};

/// A plan to choose from.
struct MppiPlan {
  std::vector<double> action;
  PlanCost cost;
  RigidTransform X_WO_end = RigidTransform::Identity();
};
/// Plans whose ends are nearer than this are the same to a grasp.
inline constexpr double kSameShift = 0.01;  // [m]
inline constexpr double kSameTurnDeg = 10.0;

/// Why an optimisation has ended.
enum class MppiEnd {
  kNone,      ///< it has not
  kPatience,  ///< the best cost has not fallen by `progress` in the last `patience` iterations
  kLimit,     ///< `iterations` are done; whether the cost would have fallen further is open
};

/// "", "patience", "limit": the word used in logs.
const char* MppiEndName(MppiEnd end);

inline constexpr int kMostPlans = 8;

/// Everything that the next iteration depends on, and what the last one did: a copyable value. To
/// go back, keep a copy; to fork, step a copy with another Mppi.
struct MppiState {
  int iteration = 0;  ///< iterations done, not counting those that screened the path
  int screened = 0;   ///< iterations that did
  /// CalcScoreScale of the first iteration's plans, and from then on the same: so that costs of
  /// different iterations compare. 0 before.
  double score_scale = 0.0;
  double rest_reward = 0.0;  ///< of doing nothing: no finger on
  int rose_at = 0;           ///< the iteration of the first rise, from 1; 0 before it
  std::vector<double> mean;
  /// The best of all iterations whose ends differ, best first, at most kMostPlans: by cost, and by
  /// cost without fragility. What may be put to certification; plans[0] is `best`.
  std::vector<MppiPlan> plans;
  std::vector<double> best_action;  ///< of all iterations
  PlanCost best;
  double best_cost = 0.0;            ///< best.total
  std::vector<double> best_history;  ///< best_cost after each iteration
  std::vector<double> mean_history;  ///< mean cost of the samples of each iteration
  std::vector<MppiSample> samples;   ///< of the last iteration, in index order
  MppiEnd end = MppiEnd::kNone;
  bool ended() const { return end != MppiEnd::kNone; }
  bool converged() const { return end == MppiEnd::kPatience; }
};

/// What MPPI works on; all referenced objects outlive it.
struct MppiProblem {
  const World* world = nullptr;
  const EnvironmentDistance* environment = nullptr;
  const SignedDistance* shape = nullptr;  ///< the object's
  const ContactGraph* graph = nullptr;
  const StateScorer* scorer = nullptr;
  const GraspRoom* room = nullptr;  ///< may be null: the learned score alone
  /// In which plans are tried, too (MakeExtremeWorlds); may be null: in none.
  const std::vector<World>* others = nullptr;
  WorldState start;
  ContactPath path;
  std::uint64_t seed = 1;  ///< of the run; path.rank and the iteration key the noise too
};

class Mppi {
 public:
  Mppi(const MppiProblem& problem, const MppiConfig& config);

  /// With what doing nothing is worth.
  MppiState Start() const;

  /// One iteration: sample around the mean, roll out, score, weigh, move the mean. Sample 0 is the
  /// mean itself, sample 1 the best plan so far. The better half is tried in the other worlds, too.
  /// The same bits for any number of threads.
  void Step(MppiState& state, ThreadPool& pool) const;

  /// Iterations that find out what a path is worth, in the scene's own world alone: what comes
  /// after begins with their mean and plans, its own iterations counted from 1.
  void Screen(MppiState& state, int iterations, ThreadPool& pool) const;

  /// Decodes and simulates one action again, e.g. the winner. @param trace  as SimulatePlan's.
  PlanOutcome Simulate(const std::vector<double>& action,
                       std::vector<TraceRow>* trace = nullptr) const;

  RelativePlan Decode(const std::vector<double>& action) const { return space_.Decode(action); }
  /// Standard deviation of the noise in `iteration`, from 0: falls geometrically from the first to
  /// the last.
  double CalcSigma(int iteration) const;

  const MppiConfig& config() const { return config_; }
  const MppiProblem& problem() const { return problem_; }

 private:
  std::vector<std::vector<double>> SampleActions(const MppiState& state) const;
  // What a plan left, scored.
  struct Judged {
    std::vector<double> stage_scores;
    double final_score = 0.0, room = 0.0;
  };
  std::vector<Judged> Judge(const std::vector<PlanOutcome>& outcomes, ThreadPool* pool) const;
  PlanCost CalcCost(const PlanOutcome& outcome, const Judged& judged, double score_scale) const;
  // @param elsewhere  try the samples in the other worlds, too.
  void Iterate(MppiState& state, bool elsewhere, ThreadPool& pool) const;
  bool is_tried_elsewhere() const {
    return problem_.others != nullptr && config_.weights.fragility > 0.0;
  }
  // CalcFragility in the other worlds.
  double TryElsewhere(const PlanOutcome& nominal) const;
  // What screening found, which has been tried in no other world.
  void TryPlansElsewhere(MppiState& state, ThreadPool& pool) const;
  // Tries the better half of `samples` in the other worlds; the rest count as most fragile.
  void AddFragilities(const std::vector<PlanOutcome>& outcomes, double rest_reward,
                      std::vector<MppiSample>& samples, ThreadPool& pool) const;
  void FixScale(MppiState& state, const std::vector<Judged>& judged) const;
  static void SetBest(MppiState& state);
  static void Offer(MppiState& state, const MppiSample& sample);
  static std::vector<MppiPlan>::iterator FindLeastPromising(std::vector<MppiPlan>& plans);
  void CheckEnd(MppiState& state) const;
  void MoveMean(MppiState& state) const;

  MppiProblem problem_;
  MppiConfig config_;
  ActionRange range_;
  ActionSpace space_;
};

}  // namespace pregrasp
