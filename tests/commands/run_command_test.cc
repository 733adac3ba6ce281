// pregrasp run as a user types it, with networks whose weights are random: what it finds is poor,
// what it answers is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "app/core/data_folder.h"
#include "app/job/run_policy.h"
#include "app/recording/checked_file.h"
#include "app/recording/gzip_file.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "render/image.h"
#include "tests/bindings/run_program.h"
#include "tests/commands/small_run.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const std::string kScene = PREGRASP_SOURCE_DIR "/scenes/ruler.lua";

class RunCommandTest : public testing::Test {
 protected:
  RunCommandTest() {
    fs::create_directories(Weights());
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);  // for the program's verdicts
    WriteRandomWeights(Weights());
  }

  fs::path Weights() const { return folder_ / "weights"; }

  std::vector<std::string> Arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run",        kScene, "--weights", Weights().string(),
                                          "--pictures", "none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::vector<std::string> Quick(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = Arguments({"--paths", "1"});
    for (const auto& part : {SmallRun(), more}) {
      arguments.insert(arguments.end(), part.begin(), part.end());
    }
    return arguments;
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(RunCommandTest, WithoutSuccessTheRunIsCompleteAndSaysWhy) {
  const ProgramResult result = RunProgram(Quick({"--set", "fingertips.friction=0.1"}), folder_);
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.out.find(", cost "), std::string::npos) << result.out;
  EXPECT_FALSE(VerifyManifest(folder_ / "out" / "ruler").has_value());
  const LoadedRun run = LoadRun(folder_ / "out" / "ruler");
  EXPECT_EQ(run.summary.status, "no_feasible_grasp");
  EXPECT_EQ(run.manifest["configuration"]["mppi"]["iterations"], 2);
}

TEST_F(RunCommandTest, ALooserSettingIsWarnedOfAndTakesTheRunOutOfTheRules) {
  const std::vector<std::string> strict = {"--set", "fingertips.friction=0.1",
                                           "--set", "grasps.tip_tolerance=0.0005",
                                           "--set", "motion.tip_tolerance=0.0005"};
  const fs::path out = folder_ / "out" / "ruler";
  RunProgram(Quick(strict), folder_);
  EXPECT_EQ(LoadRun(out).summary.within_rules, true);
  std::vector<std::string> loose = strict;
  loose.insert(loose.end(), {"--set", "certify.hold_seconds=0.5"});
  const ProgramResult result = RunProgram(Quick(loose), folder_);
  EXPECT_NE(result.err.find("warning: certify.hold_seconds 0.5 s is not at least 1.5"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(LoadRun(out).summary.within_rules, false);
}

TEST(InfoCommandTest, SettingsAreListedWithDefaultRangeUnitAndRule) {
  const TestFolder folder;
  const ProgramResult result = RunProgram({"info", "--settings"}, folder.path());
  EXPECT_EQ(result.code, 0);
  const std::regex line(
      R"((^|\n)certify\.hold_seconds +1\.5 +0 to 30 s +[^\n]*within the rules at least 1\.5\n)");
  EXPECT_TRUE(std::regex_search(result.out, line)) << result.out;
  EXPECT_NE(result.out.find("motion.order"), std::string::npos);
}

TEST_F(RunCommandTest, ASeedGivesTheSameBytesWithAnyNumberOfThreadsAndAFinishedRunIsReplaced) {
  const fs::path out = folder_ / "out" / "ruler";
  RunProgram(Quick({"--threads", "1"}), folder_);
  const std::string steps = ReadText(out / "steps.jsonl");
  const std::string hash = *LoadRun(out).summary.hash;
  RunProgram(Quick({"--threads", "2"}), folder_);
  EXPECT_EQ(ReadText(out / "steps.jsonl"), steps);
  EXPECT_EQ(*LoadRun(out).summary.hash, hash);
  RunProgram(Quick({"--seed", "2"}), folder_);
  EXPECT_NE(ReadText(out / "steps.jsonl"), steps);
}

TEST_F(RunCommandTest, BadInputIsOneLineAndLeavesNothing) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {Arguments({"--seed", "-3"}), "--seed"},
      {Arguments({"--seed", "nan"}), "--seed"},
      {Arguments({"--seed", "99999999999999999999"}), "--seed"},
      {Arguments({"--paths", "0"}), "--paths: expected a whole number from 1 to 1000, got \"0\""},
      {Arguments({"--paths", "1001"}), "--paths: expected a whole number from 1 to 1000"},
      {Arguments({"--threads", "-1"}),
       "--threads: expected a whole number from 0 to 256, got \"-1\""},
      {Arguments({"--threads", "257"}), "--threads: expected a whole number from 0 to 256"},
      {Arguments({"--threads", "2.5"}), "--threads: expected a whole number from 0 to 256"},
      {Arguments({"--threads", "inf"}), "--threads: expected a whole number from 0 to 256"},
      {Arguments({"--set", "mppi.sampels=3"}), "mppi.samples"},
      {Arguments({"--set", "mppi.samples=2"}),
       "--set: mppi.samples: expected a whole number from 4 to 4096, got 2"},
      {Arguments({"--set", "certify.hold_seconds=nan"}),
       "--set: certify.hold_seconds: expected a number from 0 to 30 s, got nan"},
      {Arguments({"--set", "certify.hold_seconds=-1"}), "--set: certify.hold_seconds: "},
      {Arguments({"--set", "lift.hold_seconds=0.1"}),
       "--set: lift.hold_seconds: expected a number from 0.3 to 10 s, got 0.1"},
      {Arguments({"--set", "lift.handover_seconds=0"}), "--set: lift.handover_seconds: "},
      {Arguments({"--set", "lift.closing_seconds=1e300"}), "--set: lift.closing_seconds: "},
      {Arguments({"--set", "lift.height=nan"}), "--set: lift.height: "},
      {Arguments({"--set", "motion.fps=0"}), "--set: motion.fps: "},
      {Arguments({"--set", "mppi.progress=inf"}), "--set: mppi.progress: "},
      {Arguments({"--set", "grasps.samples=0"}),
       "--set: grasps.samples: expected a whole number from 1 to 500, got 0"},
      {Arguments({"--set", "grasps.f_min=13"}),
       "grasps.f_min: expected at most fingertips.max_force, 12 N, got 13"},
      {Arguments({"--set", "fingertips.friction=nan"}),
       "--set: fingertips.friction: expected a number from 0 to 10, got nan"},
      {Arguments({"--set", "environment.table.friction=inf"}),
       "--set: environment.table.friction: "},
      {Arguments({"--set", "object.mass=-1"}), "object.mass"},
      {Arguments({"--pictures", "some"}), "--pictures"},
      {{"run", "nothing.lua"}, "nothing.lua"},
      {{"run", kScene, "--weights", "nowhere"}, "score.safetensors"},
  };
  for (const auto& [arguments, expected] : cases) {
    const std::vector<std::string> before = ListFiles(folder_);
    const ProgramResult result = RunProgram(arguments, folder_);
    EXPECT_EQ(result.code, 2) << expected;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
    EXPECT_EQ(ListFiles(folder_), before) << expected;
  }
}

