#include "app/job/command.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

TEST(CommandTest, ReadsBackWhatWasWritten) {
  Command command{Verb::kMove,
                  "sim.3~2",
                  {{"finger", "index"}, {"p_WTarget", {0.1, 1.0 / 3.0, -2e-9}}, {"seconds", 0.5}}};
  command.options["settings"] = {{"mppi.sigma", 0.3}};
  EXPECT_EQ(CommandFromJson(CommandToJson(command), "journal"), command);
}

TEST(CommandTest, EveryVerbHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (int verb = 0; verb <= static_cast<int>(Verb::kWait); ++verb) {
    const Command command{static_cast<Verb>(verb), "x", nlohmann::json::object()};
    EXPECT_TRUE(words.insert(VerbName(command.verb)).second) << verb;
    EXPECT_EQ(CommandFromJson(CommandToJson(command), ""), command);
  }
  EXPECT_EQ(words.count(""), 0U);
}

TEST(CommandTest, WhatIsNoCommandIsReportedWithItsPlace) {
  const auto error_of = [](const char* text) -> std::string {
    try {
      CommandFromJson(nlohmann::json::parse(text), "journal.jsonl:3");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(
      error_of(R"({"verb": "fly", "node": "a", "options": {}})").find("journal.jsonl:3: verb"),
      std::string::npos);
  EXPECT_NE(error_of(R"({"verb": "score", "options": {}})").find("node"), std::string::npos);
  EXPECT_NE(error_of(R"({"verb": "score", "node": "a", "options": 3})").find("options"),
            std::string::npos);
}

TEST(CommandOptionsTest, RefusesWhatIsMissingOrOfAnotherKind) {
  const Command command{Verb::kPath, "x", {{"rank", 2.5}, {"finger", 1}}};
  const CommandOptions options(command);
  EXPECT_THROW(options.Int("rank"), InputError);
  EXPECT_THROW(options.Text("finger"), InputError);
  EXPECT_THROW(options.Number("seconds"), InputError);
  EXPECT_EQ(options.Number("rank"), 2.5);
}

}  // namespace
}  // namespace pregrasp
