#include "app/graph/contact_path.h"

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

PathSearch::PathSearch(const ContactGraph& graph, int stages) : graph_(graph), stages_(stages) {
  if (graph.stage() != GraphStage::kConnected) {
    throw InputError("", "paths", "a graph that has been pruned", "one that has not");
  }
  if (stages < 1 || stages > 8) {
    throw InputError("", "stages", "a whole number from 1 to 8", std::to_string(stages));
  }
  const auto by_value = [](const Choice& a, const Choice& b) {
    return a.value != b.value ? a.value > b.value : a.node < b.node;
  };
  // best[v]: the largest sum of s_n over the stages that can follow v.
  std::vector<double> best(graph.nodes().size(), 0.0);
  after_.resize(stages - 1);
  for (int left = 0; left < stages - 1; ++left) {
    auto& options = after_[left];
    options.resize(graph.nodes().size());
    std::vector<double> better(best.size(), 0.0);
    for (const int id : graph.kept()) {
      for (const int next : graph.neighbors(id)) {
        options[id].push_back({next, graph.nodes()[next].s_n + best[next]});
      }
      std::sort(options[id].begin(), options[id].end(), by_value);
      better[id] = options[id].front().value;
    }
    best = better;
  }
  for (const int id : graph.kept()) {
    const ContactNode& node = graph.nodes()[id];
    if (node.initial) first_.push_back({id, node.s_c + best[id]});
  }
  std::sort(first_.begin(), first_.end(), by_value);
  if (!first_.empty()) heap_.push_back(Complete(std::vector<int>(stages, 0), 0));
}

bool PathSearch::IsWorse(const Candidate& a, const Candidate& b) {
  return a.score != b.score ? a.score < b.score : a.nodes > b.nodes;
}

const std::vector<PathSearch::Choice>& PathSearch::Options(int stage, int previous) const {
  return stage == 0 ? first_ : after_[stages_ - 1 - stage][previous];
}

double PathSearch::Term(int stage, int node) const {
  return stage == 0 ? graph_.nodes()[node].s_c : graph_.nodes()[node].s_n;
}

PathSearch::Candidate PathSearch::Complete(std::vector<int> ranks, int depth) const {
  Candidate candidate{0.0, std::move(ranks), {}, depth};
  for (int stage = 0; stage < stages_; ++stage) {
    const int previous = stage == 0 ? -1 : candidate.nodes.back();
    const int node = Options(stage, previous)[candidate.ranks[stage]].node;
    candidate.nodes.push_back(node);
    candidate.score += Term(stage, node);
  }
  return candidate;
}

bool PathSearch::Next(ContactPath* path) {
  if (heap_.empty()) return false;
  std::pop_heap(heap_.begin(), heap_.end(), IsWorse);
  const Candidate found = std::move(heap_.back());
  heap_.pop_back();
  // Every other path differs from this one first at some stage >= depth, by a higher rank there.
  for (int stage = found.depth; stage < stages_; ++stage) {
    const int previous = stage == 0 ? -1 : found.nodes[stage - 1];
    if (found.ranks[stage] + 1 >= static_cast<int>(Options(stage, previous).size())) continue;
    std::vector<int> ranks = found.ranks;
    ++ranks[stage];
    std::fill(ranks.begin() + stage + 1, ranks.end(), 0);
    heap_.push_back(Complete(std::move(ranks), stage));
    std::push_heap(heap_.begin(), heap_.end(), IsWorse);
  }
  path->nodes = found.nodes;
  path->score = found.score;
  path->terms.clear();
  for (int stage = 0; stage < stages_; ++stage) {
    path->terms.push_back(Term(stage, found.nodes[stage]));
  }
  path->rank = ++num_found_;
  return true;
}

double PathSearch::num_paths() const {
  std::vector<double> count(graph_.nodes().size(), 1.0);
  for (int stage = 1; stage < stages_; ++stage) {
    std::vector<double> longer(count.size(), 0.0);
    for (const int id : graph_.kept()) {
      for (const int next : graph_.neighbors(id)) longer[id] += count[next];
    }
    count = longer;
  }
  double total = 0.0;
  for (const Choice& choice : first_) total += count[choice.node];
  return total;
}

std::vector<ContactPath> FindSiblings(const ContactGraph& graph, const ContactPath& path,
                                      int count) {
  const bool one = path.nodes.size() == 1;
  std::vector<ContactPath> siblings;
  for (const int id : one ? graph.kept() : graph.neighbors(path.nodes[path.nodes.size() - 2])) {
    const ContactNode& node = graph.nodes()[id];
    if (one && !node.initial) continue;
    ContactPath sibling = path;
    sibling.rank = 0;
    sibling.nodes.back() = id;
    sibling.terms.back() = one ? node.s_c : node.s_n;
    const double lead = path.terms.back() - sibling.terms.back();
    if (lead < 0.0 || (lead == 0.0 && id <= path.nodes.back())) continue;
    sibling.score = path.score - lead;
    siblings.push_back(std::move(sibling));
  }
  std::stable_sort(siblings.begin(), siblings.end(),
                   [](const ContactPath& a, const ContactPath& b) { return a.score > b.score; });
  if (static_cast<int>(siblings.size()) > count) siblings.resize(count);
  return siblings;
}

}  // namespace pregrasp
