#include "app/recording/run_directory.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "app/core/error.h"
#include "app/core/sha256.h"
#include "app/core/json_text.h"
#include "app/recording/manifest.h"
#include "app/recording/scene_file.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A scene with the object alone in it, but for a table.
Scene SmallScene() {
  Scene scene = SampleScene();
  scene.bodies.resize(2);
  return scene;
}

nlohmann::json SummaryOf(const fs::path& run) {
  return ParseJson(ReadFile(run / "summary.json"), "summary.json");
}

TEST(RunDirectoryTest, AFinishedRunHoldsTheFilesOfTheDesignAndNothingIsLeftBesideIt) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 2, true);
  const std::vector<std::string> expected = {"frames/0001_sim-0.png",
                                             "frames/0002_sim-1.png",
                                             "manifest.json",
                                             "meshes/object.obj",
                                             "meshes/scan.obj",
                                             "meshes/scan.points.obj",
                                             "meshes/tool.2.2.obj",
                                             "rollout.csv",
                                             "run.rawlog",
                                             "run_Images",
                                             "scene.json",
                                             "steps.jsonl",
                                             "summary.json"};
  EXPECT_EQ(ListRunFiles(folder.path() / "run").files, expected);
  EXPECT_EQ(fs::read_symlink(folder.path() / "run/run_Images"), "frames");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RunDirectoryTest, TheSameRunTwiceHasTheSameBytes) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "a", 20, true);
  WriteSampleRun(folder.path() / "b", 20, true);
  const std::vector<std::string> files = ListRunFiles(folder.path() / "a").files;
  ASSERT_EQ(ListRunFiles(folder.path() / "b").files, files);
  for (const std::string& file : files) {
    if (file == "run_Images") continue;
    EXPECT_EQ(ReadFile(folder.path() / "a" / file), ReadFile(folder.path() / "b" / file)) << file;
  }
}

TEST(RunDirectoryTest, PicturesChangeNoOtherFileButTheManifest) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "with", 20, true);
  WriteSampleRun(folder.path() / "without", 20, false);
  for (const std::string& file : ListRunFiles(folder.path() / "without").files) {
    if (file == "manifest.json") continue;
    EXPECT_EQ(ReadFile(folder.path() / "with" / file), ReadFile(folder.path() / "without" / file))
        << file;
  }
}

TEST(RunDirectoryTest, TheHeaderOfTheRolloutIsTheContracts) {
  const TemporaryFolder folder;
  {  // One object and one other movable body.
    Scene scene = SampleScene();
    scene.bodies.resize(3);
    RunDirectory run(folder.path() / "run", scene);
    run.Finish({}, {});
  }
  EXPECT_EQ(ReadFile(folder.path() / "run/rollout.csv"),
            "t,p_WO_x,p_WO_y,p_WO_z,q_WO_w,q_WO_x,q_WO_y,q_WO_z,w_WO_x,w_WO_y,w_WO_z,"
            "v_WO_x,v_WO_y,v_WO_z,"
            "tool_p_WO_x,tool_p_WO_y,tool_p_WO_z,tool_q_WO_w,tool_q_WO_x,tool_q_WO_y,tool_q_WO_z,"
            "tool_w_WO_x,tool_w_WO_y,tool_w_WO_z,tool_v_WO_x,tool_v_WO_y,tool_v_WO_z,"
            "thumb_on,thumb_p_OC_x,thumb_p_OC_y,thumb_p_OC_z,"
            "thumb_target_W_x,thumb_target_W_y,thumb_target_W_z,"
            "thumb_f_W_x,thumb_f_W_y,thumb_f_W_z,"
            "index_on,index_p_OC_x,index_p_OC_y,index_p_OC_z,"
            "index_target_W_x,index_target_W_y,index_target_W_z,"
            "index_f_W_x,index_f_W_y,index_f_W_z\n");
}

