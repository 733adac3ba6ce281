#include "app/motion/hand_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/mass_properties.h"
#include "app/hand/certificate.h"
#include "app/motion/motion_problem.h"
#include "app/motion/touches.h"
#include "tests/motion/motion_audit.h"

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

  HandMotion Make(const MotionConfig& config, std::uint64_t seed = 1) const {
    return {*solver_,
            BuildMotionTask(*world_, trace_, {lift_, closing_t_, lift_t_}, MotionTiming()), grasp_,
            config, seed};
  }

  // Ten centimetres up in 1.2 s after 0.1 s of hand-over and 0.6 s at rest, turning a little, as no
  // formula of ours would. The pushing finger is on until the others are put on.
  void MakeLift() {
    WorldState state = trace_.back().state;
    const double dt = world_->config().dt;
    closing_t_ = state.t + 0.1;
    lift_t_ = state.t + 0.7;
    const Quaternion turn(Eigen::AngleAxisd(0.01 * dt, Vector3::UnitX()));
    for (const double end = state.t + 1.9; state.t < end; state.t += dt) {
      lift_.push_back({state, {}});
      for (int f = 0; f < kNumFingers && state.t > closing_t_ - 0.5 * dt; ++f) {
        state.fingers[f].on = contacts_[f].on;
        state.fingers[f].p_OC = contacts_[f].p_OC;
        state.fingers[f].nhat_O = contacts_[f].nhat_O;
      }
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
  double closing_t_ = 0.0, lift_t_ = 0.0;
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
  // Start, first contact, end of the push, of the hand-over, closed, lift begun, lifted.
  EXPECT_EQ(task.keyframes.size(), 7U);
  EXPECT_EQ(task.is_free, (std::vector<bool>{true, false, false, true, false, false}));
  // A free part has one step, and the bodies stand in it.
  EXPECT_EQ(task.num_steps(0), 1);
  EXPECT_EQ(task.num_steps(3), 1);
  EXPECT_EQ(task.frames[task.keyframes[4]].X_WB_way.size(), 1U);
}

TEST_F(HandMotionTest, UpIsAgainstGravity) {
  EXPECT_EQ(Make(MotionConfig()).task().up_W, Vector3::UnitZ());
  scene_.gravity = Vector3(-6.0, 0.0, -8.0);
  const MotionTask task =
      BuildMotionTask(World(scene_), trace_, {lift_, closing_t_, lift_t_}, MotionTiming());
  EXPECT_LT((task.up_W - Vector3(0.6, 0.0, 0.8)).norm(), 1e-15);
}

TEST_F(HandMotionTest, AFreePartCanHaveAnyNumberOfStepsAndNothingElseChanges) {
  const MotionTask task =
      BuildMotionTask(*world_, trace_, {lift_, closing_t_, lift_t_}, MotionTiming());
  const MotionTask longer = WithSteps(task, 3, 12);
  ASSERT_EQ(longer.frames.size(), task.frames.size() + 11);
  EXPECT_EQ(longer.num_steps(3), 12);
  for (std::size_t i = 0; i < longer.frames.size(); ++i) {
    EXPECT_NEAR(longer.frames[i].t, static_cast<double>(i) / 30.0, 1e-9);
  }
  const int begin = longer.keyframes[3], end = longer.keyframes[4];
  for (int i = begin + 1; i < end; ++i) {
    EXPECT_EQ(longer.frames[i].phase, MotionPhase::kClosing);
    EXPECT_TRUE(longer.frames[i].X_WB[0].isApprox(task.frames[task.keyframes[3]].X_WB[0], 0.0));
    for (const auto& contact : longer.frames[i].contacts) EXPECT_FALSE(contact.on);  // none is kept
  }
  const MotionTask back = WithSteps(longer, 3, 1);
  EXPECT_EQ(back.keyframes, task.keyframes);
  EXPECT_EQ(back.frames.size(), task.frames.size());
}

TEST_F(HandMotionTest, AHoldInWhichNothingMovesIsNotWaitedThrough) {
  std::vector<TraceRow> trace = trace_;
  WorldState state = trace.back().state;
  for (int i = 0; i < 360; ++i) {
    state.t += world_->config().dt;
    trace.push_back({state, {}});
  }
  const MotionTask task =
      BuildMotionTask(*world_, trace, {lift_, closing_t_, lift_t_}, MotionTiming());
  const auto contact = std::count_if(task.frames.begin(), task.frames.end(), [](const auto& frame) {
    return frame.phase == MotionPhase::kContact;
  });
  EXPECT_LE(contact, 25);
  EXPECT_GE(contact, 20);
}

TEST_F(HandMotionTest, TheWayToAFrameIsWhereTheSimulationHasTheBodiesMeanwhile) {
  const MotionTask task =
      BuildMotionTask(*world_, trace_, {lift_, closing_t_, lift_t_}, MotionTiming());
  for (std::size_t i = 1; i < task.frames.size(); ++i) {
    const MotionFrameTask& frame = task.frames[i];
    ASSERT_FALSE(frame.X_WB_way.empty()) << i;
    EXPECT_TRUE(frame.X_WB_way.back()[0].isApprox(frame.X_WB[0], 0.0)) << i;
    if (frame.X_WB_way.size() == 1) continue;
    EXPECT_NEAR(static_cast<double>(frame.X_WB_way.size()), 9.0, 1.0) << i;  // 8 steps of 1/240 s
    EXPECT_NEAR(
        (frame.X_WB_way.front()[0].translation() - task.frames[i - 1].X_WB[0].translation()).norm(),
        0.0, 1.1e-4)
        << i;
  }
}

TEST_F(HandMotionTest, BetweenContactStagesWithoutAFingerTheHandIsInTransit) {
  // The finger is off for the third quarter of the push.
  std::vector<TraceRow> trace = trace_;
  for (int i = 97; i < 145; ++i) trace[i].state.fingers[1].on = false;
  const MotionTask task =
      BuildMotionTask(*world_, trace, {lift_, closing_t_, lift_t_}, MotionTiming());
  std::string phases;
  for (const MotionFrameTask& frame : task.frames) {
    const char initial = MotionPhaseName(frame.phase)[1];  // all five differ there
    if (phases.empty() || phases.back() != initial) phases += initial;
    const bool touches = frame.contacts[1].on;
    if (frame.phase == MotionPhase::kTransit || frame.phase == MotionPhase::kContact) {
      EXPECT_EQ(touches, frame.phase == MotionPhase::kContact) << frame.t;
    }
  }
  EXPECT_EQ(phases, "poroli");  // approach, contact, transit, contact, closing, lift
}

TEST_F(HandMotionTest, AFingerThatIsOnWithoutTouchingHasNoContactUnlessItIsBackAtOnce) {
  const auto count_contacts = [&](int rows_without) {
    std::vector<TraceRow> trace = trace_;
    for (int i = 97; i < 97 + rows_without; ++i) trace[i].state.fingers[1].touching = false;
    const MotionTask task =
        BuildMotionTask(*world_, trace, {lift_, closing_t_, lift_t_}, MotionTiming());
    return std::count_if(task.frames.begin(), task.frames.end(), [](const auto& frame) {
      return frame.phase == MotionPhase::kContact && frame.contacts[1].on;
    });
  };
  const auto all = count_contacts(0);
  EXPECT_EQ(count_contacts(20), all);                // 0.083 s
  EXPECT_NEAR(count_contacts(48), all - 6.0, 1.0);   // 0.2 s: frames at 30 a second
  EXPECT_NEAR(count_contacts(96), all - 12.0, 1.0);  // to the end
}

TEST_F(HandMotionTest, AMotionIsHopelessOnceAKeyframeHasNoPose) {
  MotionTask task = Make(MotionConfig()).task();
  for (const int i : {task.keyframes[1], task.keyframes[2]}) {  // from below, through the table
    task.frames[i].contacts[1].p_OC = Vector3(0.0, 0.0, -kSize.z() / 2);
    task.frames[i].contacts[1].nhat_O = -Vector3::UnitZ();
  }
  const HandMotion motion(*solver_, task, grasp_, {}, 1);
  MotionState state = motion.Start();
  EXPECT_FALSE(state.is_hopeless());
  int solved = 0;
  while (!state.is_hopeless() && motion.SolveKeyframe(state)) ++solved;
  EXPECT_TRUE(state.is_hopeless());
  EXPECT_EQ(solved, 5);  // of seven, last to first
}

TEST_F(HandMotionTest, TheLiftIsTheSimulatedOneAtTheSpeedOfThePhysics) {
  const MotionTask task =
      BuildMotionTask(*world_, trace_, {lift_, closing_t_, lift_t_}, MotionTiming());
  const int closed = task.keyframes[5], count = static_cast<int>(task.frames.size());
  EXPECT_EQ(task.frames[closed].phase, MotionPhase::kClosing);
  EXPECT_EQ(task.frames[closed + 1].phase, MotionPhase::kLift);
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

TEST_F(HandMotionTest, EveryFrameIsSolvedAndCertifiedByFclAndEveryWayIsFree) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  motion.Finish(state);
  const MotionSummary summary = motion.Summarize(state);
  EXPECT_EQ(summary.failed, 0);
  EXPECT_EQ(summary.blocked_ways, 0);
  EXPECT_EQ(summary.loosened, 0);
  EXPECT_LE(summary.max_tip_error, 5e-4);
  EXPECT_GE(summary.min_clearance, 0.0);
  const HandCertificate certificate(ShadowHand(),
                                    {&scene_.bodies[0].shape, &scene_.bodies[1].shape});
  const std::vector<MotionFrameTask>& frames = state.task->frames;
  ASSERT_EQ(frames.size(), state.frames.size());
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    TouchRule touch;
    for (int f = 0; f < kNumFingers; ++f) touch.touching[f] = frames[i].contacts[f].on;
    EXPECT_TRUE(
        certificate.FindCollisions(state.frames[i].configuration, frames[i].X_WB, touch, true)
            .empty())
        << "frame " << i;
  }
}

