#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

enum class ConvexKind : std::uint8_t { kBox, kPolytope, kCylinder, kCapsule };

/// A bounded convex polyhedron: faces are planes with their corners in counter-clockwise order seen
/// from outside.
struct Polytope {
  static constexpr int kMaxCorners = 96;  ///< of one face
  struct Face {
    Vector3 nhat = Vector3::UnitZ();  ///< outward
    double offset = 0.0;              ///< nhat . p of its points [m]
    int first = 0, count = 0;         ///< range in `corners`
  };
  std::vector<Vector3> vertices;
  std::vector<double> x, y, z;  ///< of the vertices, for loops over all of them
  std::vector<Face> faces;
  std::vector<int> corners;  ///< vertex indices, face after face

  void AddVertex(const Vector3& p) {
    vertices.push_back(p);
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }

  /// The corner of face `f` numbered `i`, counted around it.
  const Vector3& corner(const Face& face, int i) const { return vertices[corners[face.first + i]]; }
};

/// One convex piece of a body's shape, as contact generation sees it: in its own frame P, whose
/// origin is the centre of the box that bounds it.
struct Convex {
  ConvexKind kind = ConvexKind::kBox;
  RigidTransform X_BP = RigidTransform::Identity();
  bool is_aligned = true;                    ///< X_BP does not turn
  Vector3 half = Vector3::Zero();            ///< half extents of the bounding box in P [m]
  double radius = 0.0;                       ///< cylinder and capsule (a sphere has no height) [m]
  double half_height = 0.0;                  ///< along z, without caps [m]
  std::shared_ptr<const Polytope> polytope;  ///< of a box too
};

/// The convex pieces of a loaded shape.
/// @throws InputError if the shape holds a piece without volume.
std::vector<Convex> BuildConvexPieces(const Shape& shape);

/// A box along W's axes [m].
struct Bounds {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();

  bool IsWithin(double distance, const Bounds& other) const {
    return low.x() - other.high.x() <= distance && other.low.x() - high.x() <= distance &&
           low.y() - other.high.y() <= distance && other.low.y() - high.y() <= distance &&
           low.z() - other.high.z() <= distance && other.low.z() - high.z() <= distance;
  }
};

/// A piece at its pose in the world, within one step, and how far the step takes it if nothing is
/// in its way.
struct PlacedConvex {
  const Convex* convex = nullptr;
  Matrix3 R_WP = Matrix3::Identity();
  Vector3 p_WP = Vector3::Zero();
  bool is_upright = false;  ///< R_WP is known to be the identity, as most tables' and walls' is
  Bounds bounds;
  Vector3 shift_W = Vector3::Zero();  ///< of its origin [m]
  Vector3 turn_W = Vector3::Zero();   ///< [rad], small

  Vector3 ToWorld(const Vector3& v) const { return is_upright ? v : Vector3(R_WP * v); }
  Vector3 FromWorld(const Vector3& v_W) const {
    return is_upright ? v_W : Vector3(R_WP.transpose() * v_W);
  }
  Matrix3 FromWorld(const Matrix3& R_WA) const {
    return is_upright ? R_WA : Matrix3(R_WP.transpose() * R_WA);
  }
};

}  // namespace pregrasp
