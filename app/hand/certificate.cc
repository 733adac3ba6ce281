#include "app/hand/certificate.h"

#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include <array>

#include "app/core/check.h"
#include "app/geometry/fcl_shape.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

// One obstacle of a body: a primitive, or a mesh's surface with its signed distance.
struct Part {
  Geometry geometry;
  int body;
  RigidTransform X_BP;
  std::shared_ptr<const MeshDistance> inside;  // for a mesh
};

struct InsideMaker {
  using Inside = std::shared_ptr<const MeshDistance>;
  Inside operator()(const TriangleMesh& mesh) const {
    return std::make_shared<const MeshDistance>(mesh);
  }
  template <typename Primitive>
  Inside operator()(const Primitive& /*has an inside*/) const {
    return nullptr;
  }
};

void AddParts(const Shape& shape, int body, std::vector<Part>* parts) {
  ForEachLeaf(shape, RigidTransform::Identity(), [&](const Shape& leaf, const RigidTransform& X) {
    parts->push_back({MakeFclShape(leaf), body, X, VisitLeaf(leaf, InsideMaker{})});
  });
}

Geometry MakeCapsule(const HandCapsule& capsule, double radius) {
  const double length = (capsule.p_LB - capsule.p_LA).norm();
  Geometry geometry;
  if (length > 0.0) {
    geometry = std::make_shared<fcl::Capsuled>(radius, length);
  } else {
    geometry = std::make_shared<fcl::Sphered>(radius);
  }
  geometry->computeLocalAABB();
  return geometry;
}

bool Collide(const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
  if (!a.getAABB().overlap(b.getAABB())) return false;
  const fcl::CollisionRequestd request(1,
                                       false);  // no contact points: those are where it is unsafe
  fcl::CollisionResultd result;
  return fcl::collide(&a, &b, request, result) > 0;
}

}  // namespace

struct HandCertificate::Impl {
  HandModel hand;
  std::vector<Geometry> capsules;
  std::vector<RigidTransform> X_LC;  // capsule frames, z along the axis
  std::vector<Part> parts;
  int num_bodies = 0;
};

HandCertificate::HandCertificate(const HandModel& hand, const std::vector<const Shape*>& shapes) {
  auto impl = std::make_unique<Impl>();
  impl->hand = hand;
  for (const HandCapsule& capsule : hand.capsules) {
    impl->capsules.push_back(MakeCapsule(capsule, capsule.radius));
    const Vector3 axis = capsule.p_LB - capsule.p_LA;
    const Vector3 nhat = axis.norm() > 0.0 ? Vector3(axis.normalized()) : Vector3::UnitZ();
    impl->X_LC.push_back(MakeTransform(FrameFromNormal(nhat), 0.5 * (capsule.p_LA + capsule.p_LB)));
  }
  for (const Shape* shape : shapes) {
    AddParts(*shape, impl->num_bodies++, &impl->parts);
  }
  impl_ = std::move(impl);
}

HandCertificate::~HandCertificate() = default;
HandCertificate::HandCertificate(HandCertificate&&) noexcept = default;

std::vector<HandCollision> HandCertificate::FindCollisions(const HandConfiguration& configuration,
                                                           const std::vector<RigidTransform>& X_WB,
                                                           const TouchRule& touch,
                                                           bool first_only) const {
  const HandModel& hand = impl_->hand;
  const int num_capsules = static_cast<int>(hand.capsules.size());
  HandPose pose;
  CalcHandPose(hand, configuration.X_WH, configuration.q, &pose);
  std::vector<fcl::CollisionObjectd> capsules;
  capsules.reserve(num_capsules);
  std::array<int, kMaxHandCapsules> touching_finger;
  touching_finger.fill(-1);
  for (int f = 0; f < hand.num_fingers; ++f) {
    if (touch.touching[f]) touching_finger[hand.tips[f].capsule] = f;
  }
  for (int i = 0; i < num_capsules; ++i) {
    capsules.emplace_back(impl_->capsules[i],
                          RigidTransform(pose.X_WL(hand.capsules[i].link) * impl_->X_LC[i]));
  }
  std::vector<HandCollision> collisions;
  for (const auto& [i, k] : hand.self_pairs) {
    if (!Collide(capsules[i], capsules[k])) continue;
    collisions.push_back({HandPair::kSelf, i, k});
    if (first_only) return collisions;
  }
  if (impl_->parts.empty()) return collisions;
  PREGRASP_CHECK(static_cast<int>(X_WB.size()) == impl_->num_bodies, X_WB.size());
  for (const Part& part : impl_->parts) {
    const RigidTransform X_WP = X_WB[part.body] * part.X_BP;
    const fcl::CollisionObjectd obstacle(part.geometry, X_WP);
    for (int i = 0; i < num_capsules; ++i) {
      const bool touches = part.body == 0 && touching_finger[i] >= 0;
      bool hit = false;
      if (touches) {
        const HandCapsule& capsule = hand.capsules[i];
        const fcl::CollisionObjectd thinner(MakeCapsule(capsule, capsule.radius - touch.depth),
                                            capsules[i].getTransform());
        hit = Collide(thinner, obstacle);
      } else {
        hit = Collide(capsules[i], obstacle);
      }
      if (!hit && part.inside) {
        hit = part.inside->Calc(X_WP.inverse() * capsules[i].getTranslation()) < 0.0;
      }
      if (!hit) continue;
      const HandPair pair = part.body == 0 ? HandPair::kObject : HandPair::kEnvironment;
      collisions.push_back({pair, i, part.body});
      if (first_only) return collisions;
    }
  }
  return collisions;
}

}  // namespace pregrasp
