#include "app/session/session.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/job/facts_json.h"
#include "app/recording/checked_file.h"
#include "app/recording/loaded_run.h"
#include "app/session/saved_state.h"
#include "tests/job/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

using Node = Timeline::Node;
using Strings = std::vector<std::string>;

class SessionTest : public testing::Test {
 protected:
  static const Node& Move(Session& session, const Node& from, const Vector3& by, double seconds) {
    const Vector3 to = from.facts.fingers[1].p_WTarget + by;
    return session.timeline().Do(
        from, Verb::kMove,
        {{"finger", "index"}, {"p_WTarget", {to.x(), to.y(), to.z()}}, {"seconds", seconds}});
  }
  // Three actions of 0, 60 and 120 physics steps.
  static const Node& Pull(Session& session, bool traced = false) {
    nlohmann::json options = {{"finger", "index"}, {"p_OC", {0.11, 0, 0.0015}}};
    if (traced) options["trace"] = true;
    const Node& touched = session.timeline().Do(session.start(), Verb::kTouch, options);
    return Move(session, Move(session, touched, {0, 0, -0.012}, 0.25), {0.02, 0, 0}, 0.5);
  }
  static const Node& Wait(Session& session, double seconds) {
    return session.timeline().Do(session.start(), Verb::kWait, {{"seconds", seconds}});
  }

  static Strings Ids(const fs::path& run) {
    Strings ids;
    for (const StepFacts& step : LoadRun(run).steps) ids.push_back(step.id);
    return ids;
  }

  static int CountLines(const fs::path& file) {
    std::ifstream in(file);
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
  }

  static Shot Draft(const std::string& caption) {
    Shot shot;
    shot.config.width = 64;
    shot.config.height = 36;
    shot.config.quality = RenderQuality::kDraft;
    shot.caption = caption;
    return shot;
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(SessionTest, EachActionIsAStepOfTheRunAndEachPhysicsStepARowOfTheRollout) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kNone);
  session.Settle(0.25);
  Pull(session);
  EXPECT_FALSE(fs::exists(folder_ / "run"));
  session.Save(std::nullopt, &session.timeline().last());
  EXPECT_EQ(Ids(folder_ / "run"),
            (Strings{"scene.start", "scene.settle", "sim.1", "sim.2", "sim.3"}));
  EXPECT_EQ(CountLines(folder_ / "run/rollout.csv"), 1 + 1 + 60 + 120);
  EXPECT_EQ(LoadRun(folder_ / "run").journal.back().verb, Verb::kMove);
}

TEST_F(SessionTest, SavingAfterwardsWritesWhatRecordingWouldHave) {
  Session recorded(MakeRulerScene(), {}), saved(MakeRulerScene(), {});
  recorded.Record(folder_ / "recorded", PictureMode::kNone);
  for (Session* session : {&recorded, &saved}) Pull(*session);
  recorded.Save(std::nullopt);
  saved.Save(folder_ / "saved");
  for (const char* name :
       {"steps.jsonl", "journal.jsonl", "rollout.csv", "scene.json", "run.rawlog"}) {
    EXPECT_EQ(ReadFile(folder_ / "recorded" / name), ReadFile(folder_ / "saved" / name)) << name;
  }
}

TEST_F(SessionTest, PicturesBelongToTheStepTheyWereAskedForAndChangeNothingElse) {
  for (const auto mode : {PictureMode::kNone, PictureMode::kKey}) {
    SessionConfig config;
    config.pictures = mode;
    Session session(MakeRulerScene(), config);
    session.Shoot(session.start(), Draft(""));
    const Node& waited = Wait(session, 0.1);
    Pull(session);
    session.Shoot(waited, Draft("first"));
    session.Shoot(waited, Draft("the same step again"));
    session.Save(folder_ / (mode == PictureMode::kNone ? "none" : "key"));
  }
  EXPECT_EQ(ReadFile(folder_ / "key/steps.jsonl"), ReadFile(folder_ / "none/steps.jsonl"));
  Strings pictures;
  for (const auto& entry : fs::directory_iterator(folder_ / "key/frames")) {
    pictures.push_back(entry.path().filename().string());
  }
  std::sort(pictures.begin(), pictures.end());
  EXPECT_EQ(pictures, (Strings{"0001_scene-start.png", "0002_sim-1.png"}));
  EXPECT_EQ(CountLines(folder_ / "key/pictures.jsonl"), 2);
  EXPECT_NE(ReadFile(folder_ / "key/pictures.jsonl").find("the same step again"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "none/frames"));
}

