#include "app/trajectory/mppi.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "app/core/check.h"
#include "app/core/finite.h"
#include "app/core/interrupt.h"
#include "app/dynamics/tip_overlap.h"
#include "app/grasp/grasp_room.h"
#include "app/trajectory/proposals.h"

namespace pregrasp {
namespace {

TipFits MakeTipFits(const MppiProblem& problem) {
  const EnvironmentDistance* environment = problem.environment;
  const SignedDistance* shape = problem.shape;
  std::vector<RigidTransform> X_WB = problem.world->GetPoses(problem.start);
  return [=, tips = problem.world->scene().tips, X_WB = std::move(X_WB)](
             Finger finger, const Placement::Contact& contact) {
    const double radius = tips.radius(finger);
    const Vector3 p_WTip = X_WB.front() * tips.Centre(finger, contact.p_OC, contact.nhat_O);
    return HasRoom(radius, contact, *shape) &&
           radius - environment->Calc(p_WTip, X_WB).phi <= kTipOverlapAllowed;
  };
}

// In the scene's own world alone.
double CostHere(const PlanCost& cost) { return cost.total - cost.fragility; }

}  // namespace

Mppi::Mppi(const MppiProblem& problem, const MppiConfig& config)
    : problem_(problem),
      config_(config),
      range_(MakeActionRange(problem.world->scene(), config.max_travel)),
      space_(*problem.graph, problem.path.nodes, *problem.shape, range_, config.timing.knots,
             problem.world->scene().tips, MakeTipFits(problem)) {
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
  const Judged judged = Judge({Simulate(state.mean)}, nullptr).front();
  state.rest_reward =
      CalcReward(judged.stage_scores, judged.final_score + config_.weights.room * judged.room);
  return state;
}

PlanOutcome Mppi::Simulate(const std::vector<double>& action, std::vector<TraceRow>* trace) const {
  return SimulatePlan(*problem_.world, *problem_.environment, problem_.start, space_.Decode(action),
                      config_.timing, trace);
}

std::vector<std::vector<double>> Mppi::SampleActions(const MppiState& state) const {
  const double sigma = CalcSigma(state.iteration);
  const bool first = state.best_action.empty();
  const double share = state.rose_at == 0 ? config_.proposals : 0.25 * config_.proposals;
  const int proposals = static_cast<int>(share * config_.samples);
  const Matrix3 R_WO = problem_.start.bodies.front().X_WB().linear();
  const Vector3 up_W = -problem_.world->scene().gravity.normalized();
  std::vector<std::vector<double>> actions(config_.samples, state.mean);
  for (int i = 0; i < config_.samples; ++i) {
    if (!first && i < 2) {
      if (i == 1) actions[i] = state.best_action;
      continue;
    }
    Rng rng(problem_.seed, RngStream::kMppiNoise, problem_.path.rank,
            state.screened + state.iteration, i);
    if (i >= config_.samples - proposals) {
      const auto kind = static_cast<Proposal>(i % kNumProposals);
      actions[i] = DrawProposal(space_, kind, R_WO, up_W, rng);
      continue;
    }
    for (double& u : actions[i]) u += sigma * rng.Normal();
  }
  return actions;
}

std::vector<Mppi::Judged> Mppi::Judge(const std::vector<PlanOutcome>& outcomes,
                                      ThreadPool* pool) const {
  const int count = static_cast<int>(outcomes.size());
  std::vector<ScoredState> ends(count);
  std::vector<Judged> judged(count);
  const auto look_at_end = [&](int i, int) {
    ThrowIfInterrupted();
    ends[i] = EndToScore(*problem_.world, outcomes[i]);
    if (problem_.room == nullptr || outcomes[i].diverged) return;
    judged[i].room = problem_.room->Calc(ends[i].X_WB, KeptContacts(ends[i]));
  };
  if (pool != nullptr) pool->ParallelFor(count, look_at_end);
  for (int i = 0; pool == nullptr && i < count; ++i) look_at_end(i, 0);

  std::vector<ScoredState> states;
  for (const PlanOutcome& outcome : outcomes) {
    for (ScoredState& scored : StatesToScore(*problem_.world, outcome)) {
      states.push_back(std::move(scored));
    }
  }
  const std::vector<double> scores = problem_.scorer->Score(states);
  PREGRASP_CHECK(scores.size() == states.size(), scores.size(), states.size());
  const std::vector<double> final_scores = problem_.scorer->ScoreGraspable(ends);
  auto next = scores.begin();
  for (int i = 0; i < count; ++i) {
    const auto end = next + std::ssize(outcomes[i].stage_starts);
    judged[i].stage_scores.assign(next, end);
    judged[i].final_score = final_scores[i];
    next = end;
  }
  return judged;
}

PlanCost Mppi::CalcCost(const PlanOutcome& outcome, const Judged& judged,
                        double score_scale) const {
  const double force_scale = range_.max_depth * problem_.world->scene().fingertips.stiffness;
  return CalcPlanCost(*problem_.world, outcome, judged.stage_scores, judged.final_score,
                      judged.room, config_.weights, force_scale, score_scale);
}

void Mppi::FixScale(MppiState& state, const std::vector<Judged>& judged) const {
  if (state.score_scale > 0.0) return;
  std::vector<double> rewards;
  for (const Judged& one : judged) {
    rewards.push_back(
        CalcReward(one.stage_scores, one.final_score + config_.weights.room * one.room));
  }
  state.score_scale = CalcScoreScale(rewards);
}

double Mppi::TryElsewhere(const PlanOutcome& nominal) const {
  std::vector<PlanOutcome> outcomes;
  for (const World& world : *problem_.others) {
    if (nominal.diverged) break;
    outcomes.push_back(SimulatePlan(world, *problem_.environment, problem_.start, nominal.plan,
                                    config_.timing, Stepper::kKernel));
  }
  return CalcFragility(nominal, outcomes);
}

void Mppi::AddFragilities(const std::vector<PlanOutcome>& outcomes, double rest_reward,
                          std::vector<MppiSample>& samples, ThreadPool& pool) const {
  if (!is_tried_elsewhere()) return;
  std::vector<int> order(samples.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return samples[a].cost.total < samples[b].cost.total; });
  const int tried = static_cast<int>((samples.size() + 1) / 2);
  pool.ParallelFor(static_cast<int>(order.size()), [&](int k, int) {
    ThrowIfInterrupted();
    const double fragility = k < tried ? TryElsewhere(outcomes[order[k]]) : 1.0;
    AddFragility(samples[order[k]].cost, fragility, config_.weights, rest_reward);
  });
}

