#pragma once

#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

// As in step_facts.h: the contact graph and its paths.

struct MeshFacts {
  int triangles = 0, nodes = 0;
  TriangleMesh mesh;  ///< in O

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("triangles", self.triangles);
    visit("nodes", self.nodes);
    visit("mesh", self.mesh);
  }
};

/// A contact state, as ContactNode.
struct NodeFacts {
  int id = 0, thumb = 0, index = 0;
  double s_c = 0.0, s_n = 0.0;
  int rank_c = 0, rank_n = 0;
  bool thumb_fits = false, index_fits = false;  ///< a tip somewhere on its triangle, at the start

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("id", self.id);
    visit("thumb", self.thumb);
    visit("index", self.index);
    visit("s_c", self.s_c);
    visit("s_n", self.s_n);
    visit("rank_c", self.rank_c);
    visit("rank_n", self.rank_n);
    visit("thumb_fits", self.thumb_fits);
    visit("index_fits", self.index_fits);
  }
};

struct ScoreFacts {
  int samples = 0;               ///< placements of each kind
  std::vector<double> s_c, s_n;  ///< by node
  std::vector<double> occluded;  ///< by node, share of its contacts where no fingertip can be
  NodeFacts best_here, best_alone;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("samples", self.samples);
    visit("s_c", self.s_c);
    visit("s_n", self.s_n);
    visit("occluded", self.occluded);
    visit("best_here", self.best_here);
    visit("best_alone", self.best_alone);
  }
};

struct PruneFacts {
  std::string cut;           ///< what this step cuts by: "context", "free", or "edges"
  bool complete = false;     ///< the graph is: nothing is left to prune
  int nodes_done = 0;        ///< of the cut under way; 0 where it is done
  double top_percent = 0.0;  ///< the paper's M
  int num_kept_each = 0;     ///< how many nodes the top M percent are
  double threshold_c = 0.0, threshold_n = 0.0;
  int num_tied_c = 0, num_tied_n = 0;  ///< nodes that score exactly that
  int num_edges = 0;
  std::vector<int> initial, kept;  ///< ids of nodes

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("cut", self.cut);
    visit("complete", self.complete);
    visit("nodes_done", self.nodes_done);
    visit("top_percent", self.top_percent);
    visit("num_kept_each", self.num_kept_each);
    visit("threshold_c", self.threshold_c);
    visit("threshold_n", self.threshold_n);
    visit("num_tied_c", self.num_tied_c);
    visit("num_tied_n", self.num_tied_n);
    visit("num_edges", self.num_edges);
    visit("initial", self.initial);
    visit("kept", self.kept);
  }
};

struct PathFacts {
  int rank = 0;
  std::string order;  ///< that it has this rank in: "explore" or "paper"
  std::vector<NodeFacts> nodes;
  double score = 0.0;
  std::vector<double> terms;  ///< its summands
  double value = 0.0;         ///< what the order goes by, as ContactPath
  double repeats = 0.0;       ///< how often paths before it had what it has
  double num_paths = 0.0;     ///< in all
  int num_tied = 1;           ///< with exactly this score, as ContactPath
  std::string tie_rule;       ///< what orders it among these: "", "scores" or "number"
  /// Paths that differ in the last node only and come after this one in the paper's order.
  struct Sibling {
    std::vector<int> nodes;
    double score = 0.0;

    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("nodes", self.nodes);
      visit("score", self.score);
    }
  };
  std::vector<Sibling> siblings;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("rank", self.rank);
    visit("order", self.order);
    visit("nodes", self.nodes);
    visit("score", self.score);
    visit("terms", self.terms);
    visit("value", self.value);
    visit("repeats", self.repeats);
    visit("num_paths", self.num_paths);
    visit("num_tied", self.num_tied);
    visit("tie_rule", self.tie_rule);
    visit("siblings", self.siblings);
  }
};

}  // namespace pregrasp
