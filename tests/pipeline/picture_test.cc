#include "app/pictures/picture.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/geometry/tessellate.h"
#include "app/pictures/camera.h"
#include "app/pictures/describe.h"
#include "app/job/simulation.h"
#include "tests/pipeline/fixture.h"

namespace pregrasp {
namespace {

// The ruler, pressed and pulled.
Simulation MakePulled(const std::shared_ptr<const World>& world) {
  Simulation sim(world, world->InitialState(), "scene.start");
  sim.Touch(Finger::kIndex, {0.11, 0, 0.0015});
  const Vector3 start = sim.state().fingers[1].p_WTarget;
  sim.Move(Finger::kIndex, start - Vector3(0, 0, 0.012), 0.25);
  sim.Move(Finger::kIndex, start + Vector3(0.03, 0, -0.012), 0.75);
  return sim;
}

TEST(PictureMakerTest, ShowsEveryBodyTheFingerItsForceAndWhereTheObjectWas) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const Simulation sim = MakePulled(world);
  const PictureMaker maker(world);
  const RenderScene scene =
      maker.Compose(sim.state(), sim.contacts(), world->InitialState(), nullptr, {}, {});
  ASSERT_EQ(scene.bodies.size(), 2U + 1U + 3U);  // ruler, table; ghost; tip and two links
  EXPECT_EQ(scene.bodies[2].shading, Shading::kGhost);
  EXPECT_EQ(scene.bodies[2].mesh, scene.bodies[0].mesh);
  EXPECT_EQ(scene.cones.size(), 1U);
  ASSERT_EQ(scene.arrows.size(), 2U);  // finger and weight
  // The force's arrow ends at the contact, and the fingertip touches there from outside.
  const Vector3 p_WF = sim.state().fingers[1].p_WF;
  EXPECT_LT((scene.arrows[0].p_W + scene.arrows[0].v_W - p_WF).norm(), 1e-12);
  const double radius = FingertipRadius(Finger::kIndex);
  EXPECT_NEAR((scene.bodies[3].X_WB.translation() - p_WF).norm(), radius, 1e-12);
  ASSERT_EQ(scene.labels.size(), 2U);
  EXPECT_EQ(scene.labels[0].text.find("index 0."), 0U) << scene.labels[0].text;
  EXPECT_EQ(scene.labels[1].text, "weight 0.25 N");
}

TEST(PictureMakerTest, ATraceShowsTheNormalOfEveryContactPointAndTheForcesOnTheObject) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const Simulation sim = MakePulled(world);
  PictureConfig config;
  config.trace = true;
  config.forces = false;
  const RenderScene scene = PictureMaker(world).Compose(sim.state(), sim.contacts(),
                                                        world->InitialState(), nullptr, {}, config);
  ASSERT_GE(sim.contacts().size(), 4U);
  EXPECT_GE(scene.arrows.size(), sim.contacts().size());
  for (const RenderArrow& arrow : scene.arrows) {
    EXPECT_GT(arrow.v_W.z(), 0.0);  // the table pushes upwards
  }
}

TEST(PictureMakerTest, OverlaysCanBeLeftOut) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const Simulation sim = MakePulled(world);
  PictureConfig config;
  config.forces = config.cones = config.contacts = config.ghost = config.fingers = config.axes =
      false;
  const RenderScene scene = PictureMaker(world).Compose(sim.state(), sim.contacts(),
                                                        world->InitialState(), nullptr, {}, config);
  EXPECT_EQ(scene.bodies.size(), 2U);
  EXPECT_TRUE(scene.arrows.empty() && scene.cones.empty() && scene.points.empty());
  EXPECT_TRUE(scene.labels.empty());
  EXPECT_FALSE(scene.axes);
  config.width = 2;
  EXPECT_THROW(config.Validate(), InputError);
}

TEST(PictureMakerTest, TheAutomaticCameraHasTheObjectInSightWhereverItIs) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const PictureMaker maker(world);
  for (const double x : {-0.3, -0.16, 0.0, 0.5}) {
    WorldState state = world->InitialState();
    state.bodies[0].p_WB.x() = x;
    const RenderScene scene = maker.Compose(state, {}, world->InitialState(), nullptr, {}, {});
    MatrixX3 ends(2, 3);
    ends << x - 0.15, 0, 0, x + 0.15, 0, 0;
    EXPECT_TRUE(IsInSight(scene.camera, ends, 1280.0 / 720.0, 0.0)) << x;
  }
}

TEST(PictureMakerTest, AStripOfSmallMotionsHasOneCamera) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const PictureMaker maker(world);
  WorldState state = world->InitialState();
  const RenderCamera first = maker.Compose(state, {}, state, nullptr, {}, {}).camera;
  state.bodies[0].p_WB.x() += 0.03;
  EXPECT_EQ(maker.Compose(state, {}, state, nullptr, {}, {}).camera.p_WCam, first.p_WCam);
}

