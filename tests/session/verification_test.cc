#include "app/session/verification.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/core/error.h"
#include "app/session/session.h"
#include "tests/job/fixture.h"
#include "tests/recording/alteration.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Node = Timeline::Node;

// A push by hand that was gone back on and tried in another way, with two pictures.
class VerificationTest : public testing::Test {
 protected:
  VerificationTest() {
    fs::create_directory(folder_.path() / "scratch");
    setenv("TMPDIR", (folder_.path() / "scratch").c_str(), 1);  // where runs are recomputed
    Session session(MakeRulerScene(), {});
    session.Record(run_, PictureMode::kNone);
    Timeline& timeline = session.timeline();
    const Node& touched =
        timeline.Do(session.Settle(0.1), Verb::kTouch,
                    {{"finger", "index"}, {"p_OC", {0.11, 0, 0.0015}}, {"trace", true}});
    const auto move = [&](const Node& from, double x, double z) -> const Node& {
      return timeline.Do(from, Verb::kMove,
                         {{"finger", "index"}, {"p_WTarget", {x, 0.0, z}}, {"seconds", 0.1}});
    };
    const Node& pressed = move(touched, -0.05, -0.01);
    const Node& pulled = move(pressed, -0.03, -0.01);
    const Node& other = move(pressed, -0.03, -0.012);
    timeline.Do(pulled, Verb::kLetGo, {{"finger", "index"}});
    session.Save(std::nullopt, &other);
  }

  Verification Verify() const {
    VerifyConfig config;
    config.weights = folder_.path();
    return VerifyRun(run_, config);
  }
  std::optional<RunDifference> Difference() const { return Verify().comparison.first(); }

  // Calls alter twenty times, seals the run again after each and tells what verify says of it.
  template <typename Alter, typename Check>
  void ExpectFound(const std::string& file, const Alter& alter, const Check& check) {
    const std::string bytes = ReadFile(run_ / file);
    Rng rng(1);
    for (int i = 0; i < 20; ++i) {
      const auto altered = alter(run_ / file, rng);
      Reseal(run_);
      ASSERT_FALSE(VerifyManifest(run_).has_value());
      const auto difference = Difference();
      ASSERT_TRUE(difference.has_value()) << file << " change " << i;
      check(altered, *difference);
      WriteFile(run_ / file, bytes);
    }
    Reseal(run_);
  }

  const TemporaryFolder folder_;
  const fs::path run_ = folder_.path() / "run";
};

TEST_F(VerificationTest, ARunThatWasForkedIsTheSameWhenRecomputed) {
  const Verification verification = Verify();
  EXPECT_TRUE(verification.provenance.same_build);
  EXPECT_EQ(verification.num_steps, 7);
  const auto& first = verification.comparison.first();
  EXPECT_FALSE(first.has_value()) << first->Sentence("run", "recomputed");
  EXPECT_TRUE(fs::is_empty(folder_.path() / "scratch"));
}

TEST_F(VerificationTest, EachOfTwentyAlteredAndSealedFieldsIsNamedWithItsStep) {
  ExpectFound("steps.jsonl", AlterRandomField,
              [](const Alteration& altered, const RunDifference& difference) {
                EXPECT_EQ(difference.place, altered.id);
                EXPECT_EQ(difference.value.field, altered.field);
              });
}

TEST_F(VerificationTest, EachOfTwentyAlteredAndSealedCellsIsNamedWithItsColumn) {
  ExpectFound("rollout.csv", AlterRandomCell,
              [](const std::string& altered, const RunDifference& difference) {
                EXPECT_EQ(difference.place + ": " + difference.value.field,
                          "rollout.csv, " + altered);
              });
}

TEST_F(VerificationTest, EachOfTwentyAlteredAndSealedFieldsOfTheTraceIsNamed) {
  ExpectFound("trace.jsonl", AlterRandomField,
              [](const Alteration& altered, const RunDifference& difference) {
                EXPECT_EQ(difference.place,
                          "trace.jsonl, line " + std::to_string(altered.line + 1));
                EXPECT_EQ(difference.value.field, altered.field);
              });
}

