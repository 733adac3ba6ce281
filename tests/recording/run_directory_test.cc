#include "app/recording/run_directory.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/job/facts_json.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "app/recording/scene_file.h"
#include "app/recording/summary.h"
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

TEST(RunDirectoryTest, APictureIsNamedByNumberAndId) {
  EXPECT_EQ(PictureName(1, "scene.start"), "0001_scene-start.png");
  EXPECT_EQ(PictureName(12345, "path.2.mppi.7~2"), "12345_path-2-mppi-7~2.png");
}

TEST(RunDirectoryTest, AFinishedRunHoldsTheFilesOfTheDesignAndNothingIsLeftBesideIt) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 2, 2);
  const std::vector<std::string> expected = {"frames/0001_sim-0.png",
                                             "frames/0002_sim-1.png",
                                             "journal.jsonl",
                                             "manifest.json",
                                             "meshes/object.obj",
                                             "meshes/scan.obj",
                                             "meshes/scan.points.obj",
                                             "meshes/tool.2.2.obj",
                                             "pictures.jsonl",
                                             "pictures.rawlog",
                                             "pictures_Images",
                                             "rollout.csv",
                                             "run.rawlog",
                                             "scene.json",
                                             "steps.jsonl",
                                             "summary.json"};
  EXPECT_EQ(ListRunFiles(folder.path() / "run").files, expected);
  EXPECT_EQ(fs::read_symlink(folder.path() / "run/pictures_Images"), "frames");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(RunDirectoryTest, TheSameRunTwiceHasTheSameBytes) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "a", 20, 20);
  WriteSampleRun(folder.path() / "b", 20, 20);
  const std::vector<std::string> files = ListRunFiles(folder.path() / "a").files;
  ASSERT_EQ(ListRunFiles(folder.path() / "b").files, files);
  for (const std::string& file : files) {
    if (file == "pictures_Images") continue;
    EXPECT_EQ(ReadFile(folder.path() / "a" / file), ReadFile(folder.path() / "b" / file)) << file;
  }
}

