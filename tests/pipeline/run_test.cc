#include "app/pipeline/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/grasp/grasp_search.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"
#include "tests/networks/random_network.h"
#include "tests/pipeline/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Short runs with networks whose weights are random: what they find is poor, how they run is not.
class RunTest : public testing::Test {
 protected:
  RunTest() {
    WriteTensors(folder_ / "score.safetensors", MakeRandomScore(3));
    WriteTensors(folder_ / "generator.safetensors", MakeRandomGenerator(4));
    start_.verdict = StartVerdict::kCertified;
    config_.graph.samples = 1;
    config_.mppi.samples = 6;
    config_.mppi.iterations = 3;
    config_.grasp_samples = 2;
    config_.completion.max_refinements = 2;
    config_.completion.max_solves = 1;
    config_.completion.grasp.kinematics.ik.max_starts = 2;
    run_.paths = 2;
  }
  ~RunTest() override { ClearInterrupt(); }

  RunResult RunInto(const std::string& name, int threads,
                    const std::function<void(const RunProgress&)>& progress = {}) {
    SessionConfig session_config;
    session_config.threads = threads;
    session_config.pictures = PictureMode::kNone;
    Session session(MakeRulerScene(), session_config);
    const Planner planner(session.shared_world(), session.start(), config_, 1, session.pool(),
                          folder_);
    PlanRecord record(session, planner);
    session.Record(folder_ / name, PictureMode::kNone);
    try {
      RunResult result = RunPlanner(planner, record, start_, run_, progress);
      session.FinishRecording();
      return result;
    } catch (const Interrupted&) {
      ClearInterrupt();
      session.FinishRecording("interrupted");
      return {};
    }
  }

