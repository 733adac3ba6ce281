#include "app/geometry/fcl_shape.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>

#include <vector>

#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct Maker {
  Geometry operator()(const Box& box) const { return std::make_shared<fcl::Boxd>(box.size); }
  Geometry operator()(const Cylinder& cylinder) const {
    return std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.height);
  }
  Geometry operator()(const Capsule& capsule) const {
    return std::make_shared<fcl::Capsuled>(capsule.radius, capsule.height);
  }
  Geometry operator()(const Sphere& sphere) const {
    return std::make_shared<fcl::Sphered>(sphere.radius);
  }
  Geometry operator()(const TriangleMesh& mesh) const {
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    std::vector<fcl::Vector3d> vertices(mesh.V.rows());
    std::vector<fcl::Triangle> triangles(mesh.F.rows());
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) vertices[v] = mesh.V.row(v);
    for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
      triangles[f].set(mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2));
    }
    model->beginModel();
    model->addSubModel(vertices, triangles);
    model->endModel();
    return model;
  }
};

}  // namespace

std::shared_ptr<fcl::CollisionGeometryd> MakeFclShape(const Shape& leaf) {
  Geometry geometry = VisitLeaf(leaf, Maker{});
  geometry->computeLocalAABB();
  return geometry;
}

}  // namespace pregrasp
