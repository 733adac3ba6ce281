#include "app/dynamics/support_spread.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// Points whose gaps are wider than the least by more than this bear nothing [m].
constexpr double kTouching = 1e-5;
// A patch narrower than this [m] is a line.
constexpr double kLine = 1e-9;

double Cross(const Vector2& a, const Vector2& b) { return a.x() * b.y() - a.y() * b.x(); }

// The convex hull, counter-clockwise, by Andrew's monotone chain. Points in line are left out.
std::vector<Vector2> CalcHull(std::vector<Vector2> points) {
  std::sort(points.begin(), points.end(), [](const Vector2& a, const Vector2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vector2> hull;
  for (int way = 0; way < 2; ++way) {
    const std::size_t first = hull.size();
    for (const Vector2& p : points) {
      while (hull.size() >= first + 2 &&
             Cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // where the way back begins
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// The integral of the distance from the origin over the triangle of origin, p and q.
double IntegrateDistance(const Vector2& p, const Vector2& q) {
  const double length = (q - p).norm();
  if (length == 0.0) return 0.0;
  const Vector2 along = (q - p) / length;
  const double h = Cross(p, along);  // the origin's distance from the line
  if (std::abs(h) < kLine) return 0.0;
  const auto primitive = [h](const Vector2& r, double s) {
    return s * r.norm() + h * h * std::asinh(s / h);
  };
  return h / 6.0 * (primitive(q, along.dot(q)) - primitive(p, along.dot(p)));
}

double CalcMeanDistanceFromMean(const std::vector<Vector2>& points) {
  const double count = static_cast<double>(points.size());
  Vector2 mean = Vector2::Zero();
  for (const Vector2& p : points) mean += p / count;
  double distance = 0.0;
  for (const Vector2& p : points) distance += (p - mean).norm() / count;
  return distance;
}

}  // namespace

double CalcMeanDistance(std::vector<Vector2> points) {
  double length = 0.0;
  for (const Vector2& p : points) length = std::max(length, (p - points.front()).norm());
  std::vector<Vector2> hull = CalcHull(std::move(points));
  const auto next = [&hull](std::size_t i) { return hull[i + 1 == hull.size() ? 0 : i + 1]; };
  double area = 0.0;
  Vector2 moment = Vector2::Zero();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2 p = hull[i] - hull.front(), q = next(i) - hull.front();
    area += 0.5 * Cross(p, q);
    moment += Cross(p, q) / 6.0 * (p + q);
  }
  if (area <= kLine * length) return 0.25 * length;
  const Vector2 centroid = hull.front() + moment / area;
  double integral = 0.0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    integral += IntegrateDistance(hull[i] - centroid, next(i) - centroid);
  }
  return integral / area;
}

double CalcSupportSpread(const Manifold& manifold) {
  const Matrix3 frame = FrameFromNormal(manifold.nhat_W);
  const Vector3 origin_W = manifold.points[0].p_W;
  const auto project = [&](const Vector3& p_W) -> Vector2 {
    return frame.leftCols<2>().transpose() * (p_W - origin_W);
  };
  double least_phi = manifold.points[0].phi;
  for (int i = 1; i < manifold.size; ++i) least_phi = std::min(least_phi, manifold.points[i].phi);
  std::vector<Vector2> points;
  for (int i = 0; i < manifold.size; ++i) {
    const ManifoldPoint& point = manifold.points[i];
    if (point.phi <= least_phi + kTouching) points.push_back(project(point.p_W));
  }
  const double distance = CalcMeanDistanceFromMean(points);
  if (distance < kLine) return 1.0;
  if (manifold.round && static_cast<int>(points.size()) == manifold.size) return 2.0 / 3.0;
  std::vector<Vector2> patch = points;
  if (const FacePoints* face = manifold.face; face != nullptr) {
    for (int i = 0; i < face->size; ++i) {
      if (face->phi[i] > least_phi + kTouching) continue;
      patch.push_back(project(manifold.plane.At(face->x[i], face->y[i], face->phi[i])));
    }
  }
  return std::min(1.0, CalcMeanDistance(std::move(patch)) / distance);
}

}  // namespace pregrasp