void Mppi::TryPlansElsewhere(MppiState& state, ThreadPool& pool) const {
  if (!is_tried_elsewhere()) return;
  std::vector<MppiPlan>& plans = state.plans;
  pool.ParallelFor(static_cast<int>(plans.size()), [&](int i, int) {
    ThrowIfInterrupted();
    const double fragility = TryElsewhere(Simulate(plans[i].action));
    AddFragility(plans[i].cost, fragility, config_.weights, state.rest_reward);
  });
  std::stable_sort(plans.begin(), plans.end(), [](const MppiPlan& a, const MppiPlan& b) {
    return a.cost.total < b.cost.total;
  });
  SetBest(state);
}

void Mppi::Step(MppiState& state, ThreadPool& pool) const {
  if (state.iteration == 0 && !state.plans.empty()) TryPlansElsewhere(state, pool);
  Iterate(state, true, pool);
}

void Mppi::Iterate(MppiState& state, bool elsewhere, ThreadPool& pool) const {
  const std::vector<std::vector<double>> actions = SampleActions(state);
  const int count = static_cast<int>(actions.size());
  std::vector<PlanOutcome> outcomes(count);
  pool.ParallelFor(count, [&](int i, int) {
    ThrowIfInterrupted();
    outcomes[i] = Simulate(actions[i]);
  });
  const std::vector<Judged> judged = Judge(outcomes, &pool);
  FixScale(state, judged);
  state.samples.assign(count, {});
  double mean_cost = 0.0;
  for (int i = 0; i < count; ++i) {
    MppiSample& sample = state.samples[i];
    sample.action = actions[i];
    sample.cost = CalcCost(outcomes[i], judged[i], state.score_scale);
    sample.X_WO_end = outcomes[i].end.bodies.front().X_WB();
    PREGRASP_CHECK(AreFinite(sample.cost.total, sample.X_WO_end), i, sample.cost.total);
  }
  if (elsewhere) AddFragilities(outcomes, state.rest_reward, state.samples, pool);
  for (const MppiSample& sample : state.samples) {
    mean_cost += sample.cost.total / count;
    Offer(state, sample);
  }
  MoveMean(state);
  ++state.iteration;
  if (state.rose_at == 0 && state.best.reward > state.rest_reward + config_.rise) {
    state.rose_at = state.iteration;
  }
  state.best_history.push_back(state.best_cost);
  state.mean_history.push_back(mean_cost);
  CheckEnd(state);
}

