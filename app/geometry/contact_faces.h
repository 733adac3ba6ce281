#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "app/geometry/mesh_distance.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Where a contact of a plan or grasp may lie (the project's definition): on a face, at least this
/// far inside every sharp convex edge of it [m], or a quarter of the face's width between that edge
/// and one that faces it where this is less.
inline constexpr double kEdgeInset = 0.5e-3;
/// An edge is sharp where its faces meet at more than this (0 is flat) [rad].
inline constexpr double kSharpAngle = kPi / 6.0;

/// How far inside a sharp convex edge a contact stays on a face of a given width [m].
inline double CalcEdgeInset(double width) { return std::min(kEdgeInset, 0.25 * width); }

/// A point of a face and the face's outward unit normal there, in the shape's frame B.
struct FacePoint {
  Vector3 p_B = Vector3::Zero();
  Vector3 nhat_B = Vector3::UnitZ();
};

/// The point nearest to p_B of those where a contact may lie; of several, that of the first face.
FacePoint ProjectToFace(const Box& box, const Vector3& p_B);
FacePoint ProjectToFace(const Cylinder& cylinder, const Vector3& p_B);
FacePoint ProjectToFace(const Capsule& capsule, const Vector3& p_B);
FacePoint ProjectToFace(const Sphere& sphere, const Vector3& p_B);

/// The smooth faces of a mesh: triangles joined where they meet at no more than kSharpAngle.
/// Immutable, safe to share between threads.
class MeshFaces {
 public:
  /// @param mesh  closed, two-manifold, outward.
  explicit MeshFaces(const TriangleMesh& mesh);

  /// A contact near p_B: the mesh's nearest point, moved over its face away from sharp convex edges
  /// as far as needed, or from there over the edge to the face beyond where that is nearer. The
  /// normal is that of the triangle it lies on.
  /// @param distance  of the same mesh.
  FacePoint Project(const MeshDistance& distance, const Vector3& p_B) const;

 private:
  struct Triangle {
    std::array<Vector3, 3> p;
    Vector3 nhat;               // of a neighbour where it has no area
    std::array<int, 3> across;  // -1 for a triangle beyond a sharp edge
  };
  // A sharp convex edge and its triangles.
  struct Edge {
    Vector3 a, b;
    std::array<int, 2> sides;
  };
  struct Place {
    int triangle;
    Vector3 p;
  };
  // Where a straight walk over a face ends.
  struct Walk {
    Place end;
    double length = 0.0;
    bool blocked = false;  // by a sharp edge
    double head_on = 0.0;  // then the cosine of the angle at which it was met, 1 for straight
  };

  void FindEdges(const std::vector<std::array<int, 3>>& neighbours);
  void ListNearEdges(int edge);
  Walk WalkOver(const Place& from, Vector3 along, double length) const;
  Vector3 DirectionInward(const Edge& edge, const Place& place, const Vector3& p_edge) const;
  static double CalcWayInside(const Walk& across, double distance);
  bool MoveInside(Place& place) const;
  FacePoint MoveInsideAll(Place place) const;

  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<std::vector<int>> near_;  // by triangle: edges of its face within kEdgeInset of it
};

}  // namespace pregrasp
