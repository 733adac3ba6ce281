#include "app/dynamics/convex.h"

#include <utility>
#include <variant>

#include "app/dynamics/polytope.h"

namespace pregrasp {
namespace {

struct PieceBuilder {
  RigidTransform X_BP;
  std::vector<Convex>* pieces;

  void operator()(const Box& box) const {
    Convex convex;
    convex.kind = ConvexKind::kBox;
    convex.half = 0.5 * box.size;
    convex.polytope = std::make_shared<Polytope>(MakeBoxPolytope(convex.half));
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
  void operator()(const Mesh& mesh) const { AddHull(mesh.mesh); }
  void operator()(const Cloud& cloud) const { AddHull(cloud.mesh); }
  void operator()(const Union& whole) const {
    for (const PlacedShape& part : whole.parts) {
      std::visit(PieceBuilder{X_BP * part.X_BP, pieces}, part.shape);
    }
  }

  void AddHull(const TriangleMesh& hull) const {
    const Vector3 low = hull.V.colwise().minCoeff(), high = hull.V.colwise().maxCoeff();
    const Vector3 center = 0.5 * (low + high);
    TriangleMesh centered = hull;
    centered.V.rowwise() -= center.transpose();
    Convex convex;
    convex.kind = ConvexKind::kPolytope;
    convex.half = 0.5 * (high - low);
    convex.polytope = std::make_shared<Polytope>(MakePolytope(centered));
    PieceBuilder{X_BP * Eigen::Translation3d(center), pieces}.Add(convex);
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
