#pragma once

#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "app/graph/path_explorer.h"

namespace pregrasp {

/// The paths of one connected graph, in either order, for any number of stages. Remembers those
/// that it has found, so that asking again is free; what it answers depends on the graph alone. Not
/// for several threads at once.
class PathList {
 public:
  explicit PathList(std::shared_ptr<const ContactGraph> graph) : graph_(std::move(graph)) {}

  /// The path of `rank`, from 1; null beyond the last one. @throws InputError as PathSearch.
  std::shared_ptr<const ContactPath> Find(PathOrder order, int stages, int rank);
  /// How many there are in all.
  double Count(PathOrder order, int stages);

 private:
  struct Found {
    std::variant<PathSearch, PathExplorer> search;
    std::vector<std::shared_ptr<const ContactPath>> paths;
  };
  Found& SearchOf(PathOrder order, int stages);

  std::shared_ptr<const ContactGraph> graph_;
  std::map<std::pair<PathOrder, int>, Found> found_;
};

}  // namespace pregrasp
