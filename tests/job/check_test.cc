#include "app/job/check.h"

#include <gtest/gtest.h>

#include "tests/job/fixture.h"

namespace pregrasp {
namespace {

using Severity = CheckFinding::Severity;

// The one finding about a scene, as "E where: message" or "W where: message".
std::string OneFinding(Scene scene) {
  LoadShapes(scene, ".");
  std::string all;
  for (const CheckFinding& finding : CheckScene(scene)) {
    all += (finding.severity == Severity::kError ? "E " : "W ") + finding.where + ": " +
           finding.message + "\n";
  }
  return all;
}

TEST(CheckSceneTest, TheRulerIsClean) { EXPECT_EQ(OneFinding(MakeRulerScene()), ""); }

TEST(CheckSceneTest, AnOverlapIsNamedWithItsDepth) {
  Scene scene = MakeRulerScene();
  scene.object().X_WB.translation().z() -= 0.001;
  EXPECT_EQ(OneFinding(scene), "E ruler.lua:2: \"ruler\" overlaps \"table\" by 1 mm\n");
}

TEST(CheckSceneTest, AFloatingBodyIsAnError) {
  Scene scene = MakeRulerScene();
  scene.object().X_WB.translation().z() += 0.05;
  const std::string finding = OneFinding(scene);
  EXPECT_EQ(finding.find("E ruler.lua:2: \"ruler\" is not at rest: within 1 s it moves 50.00 mm"),
            0U)
      << finding;
  EXPECT_NE(finding.find("it floats"), std::string::npos) << finding;
}

TEST(CheckSceneTest, ABodyThatTipsIsNotAtRestAndDoesNotFloat) {
  Scene scene = MakeRulerScene();
  scene.object().X_WB.translation().x() = 0.02;  // more than half of it over the edge
  const std::string finding = OneFinding(scene);
  EXPECT_EQ(finding.find("E ruler.lua:2: \"ruler\" is not at rest"), 0U) << finding;
  EXPECT_EQ(finding.find("floats"), std::string::npos) << finding;
}

TEST(CheckSceneTest, PhysicsThatDoesNotConvergeIsTold) {
  // A crate of 40 kg on a strip of 1 g and 8 mm of width.
  Scene scene = MakeRulerScene();
  scene.object().shape = Box{{0.3, 0.3, 0.2}};
  scene.object().X_WB.translation() = Vector3(-0.3, 0, 0.104);
  scene.object().mass_properties = MassProperties{40.0, Vector3::Zero(), Matrix3::Zero()};
  Body strip;
  strip.name = "strip";
  strip.where = "ruler.lua:4";
  strip.shape = Box{{0.3, 0.008, 0.004}};
  strip.X_WB.translation() = Vector3(-0.3, 0, 0.002);
  strip.mass_properties = MassProperties{0.001, Vector3::Zero(), Matrix3::Zero()};
  scene.bodies.push_back(strip);
  const std::string findings = OneFinding(scene);
  EXPECT_NE(findings.find("240 physics steps were not found to the solver's tolerance"),
            std::string::npos)
      << findings;
}

TEST(CheckSceneTest, MillimetresForMetresAndGramsForKilogramsAreSuspected) {
  Scene grams = MakeRulerScene();
  grams.object().mass_properties = MassProperties{25.0, Vector3::Zero(), Matrix3::Zero()};
  EXPECT_EQ(OneFinding(grams).find("W ruler.lua:2: \"ruler\" has 9.26e+05 kg/m^3 (25 kg)"), 0U)
      << OneFinding(grams);
  Scene large = MakeRulerScene();
  large.object().shape = Box{{3.0, 0.3, 0.03}};
  large.object().X_WB.translation() = Vector3(0, 0, 0.015);
  large.object().mass_properties = MassProperties{25.0, Vector3::Zero(), Matrix3::Zero()};
  large.bodies[1].shape = Box{{8, 6, 0.04}};
  large.bodies[1].X_WB.translation() = Vector3(0, 0, -0.02);
  EXPECT_EQ(OneFinding(large).find("W ruler.lua:2: \"ruler\" is 3 m long"), 0U)
      << OneFinding(large);
}

TEST(CheckSceneTest, ADepartureFromTheRulesIsAWarningAtItsBody) {
  Scene scene = MakeRulerScene();
  scene.bodies[1].friction = 0.7;
  scene.fingertips.friction = 1.5;
  EXPECT_EQ(OneFinding(scene),
            "W ruler.lua:1: fingertips.friction 1.5 is above 1.0: the results count as outside the "
            "rules\n"
            "W ruler.lua:3: friction 0.7 of \"table\" is outside 0.2 to 0.6: the results count as "
            "outside the rules\n");
}

}  // namespace
}  // namespace pregrasp