TEST(PictureMakerTest, APlanningStagesOverlayIsShownByItsNames) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const PictureMaker maker(world);
  const WorldState state = world->InitialState();
  PictureOverlay overlay;
  TriangleMesh mesh;
  mesh.V = MatrixX3::Identity(3, 3);
  mesh.F.resize(1, 3);
  mesh.F << 0, 1, 2;
  overlay.contact_mesh = std::make_shared<const TriangleMesh>(mesh);
  const Rgba color{0.1F, 0.9F, 0.2F, 1.0F};
  overlay.face_colors = {color};
  overlay.ghosts = {{RigidTransform::Identity(), color}};
  overlay.hand = HandConfiguration{};
  overlay.legend.title = "score";
  PictureConfig config;
  const RenderScene all = maker.Compose(state, {}, state, &overlay, {}, config);
  EXPECT_EQ(all.bodies[0].mesh, overlay.contact_mesh);
  EXPECT_EQ(all.bodies[0].face_colors[0].g, color.g);
  EXPECT_EQ(all.legend.title, "score");
  config.scores = false;
  const RenderScene plain = maker.Compose(state, {}, state, &overlay, {}, config);
  EXPECT_NE(plain.bodies[0].face_colors[0].g, color.g);
  EXPECT_EQ(plain.legend.title, "");
  config.mesh = config.rollouts = config.hand = false;
  EXPECT_EQ(maker.Compose(state, {}, state, &overlay, {}, config).bodies.size(),
            maker.Compose(state, {}, state, nullptr, {}, config).bodies.size());
}

TEST(IsInSightTest, KnowsThePyramidOfSight) {
  const RenderCamera camera{{0, -1, 0}, {0, 0, 0}, 90.0};
  const auto sees = [&](double x, double y, double z) {
    MatrixX3 p(1, 3);
    p << x, y, z;
    return IsInSight(camera, p, 2.0, 0.0);
  };
  EXPECT_TRUE(sees(0, 0, 0.99));
  EXPECT_FALSE(sees(0, 0, 1.01));
  EXPECT_TRUE(sees(1.99, 0, 0));
  EXPECT_FALSE(sees(2.01, 0, 0));
  EXPECT_FALSE(sees(0, -2, 0));  // behind
}

TEST(ChooseViewDirectionTest, LooksWhereNothingIsInTheWay) {
  // A wall close in front, where the preferred view would look from.
  Scene scene = MakeRulerScene();
  Body wall;
  wall.name = "wall";
  wall.shape = Box{{0.8, 0.02, 0.6}};
  wall.X_WB.translation() = Vector3(-0.4, -0.05, 0.3);
  const TriangleMesh ruler = Tessellate(scene.object().shape);
  TriangleMesh ruler_W = ruler;
  ruler_W.V.rowwise() += scene.object().X_WB.translation().transpose();
  EXPECT_LT(ChooseViewDirection(ruler_W, EnvironmentDistance(scene)).y(), 0.0);
  scene.bodies.push_back(wall);
  EXPECT_GT(ChooseViewDirection(ruler_W, EnvironmentDistance(scene)).y(), 0.0);
}

TEST(DescribeStepTest, SaysWhatDecidedTheMotion) {
  const auto world = std::make_shared<const World>(MakeRulerScene());
  const Simulation sim = MakePulled(world);
  const auto lines = DescribeStep(*world, world->InitialState(), sim.state(), sim.contacts());
  EXPECT_EQ(lines[0].find("The index sticks to the ruler and takes it along: that needs 0."), 0U)
      << lines[0];
  EXPECT_EQ(lines[1].find("ruler moved\t2"), 0U) << lines[1];
  const auto still = DescribeStep(*world, world->InitialState(), world->InitialState(), {});
  EXPECT_EQ(still[0], "Nothing touches the ruler and it stays at rest.");
}

TEST(DescribeStepTest, ALightTouchSlidesOverTheRuler) {
  // Pressed too lightly (0.05 N), the finger cannot overcome the table.
  const auto world = std::make_shared<const World>(MakeRulerScene());
  Simulation sim(world, world->InitialState(), "scene.start");
  sim.Touch(Finger::kIndex, {0.05, 0, 0.0015});
  const Vector3 start = sim.state().fingers[1].p_WTarget;
  sim.Move(Finger::kIndex, start - Vector3(0, 0, 0.001), 0.25);
  const WorldState before = sim.state();
  sim.Move(Finger::kIndex, start + Vector3(0.03, 0, -0.001), 0.75);
  const auto lines = DescribeStep(*world, before, sim.state(), sim.contacts());
  EXPECT_EQ(lines[0].find("The index slides "), 0U) << lines[0];
  EXPECT_NE(lines[0].find("over the ruler, which stays."), std::string::npos) << lines[0];
}

}  // namespace
}  // namespace pregrasp
