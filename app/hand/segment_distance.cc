#include "app/hand/segment_distance.h"

#include <array>
#include <limits>

namespace pregrasp {
namespace {

constexpr double kSpacing = 4e-3;  // [m], inside a mesh, where only the way out matters

// The nearest points of a segment and a mesh's surface so far.
class Nearest {
 public:
  Nearest(const Vector3& a, const Vector3& b, double at_most)
      : a_(a), b_(b), low_(a.cwiseMin(b)), high_(a.cwiseMax(b)), squared_(at_most * at_most) {}

  bool found() const { return found_; }
  double squared() const { return squared_; }
  double t() const { return t_; }
  const Vector3& p_surface() const { return p_surface_; }

  // Between the segment's box and another.
  double SquaredGap(const Vector3& low, const Vector3& high) const {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double gap = std::max({low[i] - high_[i], 0.0, low_[i] - high[i]});
      sum += gap * gap;
    }
    return sum;
  }

  // The nearest points of a segment and a triangle are an end over the face, or on an edge, or a
  // crossing. An edge of a triangle without area belongs to others too.
  double Visit(const Vector3& v, const Vector3& e1, const Vector3& e2, const Vector3& nhat) {
    const double height_a = nhat.dot(a_ - v);
    const double height_b = nhat.dot(b_ - v);
    const bool crosses = height_a * height_b <= 0.0;
    const double lower = std::min(std::abs(height_a), std::abs(height_b));
    if (nhat.isZero(0.0) || (!crosses && lower * lower >= squared_)) return squared_;
    if (crosses && height_a != height_b) {
      const double t = height_a / (height_a - height_b);
      const Vector3 p = a_ + t * (b_ - a_);
      if (IsOver(p - v, e1, e2)) Improve(0.0, t, p);
    }
    for (const double t : {0.0, 1.0}) {
      const double height = t == 0.0 ? height_a : height_b;
      const Vector3& p = t == 0.0 ? a_ : b_;
      if (height * height < squared_ && IsOver(p - v, e1, e2)) {
        Improve(height * height, t, p - height * nhat);
      }
    }
    const std::array<Vector3, 4> corners{v, v + e1, v + e2, v};
    for (int i = 0; i < 3; ++i) {
      double t = 0.0;
      double s = 0.0;
      FindNearestOnSegments(a_, b_, corners[i], corners[i + 1], &t, &s);
      const Vector3 p = corners[i] + s * (corners[i + 1] - corners[i]);
      Improve((a_ + t * (b_ - a_) - p).squaredNorm(), t, p);
    }
    return squared_;
  }

 private:
  static bool IsOver(const Vector3& p, const Vector3& e1, const Vector3& e2) {
    const double d11 = e1.squaredNorm();
    const double d22 = e2.squaredNorm();
    const double d12 = e1.dot(e2);
    const double p1 = p.dot(e1);
    const double p2 = p.dot(e2);
    const double scale = d11 * d22 - d12 * d12;
    const double u = d22 * p1 - d12 * p2;
    const double w = d11 * p2 - d12 * p1;
    return u >= 0.0 && w >= 0.0 && u + w <= scale;
  }

  void Improve(double squared, double t, const Vector3& p_surface) {
    if (squared >= squared_) return;
    squared_ = squared;
    t_ = t;
    p_surface_ = p_surface;
    found_ = true;
  }

  const Vector3 a_, b_, low_, high_;
  double squared_;
  double t_ = 0.0;
  Vector3 p_surface_ = Vector3::Zero();
  bool found_ = false;
};

}  // namespace

SegmentSample FindLeastOnMesh(const MeshDistance& mesh, const Vector3& a, const Vector3& b,
                              double cutoff) {
  const auto distance = [&](const Vector3& p) { return mesh.CalcWithGradient(p); };
  Nearest nearest(a, b, cutoff);
  mesh.Walk(
      nearest.squared(),
      [&](const Vector3& low, const Vector3& high) { return nearest.SquaredGap(low, high); },
      [&](const Vector3& v, const Vector3& e1, const Vector3& e2, const Vector3& nhat) {
        return nearest.Visit(v, e1, e2, nhat);
      });
  // Which side the segment is on, or whether it crosses, the nearest point itself tells.
  const Vector3 p = a + nearest.t() * (b - a);
  const bool far = !nearest.found();
  if (far && !mesh.bounds().contains(p)) return {0.0, {2.0 * cutoff, Vector3::UnitZ()}};
  const DistanceSample at_p = distance(p);
  constexpr double kCrossing = 1e-9;  // [m]; nearer, rounding would decide on the normal
  if (at_p.phi < kCrossing) return FindLeastAnywhere(distance, a, b, kSpacing);
  return {nearest.t(), at_p};
}

}  // namespace pregrasp
