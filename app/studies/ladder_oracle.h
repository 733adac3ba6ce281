#pragma once

#include "app/graph/placement.h"
#include "app/studies/ladder.h"

namespace pregrasp {

/// How far along a ladder a pose is, in [0, 1]: the share of the way done at the nearest point of
/// the way through the poses (straight lines, shortest turns), less the distance from it in shares
/// of the whole way. 0 at the start and far off the way, 1 at the last pose.
class LadderProgress {
 public:
  /// @param ladder  with poses that differ. @param radius  of the object about its origin [m]: a
  /// turn counts as the way of a point that far off.
  LadderProgress(const std::vector<LadderPose>& poses, double radius);

  double Calc(const RigidTransform& X_WO) const;

 private:
  struct Rung {
    Vector3 p_WO;
    Quaternion q_WO;
    double way = 0.0;  // from the start [m]
  };
  double CalcDistance(const Vector3& p_WO, const Quaternion& q_WO,
                      const RigidTransform& X_WO) const;

  std::vector<Rung> rungs_;
  double radius_;
};

/// Scores states by the object's progress alone, in the place of the learned score.
class LadderOracle : public StateScorer {
 public:
  explicit LadderOracle(LadderProgress progress) : progress_(std::move(progress)) {}

  std::vector<double> Score(std::span<const ScoredState> states) const override;

 private:
  LadderProgress progress_;
};

}  // namespace pregrasp
