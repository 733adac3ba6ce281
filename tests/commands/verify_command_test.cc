// pregrasp verify and diff as a user types them: on a run that succeeds, on one that fails, and on
// one that was stepped, gone back on and forked from Lua.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "app/core/data_folder.h"
#include "app/session/verification.h"
#include "render/image.h"
#include "tests/bindings/run_program.h"
#include "tests/commands/small_run.h"
#include "tests/networks/random_network.h"
#include "tests/recording/alteration.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const std::string kRuler = PREGRASP_SOURCE_DIR "/scenes/ruler.lua";

constexpr char kForks[] = R"lua(
  local pg = require "pregrasp"
  local s = pg.open("SCENE", { set = { ["grasps.samples"] = 2, ["grasps.starts"] = 2,
                                       ["grasps.max_solves"] = 1 } })
  s:record { dir = "out/forks", pictures = "none" }
  local g = s:graph { triangles = 12, samples = 1, points = 128 }
  g:score()
  for _ = 1, 3 do g:prune_step() end
  local o = g:paths { stages = 2 }:next():optimize { samples = 6, iterations = 4, patience = 9 }
  for _ = 1, 3 do o:step() end
  o:back(2)
  local other = o:fork { sigma = 0.3 }
  other:step()
  while o:step() do end
  other:certify()
  o:certify():grasps { samples = 2 }
  s:save())lua";

class VerifyCommandTest : public testing::Test {
 protected:
  VerifyCommandTest() {
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);  // for the program's verdicts
    fs::create_directories(weights_);
    WriteRandomWeights(weights_);
  }

  // A run with random weights of little work, which comes to nothing.
  fs::path MakeFailingRun(const std::string& name = "failing",
                          const std::vector<std::string>& more = {},
                          const std::string& pictures = "none") const {
    std::vector<std::string> arguments = {"run",       kRuler, "--weights",  weights_.string(),
                                          "--out",     name,   "--paths",    "1",
                                          "--threads", "1",    "--pictures", pictures};
    for (const auto& part : {SmallRun({"fingertips.friction=0.1"}), more}) {
      arguments.insert(arguments.end(), part.begin(), part.end());
    }
    const ProgramResult result = RunProgram(arguments, folder_);
    EXPECT_EQ(result.code, 3) << result.err;
    return folder_ / name;
  }

  fs::path MakeForkedRun() const {
    std::string script = kForks;
    WriteFile(folder_ / "forks.lua", script.replace(script.find("SCENE"), 5, kRuler));
    const ProgramResult result =
        RunProgram({"script", "forks.lua", "--weights", weights_.string()}, folder_);
    EXPECT_EQ(result.code, 0) << result.err;
    return folder_ / "out/forks";
  }

  ProgramResult Verify(const fs::path& run, const std::string& threads = "2") const {
    return RunProgram(
        {"verify", run.string(), "--threads", threads, "--weights", weights_.string()}, folder_);
  }

  // The program verifies it; what an altered and sealed copy of its files is found to differ in is
  // found by the same comparison with what was recomputed once.
  void ExpectProven(const fs::path& run, const fs::path& weights) const {
    const fs::path recomputed = folder_ / "recomputed", altered = folder_ / "altered";
    RunComparison same(0.0);
    RecomputeRun(run, recomputed, {1, weights, {}}, same);
    same.CompareRuns(run, recomputed);
    EXPECT_FALSE(same.first().has_value()) << same.first()->Sentence("run", "recomputed");
    fs::copy(run, altered, fs::copy_options::recursive);
    Rng rng(17);
    for (int i = 0; i < 20; ++i) {
      const Alteration alteration = AlterRandomField(altered / "steps.jsonl", rng);
      const RunDifference found = Compare(altered, recomputed);
      EXPECT_EQ(found.place, alteration.id);
      EXPECT_EQ(found.value.field, alteration.field) << alteration.id;
      Restore(run, altered, "steps.jsonl");
    }
    for (const char* table : {"rollout.csv", "lift.csv", "motion.csv"}) {
      for (int i = 0; fs::exists(run / table) && i < 20; ++i) {
        const std::string cell = AlterRandomCell(altered / table, rng);
        const RunDifference found = Compare(altered, recomputed);
        EXPECT_EQ(found.place + ": " + found.value.field, std::string(table) + ", " + cell);
        Restore(run, altered, table);
      }
    }
    fs::remove_all(recomputed);
    fs::remove_all(altered);
  }

  static RunDifference Compare(const fs::path& run, const fs::path& recomputed) {
    RunComparison comparison(0.0);
    comparison.CompareRuns(run, recomputed);
    return comparison.first().value_or(RunDifference{"no difference", {}});
  }
  static void Restore(const fs::path& from, const fs::path& to, const std::string& file) {
    fs::copy_file(from / file, to / file, fs::copy_options::overwrite_existing);
  }

  const TestFolder temporary_;
  const fs::path folder_ = temporary_.path();
  const fs::path weights_ = folder_ / "weights";
};

