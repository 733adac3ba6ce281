#include "app/pipeline/session.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "tests/pipeline/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

class SessionTest : public testing::Test {
 protected:
  static void Pull(Session& session, const std::shared_ptr<Simulation>& sim) {
    session.Touch(sim, Finger::kIndex, {0.11, 0, 0.0015});
    session.Move(sim, Finger::kIndex, sim->state().fingers[1].p_WTarget - Vector3(0, 0, 0.012),
                 0.25);
    session.Move(sim, Finger::kIndex, sim->state().fingers[1].p_WTarget + Vector3(0.02, 0, 0), 0.5);
  }

  static std::vector<std::string> Ids(const fs::path& run) {
    std::vector<std::string> ids;
    for (const StepRecord& step : LoadRun(run).steps) ids.push_back(step.id);
    return ids;
  }

  static int CountLines(const fs::path& file) {
    std::ifstream in(file);
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

using Strings = std::vector<std::string>;

TEST_F(SessionTest, EachActionIsAStepOfTheRunAndEachPhysicsStepARowOfTheRollout) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kNone);
  session.Settle(0.25);
  const auto sim = session.Simulate();
  Pull(session, sim);
  EXPECT_FALSE(fs::exists(folder_ / "run"));
  session.Save(std::nullopt);
  EXPECT_EQ(Ids(folder_ / "run"),
            (Strings{"scene.start", "scene.settle", "sim.1", "sim.2", "sim.3"}));
  EXPECT_EQ(CountLines(folder_ / "run/rollout.csv"), 1 + sim->num_states());
  EXPECT_EQ(sim->num_states(), 1 + 60 + 120);
}

TEST_F(SessionTest, SavingAfterwardsWritesWhatRecordingWouldHave) {
  Session recorded(MakeRulerScene(), {}), saved(MakeRulerScene(), {});
  recorded.Record(folder_ / "recorded", PictureMode::kNone);
  for (Session* session : {&recorded, &saved}) Pull(*session, session->Simulate());
  recorded.Save(std::nullopt);
  saved.Save(folder_ / "saved");
  for (const char* name : {"steps.jsonl", "rollout.csv", "scene.json", "run.rawlog"}) {
    std::ifstream a(folder_ / "recorded" / name, std::ios::binary);
    std::ifstream b(folder_ / "saved" / name, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(a), {}),
              std::string(std::istreambuf_iterator<char>(b), {}))
        << name;
  }
}

TEST_F(SessionTest, PicturesBelongToTheStepTheyWereAskedForAndChangeNothingElse) {
  PictureConfig draft;
  draft.width = 64;
  draft.height = 36;
  draft.quality = RenderQuality::kDraft;
  for (const auto mode : {PictureMode::kNone, PictureMode::kKey}) {
    SessionConfig config;
    config.pictures = mode;
    Session session(MakeRulerScene(), config);
    session.Shoot(session.last_step(), {draft, "", ""});
    const auto sim = session.Simulate();
    session.Touch(sim, Finger::kIndex, {0.11, 0, 0.0015});
    session.Wait(sim, 0.1);
    session.Shoot(session.StepOf(*sim), {draft, "first", ""});
    session.Shoot(session.StepOf(*sim), {draft, "the same moment again", ""});
    session.Save(folder_ / (mode == PictureMode::kNone ? "none" : "key"));
  }
  EXPECT_EQ(Ids(folder_ / "key"), (Strings{"scene.start", "sim.1", "sim.2", "sim.2"}));
  EXPECT_EQ(Ids(folder_ / "none"), Ids(folder_ / "key"));
  Strings pictures;
  for (const auto& entry : fs::directory_iterator(folder_ / "key/frames")) {
    pictures.push_back(entry.path().filename().string());
  }
  std::sort(pictures.begin(), pictures.end());
  EXPECT_EQ(pictures, (Strings{"0001_scene-start.png", "0003_sim-2.png", "0004_sim-2.png"}));
  EXPECT_FALSE(fs::exists(folder_ / "none/frames"));
}

TEST_F(SessionTest, TheSummaryHoldsTheDeepestOverlapOfAllPhysicsSteps) {
  Session session(MakeRulerScene(), {});
  const auto sim = session.Simulate();
  Pull(session, sim);
  double deepest = 0.0;
  Simulation again = *sim;
  for (; again.num_states() > 1; again.Back(1)) {
    for (const ContactPoint& contact : again.contacts()) deepest = std::max(deepest, -contact.phi);
  }
  session.Save(folder_ / "run");
  const auto summary = LoadRun(folder_ / "run").summary;
  EXPECT_GT(deepest, 0.0);
  EXPECT_LT(deepest, 1e-4);
  EXPECT_DOUBLE_EQ(summary["physics"]["max_penetration_mm"], 1e3 * deepest);
  EXPECT_GT(summary["seconds"]["total"], 0.0);
}

