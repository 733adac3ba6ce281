#pragma once

namespace pregrasp {

/// How time is stepped. The defaults are for planning and for the certificate, which steps a second
/// time at half of `dt`.
struct StepConfig {
  double dt = 1.0 / 240.0;  ///< [s]
  /// Sweeps stop when no impulse changes by more than this times the mass of the lighter body
  /// [m/s]. With more than one movable body, and where a face touches in a crowd of points, the sum
  /// of all changes still to come is bounded too.
  double tolerance = 1e-5;
  double tolerance_many = 5e-6;  ///< the same for more than two movable bodies
  /// Projected Gauss-Seidel sweeps for one or two movable bodies, five times as many where a face
  /// touches in a crowd of points. A point that is added within the step begins them anew.
  int max_sweeps = 20;
  int max_sweeps_many = 50;  ///< the same for more than two movable bodies
  /// Distance at which bodies at rest count as in contact [m]; what a step can cover is added, so
  /// that bodies stop at a surface and not inside it.
  double margin = 1e-4;
  /// Share of the approach speed that an impact above 0.2 m/s gives back, 0 to 1. Nothing bounces
  /// by default: a pregrasp consists of pushes.
  double restitution = 0.0;

  /// Whether a contact resists turning on the spot like even pressure over the patch that its
  /// points stand for: their friction then acts nearer to their centre. Without it a face resists
  /// like its corners, by half more for a disc to twice as much for a line.
  bool spread_support = false;

  /// @throws InputError naming the field.
  void Validate() const;
};

}  // namespace pregrasp
