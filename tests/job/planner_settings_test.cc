#include "app/job/planner_settings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "app/core/error.h"
#include "app/core/text.h"
#include "tests/job/fixture.h"

namespace pregrasp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// What the command line says of --set KEY=VALUE, "" if nothing.
std::string Failure(const std::string& key, const std::string& value) {
  PlannerConfig config;
  std::vector<Setting> settings = {{key, value}};
  try {
    ApplyPlannerSettings(config, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SettingsTableTest, EveryRowSaysWhatASettingIs) {
  std::set<std::string> names;
  for (const PlannerSetting& setting : SettingsTable()) {
    SCOPED_TRACE(setting.name);
    EXPECT_TRUE(names.insert(setting.name).second) << "twice";
    EXPECT_EQ(std::count(setting.name.begin(), setting.name.end(), '.'), 1);
    EXPECT_FALSE(setting.meaning.empty());
    EXPECT_EQ(setting.meaning.find('\n'), std::string::npos);
    if (!setting.is_number()) continue;
    EXPECT_TRUE(std::isfinite(setting.range.low) && std::isfinite(setting.range.high));
    EXPECT_LT(setting.range.low, setting.range.high);
    EXPECT_TRUE(setting.range.Contains(std::get<double>(setting.Default())));
    PlannerConfig config;
    for (const double value : {setting.range.low, setting.range.high}) {
      setting.Set(config, value);
      EXPECT_EQ(std::get<double>(setting.Get(config)), value);
    }
  }
  EXPECT_GT(names.size(), 50U);
}

TEST(SettingsTableTest, NoTwoRowsAreTheSameField) {
  PlannerConfig config;
  std::set<const void*> fields;
  for (const PlannerSetting& setting : SettingsTable()) {
    const void* field =
        std::visit([](auto* pointer) -> const void* { return pointer; }, setting.field(config));
    EXPECT_TRUE(fields.insert(field).second) << setting.name;
  }
}

TEST(SettingsTableTest, WhatIsNoFiniteNumberOfTheRangeIsRefusedByEveryNumber) {
  for (const PlannerSetting& setting : SettingsTable()) {
    if (!setting.is_number()) continue;
    const double beyond = setting.range.step > 0 ? setting.range.step : 1e-9;
    const double low = setting.range.low - beyond,
                 high = setting.range.high * (1.0 + 1e-9) + beyond;
    std::vector<std::string> values = {"nan",  "-nan",  "inf", "-inf", "1e300", "-1e300", "few",
                                       "true", "1e309", "",    "0x10", "1 m",   "1,2"};
    values.push_back(FormatDouble(low));
    values.push_back(FormatDouble(high));
    if (setting.range.step > 0) values.push_back(FormatDouble(setting.range.low + 0.5));
    for (const std::string& value : values) {
      EXPECT_EQ(
          Failure(setting.name, value)
              .find("--set: " + setting.name + ": expected " + setting.range.Expected() + ", got "),
          0U)
          << setting.name << "=" << value << " gives " << Failure(setting.name, value);
    }
  }
}

TEST(SettingsTableTest, FlagsAndChoicesTakeTheirWordsOnly) {
  int flags = 0, choices = 0;
  for (const PlannerSetting& setting : SettingsTable()) {
    if (setting.is_number()) continue;
    ++(setting.choices().empty() ? flags : choices);
    for (const char* value : {"1", "nan", "yes", "Reverse"}) {
      const std::string line = Failure(setting.name, value);
      EXPECT_EQ(line.find("--set: " + setting.name + ": expected " + setting.Expected()), 0U)
          << line;
    }
    for (const std::string& word : setting.choices()) EXPECT_EQ(Failure(setting.name, word), "");
  }
  EXPECT_GE(flags, 1);
  EXPECT_EQ(choices, 2);
}

TEST(SettingsTableTest, AWholeConfigurationIsHeldToTheSameRangesWhoeverFilledItIn) {
  EXPECT_NO_THROW(PlannerConfig().Validate());
  for (const PlannerSetting& setting : SettingsTable()) {
    PlannerConfig config;
    const PlannerSetting::Field field = setting.field(config);
    if (double* const* number = std::get_if<double*>(&field)) {
      for (const double value : {kNan, kInf, -kInf, setting.range.low - 1e-9,
                                 setting.range.high * (1.0 + 1e-9) + 1e-9}) {
        **number = value;
        try {
          config.Validate();
          ADD_FAILURE() << setting.name << " " << value;
        } catch (const InputError& error) {
          EXPECT_EQ(error.field(), setting.name);
        }
      }
    } else if (int* const* whole = std::get_if<int*>(&field)) {
      **whole = static_cast<int>(setting.range.high) + 1;
      EXPECT_THROW(config.Validate(), InputError) << setting.name;
    }
  }
}

TEST(PlannerConfigTest, SettingsThatMultiplyAreBoundTogether) {
  PlannerConfig config;
  config.mppi.samples = 4096;
  config.mppi.timing.knots = 4;
  EXPECT_NO_THROW(config.Validate());
  config.stages = 8;
  config.mppi.timing.knots = 100;
  try {
    config.Validate();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "mppi.samples: expected at most 103 with paths.stages 8 and mppi.knots 100, got "
                 "4096");
  }
  config.mppi.samples = 103;
  EXPECT_NO_THROW(config.Validate());
}

TEST(SettingRulesTest, TheProjectsDefinitionsAreWithinThem) {
  EXPECT_EQ(RuleDepartures(PlannerConfig()), std::vector<std::string>());
}

TEST(SettingRulesTest, EveryBoundIsWithinTheRulesAndWhatIsLooserIsOneSentenceThatNamesIt) {
  int bounds = 0;
  for (const PlannerSetting& setting : SettingsTable()) {
    const SettingRule& rule = setting.rule;
    const auto departures = [&](double value) {
      PlannerConfig config;
      setting.Set(config, value);
      return RuleDepartures(config);
    };
    const double step = setting.range.step > 0 ? setting.range.step : 1e-6;
    for (const auto& [bound, away] :
         {std::pair(rule.at_least, -step), std::pair(rule.at_most, step)}) {
      if (!bound) continue;
      ++bounds;
      EXPECT_TRUE(departures(*bound).empty()) << setting.name;
      const std::vector<std::string> loose = departures(*bound + away);
      ASSERT_EQ(loose.size(), 1U) << setting.name;
      EXPECT_EQ(loose[0].find(setting.name + " "), 0U) << loose[0];
      EXPECT_NE(loose[0].find(rule.definition), std::string::npos) << loose[0];
      EXPECT_FALSE(std::string(rule.definition).empty()) << setting.name;
    }
  }
  EXPECT_GE(bounds, 15);
}

TEST(SettingRulesTest, TheDesignsLimitsOfSuccessAreTheBounds) {
  const std::pair<const char*, double> loose[] = {{"certify.hold_seconds", 1.4},
                                                  {"certify.hold_seconds", 0.0},
                                                  {"certify.max_hold_shift", 0.02},
                                                  {"certify.max_hold_turn_deg", 6.0},
                                                  {"grasps.f_min", 0.4},
                                                  {"grasps.max_refinement", 0.011},
                                                  {"grasps.samples", 21},
                                                  {"grasps.tip_tolerance", 1e-3},
                                                  {"grasps.max_cone_deg", 70},
                                                  {"lift.height", 0.05},
                                                  {"motion.fps", 10},
                                                  {"motion.tip_tolerance", 2e-3},
                                                  {"motion.approach_distance", 0.0}};
  for (const auto& [name, value] : loose) {
    PlannerConfig config;
    SetPlannerField(config, name, value);
    EXPECT_EQ(RuleDepartures(config).size(), 1U) << name;
  }
}

TEST(SettingRulesTest, SceneAndSettingsCountTogether) {
  Scene scene = MakeRulerScene();
  PlannerConfig config;
  EXPECT_TRUE(RuleDepartures(scene, config).empty());
  scene.fingertips.friction = 1.5;
  config.certify.hold_seconds = 0.2;
  const std::vector<std::string> both = RuleDepartures(scene, config);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].find("fingertips.friction"), 0U);
  EXPECT_EQ(both[1],
            "certify.hold_seconds 0.2 s is not at least 1.5: a final pose that holds stays within "
            "0.01 m and 5 deg for 1.5 s");
}

