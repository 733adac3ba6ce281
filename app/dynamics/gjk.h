#pragma once

#include "app/dynamics/convex.h"

namespace pregrasp {

/// The nearest points of two cores (see CalcSupport).
struct CoreDistance {
  bool apart = false;                 ///< whether the cores are disjoint; the rest holds only then
  double distance = 0.0;              ///< [m]
  Vector3 nhat_W = Vector3::UnitZ();  ///< from A to B
  Vector3 p_WA = Vector3::Zero(), p_WB = Vector3::Zero();
};

/// Distance between the cores of A and of B moved by shift_W, by the Gilbert-Johnson-Keerthi
/// algorithm (1988).
CoreDistance CalcCoreDistance(const PlacedConvex& a, const PlacedConvex& b,
                              const Vector3& shift_W = Vector3::Zero());

/// A direction (from A to B) along which the separation of A and B is locally largest, and the
/// points of the two surfaces that face each other along it.
struct ContactAxis {
  Vector3 nhat_W = Vector3::UnitZ();
  double separation = 0.0;  ///< [m], negative when the shapes overlap
  Vector3 p_WA = Vector3::Zero(), p_WB = Vector3::Zero();
};

/// Climbs from nhat_W to such a direction. Works for touching and overlapping shapes as well as for
/// separate ones: B is moved off along the current direction, and the direction between the nearest
/// points is the next one. That is a proximal-point iteration on the separation, so it never gets
/// worse; it finds the least penetration near its start and not, in general, the least of all.
ContactAxis RefineAxis(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W);

}  // namespace pregrasp
