#include "app/trajectory/action.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

constexpr double kConeMargin = 0.9;    // a saturated finger still does not slip
constexpr double kWeightFactor = 3.0;  // findings, scenes: f_ref = clamp(3 W, 0.6 N, cap)
constexpr double kMinForce = 0.6;      // [N]

double ToUnit(double x) { return 0.5 * (1.0 + std::tanh(x)); }

}  // namespace

ActionRange MakeActionRange(const Scene& scene, double max_travel) {
  const FingertipConfig& tips = scene.fingertips;
  const double force =
      std::min(tips.max_force, std::max(kMinForce, kWeightFactor * scene.object_weight()));
  return {force / tips.stiffness, kConeMargin * tips.friction, max_travel};
}

ActionSpace::ActionSpace(const ContactGraph& graph, const std::vector<int>& path_nodes,
                         const SignedDistance& shape, const ActionRange& range, int knots)
    : mesh_(&graph.mesh()),
      shape_(&shape),
      range_(range),
      num_stages_(static_cast<int>(path_nodes.size())),
      knots_(knots) {
  for (const int id : path_nodes) {
    const ContactNode& node = graph.nodes().at(id);
    triangles_.push_back({node.thumb, node.index});
  }
}

RelativePlan ActionSpace::Decode(const std::vector<double>& action) const {
  PREGRASP_CHECK(static_cast<int>(action.size()) == size(), action.size(), size());
  RelativePlan plan;
  plan.stages.resize(num_stages_);
  const double* u = action.data();
  for (int stage = 0; stage < num_stages_; ++stage) {
    for (int finger = 0; finger < kNumPlanningFingers; ++finger) {
      FingerStage& out = plan.stages[stage][finger];
      out.on = u[0] > 0.0;
      out.kept = out.on && stage > 0 && plan.stages[stage - 1][finger].on;
      if (out.on && !out.kept) {
        const Vector3 w = BarycentricFromSquare(ToUnit(u[1]), ToUnit(u[2]));
        out.contact = ContactOnTriangle(*mesh_, triangles_[stage][finger], w, *shape_);
      }
      u += 3;
      for (int k = 0; k < knots_; ++k, u += kKnotSize) {
        FingerStage::Knot knot;
        knot.depth = range_.max_depth * ToUnit(u[0]);
        const Vector2 tangent(u[1], u[2]);
        const double length = tangent.norm();
        if (length > 0.0) {
          knot.tangent = tangent * (std::tanh(length) / length * range_.cone * knot.depth);
        }
        for (int axis = 0; axis < 3; ++axis) {
          knot.travel_W[axis] = range_.max_travel * std::tanh(u[3 + axis]);
        }
        out.knots.push_back(knot);
      }
    }
  }
  return plan;
}

}  // namespace pregrasp