TEST_F(VerifyCommandTest, ARunThatFailsIsProvenStepByStep) {
  const fs::path run = MakeFailingRun();
  const ProgramResult result = Verify(run);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find(" steps recomputed, every file the same"), std::string::npos);
  ExpectProven(run, weights_);
}

TEST_F(VerifyCommandTest, ASteppedAndForkedRunIsProvenStepByStep) {
  const fs::path run = MakeForkedRun();
  EXPECT_NE(ReadText(run / "steps.jsonl").find("mppi.2~2"), std::string::npos);
  const ProgramResult result = Verify(run);
  EXPECT_EQ(result.code, 0) << result.err;
  ExpectProven(run, weights_);
}

TEST_F(VerifyCommandTest, AnAlteredAndSealedRunIsRefusedWithStepAndField) {
  const fs::path run = MakeForkedRun();
  const std::string steps = ReadText(run / "steps.jsonl");
  Rng rng(5);
  for (int i = 0; i < 3; ++i) {
    const Alteration altered = AlterRandomField(run / "steps.jsonl", rng);
    Reseal(run);
    const ProgramResult result = Verify(run, "1");
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find(": " + altered.id + ": " + altered.field + ": the run says "),
              std::string::npos)
        << result.err;
    WriteFile(run / "steps.jsonl", steps);
  }
}

TEST_F(VerifyCommandTest, OtherWeightsAndOtherVersionsAreRefusedInClearWords) {
  const fs::path run = MakeForkedRun();
  ProgramResult result = RunProgram({"verify", run.string()}, folder_);
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("manifest.json: inputs.generator.safetensors: expected SHA-256 "),
            std::string::npos)
      << result.err;
  nlohmann::ordered_json manifest = nlohmann::ordered_json::parse(ReadText(run / "manifest.json"));
  manifest["compiler"] = "another 1.0";
  manifest["program_sha256"] = std::string(64, '0');
  WriteFile(run / "manifest.json", FormatJsonIndented(manifest));
  Reseal(run);
  result = Verify(run);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find(", another 1.0, "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("every decision and every number is the same"), std::string::npos);
  manifest["planner_version"] = "9.9.9";
  WriteFile(run / "manifest.json", FormatJsonIndented(manifest));
  Reseal(run);
  result = Verify(run);
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("which this program can recompute, got \"9.9.9\""), std::string::npos)
      << result.err;
}