TEST_F(SessionTest, EveryPictureOfARunIsDrawnAgainFromItsFilesWithTheSamePixels) {
  SessionConfig config;
  config.command = "pregrasp script lesson.lua";
  Session session(MakeRulerScene(), config);
  session.Record(folder_ / "run", PictureMode::kKey);
  const Node& pulled = Pull(session, true);
  Shot shot = Draft("pulled");
  shot.config.camera = CameraConfig{{0.3, -0.5, 0.3}, {-0.1, 0, 0}, 40.0};
  SetOverlays(shot.config, {"forces", "trace", "fingers"});
  session.Shoot(pulled, shot);
  session.Shoot(*pulled.parent, Draft(""));
  session.Save(std::nullopt);
  const LoadedRun run = LoadRun(folder_ / "run");
  PictureDrawer drawer(run.scene,
                       {run.summary.seed, run.manifest["scene_file"], run.manifest["command"]});
  std::istringstream lines(ReadFile(folder_ / "run/pictures.jsonl"));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const nlohmann::json picture = nlohmann::json::parse(line);
    drawer.Draw(run.Get(picture["step"]), run, ShotFromJson(picture, "pictures.jsonl"),
                folder_ / "again.png");
    EXPECT_EQ(ReadFile(folder_ / "again.png"),
              ReadFile(folder_ / "run" / picture["picture"].get<std::string>()))
        << picture["step"];
  }
  EXPECT_EQ(count, 3);
}

TEST_F(SessionTest, PicturesOfARunShareOneCameraUnlessOneIsNamed) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kAll);
  const Node& pulled = Move(session, Pull(session), {0.12, 0, 0}, 1.0);
  session.Shoot(*pulled.parent, Draft("asked for"));
  Shot named = Draft("by another camera");
  named.config.camera = CameraConfig{{0.3, -0.5, 0.3}, {-0.1, 0, 0}, 40.0};
  session.Shoot(*pulled.parent->parent->parent, named);
  session.Save(std::nullopt);
  const LoadedRun run = LoadRun(folder_ / "run");
  PictureDrawer drawer(run.scene, {});
  std::vector<const StepFacts*> sharing;
  for (const char* id : {"scene.start", "sim.2", "sim.3", "sim.4"}) sharing.push_back(&run.Get(id));
  const CameraConfig camera = drawer.FrameSteps(sharing, run, {});
  EXPECT_NE(drawer.FrameSteps({sharing[0]}, run, {}).p_WCam, camera.p_WCam);
  for (const StepFacts* step : sharing) {
    const Shot shot = FindShot(run.directory, step->id);
    EXPECT_TRUE(shot.shares_camera) << step->id;
    EXPECT_EQ(shot.config.camera.value().p_WCam, camera.p_WCam) << step->id;
    EXPECT_EQ(shot.config.camera.value().fov_deg, camera.fov_deg) << step->id;
  }
  const Shot other = FindShot(run.directory, "sim.1");
  EXPECT_FALSE(other.shares_camera);
  EXPECT_EQ(other.config.camera.value().p_WCam, named.config.camera->p_WCam);
}

TEST_F(SessionTest, TheSummaryHoldsTheDeepestOverlapOfAllPhysicsSteps) {
  Session session(MakeRulerScene(), {});
  const Node& pulled = Pull(session);
  double deepest = 0.0;
  Simulation again = *session.timeline().GetState(pulled)->simulation;
  for (; again.num_states() > 1; again.Back(1)) {
    for (const ContactPoint& contact : again.contacts()) deepest = std::max(deepest, -contact.phi);
  }
  session.Save(folder_ / "run");
  const RunSummary summary = LoadRun(folder_ / "run").summary;
  EXPECT_GT(deepest, 0.0);
  EXPECT_LT(deepest, 1e-4);
  EXPECT_DOUBLE_EQ(*summary.physics.max_penetration_mm, 1e3 * deepest);
  EXPECT_GT(*summary.seconds.total, *summary.seconds.pictures);
  EXPECT_FALSE(summary.status.has_value());
}

TEST_F(SessionTest, ATracedSimulationLeavesEveryPhysicsStepAndItsLastOneInTheSteps) {
  Session session(MakeRulerScene(), {});
  const Node& pulled = Pull(session, true);
  session.Save(folder_ / "run");
  EXPECT_EQ(CountLines(folder_ / "run/trace.jsonl"), 60 + 120);
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
  EXPECT_NEAR(weight, 0.025 * 9.81 - pulled.facts.fingers[1].f_W.z(), 1e-3);
  const StepFacts last = LoadRun(folder_ / "run").steps.back();
  const auto& trace = std::get<SimulationFacts>(last.details).trace;
  ASSERT_TRUE(trace.has_value());
  EXPECT_EQ(trace->kinetic_energy, row["kinetic_energy"].get<double>());
  EXPECT_EQ(last.contacts.size(), row["contacts"].size());
}

TEST_F(SessionTest, WithoutATraceTheRunHasNone) {
  Session session(MakeRulerScene(), {});
  Pull(session);
  session.Save(folder_ / "run");
  EXPECT_FALSE(fs::exists(folder_ / "run/trace.jsonl"));
  EXPECT_FALSE(std::get<SimulationFacts>(LoadRun(folder_ / "run").steps.back().details).trace);
}

