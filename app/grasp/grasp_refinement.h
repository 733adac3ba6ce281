#pragma once

#include <optional>
#include <set>
#include <vector>

#include "app/grasp/hold_search.h"

namespace pregrasp {

/// A projected grasp on its way to a feasible one, a set of contacts at a time. What is wrong is
/// what moves, never by more than the reach from where it was projected: where forces are missing,
/// the contacts that raise them (HoldSearch); where the hand cannot be, every contact to where its
/// fingertip came in the best attempt, those of fingers that overlap something away from it as
/// well. A set that was tried before is disturbed where it was worst. Ring and little are left out
/// when moving them has not helped.
class GraspRefinement {
 public:
  /// @param places     outlives this, as does config.
  /// @param projected  by ProjectSpaced.
  GraspRefinement(const ContactPlaces& places, const GraspConfig& config,
                  std::vector<GraspContact> projected, const std::vector<GraspContact>& fixed,
                  double reach, const Rng& rng);
  GraspRefinement(const GraspRefinement&) = delete;
  GraspRefinement& operator=(const GraspRefinement&) = delete;

  const std::vector<GraspContact>& projected() const { return projected_; }

  /// Begins with an attempt at the projected contacts, or at some of them, that failed.
  void Start(const GraspAttempt& raw);

  /// Moves contacts and puts the set to inverse kinematics. Nothing once it found a grasp or has
  /// none left to try.
  /// @param solved  configurations that solved grasps of the same object where it is; the nearest
  /// is
  ///                begun with.
  void Step(const std::vector<HandConfiguration>& solved);

  bool open() const { return !found_ && !exhausted_; }
  int solves() const { return solves_; }
  const std::optional<GraspAttempt>& found() const { return found_; }

 private:
  struct Pull;
  bool Propose();
  bool Hold();
  void LeaveOut();
  void FollowHand();
  void Disturb();
  Pull CalcPull() const;
  std::optional<HandConfiguration> FindNearest(const std::vector<HandConfiguration>& solved) const;
  Vector3 CalcTip(const HandConfiguration& hand, Finger finger) const;

  const ContactPlaces& places_;
  const GraspConfig& config_;
  std::vector<GraspContact> projected_;
  Matrix3 R_WO_;
  Rng rng_;
  std::vector<ContactChoices> choices_;
  HoldSearch holds_;
  ContactChoice choice_;
  std::optional<IkResult> last_;  // of the set in choice_, failed
  std::set<ContactChoice> tried_;
  int solves_ = 0, failures_ = 0;
  bool exhausted_ = false;
  std::optional<GraspAttempt> found_;
};

}  // namespace pregrasp