TEST(RunDirectoryTest, RowsOfTheRolloutReadBackToTheLastBit) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 10);
  std::istringstream lines(ReadFile(folder.path() / "run/rollout.csv"));
  std::string line;
  std::getline(lines, line);
  const auto columns = std::count(line.begin(), line.end(), ',');
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
    std::istringstream cells(line);
    const auto next = [&] {
      std::string cell;
      std::getline(cells, cell, ',');
      return std::strtod(cell.c_str(), nullptr);
    };
    const auto next3 = [&] {
      const double x = next();
      const double y = next();
      return Vector3(x, y, next());
    };
    const WorldState state = SampleState(i);
    EXPECT_EQ(next(), state.t);
    for (const BodyState& body : state.bodies) {
      EXPECT_EQ(next3(), body.p_WB);
      EXPECT_EQ(next(), body.q_WB.w());
      EXPECT_EQ(next3(), Vector3(body.q_WB.vec()));
      EXPECT_EQ(next3(), body.w_WB);
      EXPECT_EQ(next3(), body.v_WB);
    }
    for (std::size_t k = 0; k < kNumPlanningFingers; ++k) {
      const FingertipState& finger = state.fingers[k];
      EXPECT_EQ(next(), finger.on ? 1.0 : 0.0);
      EXPECT_EQ(next3(), finger.p_OC);
      EXPECT_EQ(next3(), finger.p_WTarget);
      EXPECT_EQ(next3(), finger.f_W);
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

// Every key of a JSON value as a path, "wrench.mu".
void CollectKeys(const nlohmann::json& value, const std::string& prefix,
                 std::set<std::string>& keys) {
  for (const auto& [key, item] : value.items()) {
    keys.insert(prefix + key);
    if (item.is_object()) CollectKeys(item, prefix + key + '.', keys);
  }
}

TEST(RunDirectoryTest, TheSummaryHasTheFieldsOfTheContractAndNoOthers) {
  const TemporaryFolder folder;
  RunDirectory run(folder.path() / "run", SmallScene());
  run.Finish({}, {});
  std::set<std::string> keys;
  CollectKeys(SummaryOf(folder.path() / "run"), "", keys);
  const std::set<std::string> expected = {"scene",
                                          "seed",
                                          "status",
                                          "within_rules",
                                          "n_paths",
                                          "n_screened",
                                          "r_suc",
                                          "r_suc_raw",
                                          "grasps",
                                          "grasps.tried",
                                          "grasps.feasible",
                                          "grasps.fingers",
                                          "grasps.kept",
                                          "start_grasps",
                                          "start_grasps.tried",
                                          "start_grasps.feasible",
                                          "start_grasps.certified",
                                          "object_motion",
                                          "object_motion.translation_m",
                                          "object_motion.rotation_deg",
                                          "object_motion.max_speed",
                                          "contacts",
                                          "switches",
                                          "wrench",
                                          "wrench.mu",
                                          "wrench.margin",
                                          "wrench.min_normal_N",
                                          "wrench.forces",
                                          "lift",
                                          "lift.held",
                                          "lift.height_m",
                                          "lift.slip_mm",
                                          "motion",
                                          "motion.frames",
                                          "motion.failed",
                                          "motion.loosened",
                                          "motion.max_tip_error_mm",
                                          "motion.min_clearance_mm",
                                          "motion.max_joint_speed",
                                          "motion.order",
                                          "physics",
                                          "physics.mu_tip",
                                          "physics.max_force_N",
                                          "physics.max_penetration_mm",
                                          "physics.dt",
                                          "counts",
                                          "counts.nodes",
                                          "counts.kept",
                                          "counts.paths",
                                          "counts.rollouts",
                                          "counts.iterations",
                                          "seconds",
                                          "seconds.total",
                                          "seconds.geometry",
                                          "seconds.graph",
                                          "seconds.trajectory",
                                          "seconds.grasp",
                                          "seconds.motion",
                                          "seconds.pictures",
                                          "peak_rss_mb",
                                          "hash"};
  EXPECT_EQ(keys, expected);
}

TEST(RunDirectoryTest, TheSummarySaysWhatIsKnownAndNullForTheRest) {
  const TemporaryFolder folder;
  Scene scene = SmallScene();
  scene.gravity = {0.0, 0.0, -9.81};
  RunDirectory run(folder.path() / "run", scene, {42, 0.001, {}});
  run.Finish({{"status", "ok"},
              {"wrench", {{"mu", 0.8}, {"margin", std::numeric_limits<double>::quiet_NaN()}}},
              {"contacts", {{{"fingers", {"thumb"}}, {"triangles", {3}}}}},
              {"grasps", nullptr}},
             {});
  const nlohmann::json summary = SummaryOf(folder.path() / "run");
  EXPECT_EQ(summary["scene"], "sample");
  EXPECT_EQ(summary["seed"], 42);
  EXPECT_EQ(summary["status"], "ok");
  EXPECT_EQ(summary["within_rules"], true);
  EXPECT_EQ(summary["physics"]["mu_tip"], 0.7);
  EXPECT_EQ(summary["physics"]["max_force_N"], 11.5);
  EXPECT_EQ(summary["physics"]["dt"], 0.001);
  EXPECT_TRUE(summary["physics"]["max_penetration_mm"].is_null());
  EXPECT_EQ(summary["wrench"]["mu"], 0.8);
  EXPECT_TRUE(summary["wrench"]["margin"].is_null());
  EXPECT_TRUE(summary["wrench"]["forces"].is_null());
  EXPECT_EQ(summary["contacts"][0]["triangles"][0], 3);
  EXPECT_TRUE(summary["grasps"]["tried"].is_null());
}

TEST(RunDirectoryTest, ASceneOutsideTheRulesIsSaidToBe) {
  const TemporaryFolder folder;
  Scene scene = SmallScene();
  scene.fingertips.friction = 1.2;
  RunDirectory run(folder.path() / "run", scene);
  run.Finish({}, {});
  EXPECT_EQ(SummaryOf(folder.path() / "run")["within_rules"], false);
}

TEST(RunDirectoryTest, TheHashOfTheSummaryIsThatOfRolloutThenMotion) {
  const TemporaryFolder folder;
  const fs::path with = folder.path() / "with";
  const fs::path without = folder.path() / "without";
  for (const fs::path& directory : {with, without}) {
    RunDirectory run(directory, SampleScene());
    for (int i = 0; i < 3; ++i) run.AddRolloutRow(SampleState(i));
    if (directory == with) WriteFile(run.partial() / "motion.csv", "t\n0\n");
    run.Finish({}, {});
  }
  const std::string rollout = ReadFile(with / "rollout.csv");
  EXPECT_EQ(SummaryOf(without)["hash"], Sha256(rollout));
  EXPECT_EQ(SummaryOf(with)["hash"], Sha256(rollout + "t\n0\n"));
}

TEST(RunDirectoryTest, AFieldOrStatusThatTheSummaryLacksIsOurBug) {
  const TemporaryFolder folder;
  const auto finish = [&](const nlohmann::json& summary) {
    RunDirectory run(folder.path() / "run", SmallScene());
    run.Finish(summary, {});
  };
  EXPECT_THROW(finish({{"r_succ", 0.5}}), InternalError);
  EXPECT_THROW(finish({{"wrench", {{"nu", 0.5}}}}), InternalError);
  EXPECT_THROW(finish({{"status", "fine"}}), InternalError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RunDirectoryTest, ARunReadsBack) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 7);
  const LoadedRun run = LoadRun(folder.path() / "run");
  EXPECT_EQ(run.summary["status"], "interrupted");
  EXPECT_EQ(run.manifest["seed"], 1);
  EXPECT_EQ(run.scene["name"], "sample");
  EXPECT_EQ(LoadScene(folder.path() / "run/scene.json").bodies.size(), 5U);
  ASSERT_EQ(run.steps.size(), 7U);
  EXPECT_EQ(run.steps[6].id, "sim.6");
  EXPECT_EQ(run.steps[6].details, SampleStep(6).details);
}

