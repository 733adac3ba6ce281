#pragma once

#include <memory>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/geometry/point_cloud.h"
#include "app/graph/placement.h"
#include "app/networks/score_function.h"

namespace pregrasp {

/// What the networks see of an object at one moment (paper: S and O'): the signed distance from
/// each cloud point to the surroundings, the points where a fingertip of `radius` cannot be, and
/// up.
/// @param X_WB  every scene body's pose, the object first.
ObjectState MakeObjectState(const PointCloud& cloud, const std::vector<RigidTransform>& X_WB,
                            const EnvironmentDistance& environment, const Vector3& gravity_W,
                            double radius);

/// The networks' view of a placement. @param X_WB  null for no surroundings.
PlanningContacts MakePlanningContacts(const Placement& placement,
                                      const std::vector<RigidTransform>* X_WB,
                                      const EnvironmentDistance& environment);

/// The learned score bound to one object in its scene. All references outlive it.
class LearnedScorer : public StateScorer {
 public:
  LearnedScorer(const ScoreFunction& score, const Scene& scene, PointCloud cloud,
                const EnvironmentDistance& environment, ThreadPool& pool);

  std::vector<double> Score(std::span<const ScoredState> states) const override;

  /// The mean of the kBestProbes best scores among the probes, each with the state's own contacts
  /// in place of its fingers'; where a fingertip cannot be, a probe scores 0.
  std::vector<double> ScoreGraspable(std::span<const ScoredState> states) const override;
  static constexpr int kBestProbes = 8;  ///< of one the noise of the network would be sought out

  /// The placements that ScoreGraspable tries: those that are good without surroundings.
  void SetProbes(std::vector<Placement> probes) { probes_ = std::move(probes); }

  const PointCloud& cloud() const { return cloud_; }

  /// The paper's s_c: placements with every body where it is at the start.
  std::unique_ptr<PlacementScorer> InContext() const {
    return At(X_WB_start_, ScoreOutput::kProgress);
  }
  /// The same, or the probability of a lifted grasp, with every body at `X_WB`, the object first.
  std::unique_ptr<PlacementScorer> At(const std::vector<RigidTransform>& X_WB,
                                      ScoreOutput output) const;
  /// The paper's s_n: the object alone, upright as at the start.
  std::unique_ptr<PlacementScorer> Free() const;

 private:
  class FixedState;
  bool IsOccluded(Finger finger, const Placement::Contact& contact,
                  const std::vector<RigidTransform>& X_WB) const;
  double ScoreBestProbes(const ScoredState& state) const;

  const ScoreFunction& score_;
  const EnvironmentDistance& environment_;
  ThreadPool& pool_;
  PointCloud cloud_;
  Vector3 gravity_W_;
  TipSpheres tips_;
  std::vector<RigidTransform> X_WB_start_;
  std::vector<Placement> probes_;
  CloudStructure structure_;
};

}  // namespace pregrasp