TEST_F(RunCommandTest, CtrlCLeavesAValidShorterRun) {
  const fs::path captured = folder_ / "captured";
  const pid_t child = StartProgram(Arguments({"--out", "run"}), folder_, captured);
  const auto is_planning = [&] {
    return ReadText(captured / "err").find("path 1 of 10, trajectory") != std::string::npos;
  };
  for (int i = 0; i < 3000 && !is_planning(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(child, SIGINT);
  EXPECT_EQ(AwaitProgram(child, captured).code, 130);
  EXPECT_EQ(LoadRun(folder_ / "run").summary.status, "interrupted");
  EXPECT_FALSE(VerifyManifest(folder_ / "run").has_value());
}

// What pregrasp run does in the paper's order, which screens nothing, as a script would.
constexpr char kSameAsRun[] = R"lua(
  local pg = require "pregrasp"
  local settings = {}
  for key, value in (...):gmatch("([%w_.]+)=([%w.]+)") do settings[key] = tonumber(value) or value end
  local s = pg.open("SCENE", { set = settings })
  s:record { dir = "out/script", pictures = "none" }
  s:verdict()
  local g = s:graph {}
  g:score()
  g:prune {}
  local paths, done = g:paths {}, false
  for _ = 1, 2 do
    local o = not done and paths:next():optimize {}
    if o then
      while o:step() do end
      local certified, most = {}, 0
      for plan = 1, 8 do  -- as many as differ
        local is_one, t
        if #certified < 4 or most == 0 then is_one, t = pcall(o.certify, o, {}, plan) end
        if not is_one then break end
        if t.certified then
          local grasps = t:grasps {}
          most = math.max(most, grasps.num_lifting)
          certified[#certified + 1] = { held = t.robust.held, grasps = grasps }
        end
      end
      local first
      for _, x in ipairs(certified) do
        local a, b = x.grasps, first and first.grasps
        local enough = 2 * a.num_lifting >= most
        if enough and (not first or x.held > first.held or
                       x.held == first.held and a.num_lifting > b.num_lifting) then first = x end
      end
      local best = first and first.grasps:best()
      if best and best.lift.held then
        for frame in best:motion {}:frames() do done = frame.number > 0 end
      end
    end
  end
  s:save())lua";

// Two run directories that say the same, but for seconds, memory, and what hashes them.
void ExpectSameRun(const fs::path& a, const fs::path& b) {
  for (const char* file : {"steps.jsonl", "journal.jsonl", "rollout.csv", "motion.csv", "lift.csv",
                           "scene.json", "run.rawlog"}) {
    ASSERT_EQ(fs::exists(a / file), fs::exists(b / file)) << file;
    if (!fs::exists(a / file)) continue;
    EXPECT_EQ(ReadText(a / file), ReadText(b / file)) << file;
  }
  nlohmann::json x = nlohmann::json::parse(ReadText(a / "summary.json"));
  nlohmann::json y = nlohmann::json::parse(ReadText(b / "summary.json"));
  for (nlohmann::json* summary : {&x, &y}) {
    EXPECT_FALSE((*summary)["status"].is_null());
    summary->erase("seconds");
    summary->erase("peak_rss_mb");
  }
  EXPECT_EQ(x, y);
}

class SameRunTest : public RunCommandTest {
 protected:
  // As a run and as a script. @returns the run's exit code.
  int Do(const fs::path& weights, const std::string& friction) const {
    const std::vector<std::string> flags =
        SmallRun({"paths.order=paper", "fingertips.friction=" + friction});
    std::vector<std::string> arguments = {"run",     kScene, "--weights",  weights.string(),
                                          "--paths", "2",    "--pictures", "none"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const int code = RunProgram(arguments, folder_).code;
    std::string settings;
    for (std::size_t i = 1; i < flags.size(); i += 2) settings += flags[i] + ' ';
    std::string text = kSameAsRun;
    text.replace(text.find("SCENE"), 5, kScene);
    std::ofstream(folder_ / "same.lua") << text;
    const ProgramResult script = RunProgram(
        {"script", (folder_ / "same.lua").string(), settings, "--weights", weights.string()},
        folder_);
    EXPECT_EQ(script.code, 0) << script.err;
    ExpectSameRun(folder_ / "out" / "ruler", folder_ / "out" / "script");
    return code;
  }
};

TEST_F(SameRunTest, AScriptOfTheSameCommandsLeavesTheSameRunWhereNothingSucceeds) {
  EXPECT_EQ(Do(Weights(), "0.1"), 3);
}

TEST_F(SameRunTest, AScriptOfTheSameCommandsLeavesTheSameRunWhereTheRulerIsGrasped) {
  EXPECT_EQ(Do(DataFolder() / "assets" / "weights", "0.8"), 0);
}

// How many lifts are held on the way from `certified` on.
int CountLifting(const LoadedRun& run, const CertifyFacts* certified) {
  return static_cast<int>(std::count_if(run.steps.begin(), run.steps.end(), [&](const auto& step) {
    const auto* lift = std::get_if<LiftFacts>(&step.details);
    return lift != nullptr && lift->held && run.FindBefore<CertifyFacts>(step) == certified;
  }));
}

// The main job with the weights that ship, as a user starts it: of the first path's plans with at
// least half as many lifting grasps as any, the one that holds in most worlds is taken on. Another
// that comes before it has been tried before, in vain.
TEST(MainJobTest, TheRulerIsGraspedByThePlanThatHoldsInMostWorlds) {
  const TestFolder temporary;
  const fs::path& folder = temporary.path();
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  const ProgramResult result = RunProgram({"run", kScene, "--pictures", "none"}, folder);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  const LoadedRun run = LoadRun(folder / "out" / "ruler");
  EXPECT_EQ(run.summary.status, "ok");
  EXPECT_GE(run.summary.r_suc, 0.2);  // of 20 samples
  EXPECT_EQ(run.summary.start_grasps.feasible, 0);
  EXPECT_EQ(run.summary.motion.failed, 0);
  EXPECT_TRUE(fs::exists(folder / "out" / "ruler" / "motion.csv"));

  const auto* taken = run.FindBefore<CertifyFacts>(run.steps.back());
  ASSERT_NE(taken, nullptr);
  const auto has_motion = [&](const CertifyFacts* plan) {
    return std::any_of(run.steps.begin(), run.steps.end(), [&](const StepFacts& step) {
      return step.stage() == "motion" && run.FindBefore<CertifyFacts>(step) == plan;
    });
  };
  std::vector<const CertifyFacts*> plans;
  int most = 0;
  for (const StepFacts& step : run.steps) {
    const auto* plan = std::get_if<CertifyFacts>(&step.details);
    if (plan == nullptr || !plan->certified || plan->path != taken->path) continue;
    plans.push_back(plan);
    most = std::max(most, CountLifting(run, plan));
  }
  const int certified = static_cast<int>(plans.size());
  const auto key = [&](const CertifyFacts* plan) {
    const int lifting = CountLifting(run, plan);
    return std::tuple(2 * lifting >= most, plan->robust->held, lifting);
  };
  for (const CertifyFacts* plan : plans) {
    if (plan != taken && !has_motion(plan)) EXPECT_LE(key(plan), key(taken)) << plan->plan;
  }
  EXPECT_GE(certified, 2);
  EXPECT_TRUE(certified <= RunConfig().plans || most == 0);

  // The same run as an animation and as a scene of MRPT's; what fits neither is one line.
  const auto show = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"show", "out/ruler"});
    return RunProgram(arguments, folder);
  };
  EXPECT_EQ(show({"--out", "motion.glb"}).code, 0);
  EXPECT_EQ(ReadFile(folder / "motion.glb").substr(0, 4), "glTF");
  EXPECT_EQ(show({"--step", run.steps.back().id, "--out", "step.3Dscene"}).code, 0);
  EXPECT_NE(ReadGzipFile(folder / "step.3Dscene").find("COpenGLScene"), std::string::npos);
  EXPECT_EQ(show({"--step", "scene.start", "--out", "motion.glb"}).code, 2);
  EXPECT_EQ(show({"--size", "640x480", "--out", "page.html"}).err,
            "--size: expected a picture, --out FILE.png, or a film, FILE.mp4, got page.html\n");
  EXPECT_EQ(show({"--step", "scene.start", "--camera", "below", "--out", "step.png"}).err,
            "--camera: expected one of run, front, back, left, right, top, got \"below\"\n");
  for (const char* camera : {"run", "top"}) {
    EXPECT_EQ(show({"--step", "scene.start", "--camera", camera, "--no-card", "--font-scale", "1.5",
                    "--size", "160x90", "--out", "step.png"})
                  .code,
              0);
  }
  EXPECT_EQ(show({"--out", "step.jpg"}).code, 2);
  EXPECT_EQ(show({"--step", "scene.start", "--out", "step.jpg"}).code, 2);
  EXPECT_EQ(show({"--size", "1280x960", "--out", "sheet.png"}).code, 0);
  EXPECT_EQ(ReadPng(folder / "sheet.png").width, 1280);
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.c_str(), 1);  // where there is no ffmpeg
  EXPECT_EQ(show({"--size", "160x90", "--out", "motion.mp4"}).code, 2);
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(fs::exists(folder / "motion.mp4"));

  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out" / "ruler")) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  EXPECT_LT(bytes, 12'000'000U);  // the bound of a run's directory is 60 MB
}