void Mppi::Screen(MppiState& state, int iterations, ThreadPool& pool) const {
  for (int i = 0; i < iterations; ++i) Iterate(state, false, pool);
  state.screened += state.iteration;
  state.iteration = 0;
  if (state.rose_at > 0) state.rose_at = 1;
  state.best_history.clear();
  state.mean_history.clear();
  state.end = MppiEnd::kNone;
}

// The plan to leave out. Where only a fragile plan gets the object to where a grasp is, robust ones
// that do not must not crowd it out: the list holds the best by cost and the best by cost without
// fragility.
std::vector<MppiPlan>::iterator Mppi::FindLeastPromising(std::vector<MppiPlan>& plans) {
  auto least = plans.end();
  std::ptrdiff_t least_rank = -1;
  for (auto plan = plans.begin(); plan != plans.end(); ++plan) {
    const std::ptrdiff_t by_cost = plan - plans.begin();  // they are in its order
    const std::ptrdiff_t by_cost_here = std::count_if(
        plans.begin(), plans.end(),
        [&](const MppiPlan& other) { return CostHere(other.cost) < CostHere(plan->cost); });
    const std::ptrdiff_t rank = std::min(by_cost, by_cost_here);
    if (rank < least_rank) continue;
    least = plan;
    least_rank = rank;
  }
  return least;
}

// Keeps the best of all plans whose ends differ.
void Mppi::Offer(MppiState& state, const MppiSample& sample) {
  const auto is_same = [&](const MppiPlan& plan) {
    const RigidTransform &a = plan.X_WO_end, &b = sample.X_WO_end;
    return (a.translation() - b.translation()).norm() < kSameShift &&
           RadToDeg(RotationAngle(a.linear(), b.linear())) < kSameTurnDeg;
  };
  std::vector<MppiPlan>& plans = state.plans;
  const auto better = std::find_if(plans.begin(), plans.end(), [&](const MppiPlan& plan) {
    return is_same(plan) && plan.cost.total <= sample.cost.total;
  });
  if (better != plans.end()) return;
  plans.erase(std::remove_if(plans.begin(), plans.end(), is_same), plans.end());
  const auto place = std::find_if(plans.begin(), plans.end(), [&](const MppiPlan& plan) {
    return sample.cost.total < plan.cost.total;
  });
  plans.insert(place, {sample.action, sample.cost, sample.X_WO_end});
  if (static_cast<int>(plans.size()) > kMostPlans) plans.erase(FindLeastPromising(plans));
  SetBest(state);
}

void Mppi::SetBest(MppiState& state) {
  const MppiPlan& best = state.plans.front();
  state.best_cost = best.cost.total;
  state.best = best.cost;
  state.best_action = best.action;
}

void Mppi::CheckEnd(MppiState& state) const {
  const int patience = config_.patience;
  const bool stalled = state.rose_at > 0 && state.iteration - state.rose_at >= patience &&
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
  // Without fragility, which would hold the mean back where every first step is fragile: what is
  // robust is chosen among the plans. Of the better half: what a certificate refuses costs so much
  // that a few such plans would set the spread of all, and make the others alike.
  std::vector<double> costs;
  for (const MppiSample& sample : state.samples) costs.push_back(CostHere(sample.cost));
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
    sample.weight = std::exp(-(CostHere(sample.cost) - lowest) / lambda);
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
