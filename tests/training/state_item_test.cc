#include "app/training/state_item.h"

#include <gtest/gtest.h>

#include "app/geometry/mass_properties.h"
#include "app/grasp/surface_points.h"
#include "app/trajectory/certify.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {
namespace {

Body MakeBox(const std::string& name, const Vector3& size, const Vector3& p_W, double mass) {
  Body body;
  body.name = name;
  body.shape = Box{size};
  body.X_WB = MakeTransform(Matrix3::Identity(), p_W);
  if (mass > 0.0) body.mass_properties = CalcMassProperties(body.shape, mass);
  return body;
}

// A strip on a table that ends `over` before the strip does.
Scene MakeStripScene(double over) {
  Scene scene;
  scene.name = "strip";
  scene.bodies.push_back(MakeBox("object", {0.24, 0.035, 0.006}, {-0.12 + over, 0, 0.003}, 0.03));
  scene.bodies.push_back(MakeBox("table", {0.8, 0.8, 0.04}, {-0.4, 0, -0.02}, 0.0));
  return scene;
}

// What is said of one state of that scene.
struct Labelled {
  explicit Labelled(double over)
      : scene(MakeStripScene(over)),
        world(scene),
        grasp_world(MakeTrainingWorld(scene)),
        room(grasp_world, {}, 1),
        cloud(SamplePointCloud(scene.object().shape, 256, Rng(1))) {
    state.state = world.InitialState();
  }
  SearchLabels Label() const { return LabelState(&world, grasp_world, room, cloud, state, {}, 1); }

  Scene scene;
  World world;
  GraspWorld grasp_world;
  GraspRoom room;
  PointCloud cloud;
  ReachedState state;
};

struct Means {
  double lifted = 0.0, relief = 0.0, room = 0.0;
};
Means MeansOf(const std::vector<TruthRecord>& truths) {
  Means means;
  for (const TruthRecord& truth : truths) {
    means.lifted += (truth.lifted ? 1.0 : 0.0) / static_cast<double>(truths.size());
    means.relief += truth.relief / static_cast<double>(truths.size());
    means.room += truth.room / static_cast<double>(truths.size());
  }
  return means;
}

TEST(SearchLabelsTest, ProgressRisesAsAStripIsPushedOverAnEdgeAndGraspsAppear) {
  const SearchLabels flat = Labelled(0.0).Label(), some = Labelled(0.030).Label(),
                     far = Labelled(0.090).Label();
  EXPECT_EQ(flat.truths.size(), 48U);
  EXPECT_EQ(flat.stats.found[0], 0);
  EXPECT_EQ(MeansOf(flat.truths).lifted, 0.0);
  EXPECT_TRUE(flat.grasps.empty());
  EXPECT_GT(MeansOf(far.truths).lifted, 0.1);
  EXPECT_FALSE(far.grasps.empty());
  EXPECT_GT(MeansOf(flat.truths).relief, 0.0);  // a flat score would leave nothing to climb
  EXPECT_LT(MeansOf(flat.truths).relief, MeansOf(far.truths).relief);
  EXPECT_LT(MeansOf(flat.truths).room, MeansOf(some.truths).room);
  EXPECT_LT(MeansOf(some.truths).room, MeansOf(far.truths).room);
}

TEST(SearchLabelsTest, WhatIsLiftedIsAGraspWithThoseContactsAndNothingIsWithoutPlace) {
  const Labelled scene(0.090);
  const SearchLabels labels = scene.Label();
  const auto X_WB = scene.grasp_world.StartPoses();
  for (const TruthRecord& truth : labels.truths) {
    EXPECT_TRUE(!truth.lifted || truth.relief == 1.0);
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (!truth.contacts[f]) continue;
      const PlanningContact& contact = *truth.contacts[f];
      EXPECT_NEAR(scene.grasp_world.object().Calc(contact.p_OC), 0.0, 1e-6);
      const double radius = TipSpheres{}.radii[f];
      const bool fits = CanTouch(contact.p_OC, contact.nhat_O, radius, {},
                                 scene.grasp_world.object(), scene.grasp_world.environment(), X_WB);
      EXPECT_TRUE(fits || !truth.lifted);
    }
  }
  for (const GraspRecord& grasp : labels.grasps) {
    std::vector<GraspContact> contacts;
    for (int f = 0; f < kNumFingers; ++f) {
      if (grasp.used[f]) {
        contacts.push_back({static_cast<Finger>(f), grasp.p_OC[f], grasp.nhat_O[f]});
      }
    }
    EXPECT_TRUE(TestContacts(scene.grasp_world, {}, contacts, X_WB, Rng(5)).feasible());
  }
}

