#include "app/scene/scene.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Scene MakeScene() {
  Scene scene;
  scene.name = "scene";
  scene.where = "scene.lua:1";
  Body object;
  object.name = "object";
  object.where = "scene.lua:2";
  object.shape = Box{{0.1, 0.1, 0.1}};
  object.mass_properties = MassProperties{0.2, Vector3::Zero(), Matrix3::Zero()};
  Body table;
  table.name = "table";
  table.where = "scene.lua:3";
  table.shape = Box{{1, 1, 0.1}};
  scene.bodies = {object, table};
  return scene;
}

std::string FailureAfter(const std::function<void(Scene&)>& change) {
  Scene scene = MakeScene();
  change(scene);
  try {
    ValidateScene(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ValidateSceneTest, AcceptsASoundScene) { EXPECT_NO_THROW(ValidateScene(MakeScene())); }

TEST(ValidateSceneTest, NamesTheLineAndFieldThatIsWrong) {
  const std::pair<std::function<void(Scene&)>, const char*> cases[] = {
      {[](Scene& s) { s.name = ""; }, "scene.lua:1: name: "},
      {[](Scene& s) { s.bodies.pop_back(); }, "scene.lua:1: environment: "},
      {[](Scene& s) { s.object().mass_properties.reset(); }, "scene.lua:2: object.mass: "},
      {[](Scene& s) { s.object().mass_properties->mass = kNan; }, "scene.lua:2: object.mass: "},
      {[](Scene& s) { s.object().mass_properties->mass = kInf; }, "scene.lua:2: object.mass: "},
      {[](Scene& s) { s.object().mass_properties->p_BoBcm.x() = kNan; },
       "scene.lua:2: object.com: "},
      {[](Scene& s) { s.bodies[1].X_WB.translation().y() = 2000; },
       "scene.lua:3: environment[1].p: "},
      {[](Scene& s) { s.bodies[1].X_WB.linear()(0, 0) = kNan; },
       "scene.lua:3: environment[1].rpy_deg: "},
      {[](Scene& s) { s.bodies[1].shape = Sphere{kInf}; }, "scene.lua:3: environment[1].shape.r: "},
      {[](Scene& s) { s.bodies[1].friction = kNan; }, "scene.lua:3: environment[1].friction: "},
      {[](Scene& s) { s.bodies[1].name = "object"; }, "scene.lua:3: environment[1].name: "},
      {[](Scene& s) { s.gravity.z() = kNan; }, "scene.lua:1: gravity: "},
      {[](Scene& s) { s.fingertips.max_force = 0; }, "scene.lua:1: fingertips.max_force: "},
      {[](Scene& s) { s.fingertips.damping = -1; }, "scene.lua:1: fingertips.damping: "},
      {[](Scene& s) { s.fingertips.grasp_stiffness = 0; },
       "scene.lua:1: fingertips.grasp_stiffness: "},
      {[](Scene& s) { s.camera = CameraConfig{}; }, "scene.lua:1: camera.look_at: "},
  };
  for (const auto& [change, start] : cases) {
    const std::string line = FailureAfter(change);
    EXPECT_EQ(line.find(start), 0U) << start << " against " << line;
  }
}

TEST(ValidateSceneTest, NoFingertipIsMadeOfWhatIsNoNumber) {
  for (double FingertipConfig::*field :
       {&FingertipConfig::friction, &FingertipConfig::max_force, &FingertipConfig::stiffness,
        &FingertipConfig::grasp_stiffness, &FingertipConfig::damping}) {
    for (const double value : {kNan, kInf, -kInf, -1.0, 1e300}) {
      const std::string line = FailureAfter([&](Scene& s) { s.fingertips.*field = value; });
      EXPECT_EQ(line.find("scene.lua:1: fingertips."), 0U) << value << " gives " << line;
    }
  }
}

TEST(ValidateSceneTest, AnInertiaMustBeThatOfARigidBody) {
  const auto with = [](double a, double b, double c, double ab = 0.0) {
    return FailureAfter([=](Scene& s) {
      Matrix3& I = s.object().mass_properties->I_BBcm;
      I = Vector3(a, b, c).asDiagonal();
      I(0, 1) = I(1, 0) = ab;
    });
  };
  EXPECT_EQ(with(1, 1, 1), "");
  EXPECT_EQ(with(1, 1, 2), "");  // a flat plate: the limit
  EXPECT_NE(with(1, 1, 2.01), "");
  EXPECT_NE(with(1, -1, 1), "");
  EXPECT_NE(with(1, 1, 1, 1.5), "");  // not positive
}

TEST(RuleDeparturesTest, WhatIsNoNumberIsNotWithinTheRules) {
  Scene scene = MakeScene();
  scene.fingertips.friction = scene.fingertips.max_force = scene.gravity.z() = kNan;
  scene.fingertips.grasp_stiffness = scene.object().friction = kNan;
  EXPECT_EQ(RuleDepartures(scene).size(), 5U);
}

TEST(RuleDeparturesTest, AreNamedOneByOne) {
  Scene scene = MakeScene();
  EXPECT_TRUE(RuleDepartures(scene).empty());
  scene.fingertips.friction = 1.2;
  scene.fingertips.max_force = 20;
  scene.gravity.z() = -1.62;
  scene.bodies[1].friction = 0.9;
  scene.fingertips.grasp_stiffness = 1500;
  EXPECT_EQ(RuleDepartures(scene).size(), 5U);
}

TEST(RuleDeparturesTest, AGraspIsAsStiffAsAFinger150To600NewtonsAMetre) {
  for (const double k : {150.0, 300.0, 600.0}) {
    Scene scene = MakeScene();
    scene.fingertips.grasp_stiffness = k;
    EXPECT_TRUE(RuleDepartures(scene).empty()) << k;
  }
  for (const double k : {149.0, 601.0}) {
    Scene scene = MakeScene();
    scene.fingertips.grasp_stiffness = k;
    EXPECT_EQ(RuleDepartures(scene).size(), 1U) << k;
  }
}

}  // namespace
}  // namespace pregrasp
