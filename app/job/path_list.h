#pragma once

#include <map>
#include <memory>
#include <vector>

#include "app/graph/contact_path.h"

namespace pregrasp {

/// The paths of one connected graph, best first, for any number of stages. Remembers those that it
/// has found, so that asking again is free; what it answers depends on the graph alone. Not for
/// several threads at once.
class PathList {
 public:
  explicit PathList(std::shared_ptr<const ContactGraph> graph) : graph_(std::move(graph)) {}

  /// The path of `rank`, from 1; null beyond the last one. @throws InputError as PathSearch.
  std::shared_ptr<const ContactPath> Find(int stages, int rank);
  /// How many there are in all.
  double Count(int stages) { return SearchOf(stages).search.num_paths(); }

 private:
  struct Found {
    PathSearch search;
    std::vector<std::shared_ptr<const ContactPath>> paths;
  };
  Found& SearchOf(int stages);

  std::shared_ptr<const ContactGraph> graph_;
  std::map<int, Found> by_stages_;
};

}  // namespace pregrasp