TEST_F(SessionTest, ATracedSimulationLeavesEveryPhysicsStepAndItsLastOneInTheSteps) {
  Session session(MakeRulerScene(), {});
  const auto sim = session.Simulate(true);
  Pull(session, sim);
  session.Save(folder_ / "run");
  EXPECT_EQ(CountLines(folder_ / "run/trace.jsonl"), sim->num_states() - 1);
  std::ifstream in(folder_ / "run/trace.jsonl");
  double weight = 0.0;
  nlohmann::json row;
  for (std::string line; std::getline(in, line);) {
    row = nlohmann::json::parse(line);
    ASSERT_GT(row["t"], 0.0);
    weight = 0.0;
    for (const auto& contact : row["contacts"]) {
      EXPECT_EQ(contact["a"], "ruler");
      EXPECT_EQ(contact["b"], "table");
      EXPECT_EQ(contact["nhat_W"][2], -1.0);
      weight -= contact["f_W"][2].get<double>();
    }
  }
  // At the end the table carries the ruler and what the finger presses.
  EXPECT_NEAR(weight, 0.025 * 9.81 - sim->state().fingers[1].f_W.z(), 1e-3);
  const auto last = LoadRun(folder_ / "run").steps.back().details["trace"];
  row.erase("t");
  EXPECT_EQ(last, row);
}

TEST_F(SessionTest, WithoutATraceTheRunHasNone) {
  Session session(MakeRulerScene(), {});
  Pull(session, session.Simulate());
  session.Save(folder_ / "run");
  EXPECT_FALSE(fs::exists(folder_ / "run/trace.jsonl"));
  EXPECT_FALSE(LoadRun(folder_ / "run").steps.back().details.contains("trace"));
}

TEST_F(SessionTest, AnInterruptedActionIsAStepAndTheRunIsValid) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kNone);
  const auto sim = session.Simulate();
  session.Wait(sim, 0.1);
  RequestInterrupt();
  EXPECT_THROW(session.Wait(sim, 0.1), Interrupted);
  ClearInterrupt();
  session.FinishRecording("interrupted");
  const LoadedRun run = LoadRun(folder_ / "run");
  EXPECT_EQ(run.summary["status"], "interrupted");
  ASSERT_EQ(run.steps.size(), 3U);
  EXPECT_EQ(run.steps[2].details["interrupted"], true);
}

TEST_F(SessionTest, RefusesOverlapsSettlingLateAndTwoRecordings) {
  Scene overlapping = MakeRulerScene();
  overlapping.object().X_WB.translation().z() = 0.0;
  try {
    const Session session(overlapping, {});
    FAIL() << "no failure";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "ruler.lua:2: ruler: expected bodies that do not overlap, got 1.5 mm of overlap "
                 "with \"table\"");
  }
  Session session(MakeRulerScene(), {});
  EXPECT_THROW(session.Save(std::nullopt), InputError);
  session.Wait(session.Simulate(), 0.1);
  EXPECT_THROW(session.Settle(1.0), InputError);
  session.Record(folder_ / "a", PictureMode::kNone);
  EXPECT_THROW(session.Record(folder_ / "b", PictureMode::kNone), InputError);
}

TEST_F(SessionTest, AShortenedActionIsTheOneThatEndedThere) {
  Session whole(MakeRulerScene(), {}), part(MakeRulerScene(), {});
  whole.Record(folder_ / "whole", PictureMode::kNone);
  part.Record(folder_ / "part", PictureMode::kNone);
  const auto a = whole.Simulate(), b = part.Simulate();
  whole.Step(a, 20);
  part.Step(b, 50);
  part.Shorten(b, 30);
  EXPECT_EQ(a->state().bodies[0].p_WB, b->state().bodies[0].p_WB);
  EXPECT_EQ(a->num_states(), b->num_states());
  whole.Save(std::nullopt);
  part.Save(std::nullopt);
  const StepRecord x = LoadRun(folder_ / "whole").steps.back();
  const StepRecord y = LoadRun(folder_ / "part").steps.back();
  EXPECT_EQ(x.id, y.id);
  EXPECT_EQ(x.t, y.t);
  EXPECT_EQ(x.details["moved_mm"], y.details["moved_mm"]);
  EXPECT_EQ(y.details["stopped"], true);
}

TEST_F(SessionTest, AFailedActionIsNoStep) {
  Session session(MakeRulerScene(), {});
  const auto sim = session.Simulate();
  EXPECT_THROW(session.Move(sim, Finger::kIndex, Vector3::Zero(), 1.0), InputError);
  EXPECT_EQ(session.last_step_id(), "scene.start");
  session.Wait(sim, 0.1);
  EXPECT_EQ(session.last_step_id(), "sim.1");
}

}  // namespace
}  // namespace pregrasp
