#pragma once

#include <array>

#include "app/core/math.h"

namespace pregrasp {

/// The five fingers of a right hand, in the paper's order. The planner's contact states use the
/// first two.
enum class Finger { kThumb = 0, kIndex = 1, kMiddle = 2, kRing = 3, kLittle = 4 };

inline constexpr int kNumFingers = 5;
inline constexpr int kNumPlanningFingers = 2;  ///< thumb and index
inline constexpr std::array<const char*, kNumFingers> kFingerNames{"thumb", "index", "middle",
                                                                   "ring", "little"};

inline const char* FingerName(Finger finger) { return kFingerNames[static_cast<int>(finger)]; }

/// Radius [m] of the sphere that stands for a fingertip in every test: occlusion, clearance,
/// inverse kinematics. Its centre is (0, 0, .0209) in the distal frame; for the thumb (0, 0, .024).
inline constexpr double FingertipRadius(Finger finger) {
  return finger == Finger::kThumb ? 0.0109 : 0.0090;
}

/// The centre of the fingertip sphere that touches p_C from outside, where the outward unit normal
/// is nhat. Both in any one frame, as the result.
inline Vector3 FingertipCentre(Finger finger, const Vector3& p_C, const Vector3& nhat) {
  return p_C + FingertipRadius(finger) * nhat;
}

/// How far apart two fingertip spheres are [m], by their centres in any one frame. Below 0 they
/// overlap, which no hand can do (design, section 4): this is what spacing means for contact nodes,
/// plans, generated grasps and search alike.
inline double CalcTipGap(Finger a, const Vector3& p_TipA, Finger b, const Vector3& p_TipB) {
  return (p_TipA - p_TipB).norm() - FingertipRadius(a) - FingertipRadius(b);
}

}  // namespace pregrasp
