#include "app/pictures/picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/tessellate.h"
#include "app/graph/path_explorer.h"
#include "app/job/timeline.h"
#include "app/pictures/camera.h"
#include "app/pictures/forces.h"
#include "app/pictures/overlay.h"
#include "app/pictures/words.h"
#include "render/camera.h"
#include "render/palette.h"
#include "tests/job/fixture.h"

namespace pregrasp {
namespace {

using Node = Timeline::Node;

// The ruler, pressed and pulled.
class PictureMakerTest : public testing::Test {
 protected:
  static JobSetup MakeSetup() {
    JobSetup setup;
    setup.scene = MakeRulerScene();
    return setup;
  }

  const Node& Press(double x, double depth) {
    const Node& touched = timeline_.Do(timeline_.root(), Verb::kTouch,
                                       {{"finger", "index"}, {"p_OC", {x, 0.0, 0.0015}}});
    target_ = touched.facts.fingers[1].p_WTarget - Vector3(0, 0, depth);
    return Move(touched, 0.25);
  }
  const Node& Pull(const Node& from, double by) {
    target_.x() += by;
    return Move(from, 0.75);
  }
  const Node& Move(const Node& from, double seconds) {
    return timeline_.Do(from, Verb::kMove,
                        {{"finger", "index"},
                         {"p_WTarget", {target_.x(), target_.y(), target_.z()}},
                         {"seconds", seconds}});
  }
  RenderScene Compose(const StepFacts& step, const PictureConfig& config = {}) const {
    return maker_.Compose(step, timeline_, {}, config);
  }

