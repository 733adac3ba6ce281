#include "app/hand/forearm.h"

#include <algorithm>

namespace pregrasp {
namespace {

constexpr double kRadius = 0.015;              // [m]
constexpr double kBegin = 0.032, kEnd = 0.20;  // behind the palm: the stub of the wrist ends there
constexpr double kLeastStep = 5e-4;            // [m]

}  // namespace

Forearm::Forearm(const Scene& scene) {
  for (const Body& body : scene.bodies) bodies_.emplace_back(body.shape);
}

bool Forearm::IsFree(const std::vector<RigidTransform>& X_WB, const RigidTransform& X_WH) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const RigidTransform X_BH = X_WB[i].inverse() * X_WH;
    // Nothing is nearer to the next point than the distance here less the way to it.
    for (double behind = kBegin;;) {
      const double clear = bodies_[i].Calc(X_BH * Vector3(0.0, 0.0, -behind)) - kRadius;
      if (clear < 0.0) return false;
      if (behind >= kEnd) break;
      behind = std::min(behind + std::max(clear, kLeastStep), kEnd);
    }
  }
  return true;
}

}  // namespace pregrasp
