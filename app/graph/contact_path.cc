#include "app/graph/contact_path.h"

#include <algorithm>
#include <iterator>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

namespace {

double TermAt(const ContactNode& node, std::size_t stage) {
  return stage == 0 ? node.s_c : node.s_n;
}

int RankAt(const ContactNode& node, std::size_t stage) {
  return stage == 0 ? node.rank_c : node.rank_n;
}

// From the last stage on, as best completions are added up: the sums of two paths that share their
// first nodes are then in the order of what differs, whatever is rounded.
double SumFromLast(const std::vector<double>& terms) {
  double sum = 0.0;
  for (auto term = terms.rbegin(); term != terms.rend(); ++term) sum = *term + sum;
  return sum;
}

std::size_t FirstDifference(const ContactPath& a, const ContactPath& b) {
  return std::mismatch(a.nodes.begin(), a.nodes.end(), b.nodes.begin()).first - a.nodes.begin();
}

// Of two different paths.
bool ComesBefore(const ContactGraph& graph, const ContactPath& a, const ContactPath& b) {
  if (a.score != b.score) return a.score > b.score;
  const std::size_t stage = FirstDifference(a, b);
  return RankAt(graph.nodes()[a.nodes[stage]], stage) <
         RankAt(graph.nodes()[b.nodes[stage]], stage);
}

TieRule FindRule(const ContactGraph& graph, const ContactPath& a, const ContactPath& b) {
  if (a.score != b.score) return TieRule::kNone;
  const std::size_t stage = FirstDifference(a, b);
  const ContactNode& node = graph.nodes()[a.nodes[stage]];
  const ContactNode& other = graph.nodes()[b.nodes[stage]];
  return node.s_c != other.s_c || node.s_n != other.s_n ? TieRule::kScores : TieRule::kNumber;
}

}  // namespace

const char* PathOrderName(PathOrder order) {
  return order == PathOrder::kPaper ? "paper" : "explore";
}

PathSearch::PathSearch(const ContactGraph& graph, int stages) : graph_(graph), stages_(stages) {
  if (graph.stage() != GraphStage::kConnected) {
    throw InputError("", "paths", "a graph that has been pruned", "one that has not");
  }
  PREGRASP_CHECK(stages >= 1, stages);
  const auto sort = [&](std::vector<Choice>& choices, std::size_t stage) {
    std::sort(choices.begin(), choices.end(), [&](const Choice& a, const Choice& b) {
      if (a.value != b.value) return a.value > b.value;
      return RankAt(graph.nodes()[a.node], stage) < RankAt(graph.nodes()[b.node], stage);
    });
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
      sort(options[id], 1);
      better[id] = options[id].front().value;
    }
    best = better;
  }
  for (const int id : graph.kept()) {
    const ContactNode& node = graph.nodes()[id];
    if (node.initial) first_.push_back({id, node.s_c + best[id]});
  }
  sort(first_, 0);
  if (!first_.empty()) heap_.push_back(Complete(std::vector<int>(stages, 0), 0));
}

bool PathSearch::IsWorse(const Candidate& a, const Candidate& b) {
  return a.score != b.score ? a.score < b.score : a.ranks > b.ranks;
}

const std::vector<PathSearch::Choice>& PathSearch::Options(int stage, int previous) const {
  return stage == 0 ? first_ : after_[stages_ - 1 - stage][previous];
}

PathSearch::Candidate PathSearch::Complete(std::vector<int> ranks, int depth) const {
  Candidate candidate{0.0, std::move(ranks), {}, depth};
  std::vector<double> terms;
  for (int stage = 0; stage < stages_; ++stage) {
    const int previous = stage == 0 ? -1 : candidate.nodes.back();
    const int node = Options(stage, previous)[candidate.ranks[stage]].node;
    candidate.nodes.push_back(node);
    terms.push_back(TermAt(graph_.nodes()[node], stage));
  }
  candidate.score = SumFromLast(terms);
  return candidate;
}

PathSearch::Candidate PathSearch::PopBest() {
  std::pop_heap(heap_.begin(), heap_.end(), IsWorse);
  Candidate found = std::move(heap_.back());
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
  return found;
}

bool PathSearch::FindTied() {
  if (heap_.empty()) return false;
  const double score = heap_.front().score;
  while (!heap_.empty() && heap_.front().score == score &&
         static_cast<int>(tied_.size()) < kMostTied) {
    ContactPath path;
    path.nodes = PopBest().nodes;
    path.score = path.value = score;
    for (std::size_t stage = 0; stage < path.nodes.size(); ++stage) {
      path.terms.push_back(TermAt(graph_.nodes()[path.nodes[stage]], stage));
    }
    tied_.push_back(std::move(path));
  }
  std::sort(tied_.begin(), tied_.end(),
            [&](const ContactPath& a, const ContactPath& b) { return ComesBefore(graph_, b, a); });
  const bool more = score == last_score_ || (!heap_.empty() && heap_.front().score == score);
  for (std::size_t i = 0; i < tied_.size(); ++i) {
    tied_[i].num_tied = more ? kMostTied : static_cast<int>(tied_.size());
    if (i == 0) continue;
    const TieRule rule = FindRule(graph_, tied_[i - 1], tied_[i]);
    tied_[i - 1].rule = std::max(tied_[i - 1].rule, rule);
    tied_[i].rule = rule;
  }
  last_score_ = score;
  return true;
}

bool PathSearch::Next(ContactPath* path) {
  if (tied_.empty() && !FindTied()) return false;
  *path = std::move(tied_.back());
  tied_.pop_back();
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
  const std::size_t last = path.nodes.size() - 1;
  std::vector<ContactPath> siblings;
  int num_tied = 1;  // with `path`
  for (const int id : last == 0 ? graph.kept() : graph.neighbors(path.nodes[last - 1])) {
    const ContactNode& node = graph.nodes()[id];
    if ((last == 0 && !node.initial) || id == path.nodes[last]) continue;
    ContactPath sibling = path;
    sibling.rank = 0;
    sibling.nodes[last] = id;
    sibling.terms[last] = TermAt(node, last);
    sibling.score = SumFromLast(sibling.terms);
    sibling.rule = FindRule(graph, path, sibling);
    num_tied += sibling.score == path.score;
    if (ComesBefore(graph, path, sibling)) siblings.push_back(std::move(sibling));
  }
  std::sort(siblings.begin(), siblings.end(),
            [&](const ContactPath& a, const ContactPath& b) { return ComesBefore(graph, a, b); });
  for (auto begin = siblings.begin(); begin != siblings.end();) {
    const double score = begin->score;
    const auto end = std::find_if(begin, siblings.end(), [score](const ContactPath& sibling) {
      return sibling.score != score;
    });
    const int tied = score == path.score ? num_tied : static_cast<int>(end - begin);
    for (; begin != end; ++begin) begin->num_tied = std::min(tied, kMostTied);
  }
  if (static_cast<int>(siblings.size()) > count) siblings.resize(count);
  return siblings;
}

}  // namespace pregrasp
