#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/training/make_item.h"

namespace pregrasp {

/// Objects to judge networks by; null for random members of ObjectFamilies().
using LearningObjects = std::shared_ptr<const std::vector<TrainingObject>>;

/// Of items that no data set has.
ItemConfig MakeUnseenItems(const LearningObjects& objects, std::uint64_t seed);

/// An item's object with nothing around it, turned at random as in training.
struct FreeObject {
  FreeObject(const ItemConfig& config, std::int64_t index);

  std::string name, family;
  PointCloud cloud;
  AlignedBox box;  ///< of the cloud, in O
  Scene scene;
};

}  // namespace pregrasp
