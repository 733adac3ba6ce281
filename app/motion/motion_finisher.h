#pragma once

#include <vector>

#include "app/motion/hand_motion.h"

namespace pregrasp {

/// The last part of a hand motion: smooths a filled motion as a whole, gives its free intervals the
/// time that the hand needs, and checks every frame and every way between two. Where the check
/// finds fault, more room is asked for there and the motion is smoothed again; what is then left is
/// marked in the frames.
class MotionFinisher {
 public:
  MotionFinisher(const IkSolver& solver, const MotionConfig& config, MotionState& state)
      : solver_(solver), config_(config), state_(state) {}

  void Run();

 private:
  /// @param urgency  share of the weight of limits.
  void SmoothOnce(int iterations, double urgency);
  bool Retime(int round);
  void Resample(int interval, int steps);
  void AskForMore();
  void Polish();
  void CheckFrame(int i);
  void CheckWayTo(int i);
  bool Check();
  HandDemand DemandOf(int i) const;
  HandDemand DemandOfWayTo(int i) const;

  // Of a frame and the way to it: room that is asked for [m], and what has been given up to find
  // a pose at all.
  struct Asked {
    double room = 0.0;
    LooseningRung rung = LooseningRung::kNone;
    HandConfiguration anchor;  ///< as it was filled in: a pose that meets the frame's demands
    double hold = 0.0;         ///< weight of staying near it, as a residual
  };

  HandDemand MakeDemand(const Asked& asked) const;

  const IkSolver& solver_;
  const MotionConfig& config_;
  MotionState& state_;
  std::vector<Asked> asked_;        ///< by frame
  std::vector<double> last_share_;  ///< of the limits, by interval, when it was last timed
};

}  // namespace pregrasp
