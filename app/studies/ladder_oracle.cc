#include "app/studies/ladder_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {

LadderProgress::LadderProgress(const std::vector<LadderPose>& poses, double radius)
    : radius_(radius) {
  for (const LadderPose& pose : poses) {
    Rung rung{pose.X_WO.translation(), Quaternion(pose.X_WO.linear())};
    if (!rungs_.empty()) {
      rung.way =
          rungs_.back().way + CalcDistance(rungs_.back().p_WO, rungs_.back().q_WO, pose.X_WO);
    }
    rungs_.push_back(rung);
  }
  PREGRASP_CHECK(rungs_.size() >= 2 && rungs_.back().way > 0.0, rungs_.size());
}

double LadderProgress::CalcDistance(const Vector3& p_WO, const Quaternion& q_WO,
                                    const RigidTransform& X_WO) const {
  const double shift = (X_WO.translation() - p_WO).norm();
  const double turn = q_WO.angularDistance(Quaternion(X_WO.linear()));
  return std::hypot(shift, radius_ * turn);
}

double LadderProgress::Calc(const RigidTransform& X_WO) const {
  constexpr int kPoints = 20;  // on the way from one pose to the next: a hundredth of the way and
                               // less, for ladders of five poses
  double nearest = std::numeric_limits<double>::infinity(), way = 0.0;
  for (std::size_t i = 1; i < rungs_.size(); ++i) {
    const Rung &a = rungs_[i - 1], &b = rungs_[i];
    for (int k = 0; k <= kPoints; ++k) {
      const double s = static_cast<double>(k) / kPoints;
      const double distance =
          CalcDistance(a.p_WO + s * (b.p_WO - a.p_WO), a.q_WO.slerp(s, b.q_WO), X_WO);
      if (distance >= nearest) continue;
      nearest = distance;
      way = a.way + s * (b.way - a.way);
    }
  }
  return std::max(0.0, (way - nearest) / rungs_.back().way);
}

std::vector<double> LadderOracle::Score(std::span<const ScoredState> states) const {
  std::vector<double> scores;
  scores.reserve(states.size());
  for (const ScoredState& state : states) scores.push_back(progress_.Calc(state.X_WB.front()));
  return scores;
}

}  // namespace pregrasp
