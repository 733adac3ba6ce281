#pragma once

#include <cstdint>
#include <string>

#include "app/geometry/bounds.h"
#include "app/training/make_item.h"

namespace pregrasp {

/// An item's object with nothing around it, turned at random as in training.
struct FreeObject {
  FreeObject(const ItemConfig& config, std::int64_t index);

  std::string name, family;
  PointCloud cloud;
  AlignedBox box;  ///< of the cloud, in O
  Scene scene;
};

}  // namespace pregrasp
