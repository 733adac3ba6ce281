#pragma once

#include <algorithm>
#include <cmath>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Signed distance to a surface at one point: `phi` [m], negative inside, and its unit gradient.
struct DistanceSample {
  double phi = 0.0;
  Vector3 nhat = Vector3::UnitZ();
};

// Closed forms, each in the primitive's own frame B and inline because inverse kinematics and
// occlusion call them millions of times. Where the nearest surface point is not unique (a medial
// axis), the gradient is that of the first candidate, so it is a unit vector everywhere.

namespace internal {

// +1 for zero, so that the gradient on a plane of symmetry has unit length.
inline double SignOf(double x) { return x < 0.0 ? -1.0 : 1.0; }

// Unit (x, y) direction from the z axis; x on the axis itself.
inline Vector2 RadialDirection(const Vector3& p, double rho) {
  return rho > 0.0 ? Vector2(p.x() / rho, p.y() / rho) : Vector2::UnitX();
}

}  // namespace internal

inline double CalcDistance(const Box& box, const Vector3& p_B) {
  const Vector3 q = p_B.cwiseAbs() - 0.5 * box.size;
  const double inside = std::min(q.maxCoeff(), 0.0);
  return q.cwiseMax(0.0).norm() + inside;
}

inline DistanceSample CalcDistanceWithGradient(const Box& box, const Vector3& p_B) {
  const Vector3 q = p_B.cwiseAbs() - 0.5 * box.size;
  const Vector3 outward(internal::SignOf(p_B.x()), internal::SignOf(p_B.y()),
                        internal::SignOf(p_B.z()));
  const Vector3 beyond = q.cwiseMax(0.0);
  const double distance = beyond.norm();
  if (distance > 0.0) return {distance, beyond.cwiseProduct(outward) / distance};
  int axis = 0;
  if (q.y() > q[axis]) axis = 1;
  if (q.z() > q[axis]) axis = 2;
  DistanceSample sample{q[axis], Vector3::Zero()};
  sample.nhat[axis] = outward[axis];
  return sample;
}

inline double CalcDistance(const Cylinder& cylinder, const Vector3& p_B) {
  const double side = std::sqrt(p_B.x() * p_B.x() + p_B.y() * p_B.y()) - cylinder.radius;
  const double cap = std::abs(p_B.z()) - 0.5 * cylinder.height;
  if (side > 0.0 && cap > 0.0) return std::sqrt(side * side + cap * cap);
  return std::max(side, cap);
}

inline DistanceSample CalcDistanceWithGradient(const Cylinder& cylinder, const Vector3& p_B) {
  const double rho = std::sqrt(p_B.x() * p_B.x() + p_B.y() * p_B.y());
  const double side = rho - cylinder.radius;
  const double cap = std::abs(p_B.z()) - 0.5 * cylinder.height;
  const Vector2 radial = internal::RadialDirection(p_B, rho);
  const double up = internal::SignOf(p_B.z());
  if (side > 0.0 && cap > 0.0) {
    const double distance = std::sqrt(side * side + cap * cap);
    if (distance > 0.0) {
      const double s = side / distance;
      return {distance, {s * radial.x(), s * radial.y(), up * cap / distance}};
    }
  }
  if (side >= cap) return {side, {radial.x(), radial.y(), 0.0}};
  return {cap, {0.0, 0.0, up}};
}

inline DistanceSample CalcDistanceWithGradient(const Sphere& sphere, const Vector3& p_B) {
  const double rho = p_B.norm();
  return {rho - sphere.radius, rho > 0.0 ? Vector3(p_B / rho) : Vector3::UnitZ()};
}

inline double CalcDistance(const Sphere& sphere, const Vector3& p_B) {
  return p_B.norm() - sphere.radius;
}

inline double CalcDistance(const Capsule& capsule, const Vector3& p_B) {
  const double half = 0.5 * capsule.height;
  const double z = p_B.z() - std::clamp(p_B.z(), -half, half);
  return std::sqrt(p_B.x() * p_B.x() + p_B.y() * p_B.y() + z * z) - capsule.radius;
}

inline DistanceSample CalcDistanceWithGradient(const Capsule& capsule, const Vector3& p_B) {
  const double half = 0.5 * capsule.height;
  const Vector3 q(p_B.x(), p_B.y(), p_B.z() - std::clamp(p_B.z(), -half, half));
  const double rho = q.norm();
  return {rho - capsule.radius, rho > 0.0 ? Vector3(q / rho) : Vector3::UnitX()};
}

}  // namespace pregrasp
