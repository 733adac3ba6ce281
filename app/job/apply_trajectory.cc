#include <fmt/format.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/geometry/mesh_distance.h"
#include "app/job/apply_stages.h"
#include "app/job/plan_json.h"
#include "app/job/plan_triangles.h"

namespace pregrasp::internal {
namespace {

CostFacts MakeCostFacts(const PlanCost& cost) {
  CostFacts facts{cost.total, cost.stage_scores, cost.final_score, cost.room, cost.reward, {}};
  for (const CostTerm& term : CostTerms()) facts.terms.push_back({term.name, cost.*term.value});
  return facts;
}

// A plan's stages, of a RelativePlan or a WorldPlan, along the path.
template <typename Stages>
std::vector<StageFacts> MakeStageFacts(const Mppi& mppi, const Stages& stages) {
  const auto triangles = TrianglesOf(mppi, stages);
  std::vector<StageFacts> facts;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    StageFacts stage;
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const auto& finger = stages[i][f];
      stage.push_back({static_cast<Finger>(f),
                       finger.on,
                       finger.kept,
                       triangles[i][f],
                       finger.contact.p_OC,
                       finger.contact.nhat_O,
                       {}});
    }
    facts.push_back(std::move(stage));
  }
  return facts;
}

RolloutFacts MakeRolloutFacts(const Mppi& mppi, const MppiSample& sample) {
  RolloutFacts facts;
  facts.cost = MakeCostFacts(sample.cost);
  facts.weight = sample.weight;
  facts.stages = MakeStageFacts(mppi, mppi.Decode(sample.action).stages);
  facts.p_WO_end = sample.X_WO_end.translation();
  facts.q_WO_end = Quaternion(sample.X_WO_end.linear());
  return facts;
}

// The optimisation of the state's path with its settings, begun unless it has been.
void Prepare(Application& a) {
  Require(a.next.path != nullptr, "a path", "none");
  if (a.next.mppi && !a.command.options.contains("settings")) return;
  const Planner planner = a.next.planner->WithConfig(a.next.config);
  const auto mppi = std::make_shared<const Mppi>(
      planner.MakeMppi(*a.next.graph, *a.next.path, a.next.config.mppi));
  MppiState start = mppi->Start();
  if (a.next.optimization && a.next.optimization->mean.size() != start.mean.size()) {
    throw InputError("", "mppi.knots",
                     std::to_string(a.next.mppi->config().timing.knots) + ", as before",
                     std::to_string(a.next.config.mppi.timing.knots));
  }
  if (!a.next.optimization) {
    a.next.optimization = std::make_shared<const MppiState>(std::move(start));
  }
  a.next.mppi = mppi;
}

// The world where the best plan so far leaves it.
void SetEndOfBestPlan(Application& a, const Mppi& mppi, const MppiState& state) {
  std::vector<TraceRow> trace;
  mppi.Simulate(state.best_action, &trace);
  SetWorldFacts(a.facts, a.job.world(), trace.back().state, trace.back().contacts);
}

void Screen(Application& a) {
  a.next.ForgetTrajectory();
  Prepare(a);
  const ScreenConfig& config = a.next.config.screen;
  Require(a.next.optimization->iteration == 0, "a path that is not being optimised yet",
          "one that is");
  MppiConfig few = a.next.config.mppi;
  few.samples = config.samples;
  const Planner planner = a.next.planner->WithConfig(a.next.config);
  const Mppi mppi = planner.MakeMppi(*a.next.graph, *a.next.path, few);
  MppiState state = *a.next.optimization;
  mppi.Screen(state, config.iterations, a.job.pool());
  ++a.next.screen_rounds;
  a.facts.id = fmt::format("path.{}.screen.{}", a.next.path->rank, a.next.screen_rounds);
  ScreenFacts facts;
  facts.path = a.next.path->rank;
  facts.round = a.next.screen_rounds;
  facts.iterations = config.iterations;
  facts.rollouts = config.iterations * config.samples;
  facts.value = state.best.CalcValue();
  facts.rest_reward = state.rest_reward;
  facts.score_scale = state.score_scale;
  facts.best = MakeCostFacts(state.best);
  facts.stages = MakeStageFacts(mppi, mppi.Decode(state.best_action).stages);
  a.facts.details = std::move(facts);
  SetEndOfBestPlan(a, mppi, state);
  state.samples.clear();
  a.next.optimization = std::make_shared<const MppiState>(std::move(state));
}

