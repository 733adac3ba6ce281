#pragma once

#include <limits>
#include <vector>

#include "app/graph/contact_graph.h"

namespace pregrasp {

/// In which order paths are tried.
enum class PathOrder {
  kExplore,  ///< best first among those that differ from what came before (PathExplorer)
  kPaper,    ///< by the paper's sum of scores alone (PathSearch)
};
/// "explore", "paper".
const char* PathOrderName(PathOrder order);

/// A sequence of contact states, one a contact stage (paper, section "Trajectory optimization").
struct ContactPath {
  std::vector<int> nodes;     ///< node ids, first to last
  double score = 0.0;         ///< s_c(v_1) + sum over i > 1 of s_n(v_i), added from the last on
  std::vector<double> terms;  ///< its summands
  int rank = 0;               ///< 1 is the best of all paths
  /// How many paths have exactly this score, itself among them; kMostTied means as many or more.
  int num_tied = 1;
  /// What orders it among these: where two first differ, the node of better rank goes first (rank_c
  /// in the first stage, rank_n after it), so that its scores decide, or its number if it decides
  /// against any neighbour in the order. kNone if it is alone.
  TieRule rule = TieRule::kNone;
  /// What PathExplorer orders by: `score` over 1 + `repeats`. In the paper's order the score
  /// itself.
  double value = 0.0;
  /// How often paths before it had what it has: PathExplorer says how that is counted.
  double repeats = 0.0;
};

/// Paths of equal score are counted up to this many.
inline constexpr int kMostTied = 1000;

/// The paths that differ from `path` in their last node only and come after it, best first, at most
/// `count`: what it beat. Their ranks are unknown (0); `num_tied` counts such paths alone, and
/// `rule` is what decided between the sibling and `path`.
std::vector<ContactPath> FindSiblings(const ContactGraph& graph, const ContactPath& path,
                                      int count);

/// All paths of a connected graph, best first, found one at a time. A copyable value: copying it
/// remembers how far the enumeration has come.
///
/// The best completion of every partial path is known beforehand (dynamic programming over the
/// remaining stages), so each pop yields the next path in order and costs a logarithm; the paths
/// themselves, millions of them, are never listed (Lawler 1972), but for those of equal score,
/// which are found together, up to kMostTied, and come in the order of ContactPath::rule.
class PathSearch {
 public:
  /// @param stages  nodes in a path, at least 1. The graph is copied. @throws InputError unless it
  ///                is connected.
  PathSearch(const ContactGraph& graph, int stages);

  /// The next best path; false when there is none left.
  bool Next(ContactPath* path);

  /// How many paths there are in all (as a double: it may be large).
  double num_paths() const;

 private:
  // A choice at one depth: the `rank`-th best successor in `options`.
  struct Choice {
    int node;
    double value;  // its own term plus that of its best completion
  };
  // A path whose first `depth` choices are fixed by a parent and whose last one is `rank` in the
  // successors of the node before it; completed by best choices.
  struct Candidate {
    double score;
    std::vector<int> ranks;  // one a stage, from 0 for the best successor
    std::vector<int> nodes;
    int depth;  // the first stage whose rank may still be raised
  };
  static bool IsWorse(const Candidate& a, const Candidate& b);

  const std::vector<Choice>& Options(int stage, int previous) const;
  Candidate Complete(std::vector<int> ranks, int depth) const;
  Candidate PopBest();
  // Fills tied_ with the paths of the next score.
  bool FindTied();

  ContactGraph graph_;
  int stages_;
  int num_found_ = 0;
  double last_score_ = std::numeric_limits<double>::infinity();  // of the paths found last
  std::vector<Choice> first_;                                    // choices of the first stage
  std::vector<std::vector<std::vector<Choice>>> after_;          // [stages left after it][node id]
  std::vector<Candidate> heap_;
  std::vector<ContactPath> tied_;  // found and not given yet, last first
};

}  // namespace pregrasp
