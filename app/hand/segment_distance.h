#pragma once

#include <algorithm>
#include <cmath>

#include "app/geometry/mesh_distance.h"

namespace pregrasp {

/// The point of a segment where a signed distance is least.
struct SegmentSample {
  double t = 0.0;  ///< 0 at a, 1 at b
  DistanceSample sample;
};

namespace internal {

// The minimum between two points of a segment, where the derivative is negative at `low` and not at
// `high`: secant steps, each followed by a bisection so that a kink cannot stall it. For a convex
// distance it is the minimum of the segment.
template <typename Distance>
SegmentSample RefineBetween(const Distance& distance, const Vector3& a, const Vector3& ab,
                            double low, double slope_low, double high, double slope_high) {
  constexpr double kSlope = 1e-9;  // relative to the segment's length: value within 1e-18 m
  constexpr double kWidth = 1e-7;  // of the segment: within 1e-8 m even at a kink
  const double flat = kSlope * ab.norm();
  SegmentSample best;
  for (bool secant = true; high - low > kWidth; secant = !secant) {
    double t = 0.5 * (low + high);
    if (secant) {
      t = low - slope_low * (high - low) / (slope_high - slope_low);
      t = std::clamp(t, low + 0.01 * (high - low), high - 0.01 * (high - low));
    }
    best = {t, distance(a + t * ab)};
    const double slope = best.sample.nhat.dot(ab);
    if (std::abs(slope) <= flat) return best;
    if (slope < 0.0) {
      low = t;
      slope_low = slope;
    } else {
      high = t;
      slope_high = slope;
    }
  }
  return best;
}

}  // namespace internal

/// Least value along the segment from a to b of a convex body's signed distance, which is convex
/// along it. `distance(p)` returns a DistanceSample.
template <typename Distance>
SegmentSample FindLeastConvex(const Distance& distance, const Vector3& a, const Vector3& b) {
  const Vector3 ab = b - a;
  const DistanceSample at_a = distance(a);
  const double slope_a = at_a.nhat.dot(ab);
  if (slope_a >= 0.0) return {0.0, at_a};
  const DistanceSample at_b = distance(b);
  const double slope_b = at_b.nhat.dot(ab);
  if (slope_b <= 0.0) return {1.0, at_b};
  return internal::RefineBetween(distance, a, ab, 0.0, slope_a, 1.0, slope_b);
}

/// The same for any signed distance, which changes by at most 1 m per metre: steps of `spacing`, or
/// longer where the distance rules out a smaller value; then refined around the best step. Too
/// large by at most spacing / 2, and only where the body has a feature narrower than spacing.
template <typename Distance>
SegmentSample FindLeastAnywhere(const Distance& distance, const Vector3& a, const Vector3& b,
                                double spacing) {
  const Vector3 ab = b - a;
  const double length = ab.norm();
  SegmentSample best{0.0, distance(a)};
  if (length == 0.0) return best;
  const double step = spacing / length;
  double t = 0.0;
  double phi = best.sample.phi;
  double before = 0.0;  // the step before the best one, and the one after it
  double after = std::min(1.0, step);
  while (t < 1.0) {
    const double last = t;
    t = std::min(1.0, t + std::max(step, (phi - best.sample.phi) / length));
    const DistanceSample sample = distance(a + t * ab);
    phi = sample.phi;
    if (best.t == last) after = t;
    if (phi < best.sample.phi) {
      best = {t, sample};
      before = last;
      after = std::min(1.0, t + step);
    }
  }
  // Downhill from the best step to its neighbour, where the slope must have turned.
  const double slope = best.sample.nhat.dot(ab);
  const double other = slope < 0.0 ? after : before;
  if (slope == 0.0 || other == best.t) return best;
  const double other_slope = distance(a + other * ab).nhat.dot(ab);
  if (other_slope == 0.0 || (slope < 0.0) == (other_slope < 0.0)) return best;
  const SegmentSample refined =
      slope < 0.0 ? internal::RefineBetween(distance, a, ab, best.t, slope, other, other_slope)
                  : internal::RefineBetween(distance, a, ab, other, other_slope, best.t, slope);
  return refined.sample.phi < best.sample.phi ? refined : best;
}

/// Nearest points of two segments, as fractions of their lengths (Ericson, "Real-Time Collision
/// Detection", 2005, section 5.1.9).
inline void FindNearestOnSegments(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                                  const Vector3& b1, double* s, double* t) {
  const Vector3 u = a1 - a0;
  const Vector3 v = b1 - b0;
  const Vector3 w = a0 - b0;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  if (uu == 0.0 || vv == 0.0) {
    *s = uu == 0.0 ? 0.0 : std::clamp(-uw / uu, 0.0, 1.0);
    *t = vv == 0.0 ? 0.0 : std::clamp(vw / vv, 0.0, 1.0);
    return;
  }
  const double denominator = uu * vv - uv * uv;
  // Parallel segments have many nearest points; s = 0 is one candidate and clamping finds the rest.
  *s =
      denominator > 1e-12 * uu * vv ? std::clamp((uv * vw - uw * vv) / denominator, 0.0, 1.0) : 0.0;
  *t = (uv * *s + vw) / vv;
  if (*t < 0.0 || *t > 1.0) {
    *t = std::clamp(*t, 0.0, 1.0);
    *s = std::clamp((uv * *t - uw) / uu, 0.0, 1.0);
  }
}

/// Least value along the segment from a to b of a mesh's signed distance: exact where the segment
/// does not meet the surface, by FindLeastAnywhere in steps of 4 mm where it does. A least value
/// above `cutoff` is only known to be above it.
SegmentSample FindLeastOnMesh(const MeshDistance& mesh, const Vector3& a, const Vector3& b,
                              double cutoff);

}  // namespace pregrasp
