#include "app/hand/hand_measures.h"

#include <algorithm>
#include <limits>

#include "app/core/rng.h"
#include "app/hand/distance.h"
#include "app/hand/hand_kinematics.h"

namespace pregrasp {
namespace {

constexpr int kPostures = 5000;
constexpr int kSweeps = 200;          // downhill, over all joints
constexpr double kFirstTurn = 0.2;    // [rad]
constexpr double kFinestTurn = 1e-3;  // [rad]

bool IsFree(const HandModel& hand, const HandPose& pose) {
  CapsuleEnds ends;
  CalcCapsuleEnds(hand, pose, &ends);
  std::vector<HandDistance> near;
  FindNearSelf(hand, ends, 0.0, &near);
  return near.empty();
}

class Measurer {
 public:
  explicit Measurer(const HandModel& hand) : hand_(hand) {}

  HandMeasures Run() {
    HandMeasures measures;
    for (int link = 0; link < hand_.num_links(); ++link) measures.mass += hand_.links[link].mass;
    std::vector<HandJoints> postures;
    Rng rng(0, RngStream::kHandMeasures);
    int free = 0;
    for (int i = 0; i < kPostures; ++i) {
      HandJoints q = HandJoints::Zero();
      for (int j = 0; j < hand_.num_joints; ++j) {
        q[j] = rng.Uniform(hand_.q_lower[j], hand_.q_upper[j]);
      }
      free += IsFree(hand_, PoseOf(q));
      postures.push_back(q);
    }
    measures.free_share = static_cast<double>(free) / kPostures;
    for (int f = 0; f < hand_.num_fingers; ++f) {
      const auto reach = [this, f](const HandJoints& q) {
        return -(TipOf(PoseOf(q), f).norm() + hand_.tips[f].radius);
      };
      measures.reach[f] = -reach(Descend(Best(postures, reach), reach));
      if (f == 0) continue;
      const auto gap = [this, f](const HandJoints& q) { return GapOf(PoseOf(q), f); };
      // Tips in each other are no meeting: where they touch is one.
      const auto apart = [&](const HandJoints& q) { return std::abs(gap(q)); };
      const auto wide = [&](const HandJoints& q) { return -gap(q); };
      const HandJoints nearest = Descend(Best(postures, gap), gap);
      measures.nearest[f] = gap(nearest);
      measures.meeting[f] =
          measures.nearest[f] > 0.0 ? nearest : Descend(Best(postures, apart), apart);
      measures.farthest[f] = gap(Descend(Best(postures, wide), wide));
    }
    return measures;
  }

 private:
  HandPose PoseOf(const HandJoints& q) const {
    HandPose pose;
    CalcHandPose(hand_, RigidTransform::Identity(), q, &pose);
    return pose;
  }
  Vector3 TipOf(const HandPose& pose, int finger) const {
    return pose.CalcPoint(hand_.tips[finger].link, hand_.tips[finger].p_LT);
  }
  double GapOf(const HandPose& pose, int finger) const {
    return (TipOf(pose, 0) - TipOf(pose, finger)).norm() - hand_.tips[0].radius -
           hand_.tips[finger].radius;
  }

  // The posture with the least of a measure; of those in which the hand is free, if there are any.
  template <typename Measure>
  HandJoints Best(const std::vector<HandJoints>& postures, const Measure& measure) const {
    const HandJoints* best = &postures.front();
    double least = std::numeric_limits<double>::infinity();
    bool best_free = false;
    for (const HandJoints& q : postures) {
      const double value = measure(q);
      if (best_free && !(value < least)) continue;
      const bool free = IsFree(hand_, PoseOf(q));
      if (free < best_free || (free == best_free && !(value < least))) continue;
      best = &q;
      least = value;
      best_free = free;
    }
    return *best;
  }

  // Joint by joint downhill, keeping free of itself where it is.
  template <typename Measure>
  HandJoints Descend(HandJoints q, const Measure& measure) const {
    double least = measure(q);
    const bool was_free = IsFree(hand_, PoseOf(q));
    double step = kFirstTurn;
    for (int sweep = 0; sweep < kSweeps && step > kFinestTurn; ++sweep) {
      bool moved = false;
      for (int j = 0; j < hand_.num_joints; ++j) {
        for (const double way : {-step, step}) {
          HandJoints trial = q;
          trial[j] = std::clamp(q[j] + way, hand_.q_lower[j], hand_.q_upper[j]);
          const double value = measure(trial);
          if (!(value < least) || (was_free && !IsFree(hand_, PoseOf(trial)))) continue;
          q = trial;
          least = value;
          moved = true;
        }
      }
      if (!moved) step *= 0.5;
    }
    return q;
  }

  const HandModel& hand_;
};

}  // namespace

HandMeasures MeasureHand(const HandModel& hand) { return Measurer(hand).Run(); }

}  // namespace pregrasp
