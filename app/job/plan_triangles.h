#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "app/graph/contact_graph.h"
#include "app/trajectory/mppi.h"

namespace pregrasp {

/// The triangle of each planning finger in each of a plan's stages: that of the path's state, the
/// last of which stands for further stages, which a plan made by hand may have. A finger that is
/// kept stays on its triangle, whichever the next state has.
/// @param stages  of a RelativePlan or a WorldPlan.
template <typename Stages>
std::vector<std::array<int, kNumPlanningFingers>> TrianglesOf(const Mppi& mppi,
                                                              const Stages& stages) {
  const std::vector<int>& path = mppi.problem().path.nodes;
  std::vector<std::array<int, kNumPlanningFingers>> triangles;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const ContactNode& node = mppi.problem().graph->nodes().at(path[std::min(i, path.size() - 1)]);
    std::array<int, kNumPlanningFingers> own{node.thumb, node.index};
    for (std::size_t f = 0; f < own.size(); ++f) {
      if (stages[i][f].kept) own[f] = triangles.back()[f];
    }
    triangles.push_back(own);
  }
  return triangles;
}

}  // namespace pregrasp
