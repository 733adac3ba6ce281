#pragma once

#include <array>

#include "app/core/math.h"

namespace pregrasp {

/// The fingers of a hand, in the paper's order: a hand with fewer has the first of them. The
/// planner's contact states use the first two.
enum class Finger { kThumb = 0, kIndex = 1, kMiddle = 2, kRing = 3, kLittle = 4 };

inline constexpr int kNumFingers = 5;  ///< at most
inline constexpr int kLeastFingers = 2;
inline constexpr int kNumPlanningFingers = 2;  ///< thumb and index
inline constexpr std::array<const char*, kNumFingers> kFingerNames{"thumb", "index", "middle",
                                                                   "ring", "little"};

inline const char* FingerName(Finger finger) { return kFingerNames[static_cast<int>(finger)]; }

/// The spheres that stand for a hand's fingertips in every test: occlusion, clearance, inverse
/// kinematics.
struct TipSpheres {
  int count = kNumFingers;  ///< the hand's fingers: the first of Finger
  /// By Finger [m]; those of the Shadow Hand unless a scene has another (TakeHand).
  std::array<double, kNumFingers> radii{0.0109, 0.0090, 0.0090, 0.0090, 0.0090};

  double radius(Finger finger) const { return radii[static_cast<int>(finger)]; }
  bool has(Finger finger) const { return static_cast<int>(finger) < count; }

  /// The centre of the sphere that touches p_C from outside, where the outward unit normal is nhat.
  /// Both in any one frame, as the result.
  Vector3 Centre(Finger finger, const Vector3& p_C, const Vector3& nhat) const {
    return p_C + radius(finger) * nhat;
  }

  /// How far apart two spheres are [m], by their centres in any one frame. Below 0 they overlap,
  /// which no hand can do (design, section 4): this is what spacing means for contact nodes, plans,
  /// generated grasps and search alike.
  double CalcGap(Finger a, const Vector3& p_TipA, Finger b, const Vector3& p_TipB) const {
    return (p_TipA - p_TipB).norm() - radius(a) - radius(b);
  }
};

}  // namespace pregrasp
