#include "app/job/step_facts.h"

namespace pregrasp {

HandConfiguration HandFacts::configuration() const {
  HandConfiguration hand;
  hand.X_WH = MakeTransform(q_WH, p_WH);
  for (std::size_t j = 0; j < joints.size() && j < kMaxHandJoints; ++j) {
    hand.q[static_cast<Eigen::Index>(j)] = joints[j];
  }
  return hand;
}

HandFacts MakeHandFacts(const HandModel& model, const HandConfiguration& hand) {
  HandFacts facts;
  facts.p_WH = hand.X_WH.translation();
  facts.q_WH = Quaternion(hand.X_WH.linear());
  if (facts.q_WH.w() < 0.0) facts.q_WH.coeffs() = -facts.q_WH.coeffs();
  facts.joints.assign(hand.q.data(), hand.q.data() + model.num_joints);
  return facts;
}

NeighbourFacts MakeNeighbourFacts(const NeighbourMotion& motion, const Scene& scene) {
  NeighbourFacts facts;
  if (motion.worst) facts.worst = scene.bodies.at(motion.worst->value).name;
  facts.moved_mm = 1e3 * motion.moved;
  facts.turned_deg = motion.turned_deg;
  facts.disturbed = motion.disturbed;
  return facts;
}

StepDetails MakeDetails(Verb verb) {
  switch (verb) {
    case Verb::kOpen:
      return OpenFacts{};
    case Verb::kSettle:
      return SettleFacts{};
    case Verb::kVerdict:
      return VerdictFacts{};
    case Verb::kMesh:
      return MeshFacts{};
    case Verb::kScore:
      return ScoreFacts{};
    case Verb::kPrune:
      return PruneFacts{};
    case Verb::kPath:
      return PathFacts{};
    case Verb::kScreen:
      return ScreenFacts{};
    case Verb::kIterate:
      return IterationFacts{};
    case Verb::kCertify:
      return CertifyFacts{};
    case Verb::kGrasp:
      return GraspFacts{};
    case Verb::kLift:
      return LiftFacts{};
    case Verb::kKeyframe:
    case Verb::kFrame:
      return FrameFacts{};
    case Verb::kFill:
    case Verb::kSmooth:
      return MotionFacts{};
    case Verb::kTouch:
    case Verb::kLetGo:
    case Verb::kMove:
    case Verb::kWait:
      break;
  }
  return SimulationFacts{};
}

}  // namespace pregrasp
