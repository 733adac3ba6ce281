#include "app/graph/path_explorer.h"

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

// The axis of O that a triangle's normal is nearest to: 0 to 5 for +x, -x, +y, ..
int SideOf(const TriangleMesh& mesh, int t) {
  const Vector3 a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                c = mesh.V.row(mesh.F(t, 2));
  const Vector3 normal = (b - a).cross(c - a);
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * static_cast<int>(axis) + (normal[axis] < 0.0 ? 1 : 0);
}

bool Fits(const ContactNode& node) { return node.thumb_fits || node.index_fits; }

int CountOf(const std::map<int, int>& counts, int key) {
  const auto found = counts.find(key);
  return found == counts.end() ? 0 : found->second;
}

int CountOf(const std::map<std::pair<int, int>, int>& counts, int finger, int key) {
  const auto found = counts.find({finger, key});
  return found == counts.end() ? 0 : found->second;
}

}  // namespace

PathExplorer::PathExplorer(const ContactGraph& graph, int stages)
    : graph_(graph), stages_(stages), used_(graph.nodes().size()), later_(stages) {
  if (graph.stage() != GraphStage::kConnected) {
    throw InputError("", "paths", "a graph that has been pruned", "one that has not");
  }
  PREGRASP_CHECK(stages >= 1, stages);
  for (int t = 0; t < graph.num_triangles(); ++t) sides_.push_back(SideOf(graph.mesh(), t));
  for (const ContactNode& node : graph.nodes()) {
    num_first_ += Fits(node);
    if (Fits(node)) best_c_ = std::max(best_c_, node.s_c);
    best_n_ = std::max(best_n_, node.s_n);
  }
}

std::vector<PathExplorer::Lead> PathExplorer::Leads(const ContactNode& node) const {
  std::vector<Lead> leads;
  if (node.thumb_fits) leads.push_back({0, node.thumb, sides_[node.thumb]});
  if (node.index_fits) leads.push_back({1, node.index, sides_[node.index]});
  return leads;
}

double PathExplorer::CountRepeats(const ContactNode& node) const {
  double repeats = 0.0;
  for (const Lead& lead : Leads(node)) {
    repeats += CountOf(triangles_, lead.finger, lead.triangle) +
               0.5 * CountOf(side_counts_, lead.finger, lead.side);
  }
  return repeats;
}

double PathExplorer::ValueOf(const ContactNode& first) const {
  const double share = best_c_ > 0.0 ? first.s_c / best_c_ : 0.0;
  return std::max(kLeastScore, share) / (1.0 + CountRepeats(first));
}

int PathExplorer::FindLater(int previous, std::size_t stage) const {
  const std::vector<ContactNode>& nodes = graph_.nodes();
  const ContactNode& before = nodes[previous];
  int best = -1;
  double best_value = 0.0;
  const auto offer = [&](int id) {
    const ContactNode& node = nodes[id];
    const double share = best_n_ > 0.0 ? node.s_n / best_n_ : 0.0;
    const double offered = (Fits(node) ? 1.0 : 0.0) +
                           std::max(kLeastScore, share) / (1.0 + 0.25 * CountOf(later_[stage], id));
    const bool better = best < 0 || offered > best_value ||
                        (offered == best_value && node.rank_n < nodes[best].rank_n);
    if (!better) return;
    best = id;
    best_value = offered;
  };
  offer(previous);
  for (const int id : graph_.kept()) {
    if (nodes[id].thumb == before.thumb || nodes[id].index == before.index) offer(id);
  }
  return best;
}

void PathExplorer::Remember(const ContactPath& path) {
  const ContactNode& first = graph_.nodes()[path.nodes.front()];
  used_[first.id] = true;
  for (const Lead& lead : Leads(first)) {
    ++triangles_[{lead.finger, lead.triangle}];
    ++side_counts_[{lead.finger, lead.side}];
  }
  for (std::size_t stage = 1; stage < path.nodes.size(); ++stage)
    ++later_[stage][path.nodes[stage]];
}

bool PathExplorer::Next(ContactPath* path) {
  const std::vector<ContactNode>& nodes = graph_.nodes();
  std::vector<const ContactNode*> tied;  // those of the highest value, by number
  double value = 0.0;
  for (const ContactNode& node : nodes) {
    if (!Fits(node) || used_[node.id]) continue;
    const double offered = ValueOf(node);
    if (offered > value) tied.clear();
    if (offered >= value) tied.push_back(&node);
    value = std::max(value, offered);
  }
  if (tied.empty()) return false;
  const ContactNode& first = **std::min_element(
      tied.begin(), tied.end(),
      [](const ContactNode* a, const ContactNode* b) { return a->rank_c < b->rank_c; });
  *path = {};
  path->value = value;
  path->repeats = CountRepeats(first);
  path->num_tied = std::min(static_cast<int>(tied.size()), kMostTied);
  for (const ContactNode* other : tied) {
    if (other == &first) continue;
    const bool alike = other->s_c == first.s_c && other->s_n == first.s_n;
    path->rule = std::max(path->rule, alike ? TieRule::kNumber : TieRule::kScores);
  }
  path->nodes = {first.id};
  path->terms = {first.s_c};
  for (int stage = 1; stage < stages_; ++stage) {
    path->nodes.push_back(FindLater(path->nodes.back(), stage));
    path->terms.push_back(nodes[path->nodes.back()].s_n);
  }
  for (auto term = path->terms.rbegin(); term != path->terms.rend(); ++term) path->score += *term;
  Remember(*path);
  path->rank = ++num_found_;
  return true;
}

}  // namespace pregrasp