  std::vector<std::string> Ids(const std::string& name) const {
    std::vector<std::string> ids;
    for (const StepRecord& step : LoadRun(folder_ / name).steps) ids.push_back(step.id);
    return ids;
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
  StartCertificate start_;
  PlannerConfig config_;
  RunConfig run_;
};

TEST_F(RunTest, EveryStageIsAStepOfTheRunDirectory) {
  const RunResult result = RunInto("run", 1);
  EXPECT_EQ(result.reasons.size(), 2U);
  const std::vector<std::string> ids = Ids("run");
  const std::vector<std::string> head(ids.begin(), ids.begin() + 8);
  EXPECT_EQ(head, (std::vector<std::string>{"scene.start", "graph.mesh", "graph.score",
                                            "graph.prune.1", "graph.prune.2", "graph.prune.3",
                                            "paths.rank.1", "path.1.mppi.1"}));
  for (const char* id : {"path.1.mppi.3", "path.1.certify", "paths.rank.2", "path.2.certify"}) {
    EXPECT_EQ(std::count(ids.begin(), ids.end(), id), 1) << id;
  }
  EXPECT_FALSE(VerifyManifest(folder_ / "run").has_value());
}

TEST_F(RunTest, TheSummarySaysWhatWasDone) {
  const RunResult result = RunInto("run", 1);
  const LoadedRun run = LoadRun(folder_ / "run");
  EXPECT_EQ(run.summary["status"], RunStatusName(result.status));
  EXPECT_EQ(run.summary["n_paths"], 2);
  EXPECT_EQ(run.summary["counts"]["nodes"], 1600);
  const auto pruned = std::find_if(run.steps.begin(), run.steps.end(), [](const StepRecord& step) {
    return step.id == "graph.prune.3";
  });
  ASSERT_NE(pruned, run.steps.end());
  EXPECT_EQ(run.summary["counts"]["kept"].get<std::size_t>(), pruned->details["kept"].size());
  EXPECT_EQ(pruned->details["initial"].size(), 80U);  // 5 % of 1600
  EXPECT_EQ(run.summary["counts"]["iterations"], 6);
  EXPECT_EQ(run.summary["counts"]["rollouts"], 36);
  EXPECT_EQ(run.summary["start_grasps"]["certified"], true);
}

TEST_F(RunTest, OneAndTwoThreadsGiveTheSameBytes) {
  RunInto("one", 1);
  RunInto("two", 2);
  for (const char* file : {"steps.jsonl", "rollout.csv", "run.rawlog", "scene.json"}) {
    EXPECT_EQ(ReadFile(folder_ / "one" / file), ReadFile(folder_ / "two" / file)) << file;
  }
}

TEST_F(RunTest, AGraspableStartIsNotPlannedFor) {
  start_.verdict = StartVerdict::kGraspable;
  EXPECT_EQ(RunInto("run", 1).status, RunStatus::kStartGraspable);
  EXPECT_EQ(LoadRun(folder_ / "run").summary["status"], "start_graspable");
  EXPECT_EQ(Ids("run"), std::vector<std::string>{"scene.start"});
}

TEST_F(RunTest, AnInterruptLeavesAValidShorterRun) {
  RunInto("run", 1, [](const RunProgress& progress) {
    if (progress.stage == "path 1 of 2, trajectory" && progress.done == 2) RequestInterrupt();
  });
  EXPECT_EQ(LoadRun(folder_ / "run").summary["status"], "interrupted");
  EXPECT_FALSE(VerifyManifest(folder_ / "run").has_value());
  EXPECT_EQ(Ids("run").back(), "path.1.mppi.2");
}

// What the shipped networks and an exhaustive search find at the end of a plan whose index finger
// presses the middle of the ruler's top and never moves.
struct MotionlessEnd {
  Certificate certificate;
  ReleaseResult release;
  int generated = 0, feasible = 0;  // by the generator, with refinement
  bool searched = false;            // a feasible set was found
};

MotionlessEnd PressWithoutMoving(double overhang) {
  Scene scene = MakeRulerScene();
  scene.bodies[0].X_WB.translation().x() = overhang - 0.150;
  Session session(std::move(scene), {});
  PlannerConfig config;
  config.graph.samples = 1;
  const Planner planner(session.shared_world(), session.start(), config, 1, session.pool(),
                        PREGRASP_SOURCE_DIR "/assets/weights");
  const ContactGraph graph = planner.BuildGraph(config.mesh, config.graph);
  int top = 0;  // the triangle of the top face nearest to the middle
  const auto centre = [&](int t) {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < 3; ++i) sum += graph.mesh().V.row(graph.mesh().F(t, i)).transpose() / 3.0;
    return sum;
  };
  const Vector3 middle(0.0, 0.0, 0.0015);
  for (int t = 1; t < graph.num_triangles(); ++t) {
    if ((centre(t) - middle).norm() < (centre(top) - middle).norm()) top = t;
  }
  ContactPath path;
  path.rank = 1;
  path.nodes = {top * graph.num_triangles() + top};
  const Mppi mppi = planner.MakeMppi(graph, path, config.mppi);
  MppiState state = mppi.Start();
  state.best_action.assign(state.mean.size(), 0.0);
  state.best_action[state.best_action.size() / 2] = 1.0;  // the index finger on, its targets still
  MotionlessEnd end;
  end.certificate = planner.Certify(mppi, state);
  end.release = planner.Release(graph, end.certificate);
  const GraspSet grasps = planner.CompleteGrasps(end.certificate, end.release, 1);
  end.generated = static_cast<int>(grasps.grasps.size());
  end.feasible = static_cast<int>(grasps.feasible.size());
  GraspSearchConfig search;
  search.max_sets = 20000;
  end.searched =
      !SearchGrasps(planner.grasp_world(), search, {},
                    planner.world().GetPoses(end.certificate.full.end), 1, session.pool())
           .found.empty();
  return end;
}

// Where the ruler lies such a plan holds, and no contacts at all make it a success; where it stands
// over the edge the same planner finds grasps, so that it is the place that fails.
TEST(MotionlessPlanTest, FailsWhereTheRulerLiesAndTheSamePlannerGraspsItOverTheEdge) {
  for (const double overhang : {-0.010, 0.060}) {
    const MotionlessEnd end = PressWithoutMoving(overhang);
    ASSERT_TRUE(end.certificate.certified) << overhang;
    const Vector3 p_WO = end.certificate.full.end.bodies[0].p_WB;
    EXPECT_LT((p_WO - Vector3(overhang - 0.150, 0.0, 0.0015)).norm(), 1e-3) << overhang;
    EXPECT_TRUE(end.release.stays) << overhang;
    EXPECT_EQ(end.generated, 20) << overhang;
    EXPECT_EQ(end.feasible > 0, overhang > 0.0) << end.feasible;
    EXPECT_EQ(end.searched, overhang > 0.0) << overhang;
  }
}

TEST_F(RunTest, MissingWeightsAreBadInputThatNamesTheFile) {
  fs::remove(folder_ / "score.safetensors");
  try {
    RunInto("run", 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("score.safetensors"), std::string::npos);
  }
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

}  // namespace
}  // namespace pregrasp