TEST(RunDirectoryTest, PicturesChangeNoOtherFileButTheManifest) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "with", 20, 20);
  WriteSampleRun(folder.path() / "without", 20, 0);
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
    run.Finish(RunSummary{}, "", {});
  }
  EXPECT_EQ(ReadFile(folder.path() / "run/rollout.csv"),
            "t,p_WO_x,p_WO_y,p_WO_z,q_WO_w,q_WO_x,q_WO_y,q_WO_z,w_WO_x,w_WO_y,w_WO_z,"
            "v_WO_x,v_WO_y,v_WO_z,"
            "tool_p_WO_x,tool_p_WO_y,tool_p_WO_z,tool_q_WO_w,tool_q_WO_x,tool_q_WO_y,tool_q_WO_z,"
            "tool_w_WO_x,tool_w_WO_y,tool_w_WO_z,tool_v_WO_x,tool_v_WO_y,tool_v_WO_z,"
            "thumb_on,thumb_p_OC_x,thumb_p_OC_y,thumb_p_OC_z,"
            "thumb_n_OC_x,thumb_n_OC_y,thumb_n_OC_z,"
            "thumb_target_W_x,thumb_target_W_y,thumb_target_W_z,"
            "thumb_f_W_x,thumb_f_W_y,thumb_f_W_z,"
            "index_on,index_p_OC_x,index_p_OC_y,index_p_OC_z,"
            "index_n_OC_x,index_n_OC_y,index_n_OC_z,"
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
      EXPECT_EQ(next3(), finger.nhat_O);
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
  run.Finish(RunSummary{}, "", {});
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
                                          "r_lift",
                                          "grasps",
                                          "grasps.tried",
                                          "grasps.feasible",
                                          "grasps.fingers",
                                          "grasps.kept",
                                          "grasps.lifting",
                                          "grasps.source",
                                          "start_grasps",
                                          "start_grasps.tried",
                                          "start_grasps.feasible",
                                          "start_grasps.certified",
                                          "start_grasps.mu_star",
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
                                          "lift.turn_deg",
                                          "lift.pushes",
                                          "lift.soft",
                                          "lift.stiff",
                                          "robust",
                                          "robust.worlds",
                                          "robust.held",
                                          "robust.worst_shift_mm",
                                          "robust.worst_turn_deg",
                                          "neighbours",
                                          "neighbours.moved_mm",
                                          "neighbours.turned_deg",
                                          "neighbours.worst",
                                          "motion",
                                          "motion.frames",
                                          "motion.failed",
                                          "motion.loosened",
                                          "motion.max_tip_error_mm",
                                          "motion.min_clearance_mm",
                                          "motion.max_joint_speed",
                                          "motion.max_wrist_speed",
                                          "motion.forearm_free",
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

TEST(RunDirectoryTest, TheSummaryReadsBackAndIsNullWhereNothingIsKnown) {
  const TemporaryFolder folder;
  RunSummary summary;
  summary.scene = "sample";
  summary.seed = 42;
  summary.status = "ok";
  summary.r_suc = 1.0 / 3.0;
  summary.wrench.mu = 0.8;
  summary.wrench.forces = {{Finger::kThumb, {1, 2, 3}, {0, 0, 1}, {0.1, 0.2, 0.3}}};
  summary.contacts = {{{Finger::kThumb}, {3}}};
  summary.object_motion.translation_m = 0.1;
  RunDirectory run(folder.path() / "run", SmallScene());
  run.Finish(summary, "", {});
  const nlohmann::json json = SummaryOf(folder.path() / "run");
  EXPECT_EQ(json["contacts"][0]["fingers"][0], "thumb");
  EXPECT_TRUE(json["wrench"]["margin"].is_null());
  EXPECT_TRUE(json["grasps"]["tried"].is_null());
  const RunSummary back = LoadSummary(folder.path() / "run" / "summary.json");
  EXPECT_EQ(back.seed, 42U);
  EXPECT_EQ(back.r_suc, summary.r_suc);
  EXPECT_EQ(back.wrench.forces->at(0).f_W, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(back.contacts->at(0).triangles, std::vector<int>{3});
  EXPECT_FALSE(back.lift.held.has_value());
  EXPECT_TRUE(back.hash.has_value());
}

TEST(RunDirectoryTest, TheHashOfTheSummaryIsThatOfRolloutThenLiftThenMotion) {
  const TemporaryFolder folder;
  const fs::path with = folder.path() / "with";
  const fs::path without = folder.path() / "without";
  for (const fs::path& directory : {with, without}) {
    RunDirectory run(directory, SampleScene());
    for (int i = 0; i < 3; ++i) run.AddRolloutRow(SampleState(i));
    if (directory == with) {
      WriteFile(run.partial() / "motion.csv", "t\n0\n");
      WriteFile(run.partial() / "lift.csv", "t\n1\n");
    }
    run.Finish(RunSummary{}, "", {});
  }
  const std::string rollout = ReadFile(with / "rollout.csv");
  EXPECT_EQ(SummaryOf(without)["hash"], Sha256(rollout));
  EXPECT_EQ(SummaryOf(with)["hash"], Sha256(rollout + "t\n1\nt\n0\n"));
}

TEST(RunDirectoryTest, ARunReadsBack) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run", 7);
  const LoadedRun run = LoadRun(folder.path() / "run");
  EXPECT_EQ(run.summary.status, "interrupted");
  EXPECT_EQ(run.manifest["seed"], 1);
  EXPECT_EQ(run.scene.name, "sample");
  EXPECT_EQ(run.scene.bodies.size(), 5U);
  ASSERT_EQ(run.steps.size(), 7U);
  EXPECT_FALSE(CompareFacts(run.Get("sim.6"), SampleStep(6)).has_value());
  EXPECT_EQ(run.journal[3], SampleStep(3).command);
  EXPECT_THROW(run.Get("sim.7"), InputError);
}

TEST(RunDirectoryTest, AnUnfinishedRunLeavesNothingBehind) {
  const TemporaryFolder folder;
  {
    RunDirectory run(folder.path() / "not/there/yet", SampleScene());
    WriteFile(run.PictureFile(1, "sim.0"), kOnePixelPng);
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
  WriteSampleRun(folder.path() / "run", 5, 5, 1);
  WriteSampleRun(folder.path() / "run", 3, 0, 2);
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
