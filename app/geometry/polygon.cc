#include "app/geometry/polygon.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pregrasp {
namespace {

// Twice the area of a, b and c; positive where they turn left.
double Turn(const Vector2& a, const Vector2& b, const Vector2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Newell's: exact for a plane polygon, a mean for others. Its length is twice the area.
Vector3 CalcNormal(std::span<const Vector3> corners) {
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    normal += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  return normal;
}

// The corners that are left, as indices, in the plane.
class EarCutter {
 public:
  explicit EarCutter(std::vector<Vector2> points) : points_(std::move(points)) {
    left_.resize(points_.size());
    std::iota(left_.begin(), left_.end(), 0);
  }

  std::vector<std::array<int, 3>> Cut() {
    std::vector<std::array<int, 3>> triangles;
    while (left_.size() > 3) {
      const std::size_t at = FindEar();
      triangles.push_back(Around(at));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  // The corner at this place, between its neighbours.
  std::array<int, 3> Around(std::size_t at) const {
    const std::size_t count = left_.size();
    return {left_[(at + count - 1) % count], left_[at], left_[(at + 1) % count]};
  }

  // The first ear, or else the corner that turns the most.
  std::size_t FindEar() const {
    std::size_t widest = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t at = 0; at < left_.size(); ++at) {
      const auto [a, b, c] = Around(at);
      const double turn = Turn(points_[a], points_[b], points_[c]);
      if (turn > 0.0 && !HoldsAnother(points_[a], points_[b], points_[c])) return at;
      if (!(turn > most)) continue;
      most = turn;
      widest = at;
    }
    return widest;
  }

  // Corners at the same place as one of the triangle's do not count: a slit comes back there.
  bool HoldsAnother(const Vector2& a, const Vector2& b, const Vector2& c) const {
    return std::any_of(left_.begin(), left_.end(), [&](int i) {
      const Vector2& p = points_[i];
      if (p == a || p == b || p == c) return false;
      return Turn(a, b, p) >= 0.0 && Turn(b, c, p) >= 0.0 && Turn(c, a, p) >= 0.0;
    });
  }

  std::vector<Vector2> points_;
  std::vector<int> left_;
};

bool IsConvex(const std::vector<Vector2>& points) {
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (Turn(points[i], points[(i + 1) % count], points[(i + 2) % count]) < 0.0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> TriangulatePolygon(std::span<const Vector3> corners) {
  if (corners.size() < 3) return {};
  std::vector<std::array<int, 3>> fan;
  for (int i = 2; i < std::ssize(corners); ++i) fan.push_back({0, i - 1, i});
  const Vector3 normal = CalcNormal(corners);
  if (corners.size() == 3 || !(normal.norm() > 0.0)) return fan;
  const Matrix3 frame = FrameFromNormal(normal.normalized());
  std::vector<Vector2> points;
  for (const Vector3& corner : corners) {
    points.emplace_back(frame.leftCols<2>().transpose() * (corner - corners[0]));
  }
  if (IsConvex(points)) return fan;
  return EarCutter(std::move(points)).Cut();
}

}  // namespace pregrasp
