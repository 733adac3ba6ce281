#include "app/geometry/overlap.h"

#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "app/core/check.h"
#include "app/geometry/bounds.h"
#include "app/geometry/fcl_shape.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/simplify.h"
#include "app/geometry/tessellate.h"
#include "app/scene/shape_visit.h"

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

std::vector<Leaf> CollectLeaves(const Shape& shape, const RigidTransform& X_WB) {
  constexpr int kAcross = 10;
  std::vector<Leaf> leaves;
  ForEachLeaf(shape, X_WB, [&](const Shape& part, const RigidTransform& X_WP) {
    const double spacing = CalcBounds(part).sizes().maxCoeff() / kAcross;
    leaves.push_back({X_WP, CalcBounds(part, X_WP), SignedDistance(part), MakeFclShape(part),
                      std::holds_alternative<Mesh>(part) || std::holds_alternative<Cloud>(part),
                      SplitLongEdges(Tessellate(part, 32), spacing).V});
  });
  return leaves;
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
  order.reserve(a.samples.rows());
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
    leaves[i] = CollectLeaves(scene.bodies[i].shape, scene.bodies[i].X_WB);
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
