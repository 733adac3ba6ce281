#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "app/geometry/contact_mesh.h"
#include "app/graph/learned_scorer.h"
#include "app/graph/placement_search.h"
#include "app/grasp/grasp_completion.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {

/// Generated grasps of an object where it is in a scene, by the shipped weights, as the planner
/// asks for its trials: the conditions are the placements with the best learned scores there, and
/// hold what presses already.
class GeneratedGrasps {
 public:
  static constexpr int kSamples = 20;
  static constexpr int kCloudPoints = 512;

  explicit GeneratedGrasps(const Scene& scene, const std::vector<GraspContact>& pressing = {})
      : world_(scene, ShadowHand()), pressing_(pressing), pool_(1) {}

  const GraspWorld& world() const { return world_; }
  const std::vector<GraspContact>& pressing() const { return pressing_; }

  std::vector<GeneratedGrasp> Draw(std::uint64_t seed) {
    const Scene& scene = world_.scene();
    const std::filesystem::path weights = PREGRASP_WEIGHTS;
    const auto score = ScoreFunction::Load(weights / "score.safetensors");
    const auto generator = GraspGenerator::Load(weights / "generator.safetensors");
    const PointCloud cloud =
        SamplePointCloud(scene.object().shape, kCloudPoints, Rng(seed, RngStream::kObjectCloud));
    const std::vector<RigidTransform> X_WB = world_.StartPoses();
    const LearnedScorer scorer(score, scene, cloud, world_.environment(), pool_);
    const CloudStructure structure = generator.BuildStructure(cloud.P, X_WB[0].linear());
    const EncodedState encoded = generator.Encode(
        structure, MakeObjectState(cloud, X_WB, world_.environment(), scene.gravity, 0.009));
    Placement fixed;
    for (const GraspContact& contact : pressing_) {
      fixed.fingers[static_cast<int>(contact.finger)] = {true, contact.p_OC, contact.nhat_O};
    }
    const std::vector<Placement> conditions = FindPlacements(
        BuildContactMesh(scene.object().shape, {}), world_.object(), *scorer.InContext(), fixed,
        kSamples, {}, Rng(seed, RngStream::kReleasePlacements));
    std::vector<GeneratedGrasp> grasps;
    for (int i = 0; i < kSamples && !conditions.empty(); ++i) {
      const Placement& condition = conditions[i % conditions.size()];
      const GraspPoints points =
          generator
              .Sample(structure, encoded,
                      MakePlanningContacts(condition, &X_WB, world_.environment()), 1,
                      Rng(seed, RngStream::kGraspLatent, 1, i))
              .front();
      grasps.push_back({points, Rng(seed, RngStream::kGraspCompletion, 1, i)});
    }
    return grasps;
  }

 private:
  GraspWorld world_;
  std::vector<GraspContact> pressing_;
  ThreadPool pool_;
};

/// A scene whose object is turned by `turn_deg` about +y through the point `pivot_W`.
inline Scene Tilted(Scene scene, double turn_deg, const Vector3& pivot_W) {
  const Matrix3 R = RotationFromRpy({0.0, DegToRad(turn_deg), 0.0});
  RigidTransform& X_WO = scene.object().X_WB;
  X_WO = MakeTransform(Matrix3(R * X_WO.linear()),
                       Vector3(pivot_W + R * (X_WO.translation() - pivot_W)));
  return scene;
}

/// The scene with its object moved.
inline Scene Moved(Scene scene, const Vector3& by_W) {
  scene.object().X_WB.translation() += by_W;
  return scene;
}

/// A board of 30 x 20 x 1.2 cm on a shelf, `overhang` of it over the edge, the rest between the
/// shelf and a second board 3 cm above it.
inline Scene BoardScene(double overhang) {
  Scene scene = FlatScene({0.300, 0.200, 0.012}, 0.45, overhang);
  scene.bodies.push_back(
      FixedBox("above", {0.4, 0.8, 0.02}, {0.150 - overhang - 0.2, 0, 0.012 + 0.03 + 0.01}));
  return scene;
}

}  // namespace pregrasp
