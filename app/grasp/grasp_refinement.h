#pragma once

#include <optional>
#include <set>
#include <vector>

#include "app/grasp/stiffness_search.h"

namespace pregrasp {

struct RefinementConfig {
  GraspConfig grasp;
  /// How far a contact may be moved from where its generated point was projected [m], in a straight
  /// line: the far side of a thin plate is near.
  double reach = 0.0;
  GraspForcesConfig forces;
  /// Sets of contacts tested for whether they hold stiffly enough to lift, about 2 ms each. 0: what
  /// is feasible will do.
  int max_stiffness_tests = 0;
};

/// A projected grasp on its way to a feasible one that can lift, a set of contacts at a time. What
/// is wrong is what moves, never by more than the reach from where it was projected: where forces
/// are missing, the contacts that raise them (HoldSearch); where the grasp would give way, those
/// that make it stiffer (StiffnessSearch); where the hand cannot be, every contact to where its
/// fingertip came in the best attempt, those of fingers that overlap something away from it as
/// well. A set that was tried before is disturbed where it was worst. Ring and little are left out
/// when moving them has not helped. A feasible grasp that gives way is kept until a stiff one is
/// found.
class GraspRefinement {
 public:
  /// @param places     outlives this, as does config.
  /// @param projected  by ProjectSpaced.
  GraspRefinement(const ContactPlaces& places, const RefinementConfig& config,
                  std::vector<GraspContact> projected, const std::vector<GraspContact>& fixed,
                  const Rng& rng);
  GraspRefinement(const GraspRefinement&) = delete;
  GraspRefinement& operator=(const GraspRefinement&) = delete;

  const std::vector<GraspContact>& projected() const { return projected_; }

  /// Begins with an attempt at the projected contacts, or at some of them.
  void Start(const GraspAttempt& raw);

  /// Moves contacts and puts the set to inverse kinematics; whether that found a grasp. Nothing
  /// once it is not open.
  /// @param solved  configurations that solved grasps of the same object where it is; the nearest
  ///                is begun with.
  bool Step(const std::vector<HandConfiguration>& solved);

  /// Whether there is something left to try: no stiff grasp is found yet, and there were not too
  /// many attempts since a feasible one was.
  bool open() const;
  int solves() const { return solves_; }
  /// A feasible grasp other than the projected contacts; better than these if they are feasible.
  const std::optional<GraspAttempt>& found() const { return found_; }

 private:
  struct Pull;
  void NoteFeasible();
  bool Propose();
  bool Hold();
  void LeaveOut();
  void FollowHand();
  void Disturb();
  Pull CalcPull() const;
  std::optional<HandConfiguration> FindNearest(const std::vector<HandConfiguration>& solved) const;
  Vector3 CalcTip(const HandConfiguration& hand, Finger finger) const;

  const TipSpheres& tips() const { return places_.world().tips(); }

  const ContactPlaces& places_;
  const RefinementConfig& config_;
  std::vector<GraspContact> projected_;
  Matrix3 R_WO_;
  Rng rng_;
  std::vector<ContactChoices> choices_;
  HoldSearch holds_;
  StiffnessSearch stiffness_;
  ContactChoice choice_;
  std::optional<IkResult> last_;  // of the set in choice_
  std::set<ContactChoice> tried_;
  int solves_ = 0, failures_ = 0;
  bool exhausted_ = false;
  bool feasible_ = false, stiff_ = false;  // what is found, or the projected contacts
  int attempts_since_ = 0;                 // it is feasible
  std::optional<GraspAttempt> found_;
};

}  // namespace pregrasp
