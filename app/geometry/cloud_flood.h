#pragma once

#include <vector>

#include "app/geometry/cloud_planes.h"
#include "app/geometry/grid_marks.h"

namespace pregrasp {

/// A grid of about `cell` [m] around a cloud with `margin` [m] on each side; coarser where it would
/// have too many nodes.
ScalarGrid GridAround(const SampledCloud& cloud, double cell, double margin);

/// What can be reached from outside without coming within `radius` [m] of a point.
class CloudFlood {
 public:
  CloudFlood(const SampledCloud& cloud, double radius);

  bool Reaches(const Vector3& p) const;

  /// Lets the flood on to within `distance` [m] of the points from where it stands. It does not get
  /// through gaps in the surface in that way.
  void Spread(double distance) { SpreadMark(grid_, kReached, radius_ - distance, marks_); }

  /// +1 where the flood is nearer on the side that the normal points to, -1 where on the other, 0
  /// where both are alike: then it has come in.
  std::vector<int> Orient(const SampledCloud& cloud) const;

  double radius() const { return radius_; }

 private:
  static constexpr std::uint8_t kOpen = 0, kNear = 1, kReached = 2;

  MatrixX3 ListFront() const;

  ScalarGrid grid_;
  GridMarks marks_;
  double radius_;
};

/// Turns the normals outward and returns the flood that told the way. It must stop at the surface,
/// which takes a large radius, and get into hollows, which takes a small one: of several the one is
/// taken after which neighbours agree best. Normals that came with the points are turned all
/// together or stay as they are: they know hollows that no flood gets into.
CloudFlood OrientOutward(SampledCloud& cloud, bool has_normals);

}  // namespace pregrasp
