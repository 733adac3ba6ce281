#pragma once

#include <optional>
#include <vector>

#include "app/grasp/grasp_stiffness.h"
#include "app/grasp/hold_search.h"

namespace pregrasp {

/// Moves contacts among their choices until the hand holds the object stiffly enough to lift it
/// (ChooseGraspForces). The direction in which a grasp gives way is an eigenvector of its
/// stiffness, which is known in closed form: the move that raises the least eigenvalue most at
/// forces that stay what they are is tried first, be it of a contact or that of a finger that was
/// left out. Deterministic.
class StiffnessSearch {
 public:
  /// @param choices    outlive this, as do world and config.
  /// @param max_tests  sets for which forces are chosen, about 2 ms each, in all runs together.
  StiffnessSearch(const GraspWorld& world, const GraspConfig& config,
                  const GraspForcesConfig& forces, const std::vector<ContactChoices>& choices,
                  const Matrix3& R_WO, int max_tests);

  /// Whether a set of contacts that holds does so stiffly; false also when tests are used up.
  int left() const { return tests_left_; }
  bool IsStiff(const ContactChoice& choice);

  /// Changes `choice`, which holds, to one that holds stiffly; where none is found, nothing.
  bool Run(ContactChoice& choice);

 private:
  struct Move {
    int contact = 0, place = 0;
    double stiffness = 0.0;  // expected [N/m]
  };
  std::optional<GraspForces> Choose(const ContactChoice& choice);
  std::vector<Move> FindMoves(const ContactChoice& choice, const GraspForces& forces) const;

  const GraspWorld& world_;
  const GraspConfig& config_;
  GraspForcesConfig forces_;
  const std::vector<ContactChoices>& choices_;
  Matrix3 R_WO_;
  WrenchConfig wrench_;
  double k_ = 0.0;  // [N/m]
  int tests_left_;
};

}  // namespace pregrasp
