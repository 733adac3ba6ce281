#include "app/graph/contact_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/finite.h"
#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

// Contacts of one finger on one triangle: drawn once, used by every node with that triangle.
struct TriangleSamples {
  std::vector<Placement::Contact> contacts;
  std::vector<bool> occluded;  // by the surroundings or by the object itself
  std::vector<bool> enclosed;  // by the latter
  bool fits = false;           // at one of these, or of kFitSamples others
};

std::vector<TriangleSamples> SampleTriangles(Finger finger, const TriangleMesh& mesh, int samples,
                                             const SignedDistance& shape,
                                             const PlacementScorer& context, std::uint64_t seed) {
  std::vector<TriangleSamples> all(mesh.F.rows());
  const auto draw = [&](int t, Rng& rng) {
    const double u = rng.Uniform();
    const double v = rng.Uniform();
    return ContactOnTriangle(mesh, t, BarycentricFromSquare(u, v), shape);
  };
  for (int t = 0; t < static_cast<int>(all.size()); ++t) {
    ThrowIfInterrupted();
    Rng rng(seed, RngStream::kGraphSamples, static_cast<int>(finger), t);
    for (int s = 0; s < samples; ++s) {
      const Placement::Contact contact = draw(t, rng);
      all[t].contacts.push_back(contact);
      all[t].enclosed.push_back(!HasRoom(context.tips().radius(finger), contact, shape));
      all[t].occluded.push_back(all[t].enclosed.back() || context.IsOccluded(finger, contact));
      all[t].fits = all[t].fits || !all[t].occluded.back();
    }
    for (int s = 0; s < kFitSamples && !all[t].fits; ++s) {
      const Placement::Contact contact = draw(t, rng);
      all[t].fits = HasRoom(context.tips().radius(finger), contact, shape) &&
                    !context.IsOccluded(finger, contact);
    }
  }
  return all;
}

Placement PlaceOne(Finger finger, const Placement::Contact& contact) {
  Placement placement;
  placement.fingers[static_cast<int>(finger)] = contact;
  return placement;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double CountOccluded(const TriangleSamples& samples) {
  return static_cast<double>(std::count(samples.occluded.begin(), samples.occluded.end(), true));
}

// The sampled contacts of both fingers, by triangle, and what every node's scores are made from.
class NodeSampler {
 public:
  NodeSampler(const TriangleMesh& mesh, const ContactGraphConfig& config,
              const SignedDistance& shape, const PlacementScorer& context, std::uint64_t seed)
      : config_(config), context_(context) {
    for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
      samples_[static_cast<int>(finger)] =
          SampleTriangles(finger, mesh, config.samples, shape, context, seed);
    }
  }

  // Mean scores of one finger alone, by triangle.
  std::vector<double> ScoreAlone(Finger finger, const PlacementScorer& scorer) const {
    const auto& triangles = samples_[static_cast<int>(finger)];
    std::vector<double> means;
    for (const TriangleSamples& triangle : triangles) {
      ThrowIfInterrupted();
      std::vector<Placement> placements;
      for (const auto& contact : triangle.contacts) {
        placements.push_back(PlaceOne(finger, contact));
      }
      std::vector<double> scores = scorer.Score(placements);
      ClearOccluded(scorer, triangle, triangle, scores);
      means.push_back(Mean(scores));
    }
    return means;
  }

  // Mean scores of both fingers for the nodes of one thumb triangle, by index triangle.
  std::vector<double> ScoreBoth(int thumb, const PlacementScorer& scorer) const {
    const auto& indices = samples_[1];
    std::vector<Placement> placements;
    for (const TriangleSamples& index : indices) {
      for (int s = 0; s < config_.samples; ++s) {
        Placement placement = PlaceOne(Finger::kIndex, index.contacts[s]);
        placement.fingers[0] = samples_[0][thumb].contacts[s];
        placements.push_back(placement);
      }
    }
    const std::vector<double> all = scorer.Score(placements);
    PREGRASP_CHECK(all.size() == placements.size(), all.size(), placements.size());
    std::vector<double> means;
    for (std::size_t index = 0; index < indices.size(); ++index) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(index * config_.samples);
      std::vector<double> scores(begin, begin + config_.samples);
      for (int s = 0; s < config_.samples; ++s) {
        const Placement& placement = placements[index * config_.samples + s];
        if (!(CalcTipGap(scorer.tips(), placement) >= 0.0)) scores[s] = 0.0;
      }
      ClearOccluded(scorer, samples_[0][thumb], indices[index], scores);
      means.push_back(Mean(scores));
    }
    return means;
  }

  bool Fits(Finger finger, int triangle) const {
    return samples_[static_cast<int>(finger)][triangle].fits;
  }

  double OccludedShare(int thumb, int index) const {
    return (CountOccluded(samples_[0][thumb]) + CountOccluded(samples_[1][index])) /
           (2.0 * config_.samples);
  }

 private:
  // A fingertip that cannot be where it is asked to be is worth nothing; what is around the object
  // counts in context only.
  void ClearOccluded(const PlacementScorer& scorer, const TriangleSamples& a,
                     const TriangleSamples& b, std::vector<double>& scores) const {
    std::vector<bool> TriangleSamples::*const blocked =
        &scorer == &context_ ? &TriangleSamples::occluded : &TriangleSamples::enclosed;
    for (int s = 0; s < config_.samples; ++s) {
      if ((a.*blocked)[s] || (b.*blocked)[s]) scores[s] = 0.0;
    }
  }

  const ContactGraphConfig& config_;
  const PlacementScorer& context_;
  std::array<std::vector<TriangleSamples>, kNumPlanningFingers> samples_;
};

