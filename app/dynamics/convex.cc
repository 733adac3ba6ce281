#include "app/dynamics/convex.h"

#include <cmath>
#include <variant>

namespace pregrasp {
namespace {

// Corner i of a box has +x if bit 0 is set, +y for bit 1, +z for bit 2.
std::shared_ptr<const Polytope> MakeBoxPolytope(const Vector3& half) {
  auto polytope = std::make_shared<Polytope>();
  for (int i = 0; i < 8; ++i) {
    polytope->vertices.push_back(Vector3((i & 1) != 0 ? half.x() : -half.x(),
                                         (i & 2) != 0 ? half.y() : -half.y(),
                                         (i & 4) != 0 ? half.z() : -half.z()));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int bit = 1 << axis, bit_u = 1 << (axis + 1) % 3, bit_v = 1 << (axis + 2) % 3;
    for (const int side : {0, bit}) {
      Polytope::Face face;
      face.nhat = (side != 0 ? 1.0 : -1.0) * Vector3::Unit(axis);
      face.offset = half[axis];
      face.first = static_cast<int>(polytope->corners.size());
      face.count = 4;
      if (side != 0) {
        polytope->corners.insert(polytope->corners.end(),
                                 {side, side | bit_u, side | bit_u | bit_v, side | bit_v});
      } else {
        polytope->corners.insert(polytope->corners.end(), {0, bit_v, bit_u | bit_v, bit_u});
      }
      polytope->faces.push_back(face);
    }
  }
  return polytope;
}

struct PieceBuilder {
  RigidTransform X_BP;
  std::vector<Convex>* pieces;

  void operator()(const Box& box) const {
    Convex convex;
    convex.kind = ConvexKind::kBox;
    convex.half = 0.5 * box.size;
    convex.polytope = MakeBoxPolytope(convex.half);
    Add(convex);
  }
  void operator()(const Cylinder& cylinder) const {
    Convex convex;
    convex.kind = ConvexKind::kCylinder;
    convex.radius = cylinder.radius;
    convex.half_height = 0.5 * cylinder.height;
    convex.half = Vector3(convex.radius, convex.radius, convex.half_height);
    Add(convex);
  }
  void operator()(const Capsule& capsule) const {
    Convex convex;
    convex.kind = ConvexKind::kCapsule;
    convex.radius = capsule.radius;
    convex.half_height = 0.5 * capsule.height;
    convex.half = Vector3(convex.radius, convex.radius, convex.half_height + convex.radius);
    Add(convex);
  }
  void operator()(const Sphere& sphere) const { (*this)(Capsule{sphere.radius, 0.0}); }
  void operator()(const Mesh&) const {}
  void operator()(const Cloud&) const {}
  void operator()(const Union& whole) const {
    for (const PlacedShape& part : whole.parts) {
      std::visit(PieceBuilder{X_BP * part.X_BP, pieces}, part.shape);
    }
  }

  void Add(Convex convex) const {
    convex.X_BP = X_BP;
    pieces->push_back(std::move(convex));
  }
};

}  // namespace

std::vector<Convex> BuildConvexPieces(const Shape& shape) {
  std::vector<Convex> pieces;
  std::visit(PieceBuilder{RigidTransform::Identity(), &pieces}, shape);
  return pieces;
}

}  // namespace pregrasp