TEST_F(HandMotionTest, AtTenTimesTheFrameRateAnIndependentCheckFindsNothingAndLimitsAreKept) {
  for (const std::uint64_t seed : {1, 2}) {
    const HandMotion motion = Make(MotionConfig(), seed);
    MotionState state = motion.Start();
    motion.Finish(state);
    const MotionAudit audit = AuditMotion(ShadowHand(), scene_, FramesOf(state));
    EXPECT_EQ(audit.bad_frames, 0) << audit.worst_pair;
    EXPECT_EQ(audit.bad_ways, 0) << audit.worst_pair;
    EXPECT_EQ(audit.out_of_range, 0);
    for (const AuditRates& rates : audit.rates) EXPECT_EQ(rates.over, 0) << rates.limiting;
    EXPECT_LE(audit.longest_still, 1.2);  // what the simulation stands still for
  }
}

TEST_F(HandMotionTest, ATableThatRisesBetweenTwoFramesOnlyIsFoundAndMarked) {
  // In the middle of the lift, for less than a frame, the table is where the hand is.
  const HandMotion honest = Make(MotionConfig());
  MotionTask task = honest.task();
  MotionFrameTask& frame = task.frames[task.frames.size() - 10];
  ASSERT_EQ(frame.X_WB_way.size(), 9U);
  for (int i = 3; i < 6; ++i) {
    frame.X_WB_way[i][1].translation().z() = frame.X_WB[0].translation().z() + 0.05;
  }
  const HandMotion motion(*solver_, task, grasp_, {}, 1);
  MotionState state = motion.Start();
  motion.Finish(state);
  const MotionSummary summary = motion.Summarize(state);
  EXPECT_GE(summary.blocked_ways, 1);
  EXPECT_GE(summary.failed, summary.blocked_ways);
}

