#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "app/core/rng.h"
#include "app/graph/placement.h"

namespace pregrasp {

struct ContactGraphConfig {
  /// Fingertip placements drawn for each of thumb only, index only and both (the paper's five).
  int samples = 5;
  /// The paper's M: a node is kept if it is in the top M percent by s_c or by s_n.
  double top_percent = 5.0;
};

/// How far Algorithm 1 of the paper has come on a graph.
enum class GraphStage {
  kMeshed,         ///< nodes exist, without scores
  kScored,         ///< s_c and s_n are known
  kPrunedContext,  ///< V_c chosen by s_c
  kPrunedFree,     ///< and the others by s_n
  kConnected,      ///< edges built: the graph is complete
};

/// A contact state: the thumb somewhere on one triangle, the index finger on another (or the same).
struct ContactNode {
  int id = 0;  ///< thumb * #triangles + index; never changes
  int thumb = 0, index = 0;
  double s_c = 0.0;  ///< mean score in the context of the surroundings
  double s_n = 0.0;  ///< mean score without surroundings
  int rank_c = 0;    ///< 1 is the best by s_c; of equal ones by s_n, then by id
  int rank_n = 0;    ///< 1 is the best by s_n; of equal ones by s_c, then by id
  double occluded =
      0.0;  ///< share of the sampled contacts where a fingertip cannot be at the start
  /// Whether the finger's tip can be anywhere on its triangle with every body at its start, of
  /// kFitSamples places there: the graph knows this from its scores on.
  bool thumb_fits = false, index_fits = false;
  bool initial = false;  ///< in V_c: may start a path
  bool kept = false;     ///< in V
};

/// Places on a triangle at which a fingertip is tried.
inline constexpr int kFitSamples = 32;

/// What decided between nodes, or paths, of exactly equal score. Equal s_c are common: wherever the
/// thumb's triangle is out of reach of any fingertip, all its nodes score by the index alone.
enum class TieRule {
  kNone,    ///< the scores differ
  kScores,  ///< nodes: the other of s_c and s_n; paths: the ranks of the first nodes that differ
  kNumber,  ///< these are equal too: the lower id, which means nothing
};

/// Why a node is in the graph or not: the numbers that decided.
struct NodeReason {
  enum class Verdict {
    kNotScored,
    kScored,  ///< the pruning has not come so far as to decide
    kKeptByContext,
    kKeptByFree,
    kKeptByBoth,
    kPruned
  };
  Verdict verdict = Verdict::kNotScored;
  ContactNode node;
  int num_nodes = 0;
  int num_kept_each = 0;     ///< how many nodes the top M percent are
  double threshold_c = 0.0;  ///< the lowest s_c among the top M percent by s_c
  double threshold_n = 0.0;  ///< the lowest s_n among the top M percent by s_n
  int num_tied_c = 0;        ///< nodes whose s_c is exactly threshold_c, whichever side they are on
  int num_tied_n = 0;        ///< nodes whose s_n is exactly threshold_n
  /// What sets this node apart from the nearest one on the other side of the cut by s_c, by s_n.
  TieRule rule_c = TieRule::kNone, rule_n = TieRule::kNone;
};

/// The contact-state graph (paper, section "Contact state graph", Algorithm 1) as a value. Each
/// function below takes it one step further, so that a copy is a point in time to come back to.
class ContactGraph {
 public:
  /// What scoring finds out, by node, for TakeScores.
  struct Scores {
    std::vector<double> s_c, s_n, occluded;
  };

  /// All ordered pairs of triangles of `mesh` as nodes, without scores.
  ContactGraph(TriangleMesh mesh, const ContactGraphConfig& config);

  /// Draws `samples` placements a scenario on each node and takes the mean scores: s_c by `context`
  /// (surroundings at the start, occluded points removed; an occluded placement scores 0), s_n by
  /// `free` (no surroundings). The placements of one finger alone are shared by all nodes with that
  /// triangle. @param shape  the object's true surface.
  void Score(const SignedDistance& shape, const PlacementScorer& context,
             const PlacementScorer& free, std::uint64_t seed);

  /// In place of Score: the scores that a finished run has recorded. Where fingertips fit is not
  /// among them and counts as if they did everywhere; pruning and Why do not depend on it but for
  /// what Why says of it. @throws InputError unless there is one of each for every node.
  void TakeScores(const Scores& scores);

  /// Sets the paper's M anew. @throws InputError once pruning has begun.
  void SetTopPercent(double top_percent);
  /// The next of three steps: keeps the top M percent by s_c as V_c; adds the top M percent by s_n;
  /// connects kept nodes that share a triangle, and each with itself. False when all are done.
  /// Needs scores.
  /// @param nodes  at most so many of the step's nodes, from 1; it goes on with the next call.
  bool PruneStep(int nodes = std::numeric_limits<int>::max());
  /// The steps that are still to do. @throws InputError before Score.
  void Prune();

  GraphStage stage() const { return stage_; }
  /// Nodes done of the pruning step that is under way; 0 between steps.
  int num_done() const { return num_done_; }
  /// Calls of PruneStep that did something.
  int num_prune_steps() const { return num_prune_steps_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const ContactGraphConfig& config() const { return config_; }
  const std::vector<ContactNode>& nodes() const { return nodes_; }
  int num_triangles() const { return static_cast<int>(mesh_.F.rows()); }

  /// Ids of the kept nodes, ascending.
  const std::vector<int>& kept() const { return kept_; }
  /// Ids of the kept nodes that `id` (kept) is connected to, itself included, ascending.
  const std::vector<int>& neighbors(int id) const;
  /// Number of undirected edges, loops included; 0 before the graph is connected.
  int num_edges() const;

  /// @throws InputError if there is no node `id`.
  NodeReason Why(int id) const;

 private:
  void RankNodes();
  int NumKeptEach() const;
  // Of the cut by one of the scores.
  void ExplainCut(const std::vector<int>& order, double ContactNode::*score, int rank,
                  double* threshold, int* num_tied, TieRule* rule) const;
  void ConnectNode(int id);

  TriangleMesh mesh_;
  ContactGraphConfig config_;
  GraphStage stage_ = GraphStage::kMeshed;
  int num_done_ = 0, num_prune_steps_ = 0;
  std::vector<ContactNode> nodes_;
  std::vector<int> order_c_, order_n_;  // node ids, best first
  std::vector<int> kept_;
  std::vector<std::vector<int>> neighbors_;  // by node id; empty for pruned nodes
};

}  // namespace pregrasp
