#include "app/grasp/lift.h"

#include <fmt/format.h>

#include <tuple>

#include "app/core/check.h"

namespace pregrasp {
namespace {

constexpr double kPushShare = 0.5;  // of the object's weight

// One lift with fingers of one stiffness.
class Lift {
 public:
  Lift(const LiftWorlds& worlds, const WorldState& state, const GraspResult& grasp,
       const LiftWay& way, const LiftConfig& config)
      : worlds_(worlds), state_(state), way_(way), config_(config) {
    contacts_ = MoveToPressing(state, grasp.contacts);
    const std::vector<WrenchContact> wrench_contacts = worlds.grasp.ToWrenchContacts(contacts_);
    const WrenchConfig wrench =
        worlds.grasp.MakeWrenchConfig(kMinForce, state.bodies.front().X_WB().linear());
    if (CalcWrenchStatus(wrench_contacts, wrench) != WrenchStatus::kFeasible) {
      // A finger has slipped by a millimetre from where the grasp has it: its own place will do.
      contacts_ = grasp.contacts;
    }
  }

  std::optional<GraspForces> ChooseForces(double k) const {
    const WrenchConfig wrench =
        worlds_.grasp.MakeWrenchConfig(kMinForce, state_.bodies.front().X_WB().linear());
    return ChooseGraspForces(worlds_.grasp.ToWrenchContacts(contacts_), wrench, k, config_.forces);
  }

  LiftOutcome Simulate(const World& world, const LiftGrip& grip, Stepper stepper,
                       bool trace) const {
    return SimulateLift(world, worlds_.grasp.environment(), state_, grip, way_, config_, stepper,
                        trace);
  }

  // Forces and simulation with fingers of another stiffness, without a second look at half the
  // step.
  bool HoldsWith(double k) const {
    const std::optional<GraspForces> forces = ChooseForces(k);
    if (!forces || !forces->is_stiff) return false;
    const LiftGrip grip{contacts_, forces->forces, k};
    return JudgeLift(Simulate(worlds_.full, grip, Stepper::kKernel, false)).empty();
  }

  int CountPushes(const WorldState& top) const {
    const double force = kPushShare * worlds_.full.scene().object_weight();
    const Matrix3 R_WO = top.bodies.front().X_WB().linear();
    int held = 0;
    for (int i = 0; i < kNumPushes; ++i) {
      const Vector3 force_W = (i % 2 == 0 ? force : -force) * R_WO.col(i / 2);
      held += WithstandsPush(SimulatePush(worlds_.full, worlds_.grasp.environment(), top, force_W));
    }
    return held;
  }

  const std::vector<GraspContact>& contacts() const { return contacts_; }

 private:
  static constexpr double kMinForce = 0.5;  // of every finger (design, section 4) [N]

