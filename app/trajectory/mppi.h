#pragma once

#include <cstdint>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/trajectory/action.h"
#include "app/trajectory/cost.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {

/// Model-predictive path integral optimisation of one path (Williams et al., ICRA 2017), as a
/// one-shot optimiser.
struct MppiConfig {
  int samples = 48;     ///< rollouts an iteration, at least 2
  int iterations = 15;  ///< at most
  double sigma = 1.2;   ///< standard deviation of the noise in the first iteration, so wide that
                        ///< squashing by tanh reaches the ends of each range
  double final_sigma = 0.3;  ///< and in the last; geometric in between
  double temperature = 0.5;  ///< lambda over the standard deviation of the better half's costs
  int patience = 7;          ///< iterations without progress after which it has ended; with 4,
                             ///< half of the paths ended before they had found anything
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
  double weight = 0.0;  ///< in the new mean
  RigidTransform X_WO_end = RigidTransform::Identity();
};

/// Why an optimisation has ended.
enum class MppiEnd {
  kNone,      ///< it has not
  kPatience,  ///< the best cost has not fallen by `progress` in the last `patience` iterations
  kLimit,     ///< `iterations` are done; whether the cost would have fallen further is open
};

/// "", "patience", "limit": the word used in logs.
const char* MppiEndName(MppiEnd end);

/// Everything that the next iteration depends on, and what the last one did: a copyable value. To
/// go back, keep a copy; to fork, step a copy with another Mppi.
struct MppiState {
  int iteration = 0;  ///< iterations done
  /// CalcScoreScale of the first iteration's plans, and from then on the same: so that costs of
  /// different iterations compare. 0 before.
  double score_scale = 0.0;
  std::vector<double> mean;
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
  WorldState start;
  ContactPath path;
  std::uint64_t seed = 1;  ///< of the run; path.rank and the iteration key the noise too
};

class Mppi {
 public:
  Mppi(const MppiProblem& problem, const MppiConfig& config);

  MppiState Start() const;

  /// One iteration: sample around the mean, roll out, score, weigh, move the mean. Sample 0 is the
  /// mean itself, sample 1 the best plan so far. The same bits for any number of threads.
  void Step(MppiState& state, ThreadPool& pool) const;

  /// Decodes and simulates one action again, e.g. the winner.
  PlanOutcome Simulate(const std::vector<double>& action) const;

  RelativePlan Decode(const std::vector<double>& action) const { return space_.Decode(action); }
  /// Standard deviation of the noise in `iteration`, from 0: falls geometrically from the first to
  /// the last.
  double CalcSigma(int iteration) const;

  const MppiConfig& config() const { return config_; }
  const MppiProblem& problem() const { return problem_; }

 private:
  std::vector<std::vector<double>> SampleActions(const MppiState& state) const;
  void MoveMean(MppiState& state) const;

  MppiProblem problem_;
  MppiConfig config_;
  ActionRange range_;
  ActionSpace space_;
};

}  // namespace pregrasp
