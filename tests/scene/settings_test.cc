#include "app/scene/settings.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

Scene MakeObjectOnTable() {
  Scene scene;
  scene.name = "scene";
  Body object;
  object.name = "object";
  object.shape = Box{{0.1, 0.1, 0.1}};
  object.mass_properties = MassProperties{0.2, Vector3::Zero(), Matrix3::Identity()};
  Body table;
  table.name = "table";
  table.shape = Box{{1, 1, 0.1}};
  scene.bodies = {object, table};
  return scene;
}

void Set(Scene& scene, const std::string& assignment) {
  std::vector<Setting> settings = {ParseSetting(assignment)};
  ApplySceneSettings(scene, settings);
  RequireNoSettingsLeft(settings);
}

std::string Failure(const std::string& assignment) {
  Scene scene = MakeObjectOnTable();
  try {
    Set(scene, assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SettingsTest, ChangeTheSceneByKey) {
  Scene scene = MakeObjectOnTable();
  Set(scene, "fingertips.friction=0.05");
  Set(scene, "fingertips.grasp_stiffness=450");
  Set(scene, "environment.table.friction=0.25");
  Set(scene, "environment.table.p=0,0,-0.05");
  Set(scene, "object.rpy_deg={0,0,90}");
  Set(scene, "gravity=0,0,-1.62");
  EXPECT_EQ(scene.fingertips.friction, 0.05);
  EXPECT_EQ(scene.fingertips.grasp_stiffness, 450.0);
  EXPECT_EQ(scene.bodies[1].friction, 0.25);
  EXPECT_EQ(scene.bodies[1].X_WB.translation(), Vector3(0, 0, -0.05));
  EXPECT_NEAR(scene.object().X_WB.linear()(1, 0), 1.0, 1e-15);
  EXPECT_EQ(scene.gravity, Vector3(0, 0, -1.62));
}

TEST(SettingsTest, AGivenInertiaFollowsTheMassAndAMassMakesABodyMovable) {
  Scene scene = MakeObjectOnTable();
  Set(scene, "object.mass=0.4");
  EXPECT_EQ(scene.object().mass_properties->mass, 0.4);
  EXPECT_EQ(scene.object().mass_properties->I_BBcm(0, 0), 2.0);
  Set(scene, "environment.table.mass=3");
  EXPECT_TRUE(scene.bodies[1].movable());
}

TEST(SettingsTest, WhatIsWrongIsSaidWithTheNearestKey) {
  EXPECT_EQ(
      Failure("object.mas=1"),
      "--set: expected a key that can be set, got \"object.mas\" (did you mean \"object.mass\"?)");
  EXPECT_EQ(Failure("object.mass=heavy"),
            "--set: object.mass: expected a number from 1e-06 to 1e+06 kg, got \"heavy\"");
  EXPECT_EQ(Failure("object.mass=1kg"),
            "--set: object.mass: expected a number from 1e-06 to 1e+06 kg, got \"1kg\"");
  EXPECT_EQ(Failure("gravity=0,0"), "--set: gravity: expected three numbers x,y,z, got \"0,0\"");
  EXPECT_EQ(Failure("gravity=0,0,1,2"),
            "--set: gravity: expected three numbers x,y,z, got \"0,0,1,2\"");
  for (const char* assignment : {"", "=", "object.mass", "object.mass=", "=1"}) {
    EXPECT_NE(Failure(assignment).find("expected key=value"), std::string::npos) << assignment;
  }
}

TEST(SettingsTest, WhatDoesNotFitTheSceneIsRefusedByTheKeyThatWasTyped) {
  EXPECT_EQ(Failure("name=a b"),
            "--set: name: expected a name of letters, digits, _ and -, got \"a b\"");
  EXPECT_EQ(Failure("environment.table.name=object"),
            "--set: environment.table.name: expected a name no other body has, got \"object\"");
  Scene scene = MakeObjectOnTable();
  std::vector<Setting> settings = {{"environment.table.name", "", "set"}};
  try {
    ApplySceneSettings(scene, settings);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "set: environment.table.name: expected a name of letters, digits, _ and -, got "
                 "\"\"");
  }
  // What is the scene's own fault stays so.
  scene = MakeObjectOnTable();
  scene.object().where = "scene.lua:3";
  scene.object().friction = -1.0;
  settings = {ParseSetting("environment.table.name=board")};
  try {
    ApplySceneSettings(scene, settings);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "scene.lua:3");
  }
}

// Every number that --set reaches, with one that is just beyond each end of what it may be.
TEST(SettingsTest, WhatIsNotFiniteOrOutOfRangeIsRefusedByTheKeyThatWasTyped) {
  const struct {
    const char* key;
    const char* low;
    const char* high;
    bool vector;
  } numbers[] = {
      {"object.mass", "0", "2e6", false},
      {"object.friction", "-0.01", "10.1", false},
      {"environment.table.mass", "-3", "1e300", false},
      {"environment.table.friction", "-1", "11", false},
      {"fingertips.friction", "-0.1", "10.5", false},
      {"fingertips.max_force", "0", "1001", false},
      {"fingertips.stiffness", "0", "1e6", false},
      {"fingertips.grasp_stiffness", "-300", "1e9", false},
      {"fingertips.damping", "-0.1", "101", false},
      {"object.p", "-1001", "1e4", true},
      {"object.rpy_deg", "-1e5", "1e300", true},
      {"environment.table.p", "-1e18", "2000", true},
      {"gravity", "-101", "1e3", true},
  };
  for (const auto& [key, low, high, vector] : numbers) {
    for (const std::string value : {"nan", "-nan", "inf", "-inf", low, high}) {
      const std::string text = vector ? "0," + value + ",0" : value;
      const std::string line = Failure(std::string(key) + "=" + text);
      EXPECT_EQ(line.find("--set: " + std::string(key) + ": expected a number from "), 0U)
          << key << "=" << text << " gives " << line;
    }
  }
}

TEST(SettingsTest, KeysOfOtherStagesAreLeftForThem) {
  Scene scene = MakeObjectOnTable();
  std::vector<Setting> settings = {ParseSetting("mppi.samples=64"), ParseSetting("object.mass=1"),
                                   ParseSetting("graph.triangles=30")};
  ApplySceneSettings(scene, settings);
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[0].key, "mppi.samples");
  EXPECT_THROW(RequireNoSettingsLeft(settings), InputError);
}

}  // namespace
}  // namespace pregrasp
