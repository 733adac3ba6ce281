#include "app/hand/ik_residuals.h"

#include <gtest/gtest.h>

#include "app/hand/hand_kinematics.h"

namespace pregrasp {
namespace {

TEST(IkResidualsTest, TheNormalEquationsAreThoseOfTheCost) {
  // Near a plate, a contact missed by a centimetre, a reference some way off: all kinds of
  // residual.
  const Shape ball(Sphere{0.03}), plate(Box{{0.4, 0.4, 0.01}});
  const IkSolver solver(ShadowHand(), std::vector<const Shape*>{&ball, &plate});
  HandConfiguration at;
  at.q = ShadowHand().posture;
  HandPose pose;
  CalcHandPose(ShadowHand(), at.X_WH, at.q, &pose);
  const Fingertip& tip = ShadowHand().tip(Finger::kIndex);
  const Vector3 p_WT = pose.CalcPoint(tip.link, tip.p_LT);
  IkProblem problem;
  problem.contacts = {{Finger::kIndex, p_WT + Vector3(0.01, 0.0, 0.005), Vector3::UnitX()}};
  problem.may_touch[0] = true;
  problem.X_WB = {MakeTransform(Quaternion::Identity(), Vector3(0.5, 0.0, 0.0)),
                  MakeTransform(Quaternion::Identity(), p_WT + Vector3(0.0, 0.0, 0.0145))};
  problem.reference = at;
  problem.reference->X_WH.translation().x() += 0.02;
  problem.reference->q[3] += 0.3;
  IkConfig config;
  config.clearance_buffer = 2e-3;
  IkResiduals residuals(solver, config, problem);
  residuals.Evaluate(at);
  HandMatrix A = HandMatrix::Zero();
  HandVector b = HandVector::Zero();
  residuals.AddNormalEquations(&A, &b);
  residuals.AddNormalEquations(&A, &b);  // adds
  EXPECT_GT(b.norm(), 1.0);
  constexpr double kStep = 1e-7;
  for (int d = 0; d < kMaxHandDofs; ++d) {
    const double up = residuals.Evaluate(Advance(at, HandVector(kStep * HandVector::Unit(d))));
    const double down = residuals.Evaluate(Advance(at, HandVector(-kStep * HandVector::Unit(d))));
    // The cost's gradient is 2 J^T r, of which b holds two.
    EXPECT_NEAR((up - down) / (2.0 * kStep), b[d], 1e-3 * b.norm()) << d;
  }
}

}  // namespace
}  // namespace pregrasp
