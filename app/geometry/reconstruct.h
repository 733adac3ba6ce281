#pragma once

#include <stdexcept>
#include <string>

#include "app/scene/shape.h"

namespace pregrasp {

/// A closed mesh made from points on a surface.
struct Reconstruction {
  TriangleMesh mesh;     ///< closed, two-manifold, outward, one component
  double spacing = 0.0;  ///< between neighbouring points, median [m]
  /// Distance from the points to the mesh, mean and 99th percentile [m].
  double mean_error = 0.0;
  double p99_error = 0.0;
  int euler_number = 2;  ///< 2 for a ball, 0 for a ring, lower with more handles
};

/// Why points gave no closed surface; the two halves of an InputError.
struct UnclosedCloud : std::runtime_error {
  UnclosedCloud(const std::string& expected_text, const std::string& got_text)
      : std::runtime_error(expected_text), expected(expected_text), got(got_text) {}
  std::string expected;
  std::string got;
};

/// The closed surface that points were sampled from. Normals are those given, or of planes fitted
/// to neighbours where none are, or where they point to either side at random; a flood from outside
/// that the points hold up tells which way is out. Near the points the surface is where the height
/// over their planes is zero (SurfaceHeight), elsewhere the flood decides; it is taken from a grid
/// by marching tetrahedra and simplified to at most 8,000 triangles. Deterministic. Limits: edges
/// are sharp to about a fifth of the spacing. Points that chance placed leave bare spots, where the
/// surface may be off by up to two spacings, but not by more than 0.4 outside the points' convex
/// hull, nor by more than a few hundredths where that is flat. Points must lie closer than the
/// thinnest wall is thick when they are evenly spread, than half of it when chance placed them; a
/// wall that broke is refused by the number of holes it leaves (more than 10).
/// @param points   at least 100; of more than 15,000 an even share is used.
/// @param normals  outward, one for each point, or no rows.
/// @throws UnclosedCloud
Reconstruction ReconstructSurface(const MatrixX3& points, const MatrixX3& normals);

}  // namespace pregrasp
