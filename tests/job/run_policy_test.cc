#include "app/job/run_policy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/grasp/grasp_search.h"
#include "app/job/facts_json.h"
#include "tests/job/fixture.h"
#include "tests/networks/random_network.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

// Short runs with networks whose weights are random: what they find is poor, how they run is not.
class RunPolicyTest : public testing::Test {
 protected:
  RunPolicyTest() {
    WriteRandomWeights(folder_.path());
    setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);  // for verdicts
    setup_.scene = MakeRulerScene();
    setup_.weights = folder_.path();
    setup_.config.graph.samples = 1;
    setup_.config.mppi.samples = 6;
    setup_.config.mppi.iterations = 3;
    setup_.config.screen = {4, 4, 1, 2, 4, 100.0};  // nothing is worth so much more than nothing
    setup_.config.grasp_samples = 2;
    setup_.config.search.max_sets = 4096;
    setup_.config.search.max_solves = 16;
    setup_.config.completion.max_solves = 1;
    setup_.config.completion.grasp.kinematics.ik.max_starts = 2;
    run_.paths = 2;
  }
  ~RunPolicyTest() override { ClearInterrupt(); }

  // So that no path succeeds: the fingers cannot carry it.
  void MakeTheRulerTooHeavy() {
    MassProperties& mass = *setup_.scene.object().mass_properties;
    mass.mass *= 400.0;
    mass.I_BBcm *= 400.0;
  }

  static std::vector<std::string> Ids(const Timeline& timeline) {
    std::vector<std::string> ids;
    for (const auto& node : timeline.nodes()) ids.push_back(node->id());
    return ids;
  }

  const TestFolder folder_;
  JobSetup setup_;
  RunConfig run_;
};

TEST_F(RunPolicyTest, EveryStageIsAStep) {
  MakeTheRulerTooHeavy();
  Job job(setup_, 1);
  Timeline timeline(job);
  const RunResult result = RunPlanner(timeline, run_, {});
  EXPECT_EQ(result.reasons.size(), 2U);
  const std::vector<std::string> ids = Ids(timeline);
  const std::vector<std::string> head(ids.begin(), ids.begin() + 15);
  EXPECT_EQ(head, (std::vector<std::string>{"scene.start", "scene.verdict", "graph.mesh",
                                            "graph.score", "graph.prune.1", "graph.prune.2",
                                            "graph.prune.3", "paths.rank.1", "path.1.screen.1",
                                            "paths.rank.2", "path.2.screen.1", "paths.rank.3",
                                            "path.3.screen.1", "paths.rank.4", "path.4.screen.1"}));
  const auto count_ends = [&](const std::string& end) {
    return std::count_if(ids.begin(), ids.end(), [&](const std::string& id) {
      return id.size() > end.size() && id.compare(id.size() - end.size(), end.size(), end) == 0;
    });
  };
  EXPECT_EQ(count_ends(".screen.2"), 2);  // the better half
  EXPECT_EQ(count_ends(".mppi.3"), 2);
  EXPECT_EQ(count_ends(".certify"), 2);
}

TEST_F(RunPolicyTest, TheBetterHalfOfTheScreenedPathsGoesOnAndTheBestIsOptimisedFirst) {
  MakeTheRulerTooHeavy();
  setup_.config.screen.paths = 5;
  Job job(setup_, 1);
  Timeline timeline(job);
  RunPlanner(timeline, run_, {});
  std::map<int, double> first, second;  // values by path
  std::vector<int> optimised;
  for (const auto& node : timeline.nodes()) {
    if (const auto* screening = std::get_if<ScreenFacts>(&node->facts.details)) {
      (screening->round == 1 ? first : second)[screening->path] = screening->value;
      EXPECT_EQ(screening->rollouts, 4);
      EXPECT_GE(screening->value, first.at(screening->path));  // it never gets worse
    }
    const auto* iteration = std::get_if<IterationFacts>(&node->facts.details);
    if (iteration != nullptr && iteration->iteration == 1) optimised.push_back(iteration->path);
  }
  EXPECT_EQ(first.size(), 5U);
  EXPECT_EQ(second.size(), 3U);
  for (const auto& [path, value] : first) {
    for (const auto& [other, unused] : second) {
      EXPECT_TRUE(second.count(path) > 0 || value <= first.at(other)) << path << " " << other;
    }
  }
  ASSERT_EQ(optimised.size(), 2U);
  for (const auto& [path, value] : second) EXPECT_LE(value, second.at(optimised[0])) << path;
}

TEST_F(RunPolicyTest, ScreeningEndsWhereEnoughPathsAreClearlyWorthIt) {
  setup_.config.screen.enough = 2;
  setup_.config.screen.clear = 0.0;  // whatever is not worse than nothing
  Job job(setup_, 1);
  Timeline timeline(job);
  const RunResult result = RunPlanner(timeline, run_, {});
  int screened = 0, clear = 0;
  for (const auto& node : timeline.nodes()) {
    const auto* facts = std::get_if<ScreenFacts>(&node->facts.details);
    if (facts == nullptr) continue;
    EXPECT_LT(clear, 2);  // none is screened after that
    EXPECT_EQ(facts->round, 1);
    ++screened;
    clear += facts->value >= facts->rest_reward;
  }
  EXPECT_EQ(clear, 2);
  EXPECT_EQ(Summarize(timeline, *result.end).n_screened, screened);
}