TEST_F(SessionTest, AnInterruptedActionIsAStepAndTheRunIsValid) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kNone);
  Wait(session, 0.1);
  RequestInterrupt();
  EXPECT_THROW(Wait(session, 0.2), Interrupted);
  ClearInterrupt();
  session.FinishRecording("interrupted");
  const LoadedRun run = LoadRun(folder_ / "run");
  EXPECT_EQ(run.summary.status, "interrupted");
  ASSERT_EQ(run.steps.size(), 3U);
  EXPECT_TRUE(std::get<SimulationFacts>(run.steps[2].details).stopped);
}

TEST_F(SessionTest, AnInterruptWhileItIsSavedKeepsTheRecording) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kAll);
  Wait(session, 0.1);
  RequestInterrupt();
  EXPECT_THROW(session.Save(std::nullopt), Interrupted);
  EXPECT_TRUE(session.recording());
  EXPECT_FALSE(fs::exists(folder_ / "run"));
  session.FinishRecording("interrupted");  // without the picture that was not drawn
  ClearInterrupt();
  const LoadedRun run = LoadRun(folder_ / "run");
  EXPECT_EQ(run.summary.status, "interrupted");
  ASSERT_EQ(run.steps.size(), 2U);
}

TEST_F(SessionTest, PicturesThatAnInterruptLeftOutAreDrawnWhenItGoesOn) {
  Session session(MakeRulerScene(), {});
  session.Record(folder_ / "run", PictureMode::kAll);
  RequestInterrupt();
  EXPECT_THROW(Wait(session, 0.2), Interrupted);  // the start's picture waits for this step
  ClearInterrupt();
  Wait(session, 0.1);
  session.FinishRecording();
  EXPECT_EQ(LoadRun(folder_ / "run").steps.size(), 3U);
  const fs::directory_iterator frames(folder_ / "run/frames");
  EXPECT_EQ(std::distance(begin(frames), end(frames)), 3);
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
  Wait(session, 0.1);
  EXPECT_THROW(session.Settle(1.0), InputError);
  session.Record(folder_ / "a", PictureMode::kNone);
  EXPECT_THROW(session.Record(folder_ / "b", PictureMode::kNone), InputError);
}

TEST_F(SessionTest, AFinishedRunGoesOnWhereItStoodToTheLastBit) {
  const TestFolder folder;
  Session session(MakeRulerScene(), {});
  session.Settle(0.1);
  const Node& pulled = Pull(session);
  session.SaveState(folder.path() / "state", pulled);
  const Node& moved = Move(session, pulled, {0.01, 0, 0}, 0.2);

  const ResumedSession resumed = ResumeSession(folder.path() / "state", 1, {});
  ASSERT_EQ(resumed.node->id(), pulled.id());
  EXPECT_EQ(resumed.session->start().id(), "scene.settle");
  EXPECT_EQ(resumed.session->timeline().nodes().size() + 1, session.timeline().nodes().size());
  const Node& again = Move(*resumed.session, *resumed.node, {0.01, 0, 0}, 0.2);
  EXPECT_EQ(CompareFacts(again.facts, moved.facts), std::nullopt);
}

TEST_F(SessionTest, ARunThatWasChangedIsNotGoneOnFrom) {
  const TestFolder folder;
  Session session(MakeRulerScene(), {});
  session.SaveState(folder.path() / "state", Wait(session, 0.1));
  std::ofstream(folder.path() / "state/steps.jsonl", std::ios::app) << "\n";
  EXPECT_THROW(ResumeSession(folder.path() / "state", 1, {}), InputError);
  EXPECT_THROW(ResumeSession(folder.path() / "nothing", 1, {}), InputError);
}

TEST_F(SessionTest, WhatARecordingFailedForIsInItsManifest) {
  const TestFolder folder;
  Session session(MakeRulerScene(), {});
  session.Record(folder.path() / "run", PictureMode::kNone);
  Wait(session, 0.1);
  session.FinishRecording("failed", nullptr, "a.lua:3: no");
  const LoadedRun run = LoadRun(folder.path() / "run");
  EXPECT_EQ(run.summary.status, "failed");
  EXPECT_EQ(run.manifest["error"], "a.lua:3: no");
}

TEST_F(SessionTest, APicturesOptionsAreReadBackAsTheyWere) {
  Shot shot = Draft("caption");
  shot.title = "title";
  shot.config.card = shot.config.footer = shot.config.axes = false;
  shot.config.font_scale = 1.5;
  shot.config.camera = CameraConfig{{1, 2, 3}, {0, 0, 0.5}, 40.0};
  const nlohmann::json json = ShotToJson(shot);
  const Shot read = ShotFromJson(json, "pictures.jsonl");
  EXPECT_EQ(nlohmann::json(ShotToJson(read)), json);
  EXPECT_FALSE(read.config.card || read.config.footer || read.config.axes);
  EXPECT_TRUE(read.config.legend && read.config.forces);
  EXPECT_EQ(read.config.font_scale, 1.5);
  EXPECT_FALSE(ShotToJson(Draft("")).contains("without"));  // as runs had it before
}

}  // namespace
}  // namespace pregrasp
