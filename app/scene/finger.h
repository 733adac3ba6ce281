#pragma once

#include <array>

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

}  // namespace pregrasp
