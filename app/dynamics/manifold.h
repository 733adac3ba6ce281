#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "app/core/math.h"
#include "app/dynamics/convex.h"

namespace pregrasp {

/// One point of a manifold. `p_W` lies midway between the two surfaces.
struct ManifoldPoint {
  Vector3 p_W = Vector3::Zero();
  double phi = 0.0;           ///< gap along the normal [m], negative when the shapes overlap
  std::uint32_t feature = 0;  ///< names the pair of features, to find its impulse in the next step
};

/// Contact between two convex shapes A and B: one normal, four points that stand for all, and those
/// others that bore load in the last step.
struct Manifold {
  static constexpr int kMaxPoints = 8;

  Vector3 nhat_W = Vector3::UnitZ();  ///< from A to B
  int size = 0;
  std::array<ManifoldPoint, kMaxPoints> points;
  int num_loaded = 0;
  std::array<std::uint32_t, kMaxPoints> loaded;  ///< features that bore load in the last step

  void Clear() { size = 0; }
  std::span<const std::uint32_t> loaded_features() const {
    return {loaded.data(), static_cast<std::size_t>(num_loaded)};
  }
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

/// The most points that ChoosePoints chooses from.
inline constexpr int kMaxPlanarPoints = 256;

/// How the gap between two pieces changes in a step, over the places of the tangent plane.
struct Approach {
  double at_origin = 0.0, per_x = 0.0, per_y = 0.0;

  /// @param p_WO, R_WT  origin and axes (x, y, normal from a to b) of the tangent plane.
  Approach(const PlacedConvex& a, const PlacedConvex& b, const Vector3& p_WO, const Matrix3& R_WT);

  double At(double x, double y) const { return at_origin + per_x * x + per_y * y; }
};

/// Chooses among `count` points (kMaxPlanarPoints at most). Four at most stand for all: the deepest
/// at the end of the step, the farthest from it, the one that makes the largest triangle, and the
/// one farthest outside that triangle. Ties within a tolerance go to the lower index, so that the
/// choice does not flicker. Those of `loaded` that are not in the plane of the four are kept too,
/// as room allows: of a crowd of points almost in a plane the body rests on three, and they must
/// stay while the four change.
/// @returns how many; their indices are in `chosen`.
int ChoosePoints(const PlanarPoint* points, int count, const Approach& approach,
                 std::span<const std::uint32_t> loaded,
                 std::array<int, Manifold::kMaxPoints>* chosen);

}  // namespace pregrasp