// Puts the plan of a rollout of the last iteration in the place of the mean.
void SetNominal(const Application& a, MppiState& state) {
  const int rollout = CommandOptions(a.command).Int("nominal");
  const auto count = std::ssize(state.samples);
  if (rollout < 1 || rollout > count) {
    throw InputError(
        "", "nominal",
        count == 0 ? "an iteration before" : fmt::format("a rollout from 1 to {}", count),
        std::to_string(rollout));
  }
  state.mean = state.samples[static_cast<std::size_t>(rollout) - 1].action;
}

void Iterate(Application& a) {
  a.next.ForgetTrajectory();
  Prepare(a);
  Require(!a.next.optimization->ended() || a.command.options.contains("settings") ||
              a.command.options.contains("nominal"),
          "an optimisation that goes on", "one that has ended");
  const Mppi& mppi = *a.next.mppi;
  MppiState state = *a.next.optimization;
  if (a.command.options.contains("nominal")) SetNominal(a, state);
  const int iteration = state.iteration;
  mppi.Step(state, a.job.pool());
  a.facts.id = fmt::format("path.{}.mppi.{}", a.next.path->rank, state.iteration);
  IterationFacts facts;
  facts.path = a.next.path->rank;
  facts.iteration = state.iteration;
  facts.limit = mppi.config().iterations;
  facts.sigma = mppi.CalcSigma(iteration);
  facts.score_scale = state.score_scale;
  facts.rest_reward = state.rest_reward;
  facts.risen = state.rose_at > 0;
  facts.num_plans = static_cast<int>(state.plans.size());
  facts.best_cost = state.best_cost;
  facts.mean_cost = state.mean_history.back();
  facts.best = MakeCostFacts(state.best);
  facts.converged = state.converged();
  facts.end = MppiEndName(state.end);
  for (const MppiSample& sample : state.samples) {
    facts.rollouts.push_back(MakeRolloutFacts(mppi, sample));
  }
  a.facts.details = std::move(facts);
  SetEndOfBestPlan(a, mppi, state);
  a.next.optimization = std::make_shared<const MppiState>(std::move(state));
}

CertifyFacts MakeCertifyFacts(const JobState& state, const Scene& scene, int plan) {
  const Certificate& certificate = *state.certificate;
  const ReleaseResult& release = *state.release;
  CertifyFacts facts;
  facts.path = state.path->rank;
  facts.plan = plan;
  facts.certified = certificate.certified;
  for (const CertifyReason reason : certificate.reasons) {
    facts.reasons.emplace_back(CertifyReasonText(reason));
  }
  facts.slow = state.config.certify.slow;
  facts.hold_seconds = state.config.certify.hold_seconds;
  facts.hold_shift_mm = 1e3 * certificate.hold_shift;
  facts.hold_turn_deg = certificate.hold_turn_deg;
  facts.step_shift_mm = 1e3 * certificate.step_shift;
  facts.step_turn_deg = certificate.step_turn_deg;
  facts.released_shift_mm = 1e3 * release.shift;
  facts.released_turn_deg = release.turn_deg;
  facts.stays_when_released = release.stays;
  facts.seconds = certificate.full.seconds;
  facts.max_speed = certificate.full.max_speed;
  facts.max_force_N = certificate.full.max_force;
  facts.max_penetration_mm = 1e3 * certificate.full.max_penetration;
  facts.max_tip_overlap_mm = 1e3 * certificate.full.max_tip_overlap;
  facts.not_converged = certificate.full.not_converged;
  facts.unresolved_mm = 1e3 * std::max(certificate.full.unresolved, certificate.half.unresolved);
  facts.neighbours = MakeNeighbourFacts(certificate.neighbours, scene);
  for (const GraspContact& contact : release.pressing) {
    facts.pressing.push_back({contact.finger, contact.p_OC, contact.nhat_O});
  }
  facts.out_of_reach_t = certificate.out_of_reach_t;
  facts.waits = certificate.full.waits;
  facts.stages = MakeStageFacts(*state.mppi, certificate.full.plan.stages);
  for (std::size_t i = 0; i < facts.stages.size(); ++i) {
    for (std::size_t f = 0; f < facts.stages[i].size(); ++f) {
      facts.stages[i][f].p_WTargets = certificate.full.plan.stages[i][f].p_WTargets;
    }
  }
  return facts;
}

