#include "app/training/training_scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "app/geometry/overlap.h"
#include "app/geometry/point_cloud.h"
#include "app/geometry/signed_distance.h"
#include "app/training/make_item.h"
#include "app/training/object_similarity.h"

namespace pregrasp {
namespace {

double CalcLeastDistance(const Scene& scene, const MatrixX3& P_O,
                         const std::vector<RigidTransform>& X_WB) {
  const EnvironmentDistance environment(scene);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < P_O.rows(); ++i) {
    const Vector3 p_W = X_WB[0] * Vector3(P_O.row(i).transpose());
    least = std::min(least, environment.Calc(p_W, X_WB).phi);
  }
  return least;
}

std::vector<RigidTransform> Poses(const Scene& scene) {
  std::vector<RigidTransform> X_WB;
  for (const Body& body : scene.bodies) X_WB.push_back(body.X_WB);
  return X_WB;
}

TEST(TrainingSceneTest, ABoxRestsOnEachOfItsFacesAndOftenestOnTheLargest) {
  const Box box{{0.06, 0.10, 0.20}};
  TrainingObject object;
  object.shape = box;
  object.mass = 0.3;
  const SceneObject made = MakeSceneObject(object);
  ASSERT_EQ(made.resting.size(), 6);
  double total = 0.0;
  for (const RestingPose& pose : made.resting) {
    total += pose.share;
    // The vertical extent tells the face.
    const double height = (pose.R_WO.transpose() * Vector3::UnitZ()).cwiseAbs().dot(box.size);
    const bool largest = std::abs(height - 0.06) < 1e-9;
    EXPECT_EQ(largest, pose.share > 1.0 / 6.0) << height << " " << pose.share;
  }
  EXPECT_NEAR(total, 1.0, 1e-12);
}

TEST(TrainingSceneTest, ScenesOfEveryFamilyAreValidWithoutOverlap) {
  for (const std::string& family : ObjectFamilies()) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const SceneObject object = MakeSceneObject(SampleObject(family, Rng(i)));
      const TrainingScene made = SampleTrainingScene(object, Rng(7, RngStream::kTest, i));
      EXPECT_EQ(made.kind == "free", made.scene.bodies.size() == 1);
      if (made.kind == "free") continue;
      EXPECT_NO_THROW(ValidateScene(made.scene)) << object.object.name << ": " << made.kind;
      // Bodies are placed by their tessellations, which lie inside round shapes.
      for (const Overlap& overlap : FindOverlaps(made.scene, 5e-4)) {
        ADD_FAILURE() << object.object.name << ": " << made.kind << ": "
                      << made.scene.bodies[overlap.body_b].name << " " << overlap.depth;
      }
    }
  }
}

TEST(TrainingSceneTest, TheSameStreamMakesTheSameScene) {
  const SceneObject object = MakeSceneObject(SampleObject("book", Rng(1)));
  bool differ = false;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Scene a = SampleTrainingScene(object, Rng(3, RngStream::kTest, i)).scene;
    const Scene b = SampleTrainingScene(object, Rng(3, RngStream::kTest, i)).scene;
    const Scene c = SampleTrainingScene(object, Rng(4, RngStream::kTest, i)).scene;
    ASSERT_EQ(a.bodies.size(), b.bodies.size());
    for (std::size_t k = 0; k < a.bodies.size(); ++k) {
      EXPECT_EQ(a.bodies[k].X_WB.matrix(), b.bodies[k].X_WB.matrix());
    }
    differ = differ || a.bodies[0].X_WB.matrix() != c.bodies[0].X_WB.matrix();
  }
  EXPECT_TRUE(differ);
}

// Each body goes the whole relief; the object's distance grows by less where another part of the
// body, off the direction to the nearest points, is nearly as near: an object across an edge.
TEST(TrainingSceneTest, EachBodyMovesByTheReliefAndNoneComesNearer) {
  for (std::uint32_t i = 0; i < 60; ++i) {
    const SceneObject object = MakeSceneObject(SampleObject("carton", Rng(i)));
    const Scene scene = SampleTrainingScene(object, Rng(5, RngStream::kTest, i)).scene;
    if (scene.bodies.size() == 1) continue;
    const double before = CalcLeastDistance(scene, object.surface, Poses(scene));
    for (const double relief : {0.005, 0.04}) {
      const auto X_WB = MoveSurroundingsAway(scene, object.surface, relief);
      EXPECT_EQ(X_WB[0].matrix(), scene.object().X_WB.matrix());
      for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
        const Vector3 p_WB = scene.bodies[b].X_WB.translation();
        EXPECT_NEAR((X_WB[b].translation() - p_WB).norm(), relief, 1e-12);
        EXPECT_EQ(X_WB[b].linear(), scene.bodies[b].X_WB.linear());
      }
      const double after = CalcLeastDistance(scene, object.surface, X_WB);
      EXPECT_GT(after, before) << i;
      EXPECT_LT(after, before + relief + 1e-9) << i;
    }
  }
}

TEST(ObjectSimilarityTest, AnObjectIsLikeItselfHoweverItLies) {
  const ExcludedObject box("box", Box{{0.04, 0.09, 0.20}});
  EXPECT_LT(box.CalcUnlikeness(Box{{0.04, 0.09, 0.20}}), 1e-9);
  EXPECT_LT(box.CalcUnlikeness(Box{{0.20, 0.04, 0.09}}), 1e-9);
  // Wide objects too: no noise of samples hides that they are the same.
  const ExcludedObject wide("keyboard", Box{{0.13, 0.44, 0.02}});
  EXPECT_LT(wide.CalcUnlikeness(Box{{0.13, 0.44, 0.02}}), 1e-9);
  EXPECT_NEAR(wide.CalcUnlikeness(Box{{0.13, 0.44, 0.03}}), 0.005, 0.0015);
  EXPECT_GT(box.CalcUnlikeness(Box{{0.04, 0.15, 0.20}}), kLeastUnlikeness);
}

TEST(ObjectSimilarityTest, LikeSidesAreEnoughToResemble) {
  const ExcludedObject box("box", Box{{0.10, 0.20, 0.40}});
  EXPECT_TRUE(box.Resembles(Box{{0.365, 0.109, 0.219}}));
  EXPECT_GT(box.CalcUnlikeness(Box{{0.365, 0.109, 0.219}}), kLeastUnlikeness);
  EXPECT_FALSE(box.Resembles(Box{{0.355, 0.109, 0.219}}));
}

TEST(ObjectSimilarityTest, TrainingObjectsKeepAwayFromExcludedOnes) {
  ItemConfig config;
  const Shape drawn = MakeItemObject(config, 3).object.shape;
  // Exclude the very object that would be drawn: another must come in its place.
  config.excluded.emplace_back("evaluation", drawn);
  EXPECT_TRUE(config.excluded.front().Resembles(drawn));
  EXPECT_FALSE(config.excluded.front().Resembles(MakeItemObject(config, 3).object.shape));
}

}  // namespace
}  // namespace pregrasp
