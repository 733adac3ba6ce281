#include "app/studies/holding_press.h"

#include <cmath>
#include <vector>

#include "app/trajectory/certify.h"

namespace pregrasp {
namespace {

constexpr double kSeconds = 1.0;                  // as the release of a grasp is judged
constexpr double kShift = 0.01, kTurn_deg = 5.0;  // design, section 4
constexpr double kNormals_N[] = {0.25, 0.5, 1, 2, 3, 4, 6, 8, 10};
constexpr int kDirections = 12;                  // of the tangential force
constexpr double kTangents[] = {0.4, 0.7, 0.9};  // of the cone

// Deflections of the spring, in the world [m].
std::vector<Vector3> ListDeflections(const World& world, const Vector3& nhat_W) {
  const FingertipConfig& tips = world.scene().fingertips;
  const Vector3 tangent1 = nhat_W.unitOrthogonal();
  const Vector3 tangent2 = nhat_W.cross(tangent1);
  std::vector<Vector3> deflections;
  for (const double normal : kNormals_N) {
    deflections.push_back(-normal / tips.stiffness * nhat_W);
    for (const double share : kTangents) {
      for (int i = 0; i < kDirections; ++i) {
        const double angle = 2.0 * kPi * i / kDirections;
        const Vector3 f_W =
            normal * (-nhat_W + share * tips.friction *
                                    (std::cos(angle) * tangent1 + std::sin(angle) * tangent2));
        if (f_W.norm() <= tips.max_force) deflections.push_back(f_W / tips.stiffness);
      }
    }
  }
  return deflections;
}

HeldState Hold(const World& world, const WorldState& start) {
  HeldState held;
  held.state = start;
  const auto steps = static_cast<int>(std::lround(kSeconds / world.config().dt));
  for (int i = 0; i < steps; ++i) {
    world.Step(held.state);
    const BodyState& object = held.state.bodies[0];
    if (!object.p_WB.allFinite() || !object.q_WB.coeffs().allFinite()) {
      held.state = start;
      return held;
    }
  }
  CalcShift(start, held.state, &held.shift, &held.turn_deg);
  held.holds = held.shift < kShift && held.turn_deg < kTurn_deg;
  return held;
}

// The smaller, the more still.
double Unrest(const HeldState& held) {
  const bool finite = held.shift > 0.0 || held.turn_deg > 0.0 || held.holds;
  return finite ? held.shift / kShift + held.turn_deg / kTurn_deg : 1e9;
}

}  // namespace

HeldState FindHoldingPress(const World& world, const LadderPose& pose, ThreadPool& pool) {
  WorldState start = world.InitialState();
  start.bodies[0].p_WB = pose.X_WO.translation();
  start.bodies[0].q_WB = Quaternion(pose.X_WO.linear());
  start.cache.clear();
  std::vector<WorldState> starts;
  if (pose.press) {
    world.PutFinger(start, pose.press->finger, pose.press->p_OC);
    auto& finger = start.fingers[static_cast<int>(pose.press->finger)];
    const Vector3 p_WC = finger.p_WTarget;
    for (const Vector3& deflection : ListDeflections(world, pose.X_WO.linear() * finger.nhat_O)) {
      finger.p_WTarget = p_WC + deflection;
      starts.push_back(start);
    }
  } else {
    starts.push_back(start);
  }
  std::vector<HeldState> held(starts.size());
  pool.ParallelFor(static_cast<int>(starts.size()),
                   [&](int i, int) { held[i] = Hold(world, starts[i]); });
  std::size_t best = 0;
  for (std::size_t i = 1; i < held.size(); ++i) {
    if (Unrest(held[i]) < Unrest(held[best])) best = i;
  }
  if (!held[best].holds) held[best].state = starts[best];
  return held[best];
}

}  // namespace pregrasp
