#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// A mesh ready to be shaded: vertices split where normals differ; three indices a triangle, in the
/// order of the mesh's faces.
struct ShadedSurface {
  struct Vertex {
    std::array<float, 3> p, n;
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// An edge with the normals of its two faces (twice the same at a border).
struct ShadedEdge {
  std::array<float, 3> p, q, n, m;
};

/// Angle between faces [rad] above which an edge is a crease: it stays sharp under smooth shading
/// and gets a highlight.
inline constexpr double kCreaseAngle = 40.0 * kPi / 180.0;

/// @param smooth  averages normals, weighted by corner angle, over faces that meet a corner's own
///                face at less than the crease angle; otherwise each face keeps its own. Vertices
///                at the same place count as one.
ShadedSurface BuildShadedSurface(const TriangleMesh& mesh, bool smooth);

/// Every edge once. With `creases_only`, those that are convex creases or borders.
std::vector<ShadedEdge> BuildShadedEdges(const TriangleMesh& mesh, bool creases_only);

/// Whether each edge is shared by two faces that run along it in opposite directions: the inside of
/// such a mesh is never seen.
bool IsClosedMesh(const TriangleMesh& mesh);

/// Parts of annotations, with unit size about z: a cylinder and a cone of radius 1 from z = 0 to 1
/// (the cone's tip is at 1), an open cone whose apex is at 0, a ball of radius 1.
TriangleMesh UnitCylinder(int segments);
TriangleMesh UnitCone(int segments);
TriangleMesh UnitOpenCone(int segments);
TriangleMesh UnitBall(int subdivisions);

}  // namespace pregrasp
