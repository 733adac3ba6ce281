#include "app/dynamics/polytope.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace pregrasp {
namespace {

// Triangles join a face while their corners stay this near to its plane, as a share of the
// polytope's size, and their normals within this angle [rad] of it.
constexpr double kPlaneShare = 2e-5;
constexpr double kMaxTurn = 0.02;

struct Triangle {
  std::array<int, 3> corners;
  Vector3 nhat = Vector3::Zero();
  double area = 0.0;      ///< twice the area [m^2]
  double altitude = 0.0;  ///< over its longest side [m]
  int face = -1;
};

using Edge = std::pair<int, int>;  // directed

// Grows a face from `seed` over triangles in its plane. Returns its triangles.
std::vector<int> GrowFace(const TriangleMesh& hull, int seed, int face, double tolerance,
                          const std::map<Edge, int>& triangle_of_edge,
                          std::vector<Triangle>* triangles) {
  const Triangle& start = (*triangles)[seed];
  const Vector3 nhat = start.nhat;
  const double offset = nhat.dot(hull.V.row(start.corners[0]));
  std::vector<int> members = {seed};
  (*triangles)[seed].face = face;
  for (std::size_t next = 0; next < members.size(); ++next) {
    const std::array<int, 3> corners = (*triangles)[members[next]].corners;
    for (int i = 0; i < 3; ++i) {
      const int other = triangle_of_edge.at({corners[(i + 1) % 3], corners[i]});
      Triangle& triangle = (*triangles)[other];
      if (triangle.face >= 0) continue;
      // The normal of a sliver says nothing.
      const bool turned = triangle.nhat.dot(nhat) < 1.0 - 0.5 * kMaxTurn * kMaxTurn;
      if (turned && triangle.altitude > 10.0 * tolerance) continue;
      bool in_plane = true;
      for (const int corner : triangle.corners) {
        const double height = nhat.dot(hull.V.row(corner)) - offset;
        in_plane = in_plane && std::abs(height) <= tolerance;
      }
      if (!in_plane) continue;
      triangle.face = face;
      members.push_back(other);
    }
  }
  return members;
}

// The corners around a set of triangles, in order; nothing if they do not form one loop.
std::vector<int> TraceOutline(const std::vector<int>& members, int face,
                              const std::map<Edge, int>& triangle_of_edge,
                              const std::vector<Triangle>& triangles) {
  std::map<int, int> next_corner;
  for (const int member : members) {
    const std::array<int, 3>& corners = triangles[member].corners;
    for (int i = 0; i < 3; ++i) {
      const int from = corners[i], to = corners[(i + 1) % 3];
      if (triangles[triangle_of_edge.at({to, from})].face != face) next_corner[from] = to;
    }
  }
  std::vector<int> outline;
  if (next_corner.empty()) return {};
  const int start = next_corner.begin()->first;
  int corner = start;
  do {
    outline.push_back(corner);
    const auto next = next_corner.find(corner);
    if (next == next_corner.end() || outline.size() > next_corner.size()) return {};
    corner = next->second;
  } while (corner != start);
  return outline.size() == next_corner.size() ? outline : std::vector<int>();
}

// Leaves out corners evenly, so that a face has no more than there is room for: round faces lose
// less than 1/1800 of their radius.
std::vector<int> Thin(const std::vector<int>& outline) {
  if (outline.size() <= Polytope::kMaxCorners) return outline;
  std::vector<int> thin;
  for (std::size_t i = 0; i < Polytope::kMaxCorners; ++i) {
    thin.push_back(outline[i * outline.size() / Polytope::kMaxCorners]);
  }
  return thin;
}

// Adds a face whose plane touches the polytope from outside.
void AddFace(const Vector3& nhat, const std::vector<int>& outline, Polytope* polytope) {
  Polytope::Face face;
  face.nhat = nhat;
  face.first = static_cast<int>(polytope->corners.size());
  face.count = static_cast<int>(outline.size());
  face.offset = nhat.dot(polytope->vertices[0]);
  for (const Vector3& vertex : polytope->vertices) {
    face.offset = std::max(face.offset, nhat.dot(vertex));
  }
  polytope->corners.insert(polytope->corners.end(), outline.begin(), outline.end());
  polytope->faces.push_back(face);
}

}  // namespace

Polytope MakeBoxPolytope(const Vector3& half) {
  Polytope polytope;
  for (int i = 0; i < 8; ++i) {
    polytope.AddVertex(Vector3((i & 1) != 0 ? half.x() : -half.x(),
                               (i & 2) != 0 ? half.y() : -half.y(),
                               (i & 4) != 0 ? half.z() : -half.z()));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int bit = 1 << axis, bit_u = 1 << (axis + 1) % 3, bit_v = 1 << (axis + 2) % 3;
    for (const int side : {0, bit}) {
      Polytope::Face face;
      face.nhat = (side != 0 ? 1.0 : -1.0) * Vector3::Unit(axis);
      face.offset = half[axis];
      face.first = static_cast<int>(polytope.corners.size());
      face.count = 4;
      if (side != 0) {
        polytope.corners.insert(polytope.corners.end(),
                                {side, side | bit_u, side | bit_u | bit_v, side | bit_v});
      } else {
        polytope.corners.insert(polytope.corners.end(), {0, bit_v, bit_u | bit_v, bit_u});
      }
      polytope.faces.push_back(face);
    }
  }
  return polytope;
}

Polytope MakePolytope(const TriangleMesh& hull) {
  Polytope polytope;
  for (int i = 0; i < hull.V.rows(); ++i) polytope.AddVertex(hull.V.row(i));
  const double size = (hull.V.colwise().maxCoeff() - hull.V.colwise().minCoeff()).maxCoeff();
  std::vector<Triangle> triangles(hull.F.rows());
  std::map<Edge, int> triangle_of_edge;
  for (int t = 0; t < hull.F.rows(); ++t) {
    Triangle& triangle = triangles[t];
    triangle.corners = {hull.F(t, 0), hull.F(t, 1), hull.F(t, 2)};
    const Vector3 &p = polytope.vertices[triangle.corners[0]],
                  &q = polytope.vertices[triangle.corners[1]],
                  &r = polytope.vertices[triangle.corners[2]];
    const Vector3 n = (q - p).cross(r - p);
    triangle.area = n.norm();
    if (triangle.area > 0.0) {
      triangle.nhat = n / triangle.area;
      triangle.altitude =
          triangle.area / std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
    }
    for (int i = 0; i < 3; ++i) {
      triangle_of_edge[{triangle.corners[i], triangle.corners[(i + 1) % 3]}] = t;
    }
  }
  // Large triangles first: their normals are the most accurate.
  std::vector<int> order(triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return triangles[a].area > triangles[b].area; });
  for (const int seed : order) {
    if (triangles[seed].face >= 0) continue;
    const int index = seed;  // any number no other face has
    const std::vector<int> members =
        GrowFace(hull, seed, index, kPlaneShare * size, triangle_of_edge, &triangles);
    const std::vector<int> outline = TraceOutline(members, index, triangle_of_edge, triangles);
    if (!outline.empty()) {
      AddFace(triangles[seed].nhat, Thin(outline), &polytope);
      continue;
    }
    for (const int member : members) {
      const Triangle& triangle = triangles[member];
      if (triangle.altitude <= 0.0) continue;
      AddFace(triangle.nhat, {triangle.corners.begin(), triangle.corners.end()}, &polytope);
    }
  }
  return polytope;
}

}  // namespace pregrasp
