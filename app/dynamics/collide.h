#pragma once

#include "app/dynamics/convex.h"
#include "app/dynamics/manifold.h"

namespace pregrasp {

/// Contact between two convex pieces that are nearer than `margin` [m]: the direction of largest
/// separation (or least penetration) among those of the two shapes' features, faces preferred, and
/// the points where the features that face each other overlap.
/// @returns whether there is a point.
bool Collide(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold);

namespace internal {

/// Faces win over edges unless the edges separate by this much more [m]: nearly parallel edges give
/// directions that are almost those of the faces and flicker.
inline constexpr double kEdgeBias = 1e-4;
/// Faces of A win over faces of B unless B's separate by this much more [m], against flicker.
inline constexpr double kFaceBias = 2e-5;
/// Features whose overlap, seen along the normal, is thinner than this [m] do not touch: an object
/// that slides over the seam of two boards must not hit the second board's end.
inline constexpr double kMinOverlap = 1e-5;

/// Whether shapes with this separation along a face [m] slide along it rather than fly past. A
/// shape that slides beside a face has no contact with it, however near the corners are: an object
/// must cross the seam of two boards freely. One that flies at a corner must stop at it; it is
/// flying if it is farther away than sliding bodies come from in a step.
inline constexpr bool IsGrazing(double separation) {
  return separation >= -kMinOverlap && separation <= 1e-4;
}
inline constexpr double kSlideReach = 2e-3;

/// Whether two shapes move along a plane in the step rather than through it: at the level of a face
/// they then slide on past its edge, however fast, or cut the edge by a tenth of their way at most.
/// Gravity's part of a step, which a contact will take away, stays below that beyond kSlideReach.
inline bool MoveAlong(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W) {
  constexpr double kMaxSlope = 0.1;
  const Vector3 shift_W = b.shift_W - a.shift_W;
  const double across = nhat_W.dot(shift_W);
  return across * across <= kMaxSlope * kMaxSlope * shift_W.squaredNorm();
}

/// Whether no point of a face's contact is as near as the shapes are along its normal: the nearest
/// parts of shapes that fly at each other lie beside the face, and the face says little about them.
inline bool IsBesideFace(const Manifold& manifold, double separation) {
  if (separation <= 1e-4) return false;
  for (int i = 0; i < manifold.size; ++i) {
    if (manifold.points[i].phi <= separation + 1e-4) return false;
  }
  return true;
}

/// Set in the feature of a point whose face belongs to B, so that it is not taken for one of A's.
inline constexpr std::uint32_t kFaceOfB = 1U << 18;

enum class FaceOutcome { kNotApplicable, kApart, kTouching };

/// Contact of `q` with one face of box `a` when q's bounds lie within that face's outline, so that
/// no other face can matter: q's lowest features against a plane. The normal points from a to q;
/// `flag` is set in the points' features.
FaceOutcome CollideWithBoxFace(const PlacedConvex& a, const PlacedConvex& q, double margin,
                               std::uint32_t flag, Manifold* manifold);

/// Separating-axis test over faces and edge pairs, then clipping (Gottschalk et al. 1996;
/// Gregorius, "The separating axis test between convex polyhedra", GDC 2013).
bool CollideBoxes(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold);

/// Contact of two shapes whose faces do not lie over each other: where they are nearest, if that is
/// farther than `min_distance`.
bool CollideNearestPoints(const PlacedConvex& a, const PlacedConvex& b, double margin,
                          double min_distance, Manifold* manifold);

/// Any pair: faces and ends first, then round sides, then the nearest points, and the overlap of
/// the features that face each other along the direction found.
bool CollideConvex(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold);

}  // namespace internal
}  // namespace pregrasp
