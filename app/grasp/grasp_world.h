#pragma once

#include <array>
#include <limits>
#include <vector>

#include "app/geometry/signed_distance.h"
#include "app/grasp/surface_points.h"
#include "app/grasp/wrench.h"
#include "app/hand/ik.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// A fingertip's place on the object, in its frame O: on the true surface, with the outward unit
/// normal. Of a grasp it lies on a face, as GraspWorld::ContactNear makes it; where the start is
/// judged it may also lie on an edge or corner (edge_contacts.h).
struct GraspContact {
  Finger finger = Finger::kThumb;
  Vector3 p_OC = Vector3::Zero();
  Vector3 nhat_O = Vector3::UnitZ();
  bool on_edge = false;
};

/// The finger's contact; null if it has none.
inline const GraspContact* FindContact(const std::vector<GraspContact>& contacts, Finger finger) {
  for (const GraspContact& contact : contacts) {
    if (contact.finger == finger) return &contact;
  }
  return nullptr;
}

/// Where the fingertip sphere's centre is when it touches the contact.
inline Vector3 TipCentre(const TipSpheres& tips, const GraspContact& contact) {
  return tips.Centre(contact.finger, contact.p_OC, contact.nhat_O);
}

/// How far apart the fingertip spheres of two contacts are [m] (TipSpheres::CalcGap).
inline double CalcTipGap(const TipSpheres& tips, const GraspContact& a, const GraspContact& b) {
  return tips.CalcGap(a.finger, TipCentre(tips, a), b.finger, TipCentre(tips, b));
}

/// Two fingertips of a grasp and how far apart their spheres are [m].
struct TipPair {
  std::array<Finger, 2> fingers{};
  double gap = std::numeric_limits<double>::infinity();
};

/// The nearest two of all tips; a gap that is not a number counts as the smallest. Infinitely far
/// apart for less than two contacts.
TipPair FindNearestTips(const TipSpheres& tips, const std::vector<GraspContact>& contacts);

/// How near and how far the tip centres of two fingers can be [m], by pairs of Finger.
struct TipReach {
  std::array<std::array<double, kNumFingers>, kNumFingers> nearest{}, farthest{};
};

/// Measured over 30,000 random postures within the joint limits, without the extreme thousandth at
/// either end.
TipReach MeasureTipReach(const HandModel& hand);

/// What every test of a grasp in one scene shares, built once. Immutable, safe to share between
/// threads.
class GraspWorld {
 public:
  /// @param scene  with its shapes loaded.
  GraspWorld(const Scene& scene, const HandModel& hand, const SurfacePointsConfig& surface = {});

  const Scene& scene() const { return scene_; }
  const IkSolver& ik() const { return ik_; }
  const TipSpheres& tips() const { return scene_.tips; }  ///< the hand's
  const SignedDistance& object() const { return object_; }
  const EnvironmentDistance& environment() const { return environment_; }
  const SurfacePoints& surface() const { return surface_; }
  const SurfacePointsConfig& surface_config() const { return surface_config_; }
  const TipReach& reach() const { return reach_; }
  /// The largest distance of the object's surface from its centre of mass [m].
  double object_radius() const { return object_radius_; }

  /// The finger's contact near p_O: SignedDistance::ProjectToFace of the object.
  GraspContact ContactNear(Finger finger, const Vector3& p_O) const;

  /// Every body's pose at the start, in scene order.
  std::vector<RigidTransform> StartPoses() const;

  /// Contacts for the wrench test: relative to the centre of mass, in O's axes, normals inward.
  std::vector<WrenchContact> ToWrenchContacts(const std::vector<GraspContact>& contacts) const;

  /// The scene's friction, weight (gravity in O's axes), force cap and radius.
  WrenchConfig MakeWrenchConfig(double f_min, const Matrix3& R_WO) const;

  /// `contacts` for inverse kinematics with the bodies at X_WB.
  IkProblem ToIkProblem(const std::vector<GraspContact>& contacts,
                        const std::vector<RigidTransform>& X_WB) const;

 private:
  Scene scene_;
  IkSolver ik_;
  SignedDistance object_;
  EnvironmentDistance environment_;
  SurfacePointsConfig surface_config_;
  SurfacePoints surface_;
  TipReach reach_;
  double object_radius_ = 0.0;
};

}  // namespace pregrasp
