#include "app/geometry/overlap.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "app/core/check.h"
#include "app/geometry/bounds.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/simplify.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

// A shape without unions in it, placed in the world.
struct Leaf {
  RigidTransform X_WP;
  AlignedBox bounds_W;
  SignedDistance distance;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  bool hollow = false;  // FCL knows its surface only
  MatrixX3 samples;     // on its surface, in P
};

std::shared_ptr<fcl::CollisionGeometryd> MakeSurface(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Vector3d> points(mesh.V.rows());
  for (int v = 0; v < mesh.V.rows(); ++v) points[v] = mesh.V.row(v);
  std::vector<fcl::Triangle> triangles(mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    triangles[f].set(mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2));
  }
  model->beginModel();
  model->addSubModel(points, triangles);
  model->endModel();
  return model;
}

std::shared_ptr<fcl::CollisionGeometryd> MakeGeometry(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return std::make_shared<fcl::Boxd>(box->size);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->height);
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return std::make_shared<fcl::Capsuled>(capsule->radius, capsule->height);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return std::make_shared<fcl::Sphered>(sphere->radius);
  }
  return MakeSurface(Tessellate(shape));
}

void CollectLeaves(const Shape& shape, const RigidTransform& X_WP, std::vector<Leaf>& leaves) {
  if (const auto* whole = std::get_if<Union>(&shape)) {
    for (const PlacedShape& part : whole->parts) {
      CollectLeaves(part.shape, X_WP * part.X_BP, leaves);
    }
    return;
  }
  constexpr int kAcross = 10;
  const double spacing = CalcBounds(shape).sizes().maxCoeff() / kAcross;
  Leaf leaf{X_WP,
            CalcBounds(shape, X_WP),
            SignedDistance(shape),
            MakeGeometry(shape),
            std::holds_alternative<Mesh>(shape) || std::holds_alternative<Cloud>(shape),
            SplitLongEdges(Tessellate(shape, 32), spacing).V};
  leaves.push_back(std::move(leaf));
}

// Whether FCL finds that the two meet. Only the question with a yes or no is asked: in Debian's
// library, which keeps its assertions, those of distance and depth can end the process.
bool Meet(const Leaf& a, const Leaf& b) {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  return fcl::collide(a.geometry.get(), a.X_WP, b.geometry.get(), b.X_WP, request, result) > 0;
}

// How deep the surface of `a` reaches into `b` [m]; negative when it does not. From the samples of
// a that lie deepest, steps down b's distance that stay on a's surface.
double CalcDepth(const Leaf& a, const Leaf& b) {
  const RigidTransform X_BA = b.X_WP.inverse() * a.X_WP;
  const auto distance_at = [&](const Vector3& p_A) { return b.distance.Calc(X_BA * p_A); };
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < a.samples.rows(); ++i) order.emplace_back(distance_at(a.samples.row(i)), i);
  std::sort(order.begin(), order.end());
  constexpr std::size_t kStarts = 12;
  constexpr int kSteps = 60;
  double deepest = order.front().first;
  for (std::size_t k = 0; k < std::min(kStarts, order.size()); ++k) {
    Vector3 p_A = a.samples.row(order[k].second);
    double phi = order[k].first;
    double step = 0.1 * a.distance.bounds().sizes().maxCoeff();
    for (int i = 0; i < kSteps; ++i) {
      const Vector3 nhat_A =
          X_BA.linear().transpose() * b.distance.CalcWithGradient(X_BA * p_A).nhat;
      const Vector3 q_A = a.distance.Project(p_A - step * nhat_A, nullptr);
      const double there = distance_at(q_A);
      if (there < phi) {
        phi = there;
        p_A = q_A;
      } else {
        step *= 0.5;
      }
    }
    deepest = std::min(deepest, phi);
  }
  return -deepest;
}

// A mesh's surface meets nothing when the other body is wholly inside or around it.
bool Contains(const Leaf& outer, const Leaf& inner) {
  const Vector3 p_W = inner.X_WP * Vector3(inner.samples.row(0));
  return outer.distance.Calc(outer.X_WP.inverse() * p_W) < 0.0;
}

double CalcOverlapDepth(const std::vector<Leaf>& a, const std::vector<Leaf>& b) {
  double depth = 0.0;
  for (const Leaf& leaf_a : a) {
    for (const Leaf& leaf_b : b) {
      if (!leaf_a.bounds_W.intersects(leaf_b.bounds_W)) continue;
      const bool overlap =
          Meet(leaf_a, leaf_b) || ((leaf_a.hollow || leaf_b.hollow) &&
                                   (Contains(leaf_a, leaf_b) || Contains(leaf_b, leaf_a)));
      if (!overlap) continue;
      depth = std::max({depth, CalcDepth(leaf_a, leaf_b), CalcDepth(leaf_b, leaf_a)});
    }
  }
  return depth;
}

}  // namespace

std::vector<Overlap> FindOverlaps(const Scene& scene, double tolerance) {
  const auto count = static_cast<int>(scene.bodies.size());
  std::vector<std::vector<Leaf>> leaves(count);
  for (int i = 0; i < count; ++i) {
    CollectLeaves(scene.bodies[i].shape, scene.bodies[i].X_WB, leaves[i]);
  }
  std::vector<Overlap> overlaps;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      if (!scene.bodies[a].movable() && !scene.bodies[b].movable()) continue;
      const double depth = CalcOverlapDepth(leaves[a], leaves[b]);
      if (depth > tolerance) overlaps.push_back({a, b, depth});
    }
  }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& x, const Overlap& y) { return x.depth > y.depth; });
  return overlaps;
}

}  // namespace pregrasp
