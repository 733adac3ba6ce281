#pragma once

#include <array>
#include <cstdint>

#include "app/core/math.h"

namespace pregrasp {

/// One point of a manifold. `p_W` lies midway between the two surfaces.
struct ManifoldPoint {
  Vector3 p_W = Vector3::Zero();
  double phi = 0.0;           ///< gap along the normal [m], negative when the shapes overlap
  std::uint32_t feature = 0;  ///< names the pair of features, to find its impulse in the next step
};

/// Contact between two convex shapes A and B: one normal, at most four points.
struct Manifold {
  static constexpr int kMaxPoints = 4;

  Vector3 nhat_W = Vector3::UnitZ();  ///< from A to B
  int size = 0;
  std::array<ManifoldPoint, kMaxPoints> points;

  void Clear() { size = 0; }
  void Add(const Vector3& p_W, double phi, std::uint32_t feature) {
    points[size++] = {p_W, phi, feature};
  }
};

/// A point of a manifold that may still be left out: its place in the tangent plane.
struct PlanarPoint {
  double x = 0.0, y = 0.0;  ///< [m]
  double phi = 0.0;
  std::uint32_t feature = 0;
};

/// Chooses at most four of `count` points that stand for all: the deepest, the farthest from it,
/// the one that makes the largest triangle, and the one farthest outside that triangle. Ties within
/// a tolerance go to the lower index, so that the choice does not flicker.
/// @returns how many; their indices are in `chosen`.
int ChooseFour(const PlanarPoint* points, int count, std::array<int, Manifold::kMaxPoints>* chosen);

}  // namespace pregrasp
