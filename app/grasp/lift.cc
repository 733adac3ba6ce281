#include "app/grasp/lift.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

constexpr double kSweepStep = 0.005;    // [m]
constexpr double kSweepOverlap = 1e-3;  // a sampled point may graze the surroundings [m]
constexpr double kSameContact = 2e-3;   // a pressing finger that the grasp uses where it is [m]

bool IsFree(const RigidTransform& X_WO, const std::vector<RigidTransform>& X_WB,
            const PointCloud& cloud, const EnvironmentDistance& environment,
            const Vector3& direction_W, double height) {
  for (double s = kSweepStep; s <= height + 1e-9; s += kSweepStep) {
    for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
      const Vector3 p_W = X_WO * Vector3(cloud.P.row(i)) + s * direction_W;
      if (environment.Calc(p_W, X_WB).phi < -kSweepOverlap) return false;
    }
  }
  return true;
}

double Ease(double s) { return s * s * (3.0 - 2.0 * s); }

// The grasp's forces on the object, in O: inside a share of the cone where that is possible.
MatrixX3 ChooseForces(const GraspWorld& world, const GraspResult& grasp, const Matrix3& R_WO,
                      double friction_reserve) {
  const std::vector<WrenchContact> contacts = world.ToWrenchContacts(grasp.contacts);
  WrenchConfig config = world.MakeWrenchConfig(0.5, R_WO);
  config.mu *= friction_reserve;
  const WrenchResult reserved = CalcWrench(contacts, config);
  if (reserved.feasible()) return reserved.forces;
  PREGRASP_CHECK(grasp.wrench.has_value());
  return grasp.wrench->forces;
}

// Drives the five fingers' targets.
class Lifter {
 public:
  Lifter(const World& world, const WorldState& state, const LiftConfig& config)
      : world_(world), config_(config), state_(state) {}

  // Puts the grasp's fingers on and remembers the targets that give its forces at rest.
  void Grasp(const GraspResult& grasp, const MatrixX3& f_O) {
    const RigidTransform X_WO = state_.bodies.front().X_WB();
    for (std::size_t i = 0; i < grasp.contacts.size(); ++i) {
      const GraspContact& contact = grasp.contacts[i];
      const int f = static_cast<int>(contact.finger);
      const bool pressing =
          state_.fingers[f].on && (state_.fingers[f].p_OC - contact.p_OC).norm() < kSameContact;
      if (!pressing) world_.PutFinger(state_, contact.finger, contact.p_OC);
      const Vector3 f_W = X_WO.linear() * Vector3(f_O.row(static_cast<Eigen::Index>(i)));
      from_[f] = state_.fingers[f].p_WTarget;
      to_[f] = X_WO * contact.p_OC + f_W / world_.scene().fingertips.stiffness;
      used_[f] = true;
    }
    Run(config_.closing_seconds,
        [&](int f, double s) -> Vector3 { return from_[f] + s * (to_[f] - from_[f]); });
    // Fingers that only pressed leave once the grasp holds.
    for (int f = 0; f < kNumFingers; ++f) {
      if (state_.fingers[f].on && !used_[f]) world_.LiftFinger(state_, static_cast<Finger>(f));
    }
  }

  void Lift(const Vector3& way_W) {
    Run(config_.lift_seconds, [&](int f, double s) -> Vector3 { return to_[f] + Ease(s) * way_W; });
    Run(config_.hold_seconds, [&](int f, double) -> Vector3 { return to_[f] + way_W; });
  }

  const WorldState& state() const { return state_; }

 private:
  template <typename Target>
  void Run(double seconds, const Target& target) {
    const int steps = std::max(1, static_cast<int>(std::lround(seconds / world_.config().dt)));
    for (int i = 1; i <= steps; ++i) {
      for (int f = 0; f < kNumFingers; ++f) {
        if (used_[f]) state_.fingers[f].p_WTarget = target(f, static_cast<double>(i) / steps);
      }
      world_.Step(state_);
    }
  }

  const World& world_;
  const LiftConfig& config_;
  WorldState state_;
  std::array<Vector3, kNumFingers> from_, to_;
  std::array<bool, kNumFingers> used_{};
};

}  // namespace

Vector3 FindLiftDirection(const World& world, const WorldState& state, const PointCloud& cloud,
                          const EnvironmentDistance& environment, double height) {
  const std::vector<RigidTransform> X_WB = world.GetPoses(state);
  const Vector3 up = -world.scene().gravity.normalized();
  const Matrix3 R_WUp = FrameFromNormal(up);
  for (int tilt = 0; tilt <= 90; tilt += 15) {
    for (int azimuth = 0; azimuth < 360; azimuth += 30) {
      const double a = DegToRad(tilt), b = DegToRad(azimuth);
      const Vector3 direction =
          R_WUp * Vector3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      if (IsFree(X_WB.front(), X_WB, cloud, environment, direction, height)) return direction;
      if (tilt == 0) break;
    }
  }
  return up;
}

LiftResult SimulateLift(const World& world, const WorldState& state, const GraspWorld& grasp_world,
                        const GraspResult& grasp, const Vector3& direction_W,
                        const LiftConfig& config) {
  PREGRASP_CHECK(config.height > 0.0 && config.lift_seconds > 0.0, config.height,
                 config.lift_seconds);
  PREGRASP_CHECK(config.closing_seconds >= 0.0 && config.hold_seconds >= 0.0,
                 config.closing_seconds, config.hold_seconds);
  PREGRASP_CHECK(grasp.feasible());
  const RigidTransform X_WO = state.bodies.front().X_WB();
  const MatrixX3 f_O = ChooseForces(grasp_world, grasp, X_WO.linear(), config.friction_reserve);
  Lifter lifter(world, state, config);
  lifter.Grasp(grasp, f_O);
  lifter.Lift(config.height * direction_W);

  LiftResult result;
  result.end = lifter.state();
  result.direction_W = direction_W;
  const RigidTransform X_WO_end = result.end.bodies.front().X_WB();
  const Vector3 way = X_WO_end.translation() - X_WO.translation();
  result.height = way.dot(direction_W);
  result.shift = (way - config.height * direction_W).norm();
  result.turn_deg = RadToDeg(RotationAngle(X_WO.linear(), X_WO_end.linear()));
  for (const FingertipState& tip : result.end.fingers) {
    if (tip.on) result.slip = std::max(result.slip, tip.slip);
  }
  result.held = result.shift <= config.max_shift && result.turn_deg <= config.max_turn_deg;
  return result;
}

}  // namespace pregrasp
