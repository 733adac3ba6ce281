#pragma once

#include <array>

#include "app/hand/hand_model.h"

namespace pregrasp {

/// What a hand can do by itself, found by random postures and then downhill from the best: close
/// estimates, not bounds.
struct HandMeasures {
  double mass = 0.0;  ///< of all links [kg]
  /// The share of random postures in which no part of the hand overlaps another.
  double free_share = 0.0;
  /// From the palm's origin to the far side of the fingertip, by Finger [m].
  std::array<double, kNumFingers> reach{};
  /// Between the surfaces of the thumb's tip and of another finger's, by Finger [m]: the least,
  /// below 0 where they can overlap, and the most.
  std::array<double, kNumFingers> nearest{}, farthest{};
  /// A posture with that least distance, or where the tips touch if they can.
  std::array<HandJoints, kNumFingers> meeting{};
};

/// A thumb and a finger meet if their tips come this near [m].
inline constexpr double kMeeting = 5e-3;

HandMeasures MeasureHand(const HandModel& hand);

}  // namespace pregrasp