  Job job_{MakeSetup(), 1};
  Timeline timeline_{job_};
  PictureMaker maker_{job_.scene()};
  Vector3 target_ = Vector3::Zero();
};

TEST_F(PictureMakerTest, ShowsEveryBodyTheFingerItsForceAndWhereTheObjectWas) {
  const StepFacts& step = Pull(Press(0.11, 0.012), 0.03).facts;
  const RenderScene scene = Compose(step);
  ASSERT_EQ(scene.bodies.size(), 2U + 1U + 3U);  // ruler, table; ghost; tip and two links
  EXPECT_EQ(scene.bodies[2].shading, Shading::kGhost);
  EXPECT_EQ(scene.bodies[2].mesh, scene.bodies[0].mesh);
  EXPECT_EQ(scene.cones.size(), 1U);
  ASSERT_EQ(scene.arrows.size(), 2U);  // finger and weight
  // The force's arrow ends at the contact, and the fingertip touches there from outside.
  const Vector3 p_WF = step.fingers[1].p_WF;
  EXPECT_LT((scene.arrows[0].p_W + scene.arrows[0].v_W - p_WF).norm(), 1e-12);
  const double radius = TipSpheres{}.radius(Finger::kIndex);
  EXPECT_NEAR((scene.bodies[3].X_WB.translation() - p_WF).norm(), radius, 1e-12);
  ASSERT_EQ(scene.labels.size(), 2U);
  EXPECT_EQ(scene.labels[0].text.find("index 0."), 0U) << scene.labels[0].text;
  EXPECT_EQ(scene.labels[1].text, "weight 0.25 N");
}

TEST_F(PictureMakerTest, ATraceShowsTheNormalOfEveryContactPointAndTheForcesOnTheObject) {
  const StepFacts& step = Pull(Press(0.11, 0.012), 0.03).facts;
  PictureConfig config;
  config.trace = true;
  config.forces = false;
  const RenderScene scene = Compose(step, config);
  ASSERT_GE(step.contacts.size(), 4U);
  EXPECT_GE(scene.arrows.size(), step.contacts.size());
  for (const RenderArrow& arrow : scene.arrows) {
    EXPECT_GT(arrow.v_W.z(), 0.0);  // the table pushes upwards
  }
}

TEST_F(PictureMakerTest, OverlaysCanBeLeftOut) {
  PictureConfig config;
  config.forces = config.cones = config.contacts = config.ghost = config.fingers = config.axes =
      false;
  const RenderScene scene = Compose(Pull(Press(0.11, 0.012), 0.03).facts, config);
  EXPECT_EQ(scene.bodies.size(), 2U);
  EXPECT_TRUE(scene.arrows.empty() && scene.cones.empty() && scene.points.empty());
  EXPECT_TRUE(scene.labels.empty());
  EXPECT_FALSE(scene.axes);
  config.width = 2;
  EXPECT_THROW(config.Validate(), InputError);
}

TEST_F(PictureMakerTest, WordsCanBeLeftOutAndSized) {
  PictureText text;
  text.title = "title";
  text.lines = {"sentence"};
  text.footer = "footer";
  PictureConfig config;
  config.card = false;
  config.font_scale = 1.5;
  const StepFacts& step = timeline_.root().facts;
  RenderScene scene = maker_.Compose(step, timeline_, text, config);
  EXPECT_TRUE(scene.caption.title.empty() && scene.caption.lines.empty());
  EXPECT_EQ(scene.caption.footer, "footer");
  EXPECT_EQ(scene.font_scale, 1.5);
  config.card = true;
  config.footer = false;
  scene = maker_.Compose(step, timeline_, text, config);
  EXPECT_EQ(scene.caption.title, "title");
  EXPECT_TRUE(scene.caption.footer.empty());
  config.font_scale = 9.0;
  EXPECT_THROW(config.Validate(), InputError);
}

TEST_F(PictureMakerTest, OneCameraHasTheObjectInSightInAllStepsThatItIsFramedFor) {
  std::vector<StepFacts> steps;
  for (const double x : {-0.16, 0.1, 0.7}) {
    steps.push_back(timeline_.root().facts);
    steps.back().bodies[0].p_WB.x() = x;
  }
  std::vector<const StepFacts*> shown;
  for (const StepFacts& step : steps) shown.push_back(&step);
  const MatrixX3 focus_W = maker_.CalcFocus(shown, timeline_, {});
  const CameraConfig camera = maker_.Frame(focus_W, {});
  const CameraConfig front = maker_.Frame(focus_W, {}, Vector3(0.0, -1.0, 0.0));
  EXPECT_NEAR(front.p_WCam.z(), front.p_WTarget.z(), 1e-9);
  EXPECT_LT(front.p_WCam.y(), front.p_WTarget.y());
  for (const StepFacts& step : steps) {
    const double x = step.bodies[0].p_WB.x();
    MatrixX3 ends(2, 3);
    ends << x - 0.15, 0, 0, x + 0.15, 0, 0;
    for (const CameraConfig& each : {camera, front}) {
      EXPECT_TRUE(IsInSight({each.p_WCam, each.p_WTarget, each.fov_deg}, ends, 16.0 / 9.0, 0.0));
    }
  }
}

TEST_F(PictureMakerTest, PicturesOfOneShapeShareACameraThatShowsAllStepsButWhatWasDropped) {
  const auto step_at = [&](double x, double z) {
    StepFacts step = timeline_.root().facts;
    step.bodies[0].p_WB += Vector3(x, 0.0, z);
    return step;
  };
  const StepFacts start = step_at(0.0, 0.0), far = step_at(0.5, 0.0), fallen = step_at(0.1, -5.0);
  StepFacts slipped = step_at(-2.0, 0.0), near = start;
  LiftFacts lift;
  lift.held = false;
  slipped.details = near.details = lift;
  PictureConfig wide, small, square, named;
  small.width = 640;
  small.height = 360;
  square.width = square.height = 500;
  named.camera = CameraConfig{{1, 2, 3}, {0, 0, 0}, 40.0};
  std::vector<StepPicture> pictures = {{&start, wide},   {&far, small}, {&fallen, wide},
                                       {&slipped, wide}, {&near, wide}, {&start, named},
                                       {&start, square}, {&far, square}};
  maker_.ShareCamera(pictures, timeline_);
  const auto camera = [&](std::size_t i) { return pictures[i].config.camera.value(); };
  EXPECT_EQ(camera(1).p_WCam, camera(0).p_WCam);
  EXPECT_EQ(camera(4).p_WCam, camera(0).p_WCam);
  EXPECT_FALSE(pictures[2].config.camera || pictures[3].config.camera);
  EXPECT_EQ(camera(5).p_WCam, named.camera->p_WCam);
  EXPECT_EQ(camera(6).p_WCam, camera(7).p_WCam);
  EXPECT_NE(camera(6).p_WCam, camera(0).p_WCam);
  for (const std::size_t i : {0U, 1U, 6U, 7U}) {
    const double x = pictures[i].step->bodies[0].p_WB.x();
    MatrixX3 ends(2, 3);
    ends << x - 0.15, 0, 0, x + 0.15, 0, 0;
    EXPECT_TRUE(IsInSight({camera(i).p_WCam, camera(i).p_WTarget, camera(i).fov_deg}, ends,
                          i < 6 ? 16.0 / 9.0 : 1.0, 0.0))
        << i;
  }
}

TEST(FindOutermostTest, TakesCornersAndNothingFromWithin) {
  MatrixX3 cube_and_more(10, 3);
  for (int i = 0; i < 8; ++i) cube_and_more.row(i) << i % 2, i / 2 % 2, i / 4;
  cube_and_more.row(8) << 0.5, 0.5, 0.5;
  cube_and_more.row(9) << 0.5, 0.5, 1.2;
  const MatrixX3 outermost = FindOutermost(cube_and_more);
  for (Eigen::Index i = 0; i < 10; ++i) {
    const bool found =
        ((outermost.rowwise() - cube_and_more.row(i)).rowwise().norm().array() == 0.0).any();
    EXPECT_EQ(found, i != 8) << i;
  }
}

TEST_F(PictureMakerTest, AFingerIsWhollyInSightUnlessItHasLeft) {
  for (const bool left : {false, true}) {
    StepFacts step = Pull(Press(0.11, 0.012), 0.03).facts;
    FingerFacts& finger = step.fingers[1];
    ASSERT_TRUE(finger.on);
    finger.f_W = Vector3::Zero();
    finger.touching = !left;
    finger.p_WF.x() += left ? 0.6 : 0.14;
    const RenderCamera camera = Compose(step).camera;
    const double radius = job_.scene().tips.radius(finger.finger);
    MatrixX3 edge(1, 3);
    edge << finger.p_WF.x() + radius, finger.p_WF.y(), finger.p_WF.z() + radius;
    EXPECT_EQ(IsInSight(camera, edge, 16.0 / 9.0, 0.0), !left);
  }
}

TEST_F(PictureMakerTest, ArrowsOfForcesAreWhollyInSight) {
  StepFacts step = Pull(Press(0.11, 0.012), 0.03).facts;
  ASSERT_TRUE(step.fingers[1].on);
  step.fingers[1].f_W = Vector3(0.0, 0.0, -12.0);
  step.bodies[0].p_WB.z() += 0.1;
  step.fingers[1].p_WF.z() += 0.1;
  const CameraConfig framed = maker_.Frame(maker_.CalcFocus({&step}, timeline_, {}), {});
  const RenderScene scene = Compose(step);
  const auto arrow =
      std::find_if(scene.arrows.begin(), scene.arrows.end(), [&](const RenderArrow& each) {
        return (each.p_W + each.v_W - step.fingers[1].p_WF).norm() < 1e-9;
      });
  ASSERT_NE(arrow, scene.arrows.end());
  EXPECT_GT(arrow->v_W.norm(), 0.05);
  const MatrixX3 tail_W = arrow->p_W.transpose();
  EXPECT_TRUE(
      IsInSight({framed.p_WCam, framed.p_WTarget, framed.fov_deg}, tail_W, 16.0 / 9.0, 0.0));
  EXPECT_TRUE(IsInSight(scene.camera, tail_W, 16.0 / 9.0, 0.0));
}

TEST_F(PictureMakerTest, TheAutomaticCameraHasTheObjectInSightWhereverItIs) {
  for (const double x : {-0.3, -0.16, 0.0, 0.5}) {
    StepFacts step = timeline_.root().facts;
    step.bodies[0].p_WB.x() = x;
    const RenderScene scene = Compose(step);
    MatrixX3 ends(2, 3);
    ends << x - 0.15, 0, 0, x + 0.15, 0, 0;
    EXPECT_TRUE(IsInSight(scene.camera, ends, 1280.0 / 720.0, 0.0)) << x;
  }
}

// Whatever its size, the object is what a picture shows: arrows and points do not hide it.
TEST(PictureSizeTest, AnObjectOfAnySizeIsLargeInTheMiddle) {
  for (const double edge : {0.0015, 0.006, 0.05, 0.8, 7.0}) {
    JobSetup setup;
    setup.scene = MakeRulerScene();
    Body& cube = setup.scene.bodies[0];
    cube.shape = Box{Vector3::Constant(edge)};
    cube.X_WB.translation() = Vector3(-0.1, 0.0, 0.5 * edge);
    // Heavy enough for an arrow of its weight.
    cube.mass_properties = CalcMassProperties(cube.shape, 1e-3 + 300.0 * std::pow(edge, 3.0));
    Job job(setup, 1);
    const Timeline timeline(job);
    const RenderScene scene =
        PictureMaker(job.scene()).Compose(timeline.root().facts, timeline, {}, {});
    const CameraView view = MakeCameraView(scene.camera, 1280, 720);
    const auto top = view.Project(cube.X_WB.translation() + 0.5 * edge * Vector3::UnitZ());
    const auto bottom = view.Project(cube.X_WB.translation() - 0.5 * edge * Vector3::UnitZ());
    ASSERT_TRUE(top && bottom) << edge;
    EXPECT_GT(bottom->y() - top->y(), 100.0) << edge;
    EXPECT_NEAR(bottom->x(), 640.0, 160.0) << edge;
    EXPECT_NEAR(0.5 * (bottom->y() + top->y()), 360.0, 180.0) << edge;
    EXPECT_FALSE(scene.arrows.empty());
    for (const RenderArrow& arrow : scene.arrows) EXPECT_LT(arrow.radius, 0.1 * edge);
  }
}

TEST_F(PictureMakerTest, AStripOfSmallMotionsHasOneCamera) {
  StepFacts step = timeline_.root().facts;
  const RenderCamera first = Compose(step).camera;
  step.bodies[0].p_WB.x() += 0.03;
  EXPECT_EQ(Compose(step).camera.p_WCam, first.p_WCam);
}

// Steps of a plan, made up: pictures need no more than facts.
class PlannedSteps : public FactsSource {
 public:
  explicit PlannedSteps(const StepFacts& start) {
    steps_[start.id] = start;
    StepFacts mesh = Follow(start, "graph.mesh", Verb::kMesh);
    MeshFacts facts;
    facts.triangles = 1;
    facts.nodes = 1;
    facts.mesh.V = MatrixX3::Identity(3, 3);
    facts.mesh.F.resize(1, 3);
    facts.mesh.F << 0, 1, 2;
    mesh.details = facts;
    steps_[mesh.id] = mesh;
    StepFacts score = Follow(mesh, "graph.score", Verb::kScore);
    score.details = ScoreFacts{1, {0.5}, {0.5}, {0.0}, {}, {}};
    steps_[score.id] = score;
  }
  static StepFacts Follow(const StepFacts& before, const std::string& id, Verb verb) {
    StepFacts step = before;
    step.id = id;
    step.command = {verb, before.id, nlohmann::json::object()};
    return step;
  }
  const StepFacts& Get(const std::string& id) const override { return steps_.at(id); }