// What a command says decides what follows, so the first thing that differs is the step's, its
// command, or that it cannot be done at all.
TEST_F(VerificationTest, EachOfTwentyAlteredAndSealedCommandsIsFound) {
  const std::string bytes = ReadFile(run_ / "journal.jsonl");
  Rng rng(2);
  for (int i = 0; i < 20; ++i) {
    const Alteration altered = AlterRandomField(run_ / "journal.jsonl", rng);
    Reseal(run_);
    try {
      const auto difference = Difference();
      ASSERT_TRUE(difference.has_value()) << altered.line << ' ' << altered.field;
      const std::string line = "journal.jsonl, line " + std::to_string(altered.line + 1);
      EXPECT_TRUE(difference->place == altered.id || difference->place == line)
          << difference->Sentence("run", "recomputed") << " for " << altered.id << ' '
          << altered.field;
    } catch (const InputError& error) {  // no command at all
      EXPECT_NE(std::string(error.what()).find("journal.jsonl"), std::string::npos);
    }
    WriteFile(run_ / "journal.jsonl", bytes);
  }
}

TEST_F(VerificationTest, AlteredAndSealedResultsAreNamed) {
  for (const char* file : {"summary.json", "scene.json", "manifest.json"}) {
    const std::string bytes = ReadFile(run_ / file);
    const auto alter = [&](const std::string& from, const std::string& to) {
      std::string text = bytes;
      const std::size_t at = text.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      WriteFile(run_ / file, text.replace(at, from.size(), to));
      Reseal(run_);
    };
    if (file == std::string("summary.json")) {
      alter("\"status\": null", "\"status\": \"ok\"");
      EXPECT_EQ(Difference()->Sentence("has", "not"), "summary.json: status: has \"ok\", not null");
    } else if (file == std::string("scene.json")) {
      alter("\"mass\": 0.025", "\"mass\": 0.026");
      ASSERT_TRUE(Difference().has_value());
    } else {
      alter("\"step\": \"sim.3~2\"", "\"step\": \"sim.3\"");
      EXPECT_EQ(Difference()->place, "rollout.csv, line 27");
      alter("\"planner_version\": \"", "\"planner_version\": \"9.");
      EXPECT_THROW(Verify(), InputError);
    }
    WriteFile(run_ / file, bytes);
  }
}

TEST_F(VerificationTest, AnotherBuildsRunMayDifferByLittle) {
  std::string manifest = ReadFile(run_ / "manifest.json");
  const std::size_t at = manifest.find("\"program_sha256\": \"") + 19;
  manifest[at] = manifest[at] == '0' ? '1' : '0';
  WriteFile(run_ / "manifest.json", manifest);
  std::string steps = ReadFile(run_ / "steps.jsonl");
  const auto nudge = [&](double factor) {
    std::vector<std::string> lines = SplitLines(steps);
    auto step = nlohmann::ordered_json::parse(lines[3]);
    double& z = step["fingers"][1]["f_W"][2].get_ref<double&>();
    z *= factor;
    lines[3] = FormatJson(step);
    WriteFile(run_ / "steps.jsonl", JoinLines(lines));
    Reseal(run_);
    return Verify();
  };
  const Verification little = nudge(1.0 + 1e-10);
  EXPECT_FALSE(little.provenance.same_build);
  EXPECT_FALSE(little.comparison.first().has_value());
  EXPECT_EQ(little.comparison.largest()->value.field, "fingers[1].f_W[2]");
  const Verification much = nudge(1.01);
  EXPECT_EQ(much.comparison.first()->value.field, "fingers[1].f_W[2]");
  EXPECT_FALSE(much.comparison.decision().has_value());
  EXPECT_EQ(much.num_steps, 7);
}

}  // namespace
}  // namespace pregrasp
