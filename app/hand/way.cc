#include "app/hand/way.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// A rigid motion at constant rates, by the share of it that has passed.
struct Glide {
  Glide(const RigidTransform& from, const RigidTransform& to) : X_W(from) {
    p = to.translation() - from.translation();
    const Eigen::AngleAxisd turn(Matrix3(to.linear() * from.linear().transpose()));
    theta = turn.angle() * turn.axis();
  }

  RigidTransform At(double s) const {
    const double angle = theta.norm();
    RigidTransform X = X_W;
    if (angle > 0.0) X.linear() = Eigen::AngleAxisd(s * angle, theta / angle) * X_W.linear();
    X.translation() += s * p;
    return X;
  }

  RigidTransform X_W;
  Vector3 p, theta;  // on the whole of it
};

// One piece of a way: between two moments at which the bodies' poses are given.
class Piece {
 public:
  Piece(const HandModel& hand, const HandReach& reach, const HandObstacles* obstacles,
        const HandWay& way, WayResult* result)
      : hand_(hand), reach_(reach), obstacles_(obstacles), way_(way), result_(*result) {}

  // From share `begin` of the way to share `end`, the bodies from X_begin to X_end.
  bool IsClear(double begin, double end, const std::vector<RigidTransform>& X_begin,
               const std::vector<RigidTransform>& X_end) {
    begin_ = begin;
    share_ = end - begin;
    const HandVector whole = CalcStep(way_.from, way_.to);
    step_ = share_ * whole;
    start_ = Advance(way_.from, HandVector(begin * whole));
    bodies_.clear();
    for (std::size_t i = 0; i < X_begin.size(); ++i) bodies_.emplace_back(X_begin[i], X_end[i]);
    for (std::size_t i = 0; i < hand_.capsules.size(); ++i) {
      travel_[i] =
          reach_.CalcTravel(hand_, static_cast<int>(i), step_.tail<kMaxHandJoints>().cwiseAbs());
    }
    return IsStretchClear(0.0, 1.0);
  }

 private:
  bool IsStretchClear(double s0, double s1) {
    const double half = 0.5 * (s1 - s0);
    const double s = s0 + half;
    FindNear(s, half);
    bool certain = true;
    for (const HandDistance& near : near_) {
      const double room = near.distance - (near.touch ? -way_.touch.depth : way_.min_clearance);
      if (room < 0.0) {
        result_.s = begin_ + s * share_;
        result_.worst = near;
        return false;
      }
      certain = certain && room + kWayResolution >= BoundOf(near, half);
    }
    return certain || (IsStretchClear(s0, s) && IsStretchClear(s, s1));
  }

  // All pairs that may come too near within half a stretch about s.
  void FindNear(double s, double half) {
    ++result_.evaluations;
    const HandConfiguration at = Advance(start_, HandVector(s * step_));
    CalcHandPose(hand_, at.X_WH, at.q, &pose_);
    CalcCapsuleEnds(hand_, pose_, &ends_);
    near_.clear();
    const std::size_t count = hand_.capsules.size();
    const double most = *std::max_element(travel_.begin(), travel_.begin() + count);
    FindNearSelf(hand_, ends_, way_.min_clearance + 2.0 * most * half, &near_);
    if (obstacles_ == nullptr) return;
    X_WB_.clear();
    slide_.clear();
    turn_.clear();
    double farthest = 0.0;
    for (const Glide& body : bodies_) {
      X_WB_.push_back(body.At(s));
      // The palm's speed as seen from the body, here and by how much it may be more nearby.
      const Vector3 p_BH = at.X_WH.translation() - X_WB_.back().translation();
      const Vector3 dp = step_.head<3>();
      slide_.push_back((dp - body.p - body.theta.cross(p_BH)).norm() +
                       body.theta.norm() * (dp.norm() + body.p.norm()) * half);
      turn_.push_back((step_.segment<3>(3) - body.theta).norm());
      for (std::size_t i = 0; i < count; ++i) {
        farthest = std::max(farthest, BoundOf(static_cast<int>(i), slide_.size() - 1, half));
      }
    }
    const double influence = std::max(way_.min_clearance, 0.0) + farthest;
    obstacles_->FindNear(hand_, ends_, obstacles_->Place(X_WB_), way_.touch, influence, &near_);
  }

  double BoundOf(int capsule, std::size_t body, double half) const {
    return half * (slide_[body] + turn_[body] * reach_.FromPalm(capsule) + travel_[capsule]);
  }

  double BoundOf(const HandDistance& near, double half) const {
    if (near.pair == HandPair::kSelf) return half * (travel_[near.capsule] + travel_[near.other]);
    return BoundOf(near.capsule, static_cast<std::size_t>(near.other), half);
  }

  const HandModel& hand_;
  const HandReach& reach_;
  const HandObstacles* obstacles_;
  const HandWay& way_;
  WayResult& result_;
  double begin_ = 0.0, share_ = 1.0;
  HandConfiguration start_;
  HandVector step_;
  std::vector<Glide> bodies_;
  std::array<double, kMaxHandCapsules> travel_{};  // of the piece, by the joints
  std::vector<double> slide_, turn_;               // of the piece, by body
  HandPose pose_;
  CapsuleEnds ends_;
  std::vector<RigidTransform> X_WB_;
  std::vector<HandDistance> near_;
};

}  // namespace

HandReach::HandReach(const HandModel& hand) {
  PREGRASP_CHECK(hand.capsules.size() <= kMaxHandCapsules, hand.capsules.size());
  for (std::size_t i = 0; i < hand.capsules.size(); ++i) {
    const HandCapsule& capsule = hand.capsules[i];
    double length = std::max(capsule.p_LA.norm(), capsule.p_LB.norm());
    for (int j = capsule.link - 1; j >= hand.chain_begin[capsule.link]; --j) {
      from_joint_[i][j] = length;
      length += hand.joints[j].X_PJ.translation().norm();
    }
    from_palm_[i] = length;
  }
}

double HandReach::CalcTravel(const HandModel& hand, int capsule, const HandJoints& dq) const {
  double travel = 0.0;
  const int link = hand.capsules[capsule].link;
  for (int j = hand.chain_begin[link]; j < link; ++j) {
    travel += std::abs(dq[j]) * from_joint_[capsule][j];
  }
  return travel;
}

WayResult CheckWay(const HandModel& hand, const HandReach& reach, const HandObstacles* obstacles,
                   const HandWay& way) {
  PREGRASP_CHECK(obstacles == nullptr || !way.X_WB.empty());
  WayResult result;
  Piece piece(hand, reach, obstacles, way, &result);
  static const std::vector<RigidTransform> kNone;
  if (way.X_WB.size() < 2) {
    const std::vector<RigidTransform>& X_WB = way.X_WB.empty() ? kNone : way.X_WB.front();
    result.clear = piece.IsClear(0.0, 1.0, X_WB, X_WB);
    return result;
  }
  const double count = static_cast<double>(way.X_WB.size() - 1);
  for (std::size_t i = 0; i + 1 < way.X_WB.size(); ++i) {
    const double begin = static_cast<double>(i);
    if (!piece.IsClear(begin / count, (begin + 1.0) / count, way.X_WB[i], way.X_WB[i + 1])) {
      return result;
    }
  }
  result.clear = true;
  return result;
}

}  // namespace pregrasp