TEST(PlannerSettingsTest, AFieldIsSetByItsName) {
  PlannerConfig config;
  SetPlannerField(config, "mppi.samples", 96.0);
  SetPlannerField(config, "graph.top_percent", 2.5);
  SetPlannerField(config, "grasps.may_drop", false);
  SetPlannerField(config, "motion.order", "forward");
  SetPlannerField(config, "paths.order", "paper");
  EXPECT_EQ(config.order, PathOrder::kPaper);
  EXPECT_EQ(config.mppi.samples, 96);
  EXPECT_EQ(config.graph.top_percent, 2.5);
  EXPECT_FALSE(config.completion.grasp.may_drop);
  EXPECT_EQ(config.motion.order, KeyframeOrder::kForward);
}

TEST(PlannerSettingsTest, AnUnknownNameIsToldTheNearestOne) {
  PlannerConfig config;
  try {
    SetPlannerField(config, "mppi.sampels", 9.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mppi.samples"), std::string::npos) << error.what();
  }
}

TEST(PlannerSettingsTest, SettingsOfOthersAreLeft) {
  PlannerConfig config;
  std::vector<Setting> settings = {{"mppi.sigma", "0.3"}, {"object.mass", "0.2"}};
  ApplyPlannerSettings(config, settings);
  EXPECT_EQ(config.mppi.sigma, 0.3);
  ASSERT_EQ(settings.size(), 1U);
  EXPECT_EQ(settings[0].key, "object.mass");
}

TEST(PlannerSettingsTest, TheManifestsConfigurationHasEveryField) {
  PlannerConfig config;
  SetPlannerField(config, "lift.height", 0.07);
  const nlohmann::json all = PlannerConfigJson(config);
  EXPECT_EQ(all["lift"]["height"], 0.07);
  EXPECT_EQ(all["motion"]["order"], "reverse");
  EXPECT_TRUE(all["mppi"]["samples"].is_number_integer());
  std::vector<std::string> roots;
  std::size_t count = 0;
  for (const auto& [root, fields] : all.items()) {
    roots.push_back(root);
    count += fields.size();
  }
  EXPECT_EQ(roots, PlannerRoots());
  EXPECT_EQ(count, SettingsTable().size());
}

}  // namespace
}  // namespace pregrasp