TEST_F(RunPolicyTest, ThePapersOrderIsNotScreened) {
  setup_.config.order = PathOrder::kPaper;
  Job job(setup_, 1);
  Timeline timeline(job);
  const RunResult result = RunPlanner(timeline, run_, {});
  const std::vector<std::string> ids = Ids(timeline);
  EXPECT_EQ(ids[7], "paths.rank.1");
  EXPECT_EQ(ids[8], "path.1.mppi.1");
  EXPECT_EQ(std::count(ids.begin(), ids.end(), "paths.rank.2"), 1);
  EXPECT_EQ(Summarize(timeline, *result.end).n_screened, 0);
}

TEST_F(RunPolicyTest, TheSummarySaysWhatWasDone) {
  MakeTheRulerTooHeavy();
  Job job(setup_, 1);
  Timeline timeline(job);
  const RunResult result = RunPlanner(timeline, run_, {});
  const RunSummary summary = Summarize(timeline, *result.end);
  EXPECT_EQ(summary.status, result.status);
  EXPECT_EQ(summary.n_paths, 2);
  EXPECT_EQ(summary.counts.nodes, 1600);
  EXPECT_GE(summary.counts.kept, 160 - 1);
  EXPECT_EQ(summary.n_screened, 4);
  EXPECT_EQ(summary.counts.iterations, 4 + 2 + 6);
  EXPECT_EQ(summary.counts.rollouts, 4 * (4 + 2) + 36);
  EXPECT_EQ(summary.start_grasps.certified, true);
}

TEST_F(RunPolicyTest, TwoThreadsGiveTheFactsOfOne) {
  Job one(setup_, 1), two(setup_, 2);
  Timeline a(one), b(two);
  RunPlanner(a, run_, {});
  RunPlanner(b, run_, {});
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  for (std::size_t i = 0; i < a.nodes().size(); ++i) {
    const auto difference = CompareFacts(a.nodes()[i]->facts, b.nodes()[i]->facts);
    EXPECT_FALSE(difference.has_value()) << a.nodes()[i]->id() << ": " << difference->field;
  }
}

TEST_F(RunPolicyTest, AGraspableStartIsNotPlannedFor) {
  // The ruler, 8 cm over the edge.
  setup_.scene.object().X_WB.translation().x() = -0.05;
  Job job(setup_, 2);
  Timeline timeline(job);
  EXPECT_EQ(RunPlanner(timeline, run_, {}).status, "start_graspable");
  EXPECT_EQ(Ids(timeline), (std::vector<std::string>{"scene.start", "scene.verdict"}));
}

TEST_F(RunPolicyTest, AnInterruptLeavesWhatWasDone) {
  Job job(setup_, 1);
  Timeline timeline(job);
  const auto interrupt = [](const RunProgress& progress) {
    if (progress.stage == "path 1 of 2, trajectory" && progress.done == 2) RequestInterrupt();
  };
  EXPECT_THROW(RunPlanner(timeline, run_, interrupt), Interrupted);
  ClearInterrupt();
  EXPECT_EQ(std::get<IterationFacts>(timeline.last().facts.details).iteration, 2);
}

TEST_F(RunPolicyTest, MissingWeightsAreBadInputThatNamesTheFile) {
  std::filesystem::remove(folder_.path() / "score.safetensors");
  Job job(setup_, 1);
  Timeline timeline(job);
  try {
    RunPlanner(timeline, run_, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("score.safetensors"), std::string::npos);
  }
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
  JobSetup setup;
  setup.scene = std::move(scene);
  setup.config.graph.samples = 1;
  setup.weights = PREGRASP_SOURCE_DIR "/assets/weights";
  Job job(setup, 0);
  const PlannerConfig& config = setup.config;
  const Planner& planner = *job.GetPlanner(job.world().InitialState(), config);
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
  MppiPlan plan;
  plan.action.assign(mppi.Start().mean.size(), 0.0);
  plan.action[plan.action.size() / 2] = 1.0;  // the index finger on, its targets still
  MotionlessEnd end;
  end.certificate = planner.Certify(mppi, plan);
  end.release = planner.Release(graph, end.certificate);
  const GraspSet grasps = planner.CompleteGrasps(end.certificate, end.release, 1);
  end.generated = grasps.count(GraspSource::kGenerator);
  end.feasible = grasps.count_feasible(GraspSource::kGenerator);
  GraspSearchConfig search;
  search.max_sets = 20000;
  end.searched = !SearchGrasps(planner.grasp_world(), search, {},
                               planner.world().GetPoses(end.certificate.full.end), 1, job.pool())
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
    // What the generator is asked to complete has been tried: most of the samples are feasible.
    if (overhang > 0.0) {
      EXPECT_GE(end.feasible, 14);
    }
    EXPECT_EQ(end.searched, overhang > 0.0) << overhang;
  }
}

}  // namespace
}  // namespace pregrasp
