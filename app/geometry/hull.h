#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

/// Convex hull of `points` (#points x 3), closed and outward (qhull). Its vertices are those of the
/// points that span it; a face with more than three corners is given as triangles.
/// @throws InputError when they lie in a plane or are not finite.
TriangleMesh CalcConvexHull(const MatrixX3& points);

/// The hull of few of the points: no point lies farther than `tolerance` [m] outside, unless
/// `max_vertices` are not enough for that. Points farthest outside are taken first, so flat faces
/// keep their planes.
TriangleMesh CalcReducedHull(const MatrixX3& points, double tolerance, int max_vertices);

/// How shapes that are not convex are taken apart.
struct DecomposeConfig {
  /// At most so many pieces for a mesh that is not convex, and a quarter of them for one that fills
  /// 90 % of its hull, unless it is cut into sectors. More keep cavities more open and cost contact
  /// simulation more; a mug takes about 40.
  int max_pieces = 96;
  /// How far a piece may reach outside the shape before it is split further [m], where it is a
  /// sector of a solid of revolution. Where that takes too many pieces they reach farther, which
  /// CalcProtrusion tells.
  double concavity = 5e-4;
  /// The same for other pieces, at least `concavity`: scans are rough to about a millimetre, and
  /// each piece costs contact simulation.
  double free_concavity = 1e-3;
  /// A piece's hull leaves out what changes it by less [m], and has at most `max_vertices`.
  double tolerance = 1e-4;
  int max_vertices = 256;

  void Validate() const;
};

/// One of the convex pieces whose union stands for a shape in contact simulation.
struct ConvexPiece {
  Shape shape;  ///< Box, Cylinder, Capsule, Sphere, or Mesh holding a convex hull
  RigidTransform X_BP = RigidTransform::Identity();
};

/// Convex pieces that cover `shape` (loaded): the shape itself where it is convex, those of each
/// part of a union, an approximate decomposition of a mesh that is not convex. A mesh that is
/// nearly a solid of revolution is cut into sectors, all of them alike, the rest by planes that
/// separate most of the pairs of surface points that do not see each other through the solid; then
/// pieces whose joint hull reaches least outside are merged again (in the manner of V-HACD, Mamou
/// 2016, and CoACD, Wei et al. 2022). Deterministic; each mesh is taken apart once per process.
std::vector<ConvexPiece> DecomposeConvex(const Shape& shape, const DecomposeConfig& config = {});

/// How far the pieces reach outside `shape` [m]: the largest signed distance over a dense sample of
/// their surfaces. Small means that cavities are open.
double CalcProtrusion(const Shape& shape, const std::vector<ConvexPiece>& pieces);

}  // namespace pregrasp
