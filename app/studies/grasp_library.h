#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/core/thread_pool.h"
#include "app/grasp/grasp_completion.h"
#include "app/training/make_item.h"

namespace pregrasp {

/// Feasible grasps of random objects in free space, found by search: what a generator without
/// networks answers from, by the nearest neighbour.
class GraspLibrary {
 public:
  /// @param families  of ObjectFamilies(), of each its members 0 to `members` - 1.
  GraspLibrary(const std::vector<std::string>& families, int members, std::uint64_t seed,
               ThreadPool& pool);

  int num_grasps() const;

  /// Of the object whose box is the most like `box`, the grasps whose thumb and index are nearest
  /// to `given`, moved and stretched with the box, the nearest first; at most `count`. The contacts
  /// given stay where they are.
  std::vector<GraspPoints> FindNearest(const AlignedBox& box, const PlanningContacts& given,
                                       int count) const;

 private:
  struct KnownObject {
    AlignedBox box;  ///< of its cloud, in O
    std::vector<std::vector<GraspContact>> grasps;
  };
  std::vector<KnownObject> objects_;  ///< with at least one grasp
};

}  // namespace pregrasp
