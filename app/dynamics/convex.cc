#include "app/dynamics/convex.h"

#include <variant>

#include "app/core/check.h"
#include "app/dynamics/polytope.h"
#include "app/geometry/hull.h"

namespace pregrasp {
namespace {

// A piece as contact generation wants it, from one of DecomposeConvex.
struct PieceBuilder {
  RigidTransform X_BP;

  Convex operator()(const Box& box) const {
    Convex convex = Make(ConvexKind::kBox, 0.5 * box.size);
    convex.polytope = std::make_shared<Polytope>(MakeBoxPolytope(convex.half));
    return convex;
  }
  Convex operator()(const Cylinder& cylinder) const {
    const double r = cylinder.radius, half_height = 0.5 * cylinder.height;
    return MakeRound(ConvexKind::kCylinder, r, half_height, Vector3(r, r, half_height));
  }
  Convex operator()(const Capsule& capsule) const {
    const double r = capsule.radius, half_height = 0.5 * capsule.height;
    return MakeRound(ConvexKind::kCapsule, r, half_height, Vector3(r, r, half_height + r));
  }
  Convex operator()(const Sphere& sphere) const { return (*this)(Capsule{sphere.radius, 0.0}); }
  Convex operator()(const Mesh& mesh) const {
    const Vector3 low = mesh.mesh.V.colwise().minCoeff(), high = mesh.mesh.V.colwise().maxCoeff();
    const Vector3 center = 0.5 * (low + high);
    TriangleMesh centered = mesh.mesh;
    centered.V.rowwise() -= center.transpose();
    Convex convex = Make(ConvexKind::kPolytope, 0.5 * (high - low));
    convex.X_BP = X_BP * Eigen::Translation3d(center);
    convex.polytope = std::make_shared<Polytope>(MakePolytope(centered));
    return convex;
  }
  // DecomposeConvex turns these into the others.
  Convex operator()(const Cloud&) const { PREGRASP_CHECK(false); }
  Convex operator()(const Union&) const { PREGRASP_CHECK(false); }

  Convex Make(ConvexKind kind, const Vector3& half) const {
    Convex convex;
    convex.kind = kind;
    convex.X_BP = X_BP;
    convex.is_aligned = X_BP.linear() == Matrix3::Identity();
    convex.half = half;
    return convex;
  }
  Convex MakeRound(ConvexKind kind, double radius, double half_height, const Vector3& half) const {
    Convex convex = Make(kind, half);
    convex.radius = radius;
    convex.half_height = half_height;
    return convex;
  }
};

}  // namespace

std::vector<Convex> BuildConvexPieces(const Shape& shape) {
  std::vector<Convex> pieces;
  for (const ConvexPiece& piece : DecomposeConvex(shape)) {
    pieces.push_back(std::visit(PieceBuilder{piece.X_BP}, piece.shape));
  }
  return pieces;
}

}  // namespace pregrasp
