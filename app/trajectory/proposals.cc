#include "app/trajectory/proposals.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// Up along the surface, as seen in the contact's frame; any direction where the surface is level.
Vector2 UpAlong(const Matrix3& R_WC, const Vector3& up_W, Rng& rng) {
  const double angle = rng.Uniform(0.0, 2.0 * kPi);
  const Vector2 up = (R_WC.transpose() * up_W).head<2>();
  constexpr double kLevel = 0.1;
  if (up.norm() < kLevel) return {std::cos(angle), std::sin(angle)};
  return up.normalized();
}

SteadyPush DrawPush(const ActionSpace& space, Proposal kind, int finger, const Matrix3& R_WO,
                    const Vector3& up_W, Rng& rng) {
  SteadyPush push;
  push.on = true;
  push.u = rng.Normal();
  push.v = rng.Normal();
  const Placement::Contact contact = space.ContactAt(0, finger, push.u, push.v);
  const Matrix3 R_WC = R_WO * FrameFromNormal(contact.nhat_O);
  const Vector3 into_W = -R_WC.col(2);
  const double angle = rng.Uniform(0.0, 2.0 * kPi);
  const Vector2 aside(std::cos(angle), std::sin(angle));
  const double strength = rng.Uniform(), share = rng.Uniform(), far = rng.Uniform();
  switch (kind) {
    case Proposal::kSlide:
      push.depth = 0.2 + 0.8 * strength;
      push.tangent = aside * (0.5 + 0.5 * share);
      push.travel_W = R_WC.leftCols<2>() * aside * far;
      break;
    case Proposal::kTilt:
      push.depth = 0.4 + 0.6 * strength;
      push.tangent = aside * 0.5 * share;
      push.travel_W = into_W * far;
      break;
    case Proposal::kLift:
    case Proposal::kPinch: {
      const Vector2 up = UpAlong(R_WC, up_W, rng);
      push.depth = 0.3 + 0.7 * strength;
      push.tangent = up * (0.7 + 0.3 * share);
      push.travel_W = (R_WC.leftCols<2>() * up + 0.6 * rng.Uniform() * into_W) * far;
      break;
    }
  }
  return push;
}

}  // namespace

std::vector<double> DrawProposal(const ActionSpace& space, Proposal kind, const Matrix3& R_WO,
                                 const Vector3& up_W, Rng& rng) {
  std::array<bool, kNumPlanningFingers> used{};
  int alone = static_cast<int>(rng.UniformInt(kNumPlanningFingers));
  if (!space.FitsFirst(alone)) alone = 1 - alone;
  for (int finger = 0; finger < kNumPlanningFingers; ++finger) {
    used[finger] = kind == Proposal::kPinch ? space.FitsFirst(finger) : finger == alone;
  }
  std::vector<double> action(space.size(), 0.0);
  for (int finger = 0; finger < kNumPlanningFingers; ++finger) {
    SteadyPush push;
    if (used[finger]) push = DrawPush(space, kind, finger, R_WO, up_W, rng);
    for (int stage = 0; stage < space.num_stages(); ++stage) {
      space.SetSteady(action, stage, finger, push);
    }
  }
  return action;
}

}  // namespace pregrasp