void RequireShare(double top_percent) {
  PREGRASP_CHECK(top_percent > 0.0 && top_percent <= 100.0, top_percent);
}

// Node ids from the best `score` to the worst; of equal ones by the `other` score, then by id.
std::vector<int> OrderBy(const std::vector<ContactNode>& nodes, double ContactNode::*score,
                         double ContactNode::*other) {
  std::vector<int> order(nodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
    const ContactNode &a = nodes[i], &b = nodes[j];
    return a.*score != b.*score ? a.*score > b.*score : a.*other > b.*other;
  });
  return order;
}

// Of two nodes of which one is in the top M percent by `score` and the other is not.
TieRule FindRule(const ContactNode& a, const ContactNode& b, double ContactNode::*score) {
  if (a.*score != b.*score) return TieRule::kNone;
  return a.s_c != b.s_c || a.s_n != b.s_n ? TieRule::kScores : TieRule::kNumber;
}

}  // namespace

ContactGraph::ContactGraph(TriangleMesh mesh, const ContactGraphConfig& config)
    : mesh_(std::move(mesh)), config_(config) {
  PREGRASP_CHECK(config.samples >= 1, config.samples);
  RequireShare(config.top_percent);
  const int count = num_triangles();
  nodes_.reserve(static_cast<std::size_t>(count) * count);
  for (int thumb = 0; thumb < count; ++thumb) {
    for (int index = 0; index < count; ++index) {
      ContactNode node;
      node.id = thumb * count + index;
      node.thumb = thumb;
      node.index = index;
      nodes_.push_back(node);
    }
  }
}

void ContactGraph::Score(const SignedDistance& shape, const PlacementScorer& context,
                         const PlacementScorer& free, std::uint64_t seed) {
  const NodeSampler sampler(mesh_, config_, shape, context, seed);
  const auto thumb_c = sampler.ScoreAlone(Finger::kThumb, context);
  const auto thumb_n = sampler.ScoreAlone(Finger::kThumb, free);
  const auto index_c = sampler.ScoreAlone(Finger::kIndex, context);
  const auto index_n = sampler.ScoreAlone(Finger::kIndex, free);
  for (int thumb = 0; thumb < num_triangles(); ++thumb) {
    ThrowIfInterrupted();
    const auto both_c = sampler.ScoreBoth(thumb, context);
    const auto both_n = sampler.ScoreBoth(thumb, free);
    for (int index = 0; index < num_triangles(); ++index) {
      ContactNode& node = nodes_[thumb * num_triangles() + index];
      node.s_c = (thumb_c[thumb] + index_c[index] + both_c[index]) / 3.0;
      node.s_n = (thumb_n[thumb] + index_n[index] + both_n[index]) / 3.0;
      node.occluded = sampler.OccludedShare(thumb, index);
      node.thumb_fits = sampler.Fits(Finger::kThumb, thumb);
      node.index_fits = sampler.Fits(Finger::kIndex, index);
      PREGRASP_CHECK(AreFinite(node.s_c, node.s_n, node.occluded), node.id);
    }
  }
  RankNodes();
}

void ContactGraph::TakeScores(const Scores& scores) {
  for (const std::vector<double>* values : {&scores.s_c, &scores.s_n, &scores.occluded}) {
    if (values->size() != nodes_.size()) {
      throw InputError("", "scores", fmt::format("one for each of {} nodes", nodes_.size()),
                       std::to_string(values->size()));
    }
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].s_c = scores.s_c[i];
    nodes_[i].s_n = scores.s_n[i];
    nodes_[i].occluded = scores.occluded[i];
    nodes_[i].thumb_fits = nodes_[i].index_fits = true;
  }
  RankNodes();
}

void ContactGraph::RankNodes() {
  order_c_ = OrderBy(nodes_, &ContactNode::s_c, &ContactNode::s_n);
  order_n_ = OrderBy(nodes_, &ContactNode::s_n, &ContactNode::s_c);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[order_c_[i]].rank_c = static_cast<int>(i) + 1;
    nodes_[order_n_[i]].rank_n = static_cast<int>(i) + 1;
    nodes_[i].initial = nodes_[i].kept = false;
  }
  kept_.clear();
  neighbors_.clear();
  stage_ = GraphStage::kScored;
}

int ContactGraph::NumKeptEach() const {
  const double share = config_.top_percent / 100.0 * static_cast<double>(nodes_.size());
  return std::clamp(static_cast<int>(std::ceil(share - 1e-9)), 1, static_cast<int>(nodes_.size()));
}

