#pragma once

#include <array>
#include <limits>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/geometry/primitive_distance.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// The point of a mesh nearest to a query.
struct NearestPoint {
  int triangle = -1;
  Vector3 p_B = Vector3::Zero();
  /// Angle-weighted pseudonormal of the face, edge or vertex that p_B lies on (unit length).
  Vector3 nhat = Vector3::UnitZ();
  double distance = 0.0;  ///< unsigned [m]
};

/// Distance to a closed triangle mesh by a bounding-volume hierarchy. The sign is that of the
/// angle-weighted pseudonormal at the nearest point (Baerentzen and Aanaes 2005, "Signed distance
/// computation using the angle weighted pseudonormal"). Immutable, safe to share between threads.
class MeshDistance {
 public:
  /// @param mesh  closed, two-manifold, outward (zero-area triangles may be among its faces).
  explicit MeshDistance(const TriangleMesh& mesh);

  double Calc(const Vector3& p_B) const { return CalcWithGradient(p_B).phi; }
  DistanceSample CalcWithGradient(const Vector3& p_B) const;
  NearestPoint FindNearest(const Vector3& p_B) const;

  const AlignedBox& bounds() const { return bounds_; }

 private:
  // Both children's boxes lie in the parent, so that one cache miss decides about two subtrees. A
  // child that is negative is a leaf: ~child is its first triangle, count[] its number.
  struct Node {
    std::array<Vector3, 2> low, high;
    std::array<int, 2> child{0, 0};
    std::array<int, 2> count{0, 0};
  };
  struct Triangle {
    Vector3 a, ab, ac;
    Vector3 nhat;  // zero for a triangle without area
    int face;      // index in the mesh
  };
  // Where on a triangle a point lies: 0 face, 1 to 3 edges ab, bc, ca, 4 to 6 vertices a, b, c.
  struct Hit {
    Vector3 p_B = Vector3::Zero();
    int feature = 0;
  };
  struct Search;
  struct Item;  // of the build: a triangle's box and centre

  void BuildPseudonormals(const TriangleMesh& mesh);
  int BuildNode(std::vector<Item>& items, int begin, int end, int depth);
  void BuildChild(std::vector<Item>& items, int begin, int end, int node, int side, int depth);
  static Hit NearestOnTriangle(const Triangle& t, const Vector3& p_B);
  static Hit NearestOnEdges(const Triangle& t, const Vector3& p_B);
  void SearchLeaf(int first, int count, const Vector3& p_B, Search& search) const;

  AlignedBox bounds_;
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;                      // in leaf order
  std::vector<std::array<Vector3, 7>> feature_normals_;  // by triangle, in leaf order
};

}  // namespace pregrasp
