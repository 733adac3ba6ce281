#include "app/job/planner_settings.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

TEST(PlannerSettingsTest, AFieldIsSetByItsName) {
  PlannerConfig config;
  SetPlannerField(config, "mppi.samples", 96.0);
  SetPlannerField(config, "graph.top_percent", 2.5);
  SetPlannerField(config, "grasps.may_drop", false);
  SetPlannerField(config, "motion.order", "forward");
  EXPECT_EQ(config.mppi.samples, 96);
  EXPECT_EQ(config.graph.top_percent, 2.5);
  EXPECT_FALSE(config.completion.grasp.may_drop);
  EXPECT_EQ(config.motion.order, KeyframeOrder::kForward);
}

TEST(PlannerSettingsTest, WhatDoesNotFitIsBadInput) {
  PlannerConfig config;
  EXPECT_THROW(SetPlannerField(config, "mppi.samples", 9.5), InputError);
  EXPECT_THROW(SetPlannerField(config, "mppi.sigma", "wide"), InputError);
  EXPECT_THROW(SetPlannerField(config, "motion.order", "sideways"), InputError);
  EXPECT_THROW(SetPlannerField(config, "grasps.may_drop", 1.0), InputError);
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
  std::vector<std::string> roots;
  for (const auto& [root, fields] : all.items()) roots.push_back(root);
  EXPECT_EQ(roots, PlannerRoots());
}

}  // namespace
}  // namespace pregrasp
