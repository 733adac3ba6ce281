#include "app/trajectory/action.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/core/check.h"

namespace pregrasp {
namespace {

constexpr double kConeMargin = 0.9;    // a saturated finger still does not slip
constexpr double kWeightFactor = 3.0;  // findings, scenes: f_ref = clamp(3 W, 0.6 N, cap)
constexpr double kMinForce = 0.6;      // [N]

constexpr double kBit = 1.5;  // a contact bit that the noise of the last iterations does not turn

double ToUnit(double x) { return 0.5 * (1.0 + std::tanh(x)); }

// The number whose tanh is a share, which is kept off the ends.
double FromShare(double share) { return std::atanh(std::clamp(share, -0.98, 0.98)); }

}  // namespace

ActionRange MakeActionRange(const Scene& scene, double max_travel) {
  const FingertipConfig& tips = scene.fingertips;
  const double force =
      std::min(tips.max_force, std::max(kMinForce, kWeightFactor * scene.object_weight()));
  return {force / tips.stiffness, kConeMargin * tips.friction, max_travel};
}

ActionSpace::ActionSpace(const ContactGraph& graph, const std::vector<int>& path_nodes,
                         const SignedDistance& shape, const ActionRange& range, int knots,
                         const TipSpheres& tips, TipFits fits)
    : mesh_(&graph.mesh()),
      shape_(&shape),
      range_(range),
      num_stages_(static_cast<int>(path_nodes.size())),
      knots_(knots),
      tips_(tips),
      fits_(std::move(fits)) {
  for (const int id : path_nodes) {
    const ContactNode& node = graph.nodes().at(id);
    triangles_.push_back({node.thumb, node.index});
  }
  for (int finger = 0; fits_ && finger < kNumPlanningFingers; ++finger) {
    for (int i = 0; i < kFitGrid * kFitGrid; ++i) {
      const int row = i / kFitGrid, column = i % kFitGrid;
      const Vector3 w = BarycentricFromSquare((row + 0.5) / kFitGrid, (column + 0.5) / kFitGrid);
      const Placement::Contact contact =
          ContactOnTriangle(*mesh_, triangles_.front()[finger], w, *shape_);
      if (fits_(static_cast<Finger>(finger), contact)) fitting_[finger].push_back(contact);
    }
  }
}

Placement::Contact ActionSpace::PutFirst(int finger, const Placement::Contact& contact) const {
  const std::vector<Placement::Contact>& places = fitting_[finger];
  if (places.empty() || fits_(static_cast<Finger>(finger), contact)) return contact;
  return *std::min_element(places.begin(), places.end(), [&](const auto& a, const auto& b) {
    return (a.p_OC - contact.p_OC).squaredNorm() < (b.p_OC - contact.p_OC).squaredNorm();
  });
}

Placement::Contact ActionSpace::ContactAt(int stage, int finger, double u, double v) const {
  const Vector3 w = BarycentricFromSquare(ToUnit(u), ToUnit(v));
  const Placement::Contact contact =
      ContactOnTriangle(*mesh_, triangles_[stage][finger], w, *shape_);
  return stage == 0 ? PutFirst(finger, contact) : contact;
}

void ActionSpace::SetSteady(std::vector<double>& action, int stage, int finger,
                            const SteadyPush& push) const {
  double* u = action.data() + (stage * kNumPlanningFingers + finger) * FingerSize();
  *u++ = push.on ? kBit : -kBit;
  *u++ = push.u;
  *u++ = push.v;
  const double length = push.tangent.norm();
  for (int k = 0; k < knots_; ++k) {
    *u++ = FromShare(2.0 * push.depth - 1.0);
    for (int i = 0; i < 2; ++i) {
      *u++ = length > 0.0 ? push.tangent[i] / length * FromShare(length) : 0.0;
    }
    for (int axis = 0; axis < 3; ++axis) *u++ = FromShare(push.travel_W[axis]);
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
        out.contact = ContactAt(stage, finger, u[1], u[2]);
        out.on = HasRoom(tips_.radii[finger], out.contact, *shape_);
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
