#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "app/geometry/cloud_planes.h"
#include "app/geometry/point_index.h"

namespace pregrasp {

/// The height of a point above the surface of an oriented cloud near it [m]. Neighbours fall into
/// sheets, one for each plane, so that the two sides of an edge or of a thin wall are not averaged.
/// Two sheets that face one another bound a hollow, which is where the point is above both (the
/// smaller height counts); hollows and other sheets bound the solid together, which is where it is
/// below all (the largest counts).
class SurfaceHeight {
 public:
  explicit SurfaceHeight(const SampledCloud& cloud);

  double Calc(const Vector3& x);

 private:
  // Points around x whose planes face the same way, and what they say of it together.
  struct Sheet {
    Vector3 seed = Vector3::Zero();
    Vector3 seed_nhat = Vector3::UnitZ();
    double weight = 0.0;
    double height = 0.0;  // of x above the planes; sums until Finish
    Vector3 p = Vector3::Zero();
    Vector3 nhat = Vector3::Zero();

    void Finish() {
      height /= weight;
      p /= weight;
      nhat.normalize();
    }
  };

  static constexpr std::size_t kMaxSheets = 5;

  double Combine() const;
  void SplitIntoSheets(const Vector3& x);

  const SampledCloud& cloud_;
  double reach_;        // of the weights around x
  double least_share_;  // of the heaviest sheet's weight; less is a stray normal, likelier in noise
  PointIndex index_;
  std::vector<int> found_;
  std::vector<std::pair<double, int>> order_;  // found points by squared distance
  std::vector<Sheet> sheets_;
};

}  // namespace pregrasp