TEST(SearchLabelsTest, ContactsThatPressArePartOfEveryLabel) {
  Labelled scene(0.090);
  const GraspContact press = scene.grasp_world.ContactNear(Finger::kIndex, {-0.05, 0.0, 0.003});
  scene.world.PutFinger(scene.state.state, Finger::kIndex, press.p_OC);
  scene.state.fixed = {press};
  const SearchLabels labels = scene.Label();
  EXPECT_EQ(labels.truths.size(), 48U);
  for (const TruthRecord& truth : labels.truths) {
    ASSERT_TRUE(truth.contacts[1].has_value());
    EXPECT_EQ(truth.contacts[1]->p_OC, press.p_OC);
  }
}

TEST(MotionStatesTest, StatesAreApartAndStayWithWhatIsFixed) {
  const Labelled scene(0.02);
  const auto states = SampleMotionStates(scene.world, scene.grasp_world, scene.room, {}, 7);
  ASSERT_GE(states.size(), 3U);
  EXPECT_FALSE(states.front().moved);
  bool held = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double shift = 0.0, turn_deg = 0.0;
      CalcShift(states[i].state, states[j].state, &shift, &turn_deg);
      EXPECT_GT(shift / 0.01 + turn_deg / 10.0, 0.39) << i << " " << j;
    }
    held = held || !states[i].fixed.empty();
    EXPECT_EQ(SimulateRelease(scene.world, states[i].state).stays, states[i].fixed.empty()) << i;
  }
  EXPECT_TRUE(held);
}

TEST(StateItemTest, AnItemIsAFunctionOfSeedAndIndex) {
  StateItemConfig config;
  config.item.scenes = 1;
  config.motion.pushes = 8;
  config.motion.states = 2;
  config.labels.search.max_solves = 16;
  const std::int64_t strip = 3;
  const auto bytes = [&] {
    return SerializeTensors(ItemsToTensors({MakeStateItem(config, strip)}));
  };
  const std::string first = bytes();
  EXPECT_EQ(bytes(), first);
  config.item.seed = 2;
  EXPECT_NE(bytes(), first);
  const DatasetItem item = MakeStateItem(config, strip);
  EXPECT_EQ(item.family, "strip");
  EXPECT_GE(item.truths.size(), 24U);
  for (const TruthRecord& truth : item.truths) {
    EXPECT_LT(truth.context, static_cast<int>(item.contexts.size()));
    EXPECT_GE(truth.room, 0.0);
    EXPECT_LT(truth.room, 1.0);
  }
}

TEST(SearchLabelsTest, WithoutSurroundingsNothingIsSimulatedAndNothingCanBeMovedAway) {
  Scene scene = MakeStripScene(0.0);
  scene.bodies.resize(1);
  const GraspWorld grasp_world = MakeTrainingWorld(scene);
  const GraspRoom room(grasp_world, {}, 1);
  const PointCloud cloud = SamplePointCloud(scene.object().shape, 256, Rng(1));
  const SearchLabels labels = LabelState(nullptr, grasp_world, room, cloud, ReachedState(), {}, 1);
  EXPECT_GT(labels.stats.found[0], 0);
  EXPECT_EQ(labels.stats.found[1], 0);
  EXPECT_EQ(labels.stats.lifts, 0);
  EXPECT_GT(MeansOf(labels.truths).lifted, 0.1);
  for (const TruthRecord& truth : labels.truths) {
    EXPECT_TRUE(truth.relief == 0.0 || truth.relief == 1.0);
  }
}

}  // namespace
}  // namespace pregrasp
