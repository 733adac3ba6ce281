#pragma once

#include <array>
#include <cstdint>

#include "app/dynamics/convex.h"
#include "app/dynamics/manifold.h"

namespace pregrasp {

/// The part of a piece's surface that looks along a direction: a face, an end disc, a line of a
/// cylinder's or capsule's side, or a sphere's point.
struct Feature {
  static constexpr int kMaxCorners = Polytope::kMaxCorners;
  enum class Kind : std::uint8_t { kPoint, kSegment, kPolygon, kDisc };

  Kind kind = Kind::kPoint;
  Vector3 nhat_W = Vector3::UnitZ();  ///< outward normal of a polygon or disc
  int size = 0;
  std::array<Vector3, kMaxCorners> points;  ///< corners or ends in W; the centre of a disc
  std::array<std::uint32_t, kMaxCorners> ids{};
  Vector3 u_W = Vector3::Zero(), w_W = Vector3::Zero();  ///< a disc's half axes, length = radius
};

/// The feature of `placed` that looks along nhat_W most directly.
void FindFeature(const PlacedConvex& placed, const Vector3& nhat_W, Feature* feature);

enum class OverlapResult : std::uint8_t { kNone, kSliver, kTouching };

/// Contact points where features of A and B lie over each other, seen along nhat_W (from A to B):
/// corners of one over the other and crossings of their outlines, with the gap measured along
/// nhat_W, exactly for polygons and discs; those within `margin` are reduced as AddFacePoints does.
/// @returns kSliver if the overlap is thinner than kMinOverlap somewhere.
OverlapResult OverlapFeatures(const PlacedConvex& a, const PlacedConvex& b,
                              const Feature& feature_a, const Feature& feature_b,
                              const Vector3& nhat_W, double margin, Manifold* manifold);

}  // namespace pregrasp
