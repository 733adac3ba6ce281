#include "app/hand/forearm.h"

#include <algorithm>

namespace pregrasp {
namespace {

constexpr double kLeastStep = 5e-4;  // [m]

}  // namespace

Forearm::Forearm(const Scene& scene, const HandModel& hand) : forearm_(hand.forearm) {
  for (const Body& body : scene.bodies) bodies_.emplace_back(body.shape);
}

bool Forearm::IsFree(const std::vector<RigidTransform>& X_WB, const RigidTransform& X_WH) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const RigidTransform X_BH = X_WB[i].inverse() * X_WH;
    // Nothing is nearer to the next point than the distance here less the way to it.
    for (double behind = forearm_.begin;;) {
      const double clear = bodies_[i].Calc(X_BH * Vector3(0.0, 0.0, -behind)) - forearm_.radius;
      if (clear < 0.0) return false;
      if (behind >= forearm_.end) break;
      behind = std::min(behind + std::max(clear, kLeastStep), forearm_.end);
    }
  }
  return true;
}

}  // namespace pregrasp
