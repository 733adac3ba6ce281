#include "app/motion/hand_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/mass_properties.h"
#include "app/hand/certificate.h"

namespace pregrasp {
namespace {

const Vector3 kSize(0.05, 0.06, 0.12);

// A carton on a table, pushed a little by the index finger, then grasped across y.
class HandMotionTest : public ::testing::Test {
 protected:
  HandMotionTest() {
    Body carton;
    carton.name = "carton";
    carton.shape = Box{kSize};
    carton.mass_properties = CalcMassProperties(carton.shape, 0.2);
    carton.X_WB.translation() << 0.0, 0.0, kSize.z() / 2;
    Body table;
    table.name = "table";
    table.shape = Box{Vector3(0.8, 0.8, 0.04)};
    table.X_WB.translation() << 0.0, 0.0, -0.02;
    scene_.name = "carton";
    scene_.bodies = {carton, table};
    world_ = std::make_unique<World>(scene_);
    solver_ = std::make_unique<IkSolver>(ShadowHand(), scene_);
    PushCarton();
    FindGrasp();
    MakeLift();
  }

  void PushCarton() {
    WorldState state = world_->InitialState();
    const Vector3 p_OC(0.0, kSize.y() / 2, 0.02);
    world_->PutFinger(state, Finger::kIndex, p_OC);
    trace_.push_back({state, {}});
    for (int i = 0; i < 192; ++i) {
      state.fingers[1].p_WTarget.y() -= 0.05 / 192;
      world_->Step(state);
      trace_.push_back({state, {}});
    }
  }

  void FindGrasp() {
    const auto put = [&](Finger finger, double x, double y, double z) {
      contacts_[static_cast<int>(finger)] = {true, Vector3(x, y * kSize.y() / 2, z),
                                             Vector3(0.0, y, 0.0)};
    };
    put(Finger::kThumb, 0.0, -1.0, 0.03);
    put(Finger::kIndex, 0.011, 1.0, 0.03);
    put(Finger::kMiddle, -0.011, 1.0, 0.03);
    MotionFrameTask frame;
    frame.X_WB = world_->GetPoses(trace_.back().state);
    frame.contacts = contacts_;
    IkConfig config;
    config.max_starts = 100;
    const IkResult result = solver_->Solve(config, MakeIkProblem(frame), Rng(1, RngStream::kTest));
    ASSERT_TRUE(result.solved()) << IkStatusName(result.status);
    grasp_ = result.configuration();
  }

  HandMotion Make(const MotionConfig& config) const {
    return {*solver_, BuildMotionTask(*world_, trace_, {lift_, lift_t_}, MotionTiming()), grasp_,
            config, 1};
  }

  // Ten centimetres up in 1.2 s after 0.6 s at rest, turning a little, as no formula of ours would.
  void MakeLift() {
    WorldState state = trace_.back().state;
    for (int f = 0; f < kNumFingers; ++f) {
      state.fingers[f].on = contacts_[f].on;
      state.fingers[f].p_OC = contacts_[f].p_OC;
      state.fingers[f].nhat_O = contacts_[f].nhat_O;
    }
    const double dt = world_->config().dt;
    lift_t_ = state.t + 0.6;
    const Quaternion turn(Eigen::AngleAxisd(0.01 * dt, Vector3::UnitX()));
    for (const double end = state.t + 1.8; state.t < end; state.t += dt) {
      lift_.push_back({state, {}});
      if (state.t < lift_t_) continue;
      state.bodies[0].p_WB.z() += 0.1 / 1.2 * dt;
      state.bodies[0].q_WB = turn * state.bodies[0].q_WB;
    }
  }