void ContactGraph::SetTopPercent(double top_percent) {
  if (num_prune_steps_ > 0) {
    throw InputError("", "top_percent", "a graph that is not pruned yet", "one that is");
  }
  RequireShare(top_percent);
  config_.top_percent = top_percent;
}

bool ContactGraph::PruneStep(int nodes) {
  PREGRASP_CHECK(stage_ != GraphStage::kMeshed && nodes >= 1, nodes);
  if (stage_ == GraphStage::kConnected) return false;
  const bool connect = stage_ == GraphStage::kPrunedFree;
  const int total = connect ? static_cast<int>(kept_.size()) : NumKeptEach();
  const int end = std::min(total, num_done_ + std::min(nodes, total));
  if (connect) neighbors_.resize(nodes_.size());
  for (int i = num_done_; i < end; ++i) {
    switch (stage_) {
      case GraphStage::kScored:
        nodes_[order_c_[i]].initial = nodes_[order_c_[i]].kept = true;
        break;
      case GraphStage::kPrunedContext:
        nodes_[order_n_[i]].kept = true;
        break;
      default:
        ConnectNode(kept_[i]);
    }
  }
  num_done_ = end;
  ++num_prune_steps_;
  if (!connect) {
    kept_.clear();
    for (const ContactNode& node : nodes_) {
      if (node.kept) kept_.push_back(node.id);
    }
  }
  if (num_done_ == total) {
    stage_ = static_cast<GraphStage>(static_cast<int>(stage_) + 1);
    num_done_ = 0;
  }
  return true;
}

void ContactGraph::ConnectNode(int a) {
  for (const int b : kept_) {
    if (nodes_[a].thumb == nodes_[b].thumb || nodes_[a].index == nodes_[b].index) {
      neighbors_[a].push_back(b);
    }
  }
}

void ContactGraph::Prune() {
  if (stage_ == GraphStage::kMeshed) {
    throw InputError("", "prune", "a graph that has been scored", "one without scores");
  }
  while (PruneStep()) {
  }
}

const std::vector<int>& ContactGraph::neighbors(int id) const {
  PREGRASP_CHECK(stage_ == GraphStage::kConnected, static_cast<int>(stage_));
  return neighbors_.at(id);
}

int ContactGraph::num_edges() const {
  if (stage_ != GraphStage::kConnected) return 0;
  int count = 0;
  for (const std::vector<int>& ids : neighbors_) count += static_cast<int>(ids.size());
  // Each edge between two nodes is in both lists, each loop in one.
  return (count + static_cast<int>(kept_.size())) / 2;
}

void ContactGraph::ExplainCut(const std::vector<int>& order, double ContactNode::*score, int rank,
                              double* threshold, int* num_tied, TieRule* rule) const {
  const int count = NumKeptEach();
  const ContactNode& last = nodes_[order[count - 1]];
  *threshold = last.*score;
  *num_tied =
      static_cast<int>(std::count_if(nodes_.begin(), nodes_.end(), [&](const ContactNode& node) {
        return node.*score == last.*score;
      }));
  if (rank > count) {
    *rule = FindRule(nodes_[order[rank - 1]], last, score);
  } else if (count < static_cast<int>(order.size())) {
    *rule = FindRule(nodes_[order[rank - 1]], nodes_[order[count]], score);
  }
}

NodeReason ContactGraph::Why(int id) const {
  if (id < 0 || id >= static_cast<int>(nodes_.size())) {
    throw InputError("", "node", "an id from 0 to " + std::to_string(nodes_.size() - 1),
                     std::to_string(id));
  }
  NodeReason reason;
  reason.node = nodes_[id];
  reason.num_nodes = static_cast<int>(nodes_.size());
  if (stage_ == GraphStage::kMeshed) return reason;
  reason.num_kept_each = NumKeptEach();
  ExplainCut(order_c_, &ContactNode::s_c, reason.node.rank_c, &reason.threshold_c,
             &reason.num_tied_c, &reason.rule_c);
  ExplainCut(order_n_, &ContactNode::s_n, reason.node.rank_n, &reason.threshold_n,
             &reason.num_tied_n, &reason.rule_n);
  // As far as the pruning has come.
  const bool context_done = stage_ >= GraphStage::kPrunedContext;
  const bool free_done = stage_ >= GraphStage::kPrunedFree;
  const int best_c = context_done ? reason.num_kept_each : num_done_;
  const int best_n = free_done ? reason.num_kept_each : context_done ? num_done_ : 0;
  const bool by_context = reason.node.rank_c <= best_c, by_free = reason.node.rank_n <= best_n;
  using Verdict = NodeReason::Verdict;
  reason.verdict = by_context && by_free ? Verdict::kKeptByBoth
                   : by_context          ? Verdict::kKeptByContext
                   : by_free             ? Verdict::kKeptByFree
                   : free_done           ? Verdict::kPruned
                                         : Verdict::kScored;
  return reason;
}

}  // namespace pregrasp
