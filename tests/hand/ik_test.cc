#include "app/hand/ik.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/hand/certificate.h"
#include "app/hand/solvable_problem.h"
#include "tests/hand/dense_check.h"
#include "tests/hand/hand_test_data.h"

namespace pregrasp {
namespace {

// Rounding of two distance libraries and of sampling: a solution lies 1e-6 m inside every bound.
constexpr double kSlack = 1e-9;

void ExpectFaultless(const SolvableProblem& solvable, const IkConfig& config,
                     const IkResult& result) {
  for (const std::string& fault : FindFaults(ShadowHand(), solvable.pointers(), config,
                                             solvable.problem, result.configuration(), kSlack)) {
    ADD_FAILURE() << fault;
  }
  const HandCertificate certificate(ShadowHand(), solvable.pointers());
  TouchRule touch;
  for (const IkContact& contact : solvable.problem.contacts) {
    touch.touching[static_cast<int>(contact.finger)] = true;
  }
  EXPECT_TRUE(
      certificate.FindCollisions(result.configuration(), solvable.problem.X_WB, touch).empty());
}

struct Share {
  int solved = 0, tried = 0;
};

// Solves `count` problems with and without clutter; every solution is checked by FCL and by
// sampling.
Share SolveMany(IkObject object, int fingers, int count) {
  Share share;
  const IkConfig config;
  for (int i = 0; i < count; ++i) {
    const bool clutter = i % 2 == 1;
    Rng rng(11, RngStream::kTest, 10 * fingers + static_cast<int>(object), i);
    const SolvableProblem solvable = MakeSolvableProblem(object, fingers, clutter, rng);
    const IkSolver solver(ShadowHand(), solvable.pointers());
    EXPECT_TRUE(solver.Evaluate(config, solvable.problem, solvable.truth).solved());
    const IkResult result = solver.Solve(config, solvable.problem, Rng(1, RngStream::kTest, 0, i));
    ++share.tried;
    if (!result.solved()) continue;
    ++share.solved;
    SCOPED_TRACE(testing::Message() << kIkObjectNames[static_cast<int>(object)] << ' ' << fingers
                                    << " fingers, problem " << i);
    ExpectFaultless(solvable, config, result);
  }
  return share;
}

void ExpectNearlyAllSolved(int fingers, const std::array<int, kNumIkObjects>& counts) {
  Share all;
  for (int object = 0; object < kNumIkObjects; ++object) {
    const Share share = SolveMany(static_cast<IkObject>(object), fingers, counts[object]);
    all.solved += share.solved;
    all.tried += share.tried;
    testing::Test::RecordProperty(kIkObjectNames[object], share.solved);
  }
  EXPECT_GE(all.solved, 0.99 * all.tried);
}

TEST(IkTest, SolvesTwoFingerProblemsThatHaveASolution) { ExpectNearlyAllSolved(2, {12, 12, 6, 6}); }
TEST(IkTest, SolvesThreeFingerProblemsThatHaveASolution) {
  ExpectNearlyAllSolved(3, {12, 12, 6, 6});
}
TEST(IkTest, SolvesFiveFingerProblemsThatHaveASolution) { ExpectNearlyAllSolved(5, {8, 8, 2, 2}); }
TEST(IkLongTest, SolvesNinetyNineOfAHundredProblemsThatHaveASolution) {
  for (const int fingers : {2, 3, 5}) ExpectNearlyAllSolved(fingers, {200, 200, 100, 100});
}

TEST(IkTest, SolvesOneAndFourFingers) {
  ExpectNearlyAllSolved(1, {4, 4, 2, 2});
  ExpectNearlyAllSolved(4, {4, 4, 1, 1});
}

TEST(IkTest, IsAFunctionOfItsArguments) {
  Rng rng(5);
  const SolvableProblem solvable = MakeSolvableProblem(IkObject::kBox, 5, true, rng);
  const IkSolver solver(ShadowHand(), solvable.pointers());
  const IkResult first = solver.Solve({}, solvable.problem, Rng(3, RngStream::kTest));
  const IkResult other = solver.Solve({}, solvable.problem, Rng(4, RngStream::kTest));
  const IkSolver again(ShadowHand(), solvable.pointers());
  const IkResult second = again.Solve({}, solvable.problem, Rng(3, RngStream::kTest));
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.X_WH.matrix(), second.X_WH.matrix());
  EXPECT_NE(first.q, other.q);
}

TEST(IkTest, AnInterruptEndsItBetweenStarts) {
  Rng rng(5);
  const SolvableProblem solvable = MakeSolvableProblem(IkObject::kBox, 5, true, rng);
  const IkSolver solver(ShadowHand(), solvable.pointers());
  RequestInterrupt();
  EXPECT_THROW(solver.Solve({}, solvable.problem, Rng(3, RngStream::kTest)), Interrupted);
  ClearInterrupt();
}

TEST(IkTest, ReachesATenthOfAMillimetreNearlyAlways) {
  int exact = 0;
  constexpr int kCount = 50;
  for (int i = 0; i < kCount; ++i) {
    Rng rng(6, RngStream::kTest, 0, i);
    const SolvableProblem solvable = MakeSolvableProblem(IkObject::kBox, 3, true, rng);
    const IkResult result = IkSolver(ShadowHand(), solvable.pointers())
                                .Solve({}, solvable.problem, Rng(1, RngStream::kTest, 0, i));
    exact += result.solved() && result.tip_error <= 1e-4;
  }
  EXPECT_GE(exact, 45);
}

TEST(IkTest, AWarmStartAtASolutionStaysThere) {
  Rng rng(7);
  SolvableProblem solvable = MakeSolvableProblem(IkObject::kCylinder, 5, true, rng);
  solvable.problem.warm_start = solvable.truth;
  const IkSolver solver(ShadowHand(), solvable.pointers());
  const IkResult result = solver.Solve({}, solvable.problem, Rng(1, RngStream::kTest));
  ASSERT_TRUE(result.solved());
  EXPECT_EQ(result.starts, 1);
  EXPECT_LT((result.q - solvable.truth.q).cwiseAbs().maxCoeff(), 0.02);
}

TEST(IkTest, AReferenceDrawsTheSolutionNear) {
  double with = 0.0;
  double without = 0.0;
  for (int i = 0; i < 20; ++i) {
    Rng rng(8, RngStream::kTest, 0, i);
    SolvableProblem solvable = MakeSolvableProblem(IkObject::kBox, 3, false, rng);
    const IkSolver solver(ShadowHand(), solvable.pointers());
    const auto distance = [&](const IkResult& result) {
      return CalcStep(solvable.truth, result.configuration()).norm();
    };
    without += distance(solver.Solve({}, solvable.problem, Rng(1, RngStream::kTest, 0, i)));
    solvable.problem.reference = solvable.truth;
    with += distance(solver.Solve({}, solvable.problem, Rng(1, RngStream::kTest, 0, i)));
  }
  EXPECT_LT(with, 0.5 * without);
}

TEST(IkTest, WithoutContactsItFindsAFreePoseNearTheReference) {
  const Shape object = Box{{0.1, 0.1, 0.1}};
  const Shape table = Box{{1.0, 1.0, 0.02}};
  const IkSolver solver(ShadowHand(), {&object, &table});
  IkProblem problem;
  problem.X_WB = {MakeTransform(Matrix3::Identity(), Vector3(0, 0, 0.05)),
                  MakeTransform(Matrix3::Identity(), Vector3(0, 0, -0.01))};
  problem.reference = HandConfiguration{MakeTransform(Matrix3::Identity(), Vector3(0.0, 0.05, 0.0)),
                                        ShadowHand().posture};
  problem.warm_start = problem.reference;
  EXPECT_EQ(solver.Evaluate({}, problem, *problem.reference).status, IkStatus::kCollision);
  const IkResult result = solver.Solve({}, problem, Rng(1, RngStream::kTest));
  ASSERT_TRUE(result.solved());
  EXPECT_GE(result.clearance, 0.0);
  EXPECT_LT((result.X_WH.translation() - problem.reference->X_WH.translation()).norm(), 0.2);
}

TEST(IkTest, TellsWhichDemandFails) {
  const Shape object = Box{{0.06, 0.06, 0.06}};
  const Shape plate = Box{{0.4, 0.4, 0.02}};
  IkProblem problem;
  const Vector3 centre(0.0, 0.0, 0.2);
  problem.X_WB = {MakeTransform(Matrix3::Identity(), centre),
                  MakeTransform(Matrix3::Identity(), Vector3(0.0, 0.0, -1.0))};
  const auto contact = [&](Finger finger, const Vector3& nhat, double reach) {
    return IkContact{finger, centre + reach * nhat, nhat};
  };
  IkConfig config;
  const auto solve = [&](const IkProblem& p) {
    return IkSolver(ShadowHand(), {&object, &plate}).Solve(config, p, Rng(1, RngStream::kTest));
  };
  problem.contacts = {contact(Finger::kThumb, Vector3::UnitX(), 0.03),
                      contact(Finger::kIndex, -Vector3::UnitX(), 0.03)};
  EXPECT_EQ(solve(problem).status, IkStatus::kSolved);

  IkProblem far = problem;  // farther apart than any hand spans
  far.contacts[1].p_WC = centre - Vector3(0.5, 0.0, 0.0);
  EXPECT_EQ(solve(far).status, IkStatus::kTipError);

  // Index and middle tips side by side, in opposite directions: not within ten degrees.
  IkProblem opposed = problem;
  opposed.X_WB[0].translation() = Vector3(0.0, 0.0, 5.0);
  opposed.contacts = {{Finger::kIndex, centre, Vector3::UnitZ()},
                      {Finger::kMiddle, centre + Vector3(0.022, 0.0, 0.0), -Vector3::UnitZ()}};
  EXPECT_EQ(solve(opposed).status, IkStatus::kSolved);
  config.max_cone_deg = 10.0;
  EXPECT_EQ(solve(opposed).status, IkStatus::kCone);
  config.max_cone_deg = 60.0;

  IkProblem buried = problem;  // the plate cuts through both contacts
  buried.X_WB[1].translation() = centre;
  const IkResult result = solve(buried);
  EXPECT_EQ(result.status, IkStatus::kCollision);
  ASSERT_TRUE(result.closest.has_value());
  EXPECT_LT(result.clearance, 0.0);
}

TEST(IkTest, AWrongConfigurationIsAnInputErrorThatNamesTheField) {
  const IkSolver solver(ShadowHand());
  const auto field = [&](auto change) {
    IkConfig config;
    change(config);
    try {
      config.Validate();
    } catch (const InputError& error) {
      return error.field();
    }
    return std::string();
  };
  EXPECT_EQ(field([](IkConfig& /*c*/) {}), "");
  EXPECT_EQ(field([](IkConfig& c) { c.tip_target = 0.0; }), "tip_target");
  EXPECT_EQ(field([](IkConfig& c) { c.tip_tolerance = 1.0; }), "tip_tolerance");
  EXPECT_EQ(field([](IkConfig& c) { c.max_cone_deg = 200.0; }), "max_cone_deg");
  EXPECT_EQ(field([](IkConfig& c) { c.influence = 1e-5; }), "influence");
  EXPECT_EQ(field([](IkConfig& c) { c.max_starts = 0; }), "max_starts");
  EXPECT_EQ(field([](IkConfig& c) { c.contact_depth = std::nan(""); }), "contact_depth");
}

}  // namespace
}  // namespace pregrasp
