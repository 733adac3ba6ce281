#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "app/geometry/mesh_distance.h"
#include "app/hand/hand_kinematics.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// What a part of the hand is near to.
enum class HandPair { kSelf, kObject, kEnvironment };

/// A hand capsule near another capsule or a body.
struct HandDistance {
  double distance = 0.0;  ///< between the surfaces [m]; negative when they overlap
  bool touch = false;     ///< a contacting distal link with the object (TouchRule)
  HandPair pair = HandPair::kSelf;
  int capsule = 0;  ///< index into HandModel::capsules
  int other = 0;    ///< a capsule (kSelf) or a body's index
  /// The points of the capsule axes where the distance is taken; p_WB only for kSelf.
  Vector3 p_WA = Vector3::Zero(), p_WB = Vector3::Zero();
  /// From the other to the capsule: moving p_WA along it by a small d (against p_WB) adds d to the
  /// distance.
  Vector3 nhat_W = Vector3::UnitZ();
};

/// The ends of every capsule's axis in the world.
struct CapsuleEnds {
  std::array<Vector3, kMaxHandCapsules> p_WA, p_WB;
};
void CalcCapsuleEnds(const HandModel& hand, const HandPose& pose, CapsuleEnds* ends);

/// gradient += weight * d(distance)/d(dofs).
void AddDistanceGradient(const HandModel& hand, const HandPose& pose, const HandDistance& distance,
                         double weight, HandVector* gradient);

/// Which fingers touch the object, body 0: their distal capsules may enter it by `depth`.
struct TouchRule {
  std::array<bool, kNumFingers> touching{};
  double depth = 1e-3;  ///< [m]
};

/// Bodies prepared for distances to hand capsules: the least of a body's signed distance along the
/// capsule's axis, less the radius. Exact for boxes, cylinders, capsules, spheres and, where the
/// capsule's axis is outside, for meshes; the parts of a union one by one. Where an axis is inside
/// a body, the depth of its deepest point, which is not the shortest way out. Immutable, safe to
/// share between threads. Body 0 is the object, the others are environment.
class HandObstacles {
 public:
  explicit HandObstacles(const std::vector<const Shape*>& shapes);
  int num_bodies() const { return num_bodies_; }

  /// The obstacles with each body at its pose.
  struct Placed {
    std::vector<RigidTransform> X_WP;  ///< by part
  };
  Placed Place(const std::vector<RigidTransform>& X_WB) const;

  /// Appends every pair closer than `influence`.
  void FindNear(const HandModel& hand, const CapsuleEnds& ends, const Placed& placed,
                const TouchRule& touch, double influence, std::vector<HandDistance>* near) const;

 private:
  struct Part {
    std::variant<Box, Cylinder, Capsule, Sphere, std::shared_ptr<const MeshDistance>> shape;
    int body = 0;
    RigidTransform X_BP = RigidTransform::Identity();
    Vector3 p_PCenter = Vector3::Zero();  ///< of a sphere around the part
    double bound = 0.0;                   ///< its radius
  };
  void AddParts(const Shape& shape, int body);

  int num_bodies_ = 0;
  std::vector<Part> parts_;
};

/// Appends every self pair (HandModel::self_pairs) closer than `influence`.
void FindNearSelf(const HandModel& hand, const CapsuleEnds& ends, double influence,
                  std::vector<HandDistance>* near);

}  // namespace pregrasp
