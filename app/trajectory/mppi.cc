#include "app/trajectory/mppi.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/core/check.h"
#include "app/core/finite.h"

namespace pregrasp {

Mppi::Mppi(const MppiProblem& problem, const MppiConfig& config)
    : problem_(problem),
      config_(config),
      range_(MakeActionRange(problem.world->scene(), config.max_travel)),
      space_(*problem.graph, problem.path.nodes, *problem.shape, range_, config.timing.knots) {
  PREGRASP_CHECK(config.samples >= 2 && config.iterations >= 1 && config.patience >= 1,
                 config.samples, config.iterations, config.patience);
  PREGRASP_CHECK(config.sigma > 0.0 && config.final_sigma > 0.0 && config.temperature > 0.0,
                 config.sigma, config.final_sigma, config.temperature);
}

double Mppi::CalcSigma(int iteration) const {
  if (config_.iterations <= 1) return config_.sigma;
  const double s = std::min(1.0, static_cast<double>(iteration) / (config_.iterations - 1));
  return config_.sigma * std::pow(config_.final_sigma / config_.sigma, s);
}

MppiState Mppi::Start() const {
  MppiState state;
  state.mean.assign(space_.size(), 0.0);
  state.best_cost = std::numeric_limits<double>::infinity();
  return state;
}

PlanOutcome Mppi::Simulate(const std::vector<double>& action) const {
  return SimulatePlan(*problem_.world, *problem_.environment, problem_.start, space_.Decode(action),
                      config_.timing);
}

std::vector<std::vector<double>> Mppi::SampleActions(const MppiState& state) const {
  const double sigma = CalcSigma(state.iteration);
  std::vector<std::vector<double>> actions(config_.samples, state.mean);
  for (int i = 1; i < config_.samples; ++i) {
    if (i == 1 && !state.best_action.empty()) {
      actions[i] = state.best_action;
      continue;
    }
    Rng rng(problem_.seed, RngStream::kMppiNoise, problem_.path.rank, state.iteration, i);
    for (double& u : actions[i]) u += sigma * rng.Normal();
  }
  return actions;
}

void Mppi::Step(MppiState& state, ThreadPool& pool) const {
  const std::vector<std::vector<double>> actions = SampleActions(state);
  const int count = static_cast<int>(actions.size());
  std::vector<PlanOutcome> outcomes(count);
  std::vector<ScoredState> ends(count);
  pool.ParallelFor(count, [&](int i, int) {
    outcomes[i] = Simulate(actions[i]);
    ends[i] = EndToScore(*problem_.world, outcomes[i]);
  });

  std::vector<ScoredState> states;
  std::vector<std::size_t> first;  // index of each outcome's first state
  for (const PlanOutcome& outcome : outcomes) {
    first.push_back(states.size());
    for (ScoredState& scored : StatesToScore(*problem_.world, outcome)) {
      states.push_back(std::move(scored));
    }
  }
  first.push_back(states.size());
  const std::vector<double> scores = problem_.scorer->Score(states);
  PREGRASP_CHECK(scores.size() == states.size(), scores.size(), states.size());
  const std::vector<double> final_scores = problem_.scorer->ScoreGraspable(ends);

  const auto stage_scores = [&](int i) {
    return std::span(scores).subspan(first[i], first[i + 1] - first[i]);
  };
  if (state.iteration == 0) {
    std::vector<double> rewards;
    for (int i = 0; i < count; ++i) {
      rewards.push_back(CalcReward(stage_scores(i), final_scores[i]));
    }
    state.score_scale = CalcScoreScale(rewards);
  }
  const double force_scale = range_.max_depth * problem_.world->scene().fingertips.stiffness;
  state.samples.assign(count, {});
  double mean_cost = 0.0;
  for (int i = 0; i < count; ++i) {
    MppiSample& sample = state.samples[i];
    sample.action = actions[i];
    sample.cost = CalcPlanCost(*problem_.world, outcomes[i], stage_scores(i), final_scores[i],
                               config_.weights, force_scale, state.score_scale);
    sample.X_WO_end = outcomes[i].end.bodies.front().X_WB();
    PREGRASP_CHECK(AreFinite(sample.cost.total, sample.X_WO_end), i, sample.cost.total);
    mean_cost += sample.cost.total / count;
    if (sample.cost.total < state.best_cost) {
      state.best_cost = sample.cost.total;
      state.best = sample.cost;
      state.best_action = sample.action;
    }
  }
  MoveMean(state);
  ++state.iteration;
  state.best_history.push_back(state.best_cost);
  state.mean_history.push_back(mean_cost);
  const int patience = config_.patience;
  const bool stalled =
      state.iteration > patience &&
      state.best_history[state.iteration - 1 - patience] - state.best_cost <
          config_.progress * state.score_scale;
  state.end = stalled                                 ? MppiEnd::kPatience
              : state.iteration >= config_.iterations ? MppiEnd::kLimit
                                                      : MppiEnd::kNone;
}

const char* MppiEndName(MppiEnd end) {
  constexpr const char* kNames[] = {"", "patience", "limit"};
  return kNames[static_cast<int>(end)];
}

void Mppi::MoveMean(MppiState& state) const {
  // Of the better half: what a certificate refuses costs so much that a few such plans would set
  // the spread of all, and make the others alike.
  std::vector<double> costs;
  for (const MppiSample& sample : state.samples) costs.push_back(sample.cost.total);
  std::sort(costs.begin(), costs.end());
  const double lowest = costs.front();
  costs.resize((costs.size() + 1) / 2);
  const auto count = static_cast<double>(costs.size());
  double mean = 0.0, variance = 0.0;
  for (const double cost : costs) mean += cost / count;
  for (const double cost : costs) variance += (cost - mean) * (cost - mean) / count;
  const double lambda = config_.temperature * std::max(std::sqrt(variance), 1e-9);
  double sum = 0.0;
  for (MppiSample& sample : state.samples) {
    sample.weight = std::exp(-(sample.cost.total - lowest) / lambda);
    sum += sample.weight;
  }
  std::fill(state.mean.begin(), state.mean.end(), 0.0);
  for (MppiSample& sample : state.samples) {
    sample.weight /= sum;
    for (std::size_t d = 0; d < state.mean.size(); ++d) {
      state.mean[d] += sample.weight * sample.action[d];
    }
  }
  PREGRASP_CHECK(IsFinite(state.mean), mean, variance, sum);
}

}  // namespace pregrasp
