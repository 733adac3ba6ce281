#pragma once

#include "app/core/rng.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Points on a surface with outward unit normals, in the shape's frame (both #points x 3).
struct PointCloud {
  MatrixX3 P;
  MatrixX3 N;
};

/// `count` points spread evenly over the outer surface of `shape`: area-weighted candidates,
/// thinned by farthest-point sampling. Points inside another part of a union are left out. A Cloud
/// shape samples its reconstruction.
PointCloud SamplePointCloud(const Shape& shape, int count, Rng rng);

}  // namespace pregrasp
