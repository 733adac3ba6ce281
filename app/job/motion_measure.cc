#include "app/job/motion_measure.h"

#include <cmath>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

Motion CalcMotion(const World& world, MovableIndex movable, const WorldState& from,
                  const WorldState& to) {
  const Body& body = world.scene().bodies[world.body_index(movable).value];
  const Vector3& p_BoBcm = body.mass_properties->p_BoBcm;
  const RigidTransform X_from = from.bodies[movable.value].X_WB(),
                       X_to = to.bodies[movable.value].X_WB();
  return {(X_to * p_BoBcm - X_from * p_BoBcm).norm(), RotationAngle(X_from.linear(), X_to.linear()),
          body.name};
}

}  // namespace

Motion CalcObjectMotion(const World& world, const WorldState& from, const WorldState& to) {
  return CalcMotion(world, MovableIndex{0}, from, to);
}

SettleResult Settle(const World& world, WorldState& state, double seconds) {
  SettleResult result;
  const WorldState start = state;
  const auto steps = std::lround(seconds / world.config().dt);
  for (long step = 0; step < steps; ++step) {
    ThrowIfInterrupted();
    const Convergence convergence = world.Step(state);
    ++result.steps;
    result.not_converged += !convergence.converged;
    if (!convergence.converged) result.unresolved += world.config().dt * convergence.residual;
    for (int i = 0; i < world.num_movables(); ++i) {
      const Motion motion = CalcMotion(world, MovableIndex{i}, start, state);
      result.largest.rotated = std::max(result.largest.rotated, motion.rotated);
      if (motion.moved >= result.largest.moved) {
        result.largest.moved = motion.moved;
        result.largest.body = motion.body;
      }
    }
  }
  result.at_rest = result.largest.moved < kRestMoved && result.largest.rotated < kRestRotated;
  return result;
}

}  // namespace pregrasp
