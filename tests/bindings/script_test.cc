// The real program on whole scripts.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "render/image.h"
#include "tests/bindings/lua_text.h"
#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = PREGRASP_SOURCE_DIR;

TEST(ScriptTest, TheExampleDragsTheRulerOverTheEdgeFromAnyFolder) {
  const TestFolder folder;
  const ProgramResult result = RunProgram(
      {"script", kSource / "lua/examples/push.lua", "--pictures", "none"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("mm over the edge"), std::string::npos) << result.out;
  const LoadedRun run = LoadRun(folder.path() / "out/push");
  EXPECT_EQ(run.steps.front().id, "scene.start");
  EXPECT_EQ(run.steps.back().id, "sim.8");
  EXPECT_FALSE(run.summary.status.has_value());
  EXPECT_EQ(run.summary.within_rules, true);
  const RigidTransform X_WO = run.steps.back().object().X_WB();
  EXPECT_GT(X_WO.translation().x() + 0.15, 0.05);     // over the edge x = 0
  EXPECT_NEAR(X_WO.translation().z(), 0.0015, 1e-5);  // and still flat on the table
  EXPECT_LT(RotationAngle(X_WO.linear(), Matrix3::Identity()), 0.01);
}

TEST(ScriptTest, TheExampleGivesTheSameBytesForAnyThreads) {
  const TestFolder folder;
  for (const auto& [out, threads] : {std::pair("a", "1"), std::pair("b", "2")}) {
    const ProgramResult result =
        RunProgram({"script", kSource / "lua/examples/push.lua", "--pictures", "none", "--out", out,
                    "--threads", threads},
                   folder.path());
    ASSERT_EQ(result.code, 0) << result.err;
  }
  for (const char* name : {"scene.json", "steps.jsonl", "rollout.csv", "run.rawlog"}) {
    const std::string bytes = ReadText(folder.path() / "a/push" / name);
    EXPECT_GT(bytes.size(), 100U) << name;
    EXPECT_EQ(bytes, ReadText(folder.path() / "b/push" / name)) << name;
  }
}

TEST(ScriptTest, APictureIsDrawnWhereItIsAskedFor) {
  const TestFolder folder;
  folder.Write("shot.lua", R"(local pg = require "pregrasp"
    local s = pg.open "scenes/ruler.lua"
    local sim = s:simulate()
    sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }
    sim:shot { file = "out/pictures/touch.png", size = { 160, 90 }, quality = "draft" })");
  const ProgramResult result = RunProgram({"script", "shot.lua"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string png = ReadText(folder.path() / "out/pictures/touch.png");
  ASSERT_GT(png.size(), 1000U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
}

TEST(ScriptTest, GetsItsArgumentsAndItsSeed) {
  const TestFolder folder;
  folder.Write("arguments.lua",
               "local a, b = ... print(select('#', ...), a, b, require('pregrasp').seed)");
  const ProgramResult result =
      RunProgram({"script", "--seed", "7", "arguments.lua", "one", "two words"}, folder.path());
  EXPECT_EQ(result.out, "2\tone\ttwo words\t7\n") << result.err;
}

TEST(ScriptTest, AFailureIsOneLineAndLeavesWhatWasRecordedWithIt) {
  const TestFolder folder;
  folder.Write("fails.lua", R"(local s = require "pregrasp".open "scenes/ruler.lua"
    s:record { dir = "out/run" }
    s:simulate():wait { seconds = 0.1 }
    s:simulate():touch { finger = "toe" })");
  const ProgramResult result = RunProgram({"script", "fails.lua"}, folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.err,
            "fails.lua:4: touch: finger: expected a finger (thumb, index, middle, ring or little), "
            "got \"toe\"\n");
  const LoadedRun run = LoadRun(folder.path() / "out/run");
  EXPECT_EQ(run.summary.status, "failed");
  EXPECT_EQ(run.manifest["error"].get<std::string>() + "\n", result.err);
  EXPECT_EQ(run.steps.back().id, "sim.1");
  EXPECT_FALSE(VerifyManifest(folder.path() / "out/run").has_value());
  EXPECT_EQ(RunProgram({"verify", "out/run"}, folder.path()).code, 0);

  folder.Write("early.lua", "error 'at once'");
  const auto before = ListFiles(folder.path());
  EXPECT_EQ(RunProgram({"script", "early.lua", "--out", "other"}, folder.path()).code, 2);
  EXPECT_EQ(ListFiles(folder.path()), before);
}

// Starts the program on a script that never ends, interrupts it once it has printed, and waits.
ProgramResult Interrupt(const std::string& script, const TestFolder& folder) {
  folder.Write("long.lua", script);
  const fs::path captured = folder.path() / "captured";
  const pid_t child = StartProgram({"script", "long.lua"}, folder.path(), captured);
  for (int i = 0; i < 600 && ReadText(captured / "out").empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  kill(child, SIGINT);
  return AwaitProgram(child, captured);
}

TEST(ScriptTest, CtrlCLeavesAValidShorterRun) {
  const TestFolder folder;
  const ProgramResult result = Interrupt(R"(local pg = require "pregrasp"
    local s = pg.open "scenes/ruler.lua"
    s:record { dir = "out/run", pictures = "none" }
    local sim = s:simulate()
    sim:wait { seconds = 0.1 }
    print "waiting"
    while true do
      sim:step(20000)
      sim:back(20000)
    end)",
                                         folder);
  EXPECT_EQ(result.code, 130);
  EXPECT_EQ(result.err, "interrupted\n");
  const LoadedRun run = LoadRun(folder.path() / "out/run");
  EXPECT_EQ(run.summary.status, "interrupted");
  EXPECT_GE(run.steps.size(), 3U);
}

TEST(ScriptTest, CtrlCEndsALoopOfLuaThatCatchesEverything) {
  const TestFolder folder;
  const ProgramResult result = Interrupt(
      "print 'looping' while true do pcall(function() while true do end end) end", folder);
  EXPECT_EQ(result.code, 130);
  EXPECT_EQ(result.err, "interrupted\n");
}

TEST(ScriptTest, AFinishedRunIsReadBackStepByStep) {
  const TestFolder folder;
  folder.Write("read.lua", R"(local pg = require "pregrasp"
    local s = pg.open("scenes/ruler.lua", { seed = 7 })
    s:record { dir = "out/run", pictures = "none" }
    local sim = s:simulate()
    sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }
    sim:wait { seconds = 0.1 }
    s:save()
    local run = pg.load "out/run"
    print(run, table.concat(run.ids, " "), run.summary.seed, run.manifest.schema)
    local step = run:step "sim.2"
    print(step.number, step.command.verb, step.fingers[2].finger, step.fingers[2].on)
    print(step.bodies[1].p_WB[1] == s:body("ruler").p[1], #step.contacts > 0, run.summary.status)
    run:shot("sim.2", { file = "out/sim.png", size = { 160, 90 }, quality = "draft" })
    run:strip { "scene.start", "sim.2", file = "out/pictures/strip.png", size = { 400, 300 }, quality = "draft" }
    run:strip { file = "out/sheet.png", size = { 400, 600 }, quality = "draft" }
    s:strip { file = "out/so_far.png", size = { 400, 600 }, quality = "draft" }
    sim:wait { seconds = 0.1 }
    s:save "out/longer"
    run:strip { against = pg.load "out/longer", file = "out/pair.png", size = { 600, 900 }, quality = "draft" }
    print(pcall(run.shot, run, "sim.2", {}))
    print(pcall(run.strip, run, {}))
    print(pcall(run.strip, run, { "sim.3", file = "out/x.png" }))
    print(pcall(run.strip, run, { "sim.2", file = "out/run/frames/x.png" }))
    print(pcall(run.step, run, "sim.3"))
    print(pcall(function() return run.steps end))
    print(pcall(pg.load, "out"))
    print(pcall(pg.load, "/etc")))");
  const ProgramResult result = RunProgram({"script", "read.lua"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  const std::string start =
      "Run(out/run, 3 steps)\tscene.start sim.1 sim.2\t7\tpregrasp.run/1\n"
      "3\twait\tindex\ttrue\n"
      "true\ttrue\tnil\n";
  EXPECT_EQ(result.out.substr(0, start.size()), start);
  for (const char* picture :
       {"sim.png", "pictures/strip.png", "sheet.png", "so_far.png", "pair.png"}) {
    EXPECT_GT(ReadPng(folder.path() / "out" / picture).width, 0) << picture;
  }
  // The key steps of a session so far are those of the run that it leaves.
  EXPECT_EQ(ReadPng(folder.path() / "out/so_far.png").height,
            ReadPng(folder.path() / "out/sheet.png").height);
  EXPECT_FALSE(fs::exists(folder.path() / "out/x.png"));
  for (const char* part :
       {"shot: file: expected where the picture goes, as \"out/picture.png\", got nothing",
        "strip: file: expected where the picture goes, as",
        "step: expected \"sim.1\", got \"sim.3\"", "frames/x.png: expected",
        "id: expected \"sim.1\", got \"sim.3\"", "unknown key \"steps\"", "out/manifest.json",
        "/etc/manifest.json"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << '\n' << result.out;
  }
}

TEST(InfoTest, NamesTheProgramItsLibrariesAndTheRenderer) {
  const TestFolder folder;
  const ProgramResult result = RunProgram({"info"}, folder.path());
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* part : {"pregrasp", "lua 5.4", "mrpt", "llvmpipe", "weights", "processor"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
  }
}

TEST(CheckCommandTest, SetChangesTheSceneAndADepartureIsAWarning) {
  const TestFolder folder;
  const std::string scene = kSource / "scenes/ruler.lua";
  const ProgramResult warned = RunProgram(
      {"check", "--no-grasps", scene, "--set", "fingertips.friction=1.5"}, folder.path());
  EXPECT_EQ(warned.code, 0) << warned.err;
  EXPECT_NE(warned.out.find("warning: fingertips.friction 1.5 is above 1.0"), std::string::npos)
      << warned.out;
  const ProgramResult failed =
      RunProgram({"check", "--set", "object.p=0,0,1", scene}, folder.path());
  EXPECT_EQ(failed.code, 2);
  EXPECT_NE(failed.err.find("is not at rest"), std::string::npos) << failed.err;
  EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1) << failed.err;
}

}  // namespace
}  // namespace pregrasp