 private:
  std::map<std::string, StepFacts> steps_;
};

TEST_F(PictureMakerTest, AnOverlayIsShownByItsName) {
  const PlannedSteps steps(timeline_.root().facts);
  const auto compose = [&](const StepFacts& step, const PictureConfig& config) {
    return maker_.Compose(step, steps, {}, config);
  };
  PictureConfig config;
  const StepFacts& score = steps.Get("graph.score");
  const RenderScene all = compose(score, config);
  EXPECT_EQ(all.bodies[0].mesh->F.rows(), 1);
  EXPECT_EQ(all.bodies[0].face_colors[0].g, ScoreColor(1.0).g);
  EXPECT_EQ(all.legend.title, "best score here");
  config.scores = false;
  EXPECT_NE(compose(score, config).bodies[0].face_colors[0].g, ScoreColor(1.0).g);
  EXPECT_EQ(compose(score, config).legend.title, "");
  config.mesh = false;
  EXPECT_GT(compose(score, config).bodies[0].mesh->F.rows(), 1);

  StepFacts iteration = PlannedSteps::Follow(score, "path.1.mppi.1", Verb::kIterate);
  IterationFacts facts;
  facts.rollouts.resize(9);
  iteration.details = facts;
  const std::size_t ghosts = compose(iteration, {}).bodies.size();
  config = {};
  config.rollouts = false;
  EXPECT_EQ(compose(iteration, config).bodies.size() + 6U, ghosts);

  StepFacts frame = PlannedSteps::Follow(score, "motion.key.1", Verb::kKeyframe);
  frame.details = FrameFacts{};
  config = {};
  config.hand = false;
  EXPECT_GT(compose(frame, {}).bodies.size(), compose(frame, config).bodies.size() + 10U);
}

std::vector<std::string> TextsOf(const RenderScene& picture) {
  std::vector<std::string> texts;
  for (const RenderLabel& label : picture.labels) texts.push_back(label.text);
  return texts;
}

bool Has(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

TEST_F(PictureMakerTest, AGraspShowsItsOwnFingersAndTheirForcesAndOneWithoutForcesTheirPlaces) {
  const PlannedSteps steps(timeline_.root().facts);
  // A plan's finger presses: a grasp without it must not show it.
  StepFacts step = PlannedSteps::Follow(steps.Get("graph.score"), "path.1.grasp.1", Verb::kGrasp);
  step.fingers[1].on = step.fingers[1].touching = true;
  step.fingers[1].f_W = Vector3(0, 0, -3.0);
  GraspFacts grasp;
  grasp.feasible = true;
  for (const Finger finger : {Finger::kThumb, Finger::kMiddle}) {
    const double side = finger == Finger::kThumb ? 1.0 : -1.0;
    grasp.contacts.push_back(
        {finger, {0.1, 0.015 * side, 0}, {0, side, 0}, {0, -1.25 * side, 0.5}});
  }
  step.details = grasp;
  RenderScene picture = maker_.Compose(step, steps, {}, {});
  EXPECT_EQ(picture.cones.size(), 2U);
  EXPECT_EQ(picture.cones[0].color.g, GoodColor().g);
  std::vector<std::string> texts = TextsOf(picture);
  EXPECT_TRUE(Has(texts, "thumb 1.35 N") && Has(texts, "middle 1.35 N"));
  EXPECT_EQ(texts.size(), 3U);  // and the weight
  // The arrow ends where the finger touches, pointing as the object is pushed.
  EXPECT_NEAR(picture.arrows[0].v_W.normalized().y(), -1.25 / std::hypot(1.25, 0.5), 1e-9);

  grasp.feasible = false;
  for (GraspContactFacts& contact : grasp.contacts) contact.f_O.setZero();
  step.details = grasp;
  picture = maker_.Compose(step, steps, {}, {});
  EXPECT_EQ(picture.cones[0].color.g, BadColor().g);
  texts = TextsOf(picture);
  EXPECT_TRUE(Has(texts, "thumb") && Has(texts, "middle"));
}

TEST_F(PictureMakerTest, AGraphSaysWhereAPathMayBeginAndAPathNamesItsTriangles) {
  const PlannedSteps steps(timeline_.root().facts);
  const StepFacts& score = steps.Get("graph.score");
  StepFacts step = PlannedSteps::Follow(score, "graph.prune.3", Verb::kPrune);
  PruneFacts pruned;
  pruned.cut = "edges";
  pruned.complete = true;
  const auto begin_of_first = [&] {
    step.details = pruned;
    const RenderLegend legend = maker_.Compose(step, steps, {}, {}).legend;
    return legend.swatches.at(0).second + ", " + legend.swatches.at(1).second;
  };
  EXPECT_EQ(begin_of_first(), "0: a path may begin there, 0: only later on a path");
  pruned.kept = {0};
  EXPECT_EQ(begin_of_first(), "0: a path may begin there, 1: only later on a path");
  pruned.initial = {0};
  EXPECT_EQ(begin_of_first(), "1: a path may begin there, 0: only later on a path");

  step = PlannedSteps::Follow(score, "paths.rank.1", Verb::kPath);
  PathFacts path;
  path.nodes.resize(2);
  step.details = path;
  const std::vector<std::string> texts = TextsOf(maker_.Compose(step, steps, {}, {}));
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0].rfind("thumb 1+2, index 1+2: 0", 0), 0U) << texts[0];
}

TEST_F(PictureMakerTest, AHandOnItsWayFramesNothingAndIsShownByAWiderCamera) {
  const PlannedSteps steps(timeline_.root().facts);
  StepFacts frame = PlannedSteps::Follow(steps.Get("graph.score"), "motion.key.1", Verb::kKeyframe);
  FrameFacts facts;
  facts.phase = "approach";
  facts.hand.p_WH = Vector3(0.0, 0.0, 2.0);
  frame.details = facts;
  const StepFacts& start = timeline_.root().facts;
  const MatrixX3 alone_W = maker_.CalcFocus({&start, &start}, steps, {}),
                 both_W = maker_.CalcFocus({&start, &frame}, steps, {});
  const CameraConfig camera = maker_.Frame(alone_W, {});
  EXPECT_EQ(maker_.Frame(both_W, {}).p_WCam, camera.p_WCam);
  EXPECT_EQ(maker_.FrameOnWay(camera, start, steps, {}).p_WCam, camera.p_WCam);
  const CameraConfig wider = maker_.FrameOnWay(camera, frame, steps, {});
  EXPECT_TRUE(IsInSight({wider.p_WCam, wider.p_WTarget, wider.fov_deg},
                        MatrixX3(facts.hand.p_WH.transpose()), 16.0 / 9.0, 0.0));
  const Vector3 back = camera.p_WCam - camera.p_WTarget, further = wider.p_WCam - camera.p_WTarget;
  EXPECT_EQ(wider.p_WTarget, camera.p_WTarget);
  EXPECT_GT(further.norm(), back.norm());
  EXPECT_LT(further.normalized().cross(back.normalized()).norm(), 1e-9);
}

TEST_F(PictureMakerTest, KeyStepsAreTheFirstGraspsOfEachKindAndEveryFifthIteration) {
  const PlannedSteps steps(timeline_.root().facts);
  const StepFacts& score = steps.Get("graph.score");
  StepFacts iteration = PlannedSteps::Follow(score, "path.1.mppi.1", Verb::kIterate);
  std::vector<int> keys;
  for (int i = 1; i <= 12; ++i) {
    IterationFacts facts;
    facts.iteration = i;
    facts.end = i == 12 ? "limit" : "";
    iteration.details = facts;
    if (IsKeyStep(iteration, steps)) keys.push_back(i);
  }
  EXPECT_EQ(keys, (std::vector<int>{1, 5, 10, 12}));
  EXPECT_TRUE(IsKeyStep(timeline_.root().facts, timeline_));
  EXPECT_FALSE(IsKeyStep(Press(0.11, 0.012).facts, timeline_));
}

TEST(WordsTest, DifferencesAreNamedAsCardsNameThemWithUnits) {
  const std::vector<std::string> left = {"Prose.", "largest force\t2.05 N", "came\t1 mm", "a\t1"},
                                 right = {"Other.", "came\t2 mm", "largest force\t2.05 N", "b\t1"};
  EXPECT_EQ(DescribeRowDifferences(left, right, 3), "came: A 1 mm, B 2 mm");
  EXPECT_EQ(DescribeRowDifferences(left, left, 3), "");
  EXPECT_EQ(DescribeRowDifferences({"x\t1", "y\t1"}, {"x\t2", "y\t2"}, 1), "x: A 1, B 2");
  EXPECT_EQ(DescribeField("details.max_force_N"), "largest force [N]");
  EXPECT_EQ(DescribeField("details.score_scale"), "weight of the terms that break ties");
  EXPECT_EQ(DescribeField("bodies[0].p_WB[1]"), "the object: place, y [m]");
  EXPECT_EQ(DescribeField("bodies[2].v_WB[0]"), "body 3: speed, x [m/s]");
  EXPECT_EQ(DescribeField("fingers[1].f_W[2]"), "index: force, z [N]");
  EXPECT_EQ(DescribeField("details.rollouts[3].cost.total"), "plan 4: cost: total");
  EXPECT_EQ(DescribeField("details.rollouts[0].p_WO_end[2]"),
            "plan 1: place where it leaves the object, z [m]");
  EXPECT_EQ(DescribeField("details.s_c[17]"), "score here of state 17");
  EXPECT_EQ(DescribeField("details.some_new_thing_mm"), "some new thing [mm]");
  EXPECT_EQ(DescribeValue("-0.11551765274013556", "-0.12001633355154127"), "-0.1155");
  EXPECT_EQ(DescribeValue("0.123456", "0.123457"), "0.123456");
  EXPECT_EQ(DescribeValue("true", "false"), "true");
}

TEST(ForcesTest, PressedPulledRulerObeysTheSpringAndTheCone) {
  JobSetup setup;
  setup.scene = MakeRulerScene();
  Job job(setup, 1);
  Timeline timeline(job);
  const Node& touched = timeline.Do(timeline.root(), Verb::kTouch,
                                    {{"finger", "index"}, {"p_OC", {0.11, 0.0, 0.0015}}});
  const Vector3 start = touched.facts.fingers[1].p_WTarget;
  const auto move = [&](const Node& from, double x, double z, double seconds) -> const Node& {
    return timeline.Do(from, Verb::kMove,
                       {{"finger", "index"},
                        {"p_WTarget", {start.x() + x, start.y(), start.z() + z}},
                        {"seconds", seconds}});
  };
  const Node& pressed = timeline.Do(move(touched, 0.0, -0.012, 0.5), Verb::kWait, {{"steps", 120}});
  // At rest the spring's 12 mm give 0.6 N; the table carries that and the weight.
  const auto split_of = [&](const StepFacts& step) {
    return SplitFingerForce(job.scene(), step.object().q_WB, step.fingers[1]);
  };
  ForceSplit split = split_of(pressed.facts);
  EXPECT_NEAR(split.normal, 50.0 * 0.012, 1e-3);
  EXPECT_NEAR(split.limit, 0.8 * split.normal, 1e-12);
  std::vector<SupportForce> supports = CalcSupportForces(job.scene(), pressed.facts.contacts);
  ASSERT_EQ(supports.size(), 1U);
  EXPECT_EQ(supports[0].body, 1);
  EXPECT_NEAR(supports[0].f_W.z(), 0.6 + 0.025 * 9.81, 1e-3);
  // Pulled, it follows: the table gives way at 0.3 of what it carries, the fingertip holds.
  const Node& pulled = move(pressed, 0.05, -0.012, 1.5);
  const auto& motion = std::get<SimulationFacts>(pulled.facts.details);
  EXPECT_GT(motion.moved_mm, 40.0);
  EXPECT_LT(motion.moved_mm, 50.0);
  split = split_of(pulled.facts);
  EXPECT_LT(split.tangential, split.limit);
  supports = CalcSupportForces(job.scene(), pulled.facts.contacts);
  EXPECT_TRUE(supports.at(0).slipping);
  EXPECT_NEAR(supports[0].split.tangential, 0.3 * supports[0].split.normal, 1e-3);
}

// The picture of the ruler's scene at its start, all of it turned by `R`.
Image DrawTurned(const Matrix3& R) {
  JobSetup setup;
  setup.scene = MakeRulerScene();
  for (Body& body : setup.scene.bodies) body.X_WB = RigidTransform(R) * body.X_WB;
  setup.scene.gravity = R * setup.scene.gravity;
  Job job(setup, 1);
  const Timeline timeline(job);
  PictureConfig config;
  config.width = 320;
  config.height = 180;
  config.quality = RenderQuality::kDraft;
  config.axes = false;
  const RenderScene picture =
      PictureMaker(job.scene()).Compose(timeline.root().facts, timeline, {}, config);
  return Renderer().Render(picture, {config.width, config.height, config.quality});
}

TEST(PictureMakerUpTest, UpInThePictureIsAgainstGravity) {
  const Image upright = DrawTurned(Matrix3::Identity());
  const Image turned = DrawTurned(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()).matrix());
  ASSERT_EQ(upright.rgb.size(), turned.rgb.size());
  int differing = 0;
  for (std::size_t i = 0; i < upright.rgb.size(); ++i) {
    if (std::abs(upright.rgb[i] - turned.rgb[i]) > 8) ++differing;
  }
  EXPECT_LT(differing, static_cast<int>(upright.rgb.size() / 200));
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
  const auto choose = [&] {
    return ChooseViewDirection(ruler_W, EnvironmentDistance(scene), Vector3::UnitZ());
  };
  EXPECT_LT(choose().y(), 0.0);
  scene.bodies.push_back(wall);
  EXPECT_GT(choose().y(), 0.0);
}

