// What the project's own dynamics finds is found by another engine too, from the files of a run.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/core/check.h"
#include "app/grasp/lift.h"
#include "app/recording/rollout_table.h"
#include "app/recording/scene_file.h"
#include "app/trajectory/simulate_plan.h"
#include "tests/grasp/grasp_scenes.h"
#include "tests/replay/mujoco_replay.h"
#include "tests/test_folder.h"
#include "tests/trajectory/ruler_fixture.h"

namespace pregrasp {
namespace {

constexpr double kPushStep = 2e-3, kLiftStep = 2.5e-4;  // of MuJoCo [s]

void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

// Through files and back, as another program would see the run.
struct ReplayedRun {
  Scene scene;
  std::vector<ReplayRow> rows;

  ReplayedRun(const World& world, const std::vector<TraceRow>& trace, bool lift) {
    const TestFolder folder;
    std::string table = lift ? LiftHeader(world.scene()) : RolloutHeader(world.scene());
    for (const TraceRow& row : trace)
      table += lift ? LiftRow(world.scene(), row.state) : RolloutRow(row.state);
    WriteText(folder.path() / "table.csv", table);
    WriteScene(folder.path(), world.scene(), world.config().dt);
    scene = LoadScene(folder.path() / "scene.json");
    rows = ReadReplayTable(folder.path() / "table.csv", scene);
  }
};

TEST(ReplayTest, ADragOfTheRulerEndsInMujocoWhereItEndsHere) {
  const RulerProblem ruler;
  std::vector<TraceRow> trace;
  SimulatePlan(ruler.world, ruler.environment, ruler.world.InitialState(),
               MakeRulerDrag(0.015, 0.06), PlanTiming(), Stepper::kSimbody, &trace);
  const ReplayedRun run(ruler.world, trace, false);
  const ReplayResult result = ReplayInMujoco(run.scene, run.rows, kPushStep);
  ASSERT_EQ(result.X_WO.size(), run.rows.size());
  const RigidTransform& X_WO = run.rows.back().X_WB.front();
  EXPECT_GT((X_WO.translation() - run.rows.front().X_WB.front().translation()).norm(), 0.04);
  EXPECT_LT((result.X_WO.back().translation() - X_WO.translation()).norm(), 0.003);
  EXPECT_LT(RadToDeg(RotationAngle(result.X_WO.back().linear(), X_WO.linear())), 2.0);
}

// Thumb against index and middle across an upright bar of `width` on a table; with the stiffness
// and the friction of the world that it is lifted in.
struct BarLift {
  Scene scene, lifted;
  LiftResult lift;

  BarLift(double width, double mass, double stiffness, double friction) {
    scene = MakeScene("bar", Box{{0.05, width, 0.12}}, mass, Shift(0, 0, 0.06));
    scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
    const GraspWorld grasp_world(scene, ShadowHand());
    const double y = 0.5 * width;
    GraspResult grasp =
        TestContacts(grasp_world, GraspConfig(),
                     {{Finger::kThumb, Vector3(0, -y, 0.03), -Vector3::UnitY()},
                      {Finger::kIndex, Vector3(0.011, y, 0.03), Vector3::UnitY()},
                      {Finger::kMiddle, Vector3(-0.011, y, 0.03), Vector3::UnitY()}},
                     grasp_world.StartPoses(), Rng(1, RngStream::kTest));
    PREGRASP_CHECK(grasp.feasible());
    lifted = scene;
    lifted.fingertips.grasp_stiffness = stiffness;
    lifted.fingertips.friction = friction;
    StepConfig half;
    half.dt *= 0.5;
    const World world(lifted), half_world(lifted, half);
    LiftConfig config;
    config.forces.min_stiffness = 0.0;
    LiftWay up;
    up.status = LiftWayStatus::kFree;
    up.length = 0.10;
    lift = LiftGrasp({world, half_world, grasp_world}, world.InitialState(), grasp, up, config);
    PREGRASP_CHECK(lift.simulated, Explain(lift, scene));
    const ReplayedRun run(world, lift.trace, true);
    const ReplayResult result = ReplayInMujoco(run.scene, run.rows, kLiftStep);
    here = JudgeReplay(run.rows, ObjectPoses(run.rows),
                       lift.touching_body ? lift.touching_body->value : -1);
    mujoco = JudgeReplay(run.rows, result.X_WO, result.touching_body);
    EXPECT_NEAR(here.shift, lift.shift, 1e-9);
    EXPECT_NEAR(here.turn_deg, lift.turn_deg, 1e-6);
  }
  ReplayVerdict here, mujoco;
};

TEST(ReplayTest, MujocoLiftsWhatIsLiftedHere) {
  for (const double width : {0.045, 0.06}) {
    for (const double mass : {0.05, 0.3}) {
      const BarLift bar(width, mass, 300.0, 0.8);
      EXPECT_TRUE(bar.lift.held) << Explain(bar.lift, bar.scene);
      EXPECT_TRUE(bar.here.held) << bar.here.shift;
      EXPECT_TRUE(bar.mujoco.held) << bar.mujoco.shift << " m, " << bar.mujoco.turn_deg;
      EXPECT_NEAR(bar.mujoco.shift, bar.here.shift, 0.002);
      EXPECT_NEAR(bar.mujoco.turn_deg, bar.here.turn_deg, 2.0);
    }
  }
}

TEST(ReplayTest, MujocoDropsWhatIsDroppedHere) {
  const BarLift slippery(0.06, 0.1, 300.0, 0.05);
  EXPECT_FALSE(slippery.lift.held);
  EXPECT_FALSE(slippery.here.held);
  EXPECT_FALSE(slippery.mujoco.held);
}

}  // namespace
}  // namespace pregrasp
