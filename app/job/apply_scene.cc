#include <fmt/format.h>

#include <cmath>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/job/apply_stages.h"
#include "app/job/motion_measure.h"
#include "app/job/start_verdict.h"

namespace pregrasp::internal {
namespace {

constexpr double kLongestSettle = 300.0;  // [s]

void Open(Application& a) {
  a.facts.id = "scene.start";
  std::get<OpenFacts>(a.facts.details).departures = RuleDepartures(a.job.scene());
}

void SettleStart(Application& a) {
  Require(!a.next.planner && !a.next.simulation,
          "to settle before anything is planned or simulated", "a later step");
  const double seconds = CommandOptions(a.command).Number("seconds");
  if (!(seconds > 0.0 && seconds <= kLongestSettle)) {
    throw InputError("", "seconds", fmt::format("above 0 and at most {} s", kLongestSettle),
                     FormatDouble(seconds));
  }
  const SettleResult result = Settle(a.job.world(), a.next.start, seconds);
  a.next.start.t = 0.0;
  a.next.start.step = 0;
  a.facts.id = "scene.settle";
  a.facts.details = SettleFacts{seconds,
                                1e3 * result.largest.moved,
                                RadToDeg(result.largest.rotated),
                                result.at_rest,
                                result.largest.body,
                                result.not_converged,
                                1e3 * result.unresolved};
  SetWorldFacts(a.facts, a.job.world(), a.next.start, {});
}

void FindVerdict(Application& a) {
  // The verdict is that of the scene as it is written, settled or not.
  const JobSetup& setup = a.job.setup();
  a.next.verdict = std::make_shared<const StartCertificate>(
      FindSceneVerdict(a.job.scene(), a.job.hand(), setup.seed, setup.weights, a.job.pool()));
  const StartCertificate& start = *a.next.verdict;
  a.facts.id = "scene.verdict";
  VerdictFacts facts;
  facts.verdict = StartVerdictName(start.verdict);
  facts.mu = start.mu;
  if (std::isfinite(start.mu_star)) facts.mu_star = start.mu_star;
  facts.thin = start.thin();
  facts.reachable_points = start.reachable_points;
  facts.reachable_edge_points = start.reachable_edge_points;
  facts.proposed = start.proposed_samples;
  facts.drawn = start.search.drawn;
  facts.plausible = start.search.plausible;
  facts.on_edges = start.search.on_edges;
  facts.tried = start.proposed_samples + start.search.tried;
  facts.held = start.search.held;
  facts.reached = start.search.reached;
  facts.feasible = start.verdict == StartVerdict::kGraspable ? 1 : 0;
  if (start.example) {
    for (const GraspContact& contact : start.example->contacts) {
      facts.example.push_back({contact.finger, contact.p_OC, contact.nhat_O});
    }
  }
  facts.sentence = DescribeStart(start);
  a.facts.details = std::move(facts);
}

}  // namespace

void ApplyScene(Application& a) {
  if (a.command.verb == Verb::kOpen) Open(a);
  if (a.command.verb == Verb::kSettle) SettleStart(a);
  if (a.command.verb == Verb::kVerdict) FindVerdict(a);
}

}  // namespace pregrasp::internal