TEST(RunDirectoryTest, AnUnfinishedRunLeavesNothingBehind) {
  const TemporaryFolder folder;
  {
    RunDirectory run(folder.path() / "not/there/yet", SampleScene());
    WriteFile(run.NextPicture("sim.0"), kOnePixelPng);
    run.AddStep(SampleStep(0));
    EXPECT_THROW(LoadRun(run.partial()), InputError);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RunDirectoryTest, AnUnfinishedRunLeavesTheOldOneAsItWas) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 3);
  const std::string manifest = ReadFile(folder.path() / "run/manifest.json");
  {
    RunDirectory run(folder.path() / "run", SampleScene(2));
    run.AddStep(SampleStep(0, 2));
  }
  EXPECT_EQ(ReadFile(folder.path() / "run/manifest.json"), manifest);
  EXPECT_FALSE(VerifyManifest(folder.path() / "run"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RunDirectoryTest, ANewRunReplacesTheOldOneAltogether) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 5, true, 1);
  WriteSampleRun(folder.path() / "run", 3, false, 2);
  EXPECT_FALSE(VerifyManifest(folder.path() / "run"));
  EXPECT_FALSE(fs::exists(folder.path() / "run/frames"));
  EXPECT_EQ(LoadRun(folder.path() / "run").manifest["seed"], 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RunDirectoryTest, AnInvalidSceneIsRefusedBeforeAnythingIsMade) {
  const TemporaryFolder folder;
  Scene scene = SampleScene();
  scene.bodies[1].name = "../table";
  EXPECT_THROW(RunDirectory(folder.path() / "run", scene), InputError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace pregrasp