TEST(MainJobLongTest, FourSeedsOfFiveSucceed) {
  const TestFolder temporary;
  const fs::path& folder = temporary.path();
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  int succeeded = 0;
  for (const char* seed : {"1", "2", "3", "4", "5"}) {
    succeeded +=
        RunProgram({"run", kScene, "--pictures", "none", "--seed", seed}, folder).code == 0;
  }
  EXPECT_GE(succeeded, 4);
}

// A hand with a twentieth of the wrist's speed: no motion keeps to it, and plans are slowed down,
// by up to four times.
TEST(MainJobLongTest, APlanThatIsTooFastForTheHandIsCertifiedAgainSlower) {
  const TestFolder temporary;
  const fs::path& folder = temporary.path();
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  EXPECT_EQ(RunProgram({"run", kScene, "--pictures", "none", "--paths", "1", "--set",
                        "motion.wrist_speed=0.05"},
                       folder)
                .code,
            0);
  const LoadedRun run = LoadRun(folder / "out" / "ruler");
  double planned = 1e9, slowed = 1e9;  // the least share of the limits that a contact part reaches
  for (const StepFacts& step : run.steps) {
    const auto* motion = std::get_if<MotionFacts>(&step.details);
    const auto* plan = run.FindBefore<CertifyFacts>(step);
    if (motion == nullptr || plan == nullptr) continue;
    for (const RatesFacts& phase : motion->phases) {
      if (phase.phase != "contact") continue;
      double& least = plan->slow > 1.0 ? slowed : planned;
      least = std::min(least, phase.speed_share);
    }
  }
  EXPECT_GT(planned, 1.0);
  EXPECT_LT(slowed, 0.5 * planned);
}

TEST(DocsTest, TheStepByStepScriptRunsAsPrinted) {
  const TestFolder temporary;
  const fs::path& folder = temporary.path();
  const ProgramResult result = RunProgram(
      {"script", PREGRASP_SOURCE_DIR "/docs/step_by_step.lua", "--pictures", "none"}, folder);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find(", 0 failed, "), std::string::npos) << result.out;
  EXPECT_FALSE(VerifyManifest(folder / "out" / "step_by_step").has_value());
}

}  // namespace
}  // namespace pregrasp
