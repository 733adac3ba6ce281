#pragma once

#include <cstdint>
#include <vector>

#include "app/grasp/contact_sampler.h"
#include "app/grasp/feasible_grasp.h"

namespace pregrasp {

struct GraspRoomConfig {
  int sets = 128;        ///< contact sets that hold the object alone
  int max_drawn = 8000;  ///< draws for them at most
  double f_min = 0.5;    ///< smallest normal force of every finger [N]
  /// An overlap by so much takes a set's weight down to 1/e [m]: with nothing but free and not free
  /// a state would be worth 0 until the first set is free, and no motion better than another.
  double softness = 0.005;
  double link_length = 0.03;  ///< from a tip to the room that the finger behind it needs [m]
  double half_share = 0.1;    ///< a share of free sets that is worth one half
  /// What a set counts that must take over from a pressing finger: ends of the ruler that hold so
  /// had a third of the feasible grasps of those that stay.
  double kept_share = 0.1;
  SamplerConfig sampler;

  void Validate() const;
};

/// How much room the surroundings leave for grasps, by the contact search's own draws: a second
/// opinion beside the learned score, which is blind on many objects. Of contact sets with internal
/// forces on the object alone, the share that balances its weight as it stands and that the
/// surroundings leave free, an overlap d of a fingertip counting as exp(-d / softness) of a set. A
/// fingertip needs room for the sphere that touches, and for one more of its size, link_length
/// behind it in some direction within the cone of its distal axis.
///
/// A share s is worth s / (s + half_share): in [0, 1), rising as the object is uncovered, at first
/// most; twice as many sets are not twice as good. No kinematics of the hand. Immutable, safe to
/// share between threads.
class GraspRoom {
 public:
  /// @param world  outlives this. @param seed  keys every draw.
  GraspRoom(const GraspWorld& world, const GraspRoomConfig& config, std::uint64_t seed);

  /// @param X_WB   every body's pose, the object first.
  /// @param fixed  contacts that every set has to hold, because the object would not stay without
  ///               them: sets with these are drawn anew, and counted beside as many draws as gave
  ///               those on the object alone.
  double Calc(const std::vector<RigidTransform>& X_WB,
              const std::vector<GraspContact>& fixed) const;

  /// The same of sets that hold the contacts in `given`, as a question about these: in [0, 1), one
  /// half where as many draws with them hold and are free as hold on the object alone without.
  /// @param pressing  those of `given` that are there already, whose own room is not asked.
  double CalcWith(const std::vector<RigidTransform>& X_WB, const std::vector<GraspContact>& given,
                  const std::vector<GraspContact>& pressing) const;

  /// The contact sets on the object alone that its forces do not rule out in any orientation.
  int num_sets() const { return static_cast<int>(sets_.size()); }

 private:
  double CalcShare(const std::vector<RigidTransform>& X_WB) const;
  // The freedom of `sets` draws with the contacts in `given`, those that hold the object.
  double SumGiven(const std::vector<RigidTransform>& X_WB, const std::vector<GraspContact>& given,
                  const std::vector<GraspContact>& pressing) const;
  // How many of `sets` draws hold the object alone.
  double CalcSumAlone() const;
  double CalcFreedom(const std::vector<GraspContact>& contacts,
                     const std::vector<RigidTransform>& X_WB,
                     const std::vector<GraspContact>& fixed) const;
  double CalcOverlap(const GraspContact& contact, const std::vector<RigidTransform>& X_WB) const;

  const GraspWorld& world_;
  GraspRoomConfig config_;
  std::uint64_t seed_;
  ContactPlaces alone_;  // places with nothing around the object
  ContactSampler sampler_;
  std::vector<std::vector<GraspContact>> sets_;
  Vector3 gravity_O_ = -Vector3::UnitZ();  // its direction at the start
  std::vector<bool> balanced_there_;       // by set, in that orientation
  double held_share_ = 0.0;                // of all draws on the object alone
};

}  // namespace pregrasp