TEST_F(HandMotionTest, KeyframesAreSolvedLastToFirstByDefault) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  EXPECT_EQ(state.solved_keys, (std::vector<int>{6, 5, 4, 3, 2, 1, 0}));
}

TEST_F(HandMotionTest, TheApproachIsSolvedLastAlsoWhereTheFirstFrameTouchesNothing) {
  std::vector<TraceRow> trace = trace_;
  for (int i = 0; i < 48; ++i) trace[i].state.fingers[1].touching = false;
  const MotionTask task =
      BuildMotionTask(*world_, trace, {lift_, closing_t_, lift_t_}, MotionTiming());
  const HandMotion motion(*solver_, task, grasp_, {}, 1);
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  EXPECT_FALSE(AnyOn(task.frames[task.keyframes[1]].contacts));
  EXPECT_EQ(state.solved_keys.back(), 0);
}

TEST_F(HandMotionTest, ThePalmStartsTwentyCentimetresOff) {
  const HandMotion motion = Make(MotionConfig());
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  const Vector3 first = state.keys[1].configuration.X_WH.translation();
  const Vector3 start = state.keys[0].configuration.X_WH.translation();
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

// Two fingers push, let go, and two others push on elsewhere: the hand relocates in between.
TEST(RelocationTest, TheHandLeavesOneContactAndTakesAnotherWithoutPassingThroughAnything) {
  const MotionProblem problem = MakeMotionProblem(3);
  const IkSolver solver(ShadowHand(), problem.scene);
  const HandMotion motion(solver, problem.task, problem.grasp, {}, problem.seed);
  MotionState state = motion.Start();
  motion.Finish(state);
  EXPECT_EQ(motion.Summarize(state).failed, 0);
  EXPECT_EQ(motion.Summarize(state).over_limits, 0);
  std::vector<std::array<bool, kNumFingers>> stages;  // fingers that push, one after the other
  const std::vector<AuditFrame> frames = FramesOf(state);
  int transit = 0;
  for (const AuditFrame& frame : frames) {
    transit += frame.phase == MotionPhase::kTransit ? 1 : 0;
    if (frame.phase == MotionPhase::kContact && (stages.empty() || stages.back() != frame.on)) {
      stages.push_back(frame.on);
    }
  }
  const std::array<bool, kNumFingers> first{true, true}, second{false, false, true, true};
  EXPECT_EQ(stages, (std::vector{first, second}));
  EXPECT_GT(transit, 10);
  EXPECT_TRUE(AuditMotion(ShadowHand(), problem.scene, frames).IsFree());
}

}  // namespace
}  // namespace pregrasp