TEST_F(PictureMakerTest, TheWordsSayWhatDecidedTheMotion) {
  const auto lines = DescribeStep(job_.scene(), Pull(Press(0.11, 0.012), 0.03).facts, timeline_);
  EXPECT_EQ(lines[0], "The index's target moves by (30, 0, 0) mm in 0.75 s.");
  EXPECT_EQ(lines[1].find("The index sticks to the ruler, which moves: that needs 0."), 0U)
      << lines[1];
  EXPECT_EQ(lines[2].find("ruler moved\t2"), 0U) << lines[2];
  const Node& waited = timeline_.Do(timeline_.root(), Verb::kWait, {{"seconds", 0.1}});
  EXPECT_EQ(DescribeStep(job_.scene(), waited.facts, timeline_)[1],
            "No finger touches the ruler and it stays at rest.");
}

TEST_F(PictureMakerTest, TheWordsSayThatALightTouchSlidesOverTheRuler) {
  // Pressed too lightly (0.05 N), the finger cannot overcome the table.
  const auto lines = DescribeStep(job_.scene(), Pull(Press(0.05, 0.001), 0.03).facts, timeline_);
  EXPECT_EQ(lines[1].find("The index slides "), 0U) << lines[1];
  EXPECT_NE(lines[1].find("over the ruler, which stays."), std::string::npos) << lines[1];
}