  Scene scene_;
  std::unique_ptr<World> world_;
  std::unique_ptr<IkSolver> solver_;
  std::vector<TraceRow> trace_;
  std::vector<TraceRow> lift_;
  double lift_t_ = 0.0;
  std::array<Placement::Contact, kNumFingers> contacts_{};
  HandConfiguration grasp_;
};

TEST_F(HandMotionTest, TheTaskKeepsTheTimesOfThePhysicsAndMarksEveryChangeOfContact) {
  const HandMotion motion = Make(MotionConfig());
  const MotionTask& task = motion.task();
  int contact_frames = 0;
  for (std::size_t i = 0; i < task.frames.size(); ++i) {
    EXPECT_NEAR(task.frames[i].t, static_cast<double>(i) / 30.0, 1e-9);
    contact_frames += task.frames[i].phase == MotionPhase::kContact;
  }
  EXPECT_EQ(contact_frames, 25);  // 0.8 s at 30 frames a second, both ends
  // Start, first contact, end of the push, closed, lifted.
  EXPECT_EQ(task.keyframes.size(), 5U);
}

TEST_F(HandMotionTest, TheLiftIsTheSimulatedOneAtTheSpeedOfThePhysics) {
  const MotionTask task = BuildMotionTask(*world_, trace_, {lift_, lift_t_}, MotionTiming());
  const int closed = task.keyframes[3], count = static_cast<int>(task.frames.size());
  EXPECT_EQ(task.frames[closed].phase, MotionPhase::kClosing);
  for (int i = closed; i < count; ++i) {
    const double t = lift_t_ + task.frames[i].t - task.frames[closed].t;
    const auto row =
        std::min_element(lift_.begin(), lift_.end(), [t](const auto& a, const auto& b) {
          return std::abs(a.state.t - t) < std::abs(b.state.t - t);
        });
    const RigidTransform X_WO = world_->GetPoses(row->state)[0];
    // A frame may lie a step off: the lift's length is not a whole number of frames.
    EXPECT_NEAR((task.frames[i].X_WB[0].translation() - X_WO.translation()).norm(), 0.0, 1e-3);
  }
  EXPECT_TRUE(task.frames.back().X_WB[0].isApprox(world_->GetPoses(lift_.back().state)[0], 0.0));
}

TEST_F(HandMotionTest, EveryFrameIsSolvedAndCertifiedByFcl) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  motion.Finish(state);
  const MotionSummary summary = motion.Summarize(state);
  EXPECT_EQ(summary.failed, 0);
  EXPECT_EQ(summary.loosened, 0);
  EXPECT_LE(summary.max_tip_error, 5e-4);
  EXPECT_GE(summary.min_clearance, 0.0);
  const HandCertificate certificate(ShadowHand(),
                                    {&scene_.bodies[0].shape, &scene_.bodies[1].shape});
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    TouchRule touch;
    for (int f = 0; f < kNumFingers; ++f)
      touch.touching[f] = motion.task().frames[i].contacts[f].on;
    EXPECT_TRUE(certificate
                    .FindCollisions(state.frames[i].configuration, motion.task().frames[i].X_WB,
                                    touch, true)
                    .empty())
        << "frame " << i;
  }
}

TEST_F(HandMotionTest, KeyframesAreSolvedLastToFirstByDefault) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  std::vector<int> reversed(motion.task().keyframes.rbegin(), motion.task().keyframes.rend());
  EXPECT_EQ(state.solved_keys, reversed);
}

TEST_F(HandMotionTest, ThePalmStartsTwentyCentimetresOff) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  const Vector3 first = state.frames[motion.task().keyframes[1]].configuration.X_WH.translation();
  const Vector3 start = state.frames[0].configuration.X_WH.translation();
  EXPECT_NEAR((start - first).norm(), 0.20, 0.03);
}

TEST_F(HandMotionTest, ACopySteppedOnGivesTheSameBits) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  motion.SolveKeyframe(state);
  MotionState copy = state;
  motion.Finish(state);
  motion.Finish(copy);
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    EXPECT_EQ(state.frames[i].configuration.q, copy.frames[i].configuration.q);
    EXPECT_EQ(state.frames[i].configuration.X_WH.matrix(),
              copy.frames[i].configuration.X_WH.matrix());
  }
}

}  // namespace
}  // namespace pregrasp
