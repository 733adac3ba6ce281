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

enum class FaceOutcome { kNotApplicable, kApart, kTouching };

/// Contact of `q` with one face of box `a` when q's bounds lie within that face's outline, so that
/// no other face can matter: q's lowest features against a plane. The normal points from a to q.
FaceOutcome CollideWithBoxFace(const PlacedConvex& a, const PlacedConvex& q, double margin,
                               Manifold* manifold);

/// Separating-axis test over faces and edge pairs, then clipping (Gottschalk et al. 1996;
/// Gregorius, "The separating axis test between convex polyhedra", GDC 2013).
bool CollideBoxes(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold);

}  // namespace internal
}  // namespace pregrasp
