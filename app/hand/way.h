#pragma once

#include <optional>
#include <vector>

#include "app/hand/distance.h"

namespace pregrasp {

/// What the hand passes between two moments: in a straight line at constant rates, the palm turning
/// about a fixed axis, every joint from one angle to the other.
struct HandWay {
  HandConfiguration from, to;
  /// The bodies' poses at evenly spaced moments, the first at `from`, the last at `to`; between two
  /// of them a body moves at constant rates too. One entry for bodies that stand; not used without
  /// bodies.
  std::vector<std::vector<RigidTransform>> X_WB;
  TouchRule touch;             ///< on the whole way
  double min_clearance = 0.0;  ///< of every pair that does not touch [m]
};

/// A way that is called clear is nowhere nearer than asked for by more than this [m].
inline constexpr double kWayResolution = 5e-5;

struct WayResult {
  bool clear = false;
  double s = 0.0;                     ///< of the first overlap that was found, 0 to 1
  std::optional<HandDistance> worst;  ///< there
  int evaluations = 0;                ///< of all distances of the hand
};

/// How far the points of a hand's capsules can move when its joints do.
class HandReach {
 public:
  explicit HandReach(const HandModel& hand);

  /// Upper bounds over all joint angles, for the points of capsule i's axis: how far they are from
  /// the palm's origin [m], and how far they go when the joints turn by dq, the palm at rest [m].
  double FromPalm(int capsule) const { return from_palm_[capsule]; }
  double CalcTravel(const HandModel& hand, int capsule, const HandJoints& dq) const;

 private:
  std::array<double, kMaxHandCapsules> from_palm_{};
  /// From the joint's origin, 0 where the joint does not move the capsule.
  std::array<std::array<double, kMaxHandJoints>, kMaxHandCapsules> from_joint_{};
};

/// Whether the hand is free of overlap all along a way, with every link, the bodies and itself. By
/// conservative advancement: a pair that is d apart in the middle of a stretch stays clear on all
/// of it if neither can come nearer by d within half of it; otherwise the stretch is halved. The
/// nearness of a body is counted in its own frame, so that a hand that carries it is not in its
/// way. (Mirtich and Canny 1995, "Impulse-based simulation of rigid bodies", section 3, with a
/// bound for chains as in Schwarzer, Saha and Latombe 2005, "Adaptive dynamic collision checking",
/// IEEE T-RO 21(3).)
WayResult CheckWay(const HandModel& hand, const HandReach& reach, const HandObstacles* obstacles,
                   const HandWay& way);

}  // namespace pregrasp
