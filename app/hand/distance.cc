#include "app/hand/distance.h"

#include "app/core/check.h"
#include "app/hand/segment_distance.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

// The radius of a sphere about the shape's own origin.
double BoundOf(const Box& box) { return 0.5 * box.size.norm(); }
double BoundOf(const Cylinder& c) { return std::hypot(c.radius, 0.5 * c.height); }
double BoundOf(const Capsule& c) { return c.radius + 0.5 * c.height; }
double BoundOf(const Sphere& sphere) { return sphere.radius; }

template <typename Primitive>
SegmentSample FindLeastOf(const Primitive& primitive, const Vector3& a, const Vector3& b,
                          double /*cutoff*/) {
  return FindLeastConvex([&](const Vector3& p) { return CalcDistanceWithGradient(primitive, p); },
                         a, b);
}

SegmentSample FindLeastOf(const std::shared_ptr<const MeshDistance>& mesh, const Vector3& a,
                          const Vector3& b, double cutoff) {
  return FindLeastOnMesh(*mesh, a, b, cutoff);
}

// At most the distance, for culling.
template <typename Primitive>
double DistanceAt(const Primitive& primitive, const Vector3& p) {
  return CalcDistance(primitive, p);
}

double DistanceAt(const std::shared_ptr<const MeshDistance>& mesh, const Vector3& p) {
  return mesh->bounds().exteriorDistance(p);
}

}  // namespace

void CalcCapsuleEnds(const HandModel& hand, const HandPose& pose, CapsuleEnds* ends) {
  for (std::size_t i = 0; i < hand.capsules.size(); ++i) {
    const HandCapsule& capsule = hand.capsules[i];
    ends->p_WA[i] = pose.CalcPoint(capsule.link, capsule.p_LA);
    ends->p_WB[i] = pose.CalcPoint(capsule.link, capsule.p_LB);
  }
}

void AddDistanceGradient(const HandModel& hand, const HandPose& pose, const HandDistance& distance,
                         double weight, HandVector* gradient) {
  const Vector3 f_W = weight * distance.nhat_W;
  AddPointGradient(hand, pose, hand.capsules[distance.capsule].link, distance.p_WA, f_W, gradient);
  if (distance.pair != HandPair::kSelf) return;
  AddPointGradient(hand, pose, hand.capsules[distance.other].link, distance.p_WB, -f_W, gradient);
}

HandObstacles::HandObstacles(const std::vector<const Shape*>& shapes) {
  for (const Shape* shape : shapes) AddParts(*shape, num_bodies_++);
}

void HandObstacles::AddParts(const Shape& shape, int body) {
  ForEachLeaf(shape, RigidTransform::Identity(), [&](const Shape& leaf, const RigidTransform& X) {
    Part part;
    part.body = body;
    part.X_BP = X;
    VisitLeaf(leaf, [&](const auto& kind) {
      if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, TriangleMesh>) {
        auto distance = std::make_shared<const MeshDistance>(kind);
        part.p_PCenter = distance->bounds().center();
        part.bound = 0.5 * distance->bounds().diagonal().norm();
        part.shape = std::move(distance);
      } else {
        part.shape = kind;
        part.bound = BoundOf(kind);
      }
    });
    parts_.push_back(std::move(part));
  });
}

HandObstacles::Placed HandObstacles::Place(const std::vector<RigidTransform>& X_WB) const {
  PREGRASP_CHECK(static_cast<int>(X_WB.size()) == num_bodies_, X_WB.size(), num_bodies_);
  Placed placed;
  placed.X_WP.reserve(parts_.size());
  for (const Part& part : parts_) placed.X_WP.push_back(X_WB[part.body] * part.X_BP);
  return placed;
}

void HandObstacles::FindNear(const HandModel& hand, const CapsuleEnds& ends, const Placed& placed,
                             const TouchRule& touch, double influence,
                             std::vector<HandDistance>* near) const {
  std::array<bool, kMaxHandCapsules> touches{};
  for (int f = 0; f < hand.num_fingers; ++f) touches[hand.tips[f].capsule] = touch.touching[f];
  const int num_capsules = static_cast<int>(hand.capsules.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    const Matrix3 R_WP = placed.X_WP[k].linear();
    const Vector3 p_WP = placed.X_WP[k].translation();
    const HandPair pair = part.body == 0 ? HandPair::kObject : HandPair::kEnvironment;
    std::visit(
        [&](const auto& shape) {
          for (int i = 0; i < num_capsules; ++i) {
            const double radius = hand.capsules[i].radius;
            const Vector3 a = R_WP.transpose() * (ends.p_WA[i] - p_WP);
            const Vector3 b = R_WP.transpose() * (ends.p_WB[i] - p_WP);
            // A distance changes by at most 1 m per metre, so the middle decides for most.
            const Vector3 middle = 0.5 * (a + b);
            const double reach = 0.5 * (b - a).norm() + radius + influence;
            const double far = reach + part.bound;
            if ((middle - part.p_PCenter).squaredNorm() > far * far) continue;
            if (DistanceAt(shape, middle) > reach) continue;
            const SegmentSample least = FindLeastOf(shape, a, b, radius + influence);
            HandDistance found;
            found.distance = least.sample.phi - radius;
            if (found.distance >= influence) continue;
            found.touch = part.body == 0 && touches[i];
            found.pair = pair;
            found.capsule = i;
            found.other = part.body;
            found.p_WA = ends.p_WA[i] + least.t * (ends.p_WB[i] - ends.p_WA[i]);
            found.nhat_W = R_WP * least.sample.nhat;
            near->push_back(found);
          }
        },
        part.shape);
  }
}

void FindNearSelf(const HandModel& hand, const CapsuleEnds& ends, double influence,
                  std::vector<HandDistance>* near) {
  std::array<Vector3, kMaxHandCapsules> middle;
  std::array<double, kMaxHandCapsules> reach;
  for (std::size_t i = 0; i < hand.capsules.size(); ++i) {
    middle[i] = 0.5 * (ends.p_WA[i] + ends.p_WB[i]);
    reach[i] = 0.5 * (ends.p_WB[i] - ends.p_WA[i]).norm() + hand.capsules[i].radius;
  }
  for (const auto& [i, k] : hand.self_pairs) {
    const double far = reach[i] + reach[k] + influence;
    if ((middle[i] - middle[k]).squaredNorm() > far * far) continue;
    double s = 0.0;
    double t = 0.0;
    FindNearestOnSegments(ends.p_WA[i], ends.p_WB[i], ends.p_WA[k], ends.p_WB[k], &s, &t);
    HandDistance found;
    found.p_WA = ends.p_WA[i] + s * (ends.p_WB[i] - ends.p_WA[i]);
    found.p_WB = ends.p_WA[k] + t * (ends.p_WB[k] - ends.p_WA[k]);
    const Vector3 gap = found.p_WA - found.p_WB;
    const double length = gap.norm();
    found.distance = length - hand.capsules[i].radius - hand.capsules[k].radius;
    if (found.distance >= influence) continue;
    if (length > 1e-9) {
      found.nhat_W = gap / length;
    } else {  // crossing axes: apart along their common normal
      const Vector3 normal = (ends.p_WB[i] - ends.p_WA[i]).cross(ends.p_WB[k] - ends.p_WA[k]);
      if (normal.squaredNorm() > 0.0) found.nhat_W = normal.normalized();
    }
    found.pair = HandPair::kSelf;
    found.capsule = i;
    found.other = k;
    near->push_back(found);
  }
}

}  // namespace pregrasp
