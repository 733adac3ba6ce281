#pragma once

#include <vector>

#include "app/grasp/contact_places.h"
#include "app/grasp/feasible_grasp.h"

namespace pregrasp {

/// Where one contact of a grasp may be moved.
struct ContactChoices {
  Finger finger = Finger::kThumb;
  /// The projected contact first, then others by their distance from it. A fixed contact is alone.
  std::vector<GraspContact> places;
  std::vector<double> moved;  ///< the distance of each from the first [m]
};

/// The places within `reach` of each contact [m]; fixed contacts have no choice.
std::vector<ContactChoices> FindChoices(const ContactPlaces& places,
                                        const std::vector<GraspContact>& contacts,
                                        const std::vector<GraspContact>& fixed, double reach);

/// One of each contact's places by number, or kLeftOut.
using ContactChoice = std::vector<int>;
inline constexpr int kLeftOut = -1;

std::vector<GraspContact> ToContacts(const std::vector<ContactChoices>& choices,
                                     const ContactChoice& choice);

/// Whether the tip of one contact, at one of its places, overlaps none of the others'.
bool HasRoom(const TipSpheres& tips, const std::vector<ContactChoices>& choices,
             const ContactChoice& choice, int contact, int place);

/// Moves contacts among their choices until forces hold. Where they do not, the proof is a wrench
/// that they cannot give: the contact that raises it is moved, to the nearest place that gives
/// enough of this wrench and of all that were missing before, or else to the one that gives the
/// most (cutting planes over the support function of admissible wrenches). Keeps what it learned:
/// each missing wrench bounds every later set. Deterministic.
class HoldSearch {
 public:
  /// @param choices  outlive this, as do world and config.
  HoldSearch(const GraspWorld& world, const GraspConfig& config,
             const std::vector<ContactChoices>& choices, const Matrix3& R_WO);

  /// Changes `choice` until it holds and its tips are apart; false where it finds no way, or none
  /// of all choices gives some missing wrench.
  bool Run(ContactChoice& choice);

 private:
  void AddCut(const Vector6& missing);
  bool IsHopeless(const ContactChoice& choice) const;
  bool Improve(ContactChoice& choice) const;
  std::vector<double> CalcTotals(const ContactChoice& choice, int without) const;

  const GraspWorld& world_;
  const GraspConfig& config_;
  const std::vector<ContactChoices>& choices_;
  Matrix3 R_WO_;
  WrenchConfig wrench_;
  std::vector<Vector6> cuts_;                          // wrenches that were missing
  std::vector<std::vector<std::vector<float>>> gain_;  // of each contact, cut, place [N]
};

}  // namespace pregrasp
