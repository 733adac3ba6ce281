#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "app/graph/contact_graph.h"
#include "app/graph/contact_path.h"

namespace pregrasp {

/// The box that most tests search [m].
inline const Vector3 kBoxSize(0.2, 0.1, 0.05);

/// A box mesh of 12 triangles, full sizes (x, y, z).
inline TriangleMesh MakeBoxMesh(const Vector3& size) {
  TriangleMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    mesh.V.row(i) << ((i & 1) - 0.5) * size.x(), (((i >> 1) & 1) - 0.5) * size.y(),
        (((i >> 2) & 1) - 0.5) * size.z();
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  return mesh;
}

/// Scores by a smooth function of the contact points; occluded below a height.
class AnalyticScorer : public PlacementScorer {
 public:
  explicit AnalyticScorer(double weight, double occluded_below = -1e9)
      : weight_(weight), occluded_below_(occluded_below) {}

  std::vector<double> Score(std::span<const Placement> placements) const override {
    std::vector<double> scores;
    for (const Placement& placement : placements) {
      double sum = 0.0;
      for (const auto& finger : placement.fingers) {
        if (finger.on) sum += 1.0 + std::sin(31.0 * finger.p_OC.x() + weight_ * finger.p_OC.z());
      }
      scores.push_back(sum / 4.0);
    }
    return scores;
  }

  bool IsOccluded(Finger, const Placement::Contact& contact) const override {
    return contact.p_OC.z() < occluded_below_;
  }

 private:
  double weight_, occluded_below_;
};

/// The same, of a scene where no thumb can be anywhere: a node's s_c is then that of its index
/// finger alone, exactly equal for all nodes with one index triangle.
class NoThumbScorer : public AnalyticScorer {
 public:
  using AnalyticScorer::AnalyticScorer;
  bool IsOccluded(Finger finger, const Placement::Contact&) const override {
    return finger == Finger::kThumb;
  }
};

/// All placements alike, tips that overlap among them.
class ConstantScorer : public PlacementScorer {
 public:
  std::vector<double> Score(std::span<const Placement> placements) const override {
    return std::vector<double>(placements.size(), 0.0);
  }
  bool IsOccluded(Finger, const Placement::Contact&) const override { return false; }
};

/// Scored by `context` and `free`, not pruned.
inline ContactGraph MakeScoredGraph(const PlacementScorer& context, const PlacementScorer& free,
                                    double top_percent) {
  ContactGraphConfig config;
  config.top_percent = top_percent;
  ContactGraph graph(MakeBoxMesh(kBoxSize), config);
  graph.Score(SignedDistance(Box{kBoxSize}), context, free, 1);
  return graph;
}

/// A copy of `search`, a PathSearch or PathExplorer, gives the paths that it gives itself.
template <typename Search>
void ExpectCopyGoesOn(Search search) {
  ContactPath path;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(search.Next(&path));
  Search copy = search;
  ContactPath a, b;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(search.Next(&a));
    ASSERT_TRUE(copy.Next(&b));
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.rank, b.rank);
    EXPECT_EQ(a.value, b.value);
  }
}

}  // namespace pregrasp
