#include <fmt/format.h>

#include "app/core/error.h"
#include "app/job/apply_stages.h"

namespace pregrasp::internal {
namespace {

void SetEndOfTrajectory(Application& a) {
  const TraceRow& last = a.next.certificate->trace.back();
  SetWorldFacts(a.facts, a.job.world(), last.state, last.contacts);
}

GraspFacts MakeGraspFacts(const HandModel& hand, const JobState& state, int entry) {
  const CompletedGrasp& grasp = state.grasps->grasps[entry - 1];
  const GraspResult& result = grasp.result;
  GraspFacts facts;
  facts.path = state.path->rank;
  facts.entry = entry;
  facts.number = grasp.number;
  facts.source = GraspSourceName(grasp.source);
  facts.feasible = grasp.feasible();
  facts.status = GraspStatusName(result.status);
  facts.raw_status = GraspStatusName(grasp.raw.status);
  facts.sentence = Explain(result);
  facts.moved_mm = 1e3 * grasp.moved;
  facts.refinements = grasp.refinements;
  for (std::size_t i = 0; i < result.contacts.size(); ++i) {
    const GraspContact& contact = result.contacts[i];
    Vector3 f_O = Vector3::Zero();
    const auto row = static_cast<Eigen::Index>(i);
    if (result.wrench && row < result.wrench->forces.rows()) {
      f_O = result.wrench->forces.row(row).transpose();
    }
    facts.contacts.push_back({contact.finger, contact.p_OC, contact.nhat_O, f_O});
  }
  if (!state.release->stays) {
    for (const GraspContact& contact : state.release->pressing) {
      facts.kept.push_back({contact.finger, contact.p_OC, contact.nhat_O});
    }
  }
  if (result.wrench) {
    facts.margin = result.wrench->margin;
    facts.min_normal_N = result.wrench->min_normal;
  }
  if (result.kinematics) {
    const IkResult& ik = result.kinematics->ik;
    facts.hand = MakeHandFacts(hand, ik.configuration());
    facts.tip_error_mm = 1e3 * ik.tip_error;
    facts.clearance_mm = 1e3 * ik.clearance;
  }
  if (result.fault.overlap) {
    facts.colliding = {result.fault.overlap->link, result.fault.overlap->other};
  }
  return facts;
}

void TakeGrasp(Application& a) {
  Require(a.next.certificate != nullptr, "a trajectory that was put to certification", "none");
  a.next.ForgetMotion();
  if (!a.next.grasps || a.command.options.contains("settings")) {
    Require(a.next.num_grasps == 0, "settings of all samples before the first", "a later one");
    const Planner planner = a.next.planner->WithConfig(a.next.config);
    // What the generator is asked to complete depends on the settings.
    a.next.release =
        std::make_shared<const ReleaseResult>(planner.Release(*a.next.graph, *a.next.certificate));
    a.next.grasps = std::make_shared<const GraspSet>(
        planner.CompleteGrasps(*a.next.certificate, *a.next.release, a.next.path->rank));
  }
  const int count = static_cast<int>(a.next.grasps->grasps.size());
  Require(count > 0, "a fingertip to be anywhere on the object", "no place for one");
  Require(a.next.num_grasps < count, "a sample that is left", "none");
  const int entry = ++a.next.num_grasps;
  const CompletedGrasp& grasp = a.next.grasps->grasps[entry - 1];
  a.facts.id = fmt::format("path.{}.{}.{}", a.next.path->rank,
                           grasp.source == GraspSource::kSearch ? "search" : "grasp", grasp.number);
  SetEndOfTrajectory(a);
  a.facts.details = MakeGraspFacts(a.job.hand(), a.next, entry);
}

LiftFacts MakeLiftFacts(const Application& a, int number, const LiftResult& lift) {
  LiftFacts facts;
  facts.path = a.next.path->rank;
  facts.grasp = number;
  facts.held = lift.held;
  for (const LiftReason reason : lift.reasons) facts.reasons.emplace_back(LiftReasonName(reason));
  facts.sentence = Explain(lift, a.job.scene());
  facts.height_m = lift.height;
  facts.shift_mm = 1e3 * lift.shift;
  facts.turn_deg = lift.turn_deg;
  facts.slip_mm = 1e3 * lift.slip;
  facts.direction_W = lift.way.direction_W;
  facts.pushes = lift.pushes;
  facts.forearm_free = lift.forearm_free;
  facts.soft = lift.soft;
  facts.stiff = lift.stiff;
  facts.not_converged = lift.not_converged;
  facts.unresolved_mm = 1e3 * lift.unresolved;
  for (std::size_t i = 0; i < lift.grip.contacts.size(); ++i) {
    const GraspContact& contact = lift.grip.contacts[i];
    facts.grip.push_back({contact.finger, contact.p_OC, contact.nhat_O,
                          lift.grip.forces_O.row(static_cast<Eigen::Index>(i)).transpose()});
  }
  facts.neighbours = MakeNeighbourFacts(lift.neighbours, a.job.scene());
  facts.neighbour_moved_mm = 1e3 * lift.neighbour_moved;
  facts.neighbour_turned_deg = lift.neighbour_turned_deg;
  facts.hand = MakeHandFacts(
      a.job.hand(), a.next.grasps->grasps[number - 1].result.kinematics->ik.configuration());
  return facts;
}

void SimulateLiftOf(Application& a) {
  a.next.ForgetMotion();
  const int number = CommandOptions(a.command).Int("grasp");
  Require(a.next.grasps && number >= 1 && number <= a.next.num_grasps, "the number of a grasp",
          "another");
  const CompletedGrasp& grasp = a.next.grasps->grasps[number - 1];
  Require(grasp.feasible(), "a feasible grasp", "one that is not");
  if (!a.next.prepared_lifts || a.command.options.contains("settings")) {
    const Planner planner = a.next.planner->WithConfig(a.next.config);
    a.next.prepared_lifts = std::make_shared<const std::vector<std::optional<LiftResult>>>(
        planner.LiftGrasps(*a.next.certificate, *a.next.grasps));
  }
  const LiftResult& lift = *a.next.prepared_lifts->at(number - 1);
  a.next.lifts[number] = std::shared_ptr<const LiftResult>(a.next.prepared_lifts, &lift);
  a.facts.id = fmt::format("path.{}.lift.{}", a.next.path->rank, number);
  if (lift.simulated) {
    const TraceRow& last = lift.trace.back();
    SetWorldFacts(a.facts, a.job.world(), last.state, last.contacts);
  } else {
    SetEndOfTrajectory(a);
  }
  a.facts.details = MakeLiftFacts(a, number, lift);
}

}  // namespace

void ApplyGrasp(Application& a) {
  if (a.command.verb == Verb::kGrasp) TakeGrasp(a);
  if (a.command.verb == Verb::kLift) SimulateLiftOf(a);
}

}  // namespace pregrasp::internal
