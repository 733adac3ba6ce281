#include "app/dynamics/neighbours.h"

#include <algorithm>

namespace pregrasp {
namespace {

constexpr double kMaxTurnDeg = 30.0;
constexpr double kMaxFall = 0.05;  // [m]

}  // namespace

NeighbourMotion CalcNeighbourMotion(const World& world, const WorldState& state) {
  const Scene& scene = world.scene();
  const Vector3 down_W =
      scene.gravity.norm() > 0.0 ? Vector3(scene.gravity.normalized()) : Vector3(Vector3::Zero());
  NeighbourMotion motion;
  double worst_share = -1.0;
  bool all_within = true;
  for (int i = 1; i < world.num_movables(); ++i) {
    const BodyIndex body = world.body_index(MovableIndex{i});
    const RigidTransform& X_WB_start = scene.bodies[body.value].X_WB;
    const RigidTransform X_WB = state.bodies[i].X_WB();
    const Vector3 way = X_WB.translation() - X_WB_start.translation();
    const double turned_deg = RadToDeg(RotationAngle(X_WB_start.linear(), X_WB.linear()));
    const double fell = way.dot(down_W);
    const double share = std::max(turned_deg / kMaxTurnDeg, way.norm() / kMaxFall);
    if (share > worst_share) {
      worst_share = share;
      motion.worst = body;
    }
    motion.moved = std::max(motion.moved, way.norm());
    motion.turned_deg = std::max(motion.turned_deg, turned_deg);
    motion.fell = std::max(motion.fell, fell);
    all_within = all_within && turned_deg <= kMaxTurnDeg && fell <= kMaxFall;
  }
  motion.disturbed = !all_within;
  return motion;
}

}  // namespace pregrasp
