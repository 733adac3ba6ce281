#include "app/grasp/surface_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

constexpr int kSegments = 48;  // of the tessellation, a full turn

// The part of a convex polygon where offset <= axis p.
std::vector<Vector3> Clip(const std::vector<Vector3>& polygon, const Vector3& axis, double offset) {
  std::vector<Vector3> clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3& a = polygon[i];
    const Vector3& b = polygon[(i + 1) % polygon.size()];
    const double above_a = axis.dot(a) - offset;
    const double above_b = axis.dot(b) - offset;
    if (above_a >= 0.0) clipped.push_back(a);
    if ((above_a > 0.0 && above_b < 0.0) || (above_a < 0.0 && above_b > 0.0)) {
      clipped.emplace_back(a + above_a / (above_a - above_b) * (b - a));
    }
  }
  return clipped;
}

// The pieces of a polygon between equidistant planes across `axis`, at most `width` apart.
std::vector<std::vector<Vector3>> Slice(const std::vector<Vector3>& polygon, const Vector3& axis,
                                        double width) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vector3& p : polygon) {
    low = std::min(low, axis.dot(p));
    high = std::max(high, axis.dot(p));
  }
  const int count = std::max(1, static_cast<int>(std::ceil((high - low) / width - 1e-9)));
  if (count == 1) return {polygon};
  std::vector<std::vector<Vector3>> slices;
  for (int i = 0; i < count; ++i) {
    std::vector<Vector3> slice = polygon;
    if (i > 0) slice = Clip(slice, axis, low + i * (high - low) / count);
    if (i + 1 < count) slice = Clip(slice, -axis, -(low + (i + 1) * (high - low) / count));
    if (slice.size() >= 3) slices.push_back(std::move(slice));
  }
  return slices;
}

// Middles of the cells of a grid laid along each triangle's longest edge. A cell has a diagonal of
// `spacing`, and a middle lies within its cell, so no point is farther than that from one.
std::vector<Vector3> DivideTriangles(const TriangleMesh& mesh, double spacing) {
  const double width = spacing / std::sqrt(2.0);
  std::vector<Vector3> middles;
  for (int i = 0; i < mesh.F.rows(); ++i) {
    std::vector<Vector3> triangle(3);
    for (int k = 0; k < 3; ++k) triangle[k] = mesh.V.row(mesh.F(i, k));
    Vector3 along = Vector3::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vector3 edge = triangle[(k + 1) % 3] - triangle[k];
      if (edge.squaredNorm() > along.squaredNorm() * (1.0 + 1e-9)) along = edge;
    }
    const Vector3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (!(normal.norm() > 0.0)) continue;
    const Vector3 across = normal.cross(along).normalized();
    for (const std::vector<Vector3>& row : Slice(triangle, across, width)) {
      for (const std::vector<Vector3>& cell : Slice(row, along.normalized(), width)) {
        Vector3 middle = Vector3::Zero();
        for (const Vector3& p : cell) middle += p / static_cast<double>(cell.size());
        middles.push_back(middle);
      }
    }
  }
  return middles;
}

}  // namespace

void SurfacePointsConfig::Validate() const {
  if (!(std::isfinite(spacing) && spacing > 0.0)) {
    throw InputError("surface_points", "spacing", "a length above 0 m", FormatDouble(spacing));
  }
  if (max_points < 100) {
    throw InputError("surface_points", "max_points", "at least 100", std::to_string(max_points));
  }
}

SurfacePoints MakeSurfacePoints(const Shape& shape, const SignedDistance& distance,
                                const SurfacePointsConfig& config) {
  config.Validate();
  const TriangleMesh mesh = Tessellate(shape, kSegments);
  double area = 0.0;
  for (int i = 0; i < mesh.F.rows(); ++i) {
    const Vector3 a = mesh.V.row(mesh.F(i, 0));
    area +=
        0.5 *
        (Vector3(mesh.V.row(mesh.F(i, 1))) - a).cross(Vector3(mesh.V.row(mesh.F(i, 2))) - a).norm();
  }
  SurfacePoints points;
  points.spacing = std::max(config.spacing, std::sqrt(2.0 * area / config.max_points));
  const std::vector<Vector3> middles = DivideTriangles(mesh, points.spacing);

  points.P.resize(static_cast<int>(middles.size()), 3);
  points.N.resize(static_cast<int>(middles.size()), 3);
  int count = 0;
  for (const Vector3& middle : middles) {
    ThrowIfInterrupted();
    const FacePoint face = distance.ProjectToFace(middle);
    const bool moved_to_another_face = (face.p_B - middle).norm() > points.spacing;
    if (moved_to_another_face) continue;
    points.P.row(count) = face.p_B;
    points.N.row(count++) = face.nhat_B;
  }
  points.P.conservativeResize(count, 3);
  points.N.conservativeResize(count, 3);
  return points;
}

bool CanTouch(const Vector3& p_O, const Vector3& nhat_O, double radius, const TouchSlack& slack,
              const SignedDistance& object, const EnvironmentDistance& environment,
              const std::vector<RigidTransform>& X_WB) {
  constexpr double kRounding = 1e-6;  // [m]; a sphere that touches is at its radius, almost
  const Vector3 p_OT = p_O + radius * nhat_O;
  return object.Calc(p_OT) >= radius - slack.object - kRounding &&
         environment.Calc(X_WB.at(0) * p_OT, X_WB).phi >= radius - slack.environment;
}

double CalcRadiusAbout(const SurfacePoints& points, const Vector3& p_O) {
  return (points.P.rowwise() - p_O.transpose()).rowwise().norm().maxCoeff();
}

}  // namespace pregrasp
