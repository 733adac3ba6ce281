#include "app/job/path_list.h"

#include "app/core/error.h"

namespace pregrasp {

PathList::Found& PathList::SearchOf(PathOrder order, int stages) {
  const std::pair key(order, stages);
  const auto known = found_.find(key);
  if (known != found_.end()) return known->second;
  Found found = order == PathOrder::kPaper ? Found{PathSearch(*graph_, stages), {}}
                                           : Found{PathExplorer(*graph_, stages), {}};
  return found_.emplace(key, std::move(found)).first->second;
}

double PathList::Count(PathOrder order, int stages) {
  return std::visit([](const auto& search) { return search.num_paths(); },
                    SearchOf(order, stages).search);
}

std::shared_ptr<const ContactPath> PathList::Find(PathOrder order, int stages, int rank) {
  constexpr int kMostPaths = 100000;
  if (rank < 1 || rank > kMostPaths) {
    throw InputError("", "rank", "a whole number from 1 to 100000", std::to_string(rank));
  }
  Found& found = SearchOf(order, stages);
  ContactPath path;
  const auto next = [&] {
    return std::visit([&](auto& search) { return search.Next(&path); }, found.search);
  };
  while (static_cast<int>(found.paths.size()) < rank && next()) {
    found.paths.push_back(std::make_shared<const ContactPath>(path));
  }
  return static_cast<int>(found.paths.size()) < rank ? nullptr : found.paths[rank - 1];
}

}  // namespace pregrasp