  const LiftWorlds& worlds_;
  const WorldState& state_;
  const LiftWay& way_;
  const LiftConfig& config_;
  std::vector<GraspContact> contacts_;
};

std::string DescribeDirection(const LeastStiffness& least) {
  const bool turns = least.turn.norm() > least.shift.norm();
  Vector3 axis = (turns ? least.turn : least.shift).normalized();
  axis = (1e2 * axis).array().round() / 1e2 + 0.0;  // without a zero's sign
  return fmt::format("{} ({:.2f}, {:.2f}, {:.2f}) of the object",
                     turns ? "as it turns about" : "as it shifts along", axis.x(), axis.y(),
                     axis.z());
}

std::string ExplainReason(const LiftResult& lift, LiftReason reason, const Scene& scene) {
  switch (reason) {
    case LiftReason::kNoFreeDirection:
      return "in no direction from up to level is the object's way free";
    case LiftReason::kNeverFree:
      return fmt::format("after {:.0f} cm the object is not free of its surroundings",
                         1e2 * lift.way.length);
    case LiftReason::kNoForces:
      return "no forces within cones and limits balance the weight";
    case LiftReason::kGivesWay:
      return fmt::format("the grasp gives way: its stiffness is {:.3g} N/m {}",
                         lift.forces->least.value, DescribeDirection(lift.forces->least));
    case LiftReason::kDiverged:
      return "the object left the scene";
    case LiftReason::kTipOverlap:
      return fmt::format("the fingertip of {} enters the surroundings by {:.1f} mm",
                         FingerName(lift.deepest_tip), 1e3 * lift.tip_overlap);
    case LiftReason::kDoesNotFollow:
      return fmt::format("the object does not follow: it comes to be {:.0f} mm and {:.0f} deg off",
                         1e3 * lift.shift, lift.turn_deg);
    case LiftReason::kStillTouches:
      return fmt::format("{} still touches the object at the end",
                         scene.bodies.at(lift.touching_body->value).name);
    case LiftReason::kNotConverged:
      return fmt::format(
          "the simulation did not find the contact forces exactly enough: bodies may have sunk "
          "into each other by {:.1f} mm",
          1e3 * lift.unresolved);
    case LiftReason::kStepDependent:
      return "half the time step gives another verdict";
  }
  return "";
}

}  // namespace

LiftResult LiftGrasp(const LiftWorlds& worlds, const WorldState& state, const GraspResult& grasp,
                     const LiftWay& way, const LiftConfig& config) {
  config.Validate();
  PREGRASP_CHECK(grasp.feasible());
  LiftResult result;
  result.way = way;
  result.end = state;
  if (!way.is_free()) {
    result.reasons.push_back(way.status == LiftWayStatus::kNeverFree
                                 ? LiftReason::kNeverFree
                                 : LiftReason::kNoFreeDirection);
    return result;
  }
  const Lift lift(worlds, state, grasp, way, config);
  const double k = worlds.full.scene().fingertips.grasp_stiffness;
  result.forces = lift.ChooseForces(k);
  if (!result.forces || !result.forces->is_stiff) {
    result.reasons.push_back(result.forces ? LiftReason::kGivesWay : LiftReason::kNoForces);
    return result;
  }
  result.grip = {lift.contacts(), result.forces->forces, k};
  result.simulated = true;
  static_cast<LiftOutcome&>(result) =
      lift.Simulate(worlds.full, result.grip, Stepper::kSimbody, true);
  result.reasons = JudgeLift(result);
  if (!result.reasons.empty()) return result;
  if (!JudgeLift(lift.Simulate(worlds.half, result.grip, Stepper::kSimbody, false)).empty()) {
    result.reasons.push_back(LiftReason::kStepDependent);
    return result;
  }
  result.held = true;
  result.pushes = lift.CountPushes(result.end);
  result.soft = lift.HoldsWith(kSoftStiffness);
  result.stiff = lift.HoldsWith(kStiffStiffness);
  return result;
}

bool WithstandsMore(const LiftResult& a, const LiftResult& b) {
  const auto rank = [](const LiftResult& lift) {
    return std::tuple(lift.held, !lift.neighbours.disturbed, lift.pushes,
                      static_cast<int>(lift.soft) + static_cast<int>(lift.stiff));
  };
  return rank(a) > rank(b);
}

std::string Explain(const LiftResult& lift, const Scene& scene) {
  if (lift.held) {
    return fmt::format(
        "lifted {:.0f} mm, at most {:.1f} mm and {:.1f} deg off; {} of {} pushes held; {}with "
        "fingers of {:.0f} N/m, {}with {:.0f} N/m",
        1e3 * lift.height, 1e3 * lift.shift, lift.turn_deg, lift.pushes, kNumPushes,
        lift.soft ? "" : "not ", kSoftStiffness, lift.stiff ? "" : "not ", kStiffStiffness);
  }
  std::string text = "not lifted: ";
  for (const LiftReason reason : lift.reasons) {
    if (reason != lift.reasons.front()) text += "; ";
    text += ExplainReason(lift, reason, scene);
  }
  return text;
}

}  // namespace pregrasp