RobustFacts MakeRobustFacts(Application& a) {
  const PlanOutcome& nominal = a.next.certificate->full;
  const RobustResult result =
      a.job.robust_worlds().Test(a.next.planner->environment(), a.next.start, nominal.plan,
                                 a.next.mppi->config().timing, a.next.config.certify, nominal.end);
  RobustFacts facts{static_cast<int>(result.outcomes.size()),
                    result.held,
                    1e3 * result.worst_shift,
                    result.worst_turn_deg,
                    {}};
  for (const RobustOutcome& outcome : result.outcomes) {
    if (!outcome.held) facts.elsewhere.emplace_back(RobustChangeName(outcome.change));
  }
  return facts;
}

// A plan made by hand touches where it likes.
void SetTriangles(const TriangleMesh& mesh, std::vector<StageFacts>& stages) {
  const MeshDistance distance(mesh);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    for (std::size_t f = 0; f < stages[i].size(); ++f) {
      StageFingerFacts& finger = stages[i][f];
      if (!finger.on) continue;
      finger.triangle =
          finger.kept ? stages[i - 1][f].triangle : distance.FindNearest(finger.p_OC).triangle;
    }
  }
}

// The plan of these that the command asks for, from 1.
int ChoosePlan(const CommandOptions& options, const std::vector<MppiPlan>& plans) {
  const int plan = options.Has("plan") ? options.Int("plan") : 1;
  if (plan < 1 || plan > std::ssize(plans)) {
    throw InputError("", "plan", fmt::format("a whole number from 1 to {}", plans.size()),
                     std::to_string(plan));
  }
  return plan;
}

void Certify(Application& a) {
  const CommandOptions options(a.command);
  const bool by_hand = options.Has("stages");
  if (by_hand) {
    Prepare(a);
  } else {
    Require(a.next.optimization && !a.next.optimization->plans.empty(), "at least one step()",
            "none");
  }
  const Mppi& mppi = *a.next.mppi;
  const int plan = by_hand ? 0 : ChoosePlan(options, a.next.optimization->plans);
  a.next.ForgetTrajectory();
  const Planner planner = a.next.planner->WithConfig(a.next.config);
  auto certificate = std::make_shared<const Certificate>(
      by_hand ? planner.Certify(mppi, PlanFromJson(options.Get("stages"), planner.grasp_world(),
                                                   mppi.config().timing.knots))
              : planner.Certify(mppi, a.next.optimization->plans[plan - 1]));
  a.next.release =
      std::make_shared<const ReleaseResult>(planner.Release(*a.next.graph, *certificate));
  a.next.certificate = certificate;
  a.facts.id = fmt::format("path.{}.certify", a.next.path->rank);
  const TraceRow& last = certificate->trace.back();
  SetWorldFacts(a.facts, a.job.world(), last.state, last.contacts);
  CertifyFacts facts = MakeCertifyFacts(a.next, a.job.scene(), plan);
  if (by_hand) SetTriangles(a.next.graph->mesh(), facts.stages);
  if (certificate->certified) facts.robust = MakeRobustFacts(a);
  a.facts.details = std::move(facts);
}

}  // namespace

void ApplyTrajectory(Application& a) {
  if (a.command.verb == Verb::kScreen) Screen(a);
  if (a.command.verb == Verb::kIterate) Iterate(a);
  if (a.command.verb == Verb::kCertify) Certify(a);
}

}  // namespace pregrasp::internal
