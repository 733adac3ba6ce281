#pragma once

#include <map>
#include <vector>

#include "app/graph/contact_path.h"

namespace pregrasp {

/// Paths of a connected graph, best first among those that differ: where scores are poor, the ten
/// best of all paths push at one place with one idea.
///
/// A path begins with a node of which at least one finger's tip fits on its triangle at the start;
/// nodes outside V_c may begin one too, for it is rollouts that drop them (screening), not scores.
/// The next one is that with the highest value: s_c as a share of the best, over 1 + repeats.
/// Repeats count the paths before it: for each finger that fits, those with that finger on the same
/// triangle, and half those with it on the same side of the object (the axis of O nearest to the
/// triangle's normal). Each later node is a kept one that shares a triangle with the one before it,
/// or that one again: the best by s_n over 1 + a quarter of the paths that had it there, nodes that
/// a tip fits on at the start before all others, which the object's motion may or may not uncover.
/// Ties: the better rank_c of the first node, the better rank_n of a later one.
/// A copyable value: copying it remembers how far it has come.
class PathExplorer {
 public:
  static constexpr double kLeastScore = 0.05;  ///< of a share, so that the worst has its turn

  /// @param stages  nodes in a path, at least 1. The graph is copied. @throws InputError unless it
  ///                is connected.
  PathExplorer(const ContactGraph& graph, int stages);

  /// The next path; false when every first node has been one. `score` and `terms` are the paper's.
  bool Next(ContactPath* path);

  /// How many there are: one for each first node.
  double num_paths() const { return static_cast<double>(num_first_); }

 private:
  struct Lead {
    int finger, triangle, side;
  };
  std::vector<Lead> Leads(const ContactNode& node) const;
  double CountRepeats(const ContactNode& node) const;
  double ValueOf(const ContactNode& first) const;
  int FindLater(int previous, std::size_t stage) const;
  void Remember(const ContactPath& path);

  ContactGraph graph_;
  int stages_, num_found_ = 0, num_first_ = 0;
  double best_c_ = 0.0, best_n_ = 0.0;
  std::vector<int> sides_;                                      // of each triangle
  std::vector<bool> used_;                                      // by node: it began a path
  std::map<std::pair<int, int>, int> triangles_, side_counts_;  // by finger and triangle, or side
  std::vector<std::map<int, int>> later_;                       // by stage and node
};

}  // namespace pregrasp
