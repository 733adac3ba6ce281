#pragma once

#include <array>
#include <span>
#include <vector>

#include "app/dynamics/contact_rows.h"
#include "app/dynamics/contact_set.h"
#include "app/dynamics/finger_rows.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/step_config.h"
#include "app/dynamics/world_state.h"

namespace pregrasp {

/// Projected Gauss-Seidel over all contact points and fingers of one step, matrix-free,
/// warm-started, with circular friction cones. The memory is reused from step to step.
class ContactSolver {
 public:
  /// Sets up the rows of `contacts`; impulses start from `cache`.
  void SetContacts(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                   const std::vector<BodyMotion>& motions, const std::vector<Contact>& contacts,
                   const std::vector<WorldState::CachedImpulse>& cache);

  /// Adds a finger on movable 0.
  void AddFinger(const FingertipLaw& law, int index, const FingertipState& finger,
                 const BodyState& state, const BodyKernel& kernel, const BodyMotion& motion);

  /// After Solve: sets up the rows anew, with the points that the manifolds of `contacts` have
  /// gained at their ends, from the impulses found so far.
  void AddPoints(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                 const std::vector<BodyMotion>& motions, const std::vector<Contact>& contacts);

  /// Velocity sweeps, then, if a pair overlaps, position-correction sweeps.
  Convergence Solve(const StepConfig& config);

  const std::vector<FingerRows>& fingers() const { return fingers_; }

  /// Velocity of movable `i` after the contacts, and the velocity that corrects its position.
  const BodyVelocity& velocity(int i) const { return y_[i]; }
  const BodyVelocity& correction(int i) const { return z_[i]; }

  /// All contact points and what they bore in a step of `dt`.
  void GetPoints(const std::vector<Contact>& contacts, double dt,
                 std::vector<ContactPoint>* points) const;

  /// Sums of all impulses by movable; the impulses that the Simbody stepper applies.
  void SumImpulses(const std::vector<BodyMotion>& motions, const std::vector<Contact>& contacts,
                   std::vector<BodyImpulse>* impulses) const;

  /// The impulses to start the next step from.
  void SaveImpulses(const std::vector<Contact>& contacts,
                    std::vector<WorldState::CachedImpulse>* cache) const;

 private:
  void SetBias(const StepConfig& config, const ContactRows& rows) const;
  int CalcMassFactor() const;
  double CalcApproach() const;
  double CalcStretch() const;
  void Accelerate(double stretch);
  void CorrectPositions(const StepConfig& config, int max_sweeps);

  std::vector<BodyVelocity> y_, z_;
  std::vector<BodyVelocity> y_start_;  ///< what the starting impulses add to y
  std::vector<PointRows> point_memory_;
  std::vector<ContactRows> rows_memory_;
  std::span<ContactRows> rows_;  ///< of this step, one per contact
  std::vector<FingerRows> fingers_;
  bool crowded_ = false;                                   ///< whether some contact's manifold is
  std::vector<WorldState::CachedImpulse> found_impulses_;  ///< memory for AddPoints
  std::vector<FingerRows> found_fingers_;
};

}  // namespace pregrasp