// The first sentence that a step of planning gets.
template <typename Facts>
std::string FirstSentence(Facts facts) {
  StepFacts step;
  step.details = std::move(facts);
  return internal::DescribePlanning(MakeRulerScene(), step).front();
}

TEST(PlanningWordsTest, SayWhatWasSimulatedAndWhatEndedIt) {
  IterationFacts facts;
  facts.iteration = 4;
  facts.limit = 15;
  facts.rollouts.resize(48);
  const std::string going_on = FirstSentence(facts);
  EXPECT_EQ(
      going_on.find("Iteration 4: 48 plans were simulated, noise about the mean or steady pushes"),
      0U);
  EXPECT_EQ(going_on.find("ends it"), std::string::npos);
  facts.end = "limit";
  EXPECT_NE(FirstSentence(facts).find("The limit of 15 iterations ends it."), std::string::npos);
  facts.end = "patience";
  EXPECT_NE(FirstSentence(facts).find("the best cost hardly falls any more."), std::string::npos);
}

TEST(PlanningWordsTest, SayWhatAPathIsTheBestOfAndWhenItsScoreIsTheFloor) {
  PathFacts facts;
  facts.order = "explore";
  facts.rank = 3;
  facts.nodes.resize(1);
  facts.terms = {0.2};
  facts.repeats = 1.5;
  facts.value = 0.4;
  EXPECT_EQ(
      FirstSentence(facts),
      "Path 3: of all first states that a fingertip can touch and that no path has tried, the "
      "best by its score over 1 + 1.5, for what the paths before it have in common with it.");
  facts.value = PathExplorer::kLeastScore / 2.5;
  EXPECT_NE(FirstSentence(facts).find(" Scores below 5 % of the best count as that."),
            std::string::npos);
}

}  // namespace
}  // namespace pregrasp
