#include "app/job/path_list.h"

#include "app/core/error.h"

namespace pregrasp {

PathList::Found& PathList::SearchOf(int stages) {
  const auto known = by_stages_.find(stages);
  if (known != by_stages_.end()) return known->second;
  return by_stages_.emplace(stages, Found{PathSearch(*graph_, stages), {}}).first->second;
}

std::shared_ptr<const ContactPath> PathList::Find(int stages, int rank) {
  constexpr int kMostPaths = 100000;
  if (rank < 1 || rank > kMostPaths) {
    throw InputError("", "rank", "a whole number from 1 to 100000", std::to_string(rank));
  }
  Found& found = SearchOf(stages);
  ContactPath path;
  while (static_cast<int>(found.paths.size()) < rank && found.search.Next(&path)) {
    found.paths.push_back(std::make_shared<const ContactPath>(path));
  }
  return static_cast<int>(found.paths.size()) < rank ? nullptr : found.paths[rank - 1];
}

}  // namespace pregrasp
