#pragma once

#include <memory>

#include "app/hand/ik.h"

namespace pregrasp {

/// What inverse kinematics minimises, opened for those who minimise it over many moments at once:
/// squared residuals of fingertips, cones, clearances and preferences (IkConfig, IkProblem).
class IkResiduals {
 public:
  /// @param solver          its bodies and hand; outlives this.
  /// @param contact_weight  of the squares of tips and cones, against those of clearances.
  IkResiduals(const IkSolver& solver, const IkConfig& config, const IkProblem& problem,
              double contact_weight = 1.0);
  ~IkResiduals();
  IkResiduals(IkResiduals&&) noexcept;

  /// The sum of squares.
  double Evaluate(const HandConfiguration& configuration);
  /// Adds Gauss-Newton's J^T J (lower half) and J^T r where it was evaluated last, about the steps
  /// of Advance.
  void AddNormalEquations(HandMatrix* JtJ, HandVector* Jtr) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
