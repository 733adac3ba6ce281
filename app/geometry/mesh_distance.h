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

  /// For queries other than a point's: visits the triangles that may have a value below `best`,
  /// those in near boxes first. `in_box(low, high)` returns a lower bound of the value in a box,
  /// `visit(a, ab, ac, nhat)` the least value so far; nhat is zero for a triangle without area.
  template <typename InBox, typename Visit>
  void Walk(double best, const InBox& in_box, const Visit& visit) const;

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
  static constexpr int kMaxDepth = 60;
  // At most one entry waits at each level of the tree.
  static constexpr int kStackSize = 2 * kMaxDepth + 64;
  static Hit NearestOnTriangle(const Triangle& t, const Vector3& p_B);
  static Hit NearestOnEdges(const Triangle& t, const Vector3& p_B);
  void SearchLeaf(int first, int count, const Vector3& p_B, Search& search) const;

  AlignedBox bounds_;
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;                      // in leaf order
  std::vector<std::array<Vector3, 7>> feature_normals_;  // by triangle, in leaf order
};

template <typename InBox, typename Visit>
void MeshDistance::Walk(double best, const InBox& in_box, const Visit& visit) const {
  struct Entry {
    double least;
    int child, count;
  };
  std::array<Entry, kStackSize> stack;  // NOLINT: filled before it is read
  int top = 0;
  stack[top++] = {-std::numeric_limits<double>::infinity(), 0, 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.least >= best) continue;
    if (entry.child < 0) {
      for (int i = ~entry.child; i < ~entry.child + entry.count; ++i) {
        const Triangle& t = triangles_[i];
        best = visit(t.a, t.ab, t.ac, t.nhat);
      }
      continue;
    }
    const Node& node = nodes_[entry.child];
    const double least0 = in_box(node.low[0], node.high[0]);
    const double least1 = node.count[1] > 0 ? in_box(node.low[1], node.high[1])
                                            : std::numeric_limits<double>::infinity();
    const int near = least1 < least0 ? 1 : 0;
    stack[top++] = {near == 0 ? least1 : least0, node.child[1 - near], node.count[1 - near]};
    stack[top++] = {near == 0 ? least0 : least1, node.child[near], node.count[near]};
  }
}

}  // namespace pregrasp