TEST_F(VerifyCommandTest, TwoRunsOfOneSeedAreShownSideBySide) {
  const fs::path one = MakeFailingRun("one"), same = MakeFailingRun("same"),
                 other = MakeFailingRun("other", {"--set", "mppi.sigma=0.5"});
  ProgramResult result = RunProgram({"diff", one.string(), same.string()}, folder_);
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "every step and every file the same\n");
  result = RunProgram({"diff", one.string(), other.string()}, folder_);
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out.rfind("path.1.screen.1: ", 0), 0U) << result.out;
  EXPECT_NE(result.out.find("\nconfiguration\n  configuration.mppi.sigma"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find(" 1.2 "), std::string::npos);
  EXPECT_EQ(result.out.find("\nscene\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" 0.5\n"), std::string::npos);
  // As pictures: each run a row, the first difference framed; a strip of steps of one.
  const auto show = [&](std::vector<std::string> arguments, const char* out = "shown.png") {
    arguments.insert(arguments.begin(), {"show", "one", "--out", out});
    return RunProgram(arguments, folder_);
  };
  EXPECT_EQ(show({"--against", "other", "--size", "1600x900"}).err, "");
  const Image pair = ReadPng(folder_ / "shown.png");
  EXPECT_EQ(show({"--steps", "scene.start,path.1.screen.1", "--size", "800x600"}).err, "");
  EXPECT_EQ(pair.width, 1600);
  EXPECT_EQ(ReadPng(folder_ / "shown.png").width, 800);
  EXPECT_NE(show({"--steps", "scene.start,path.1.screen.9"}).err.find("path.1.screen."),
            std::string::npos);
  EXPECT_EQ(show({"--against", "none"}).code, 2);
  EXPECT_EQ(show({"--against", "other", "--step", "scene.start"}).err,
            "--against: expected no --step beside it, got --step scene.start\n");
  EXPECT_EQ(show({"--steps", "scene.start"}, "page.html").code, 2);
  EXPECT_EQ(show({"--what", "graph"}, "graph.svg").err, "");
  EXPECT_NE(ReadFile(folder_ / "graph.svg").find("contact states kept"), std::string::npos);
  EXPECT_EQ(show({"--what", "graph"}).err,
            "--what: expected a drawing, --out FILE.svg, got shown.png\n");
  for (const std::vector<std::string>& into :
       {std::vector<std::string>{"show", one.string(), "--out", (one / "sheet.png").string()},
        {"hand", "check", "four_finger", "--out", one.string()},
        {"eval", "--scenes", kRuler, "--seeds", "1", "--out", one.string()}}) {
    result = RunProgram(into, folder_);
    EXPECT_EQ(result.code, 2) << into.front();
    EXPECT_NE(result.err.find("expected a place outside of run directories"), std::string::npos)
        << result.err;
  }
  EXPECT_EQ(VerifyManifest(one), std::nullopt);
  const fs::path rough = MakeFailingRun("rough", {"--set", "object.friction=0.25"});
  result = RunProgram({"diff", one.string(), rough.string()}, folder_);
  EXPECT_EQ(result.out.rfind("path.1.screen.1: ", 0), 0U) << result.out;
  EXPECT_NE(result.out.find("\nscene\n  bodies[0].friction"), std::string::npos) << result.out;
}

// Files that were changed are shown with a warning; whoever follows a step's parents comes to an
// end, whatever the file says.
TEST_F(VerifyCommandTest, ChangedRunsAreWarnedOfAndStepsThatGoRoundInACircleRefused) {
  const fs::path run = MakeFailingRun("circle"), intact = folder_ / "intact";
  fs::copy(run, intact, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  WriteFile(run / "run.rawlog", ReadFile(run / "run.rawlog") + "more");
  const ProgramResult changed = RunProgram(
      {"show", run.string(), "--step", "scene.start", "--out", (folder_ / "a.png").string()},
      folder_);
  EXPECT_EQ(changed.code, 0);
  EXPECT_EQ(changed.err, run.string() + ": warning: run.rawlog was changed\n");
  for (const auto& [left, right] : {std::pair(run, intact), std::pair(intact, run)}) {
    const ProgramResult pair =
        RunProgram({"show", left.string(), "--against", right.string(), "--steps", "scene.start",
                    "--out", (folder_ / "pair.png").string()},
                   folder_);
    EXPECT_EQ(pair.code, 0);
    EXPECT_EQ(pair.err, changed.err);
  }
  const std::string steps = ReadFile(run / "steps.jsonl");
  const std::regex node("\"node\":\"[^\"]+\"");
  for (const std::string& id : {std::string("graph.score"), LoadRun(run).steps.back().id}) {
    WriteFile(run / "steps.jsonl", std::regex_replace(steps, node, "\"node\":\"" + id + '"'));
    for (const char* out : {"step.png", "page.html"}) {
      const ProgramResult result =
          RunProgram({"show", run.string(), "--out", (folder_ / out).string()}, folder_);
      EXPECT_EQ(result.code, 2);
      EXPECT_NE(result.err.find("command.node: expected the id of an earlier step"),
                std::string::npos)
          << result.err;
    }
  }
}

// The main job with the weights that ship, with pictures of key steps.
TEST_F(VerifyCommandTest, LongTheMainJobIsProvenAndTheFileOfAnyChangedByteIsNamed) {
  const ProgramResult made = RunProgram({"run", kRuler, "--pictures", "key"}, folder_);
  ASSERT_EQ(made.code, 0) << made.err;
  const fs::path run = folder_ / "out/ruler";
  const ProgramResult result = RunProgram({"verify", run.string()}, folder_);
  EXPECT_EQ(result.code, 0) << result.err;
  ExpectProven(run, DataFolder() / "assets/weights");
  const std::vector<std::string> files = ListRunFiles(run).files;
  Rng rng(23);
  for (int i = 0; i < 200; ++i) {
    const std::string& file = files[rng.UniformInt(static_cast<std::uint32_t>(files.size()))];
    if (fs::is_symlink(run / file)) continue;
    const std::string bytes = ReadFile(run / file);
    WriteFile(run / file, FlipRandomBit(bytes, rng));
    const auto mismatch = VerifyManifest(run);
    ASSERT_TRUE(mismatch.has_value()) << file;
    EXPECT_EQ(mismatch->Sentence(), file + " was changed");
    WriteFile(run / file, bytes);
  }
}

// MRPT's own programs on a real run: its steps have grasps and hands, which sample runs lack.
TEST_F(VerifyCommandTest, RawlogEditReadsBothLogsOfARunWithKeyPictures) {
  const fs::path run = MakeFailingRun("key", {}, "key");
  const auto edit = [&](const std::string& arguments) {
    const std::string command =
        "cd '" + run.string() + "' && rawlog-edit " + arguments + " > output 2>&1";
    return std::system(command.c_str());
  };
  for (const auto& [log, lines] :
       {std::pair("run", "steps.jsonl"), {"pictures", "pictures.jsonl"}}) {
    const auto expected = SplitLines(ReadText(run / lines)).size();
    const std::string in = std::string(" -i ") + log + ".rawlog";
    EXPECT_EQ(edit("--info" + in), 0);
    EXPECT_EQ(edit("--list-images" + in), 0);
    EXPECT_EQ(edit("--describe" + in), 0);
    const std::string text = ReadText(run / "output");
    std::size_t described = 0;
    for (std::size_t at = text.find("\"details\":"); at != std::string::npos;
         at = text.find("\"details\":", at + 1)) {
      ++described;
    }
    EXPECT_EQ(described, expected) << log;
    EXPECT_EQ(edit("--export-txt" + in), 0);
    EXPECT_EQ(SplitLines(ReadText(run / (std::string(log) + "_pose_ruler.txt"))).size(),
              expected + 1);
  }
}

}  // namespace
}  // namespace pregrasp
