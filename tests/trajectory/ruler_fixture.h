#pragma once

#include <algorithm>
#include <memory>

#include "app/geometry/contact_mesh.h"
#include "app/trajectory/mppi.h"

namespace pregrasp {

/// A 30 cm ruler flat on a table whose edge is at x = 0, the ruler's end 1 cm inboard of it.
inline Scene MakeRulerScene() {
  Scene scene;
  scene.name = "ruler";
  Body ruler;
  ruler.name = "ruler";
  const Vector3 size(0.300, 0.030, 0.003);
  ruler.shape = Box{size};
  ruler.friction = 0.3;
  ruler.X_WB.translation() << -0.160, 0.0, 0.0015;
  const double mass = 0.025;
  const Vector3 square = size.cwiseAbs2();
  ruler.mass_properties = MassProperties{
      mass, Vector3::Zero(),
      Vector3(square.y() + square.z(), square.x() + square.z(), square.x() + square.y())
              .asDiagonal()
              .toDenseMatrix() *
          (mass / 12.0)};
  Body table;
  table.name = "table";
  table.shape = Box{Vector3(0.6, 0.8, 0.04)};
  table.friction = 0.3;
  table.X_WB.translation() << -0.3, 0.0, -0.02;
  scene.bodies = {ruler, table};
  return scene;
}

/// One finger presses the middle of the ruler's top and its target travels along +x [m].
inline WorldPlan MakeRulerDrag(double depth, double travel) {
  WorldPlan plan;
  plan.stages.resize(1);
  WorldPlan::Finger& index = plan.stages[0][1];
  index.on = true;
  index.contact = {true, Vector3(0.0, 0.0, 0.0015), Vector3::UnitZ()};
  for (int k = 1; k <= 4; ++k) {
    index.p_WTargets.emplace_back(-0.16 + travel * k / 4, 0.0, 0.003 - depth);
  }
  return plan;
}

/// A box's triangle mesh with the faces of size (x, y) cut into `n` strips along x.
inline TriangleMesh MakeStripMesh(const Vector3& size, int n) {
  TriangleMesh mesh;
  mesh.V.resize(4 * (n + 1), 3);
  for (int i = 0; i <= n; ++i) {
    const double x = size.x() * (static_cast<double>(i) / n - 0.5);
    mesh.V.row(4 * i) << x, -size.y() / 2, -size.z() / 2;
    mesh.V.row(4 * i + 1) << x, size.y() / 2, -size.z() / 2;
    mesh.V.row(4 * i + 2) << x, size.y() / 2, size.z() / 2;
    mesh.V.row(4 * i + 3) << x, -size.y() / 2, size.z() / 2;
  }
  mesh.F.resize(8 * n + 4, 3);
  int f = 0;
  for (int i = 0; i < n; ++i) {
    for (int side = 0; side < 4; ++side) {
      const int a = 4 * i + side, b = 4 * i + (side + 1) % 4;
      mesh.F.row(f++) << a, b, b + 4;
      mesh.F.row(f++) << a, b + 4, a + 4;
    }
  }
  const int last = 4 * n;
  mesh.F.row(f++) << 0, 2, 1;
  mesh.F.row(f++) << 0, 3, 2;
  mesh.F.row(f++) << last, last + 1, last + 2;
  mesh.F.row(f++) << last, last + 2, last + 3;
  return mesh;
}

/// A stand-in for the learned score: how far the ruler's far end stands over the edge, 1 at 8 cm;
/// of a state, nothing without a contact.
class OverhangScorer : public StateScorer {
 public:
  std::vector<double> Score(std::span<const ScoredState> states) const override {
    std::vector<double> scores = ScoreGraspable(states);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Placement& placement = states[i].placement;
      if (!placement.thumb().on && !placement.index().on) scores[i] = 0.0;
    }
    return scores;
  }
  std::vector<double> ScoreGraspable(std::span<const ScoredState> states) const override {
    std::vector<double> scores;
    for (const ScoredState& state : states) {
      const Vector3 p_WEnd = state.X_WB[0] * Vector3(0.15, 0.0, 0.0);
      scores.push_back(std::clamp((p_WEnd.x() + 0.01) / 0.09, 0.0, 1.0));
    }
    return scores;
  }
};

/// The ruler with all that MPPI needs; the path presses one triangle of the top face.
struct RulerProblem {
  Scene scene = MakeRulerScene();
  World world{scene};
  EnvironmentDistance environment{scene};
  SignedDistance shape{scene.object().shape};
  ContactGraph graph{MakeStripMesh(Vector3(0.300, 0.030, 0.003), 5), {}};
  OverhangScorer scorer;

  /// @param strip  0 to 4 along the ruler.
  MppiProblem Make(int strip, std::uint64_t seed) const {
    MppiProblem problem;
    problem.world = &world;
    problem.environment = &environment;
    problem.shape = &shape;
    problem.graph = &graph;
    problem.scorer = &scorer;
    problem.start = world.InitialState();
    const int triangle = 8 * strip + 4;  // the strip's first triangle of the top face
    const int node = triangle * graph.num_triangles() + triangle + 1;
    problem.path.nodes = {node, node};
    problem.seed = seed;
    return problem;
  }
};

}  // namespace pregrasp
