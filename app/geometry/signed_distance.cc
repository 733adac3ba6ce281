#include "app/geometry/signed_distance.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "app/core/check.h"
#include "app/geometry/mesh_distance.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

struct MeshLeaf {
  explicit MeshLeaf(const TriangleMesh& mesh) : distance(mesh), faces(mesh) {}

  MeshDistance distance;
  MeshFaces faces;
};
using Leaf = std::variant<Box, Cylinder, Capsule, Sphere, std::unique_ptr<const MeshLeaf>>;

// The parts of a union, nested ones flattened. A part farther than the best so far by its bounding
// box cannot be the smallest.
class PartsDistance {
 public:
  void Add(const Shape& shape, const RigidTransform& X_BP);

  double Calc(const Vector3& p_B) const;
  DistanceSample CalcWithGradient(const Vector3& p_B) const;
  Vector3 Project(const Vector3& p_B, Vector3* nhat) const;
  FacePoint ProjectToFace(const Vector3& p_B) const;

 private:
  struct Part {
    RigidTransform X_PB;
    AlignedBox bounds_B;
    Leaf leaf;
  };
  DistanceSample CalcPart(const Part& part, const Vector3& p_B) const;
  void OfferFaces(const Vector3& near_B, const Vector3& p_B, double* squared,
                  FacePoint* best) const;

  std::vector<Part> parts_;
};

// What is asked of a leaf, one way for each kind.
struct Distance {
  const Vector3& p;
  double operator()(const std::unique_ptr<const MeshLeaf>& mesh) const {
    return mesh->distance.Calc(p);
  }
  template <typename Primitive>
  double operator()(const Primitive& primitive) const {
    return CalcDistance(primitive, p);
  }
};
struct Gradient {
  const Vector3& p;
  DistanceSample operator()(const std::unique_ptr<const MeshLeaf>& mesh) const {
    return mesh->distance.CalcWithGradient(p);
  }
  template <typename Primitive>
  DistanceSample operator()(const Primitive& primitive) const {
    return CalcDistanceWithGradient(primitive, p);
  }
};
struct FaceProjection {
  const Vector3& p;
  FacePoint operator()(const std::unique_ptr<const MeshLeaf>& mesh) const {
    return mesh->faces.Project(mesh->distance, p);
  }
  template <typename Primitive>
  FacePoint operator()(const Primitive& primitive) const {
    return ProjectToFace(primitive, p);
  }
};

double CalcLeaf(const Leaf& leaf, const Vector3& p) { return std::visit(Distance{p}, leaf); }

DistanceSample CalcLeafWithGradient(const Leaf& leaf, const Vector3& p) {
  return std::visit(Gradient{p}, leaf);
}

FacePoint ProjectLeafToFace(const Leaf& leaf, const Vector3& p) {
  return std::visit(FaceProjection{p}, leaf);
}

struct LeafMaker {
  Leaf operator()(const TriangleMesh& mesh) const { return std::make_unique<MeshLeaf>(mesh); }
  template <typename Primitive>
  Leaf operator()(const Primitive& primitive) const {
    return primitive;
  }
};

Leaf MakeLeaf(const Shape& shape) { return VisitLeaf(shape, LeafMaker{}); }

void PartsDistance::Add(const Shape& shape, const RigidTransform& X_BP) {
  ForEachLeaf(shape, X_BP, [&](const Shape& leaf, const RigidTransform& X_BL) {
    parts_.push_back({X_BL.inverse(), CalcBounds(leaf, X_BL), MakeLeaf(leaf)});
  });
}

double PartsDistance::Calc(const Vector3& p_B) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Part& part : parts_) {
    const double reach = std::max(best, 0.0);
    if (part.bounds_B.squaredExteriorDistance(p_B) > reach * reach) continue;
    best = std::min(best, CalcLeaf(part.leaf, part.X_PB * p_B));
  }
  return best;
}

DistanceSample PartsDistance::CalcPart(const Part& part, const Vector3& p_B) const {
  DistanceSample sample = CalcLeafWithGradient(part.leaf, part.X_PB * p_B);
  sample.nhat = part.X_PB.linear().transpose() * sample.nhat;
  return sample;
}

DistanceSample PartsDistance::CalcWithGradient(const Vector3& p_B) const {
  DistanceSample best{std::numeric_limits<double>::infinity(), Vector3::UnitZ()};
  for (const Part& part : parts_) {
    const double reach = std::max(best.phi, 0.0);
    if (part.bounds_B.squaredExteriorDistance(p_B) > reach * reach) continue;
    const DistanceSample sample = CalcPart(part, p_B);
    if (sample.phi < best.phi) best = sample;
  }
  return best;
}

// From outside the smallest part's nearest point is exact. From inside, each part's nearest surface
// point that no other part covers is a candidate; where all are covered, steps out of the deepest
// part lead to the outer surface.
Vector3 PartsDistance::Project(const Vector3& p_B, Vector3* nhat) const {
  constexpr double kOnSurface = 1e-9;  // [m]
  const DistanceSample here = CalcWithGradient(p_B);
  Vector3 q_B = p_B - here.phi * here.nhat;
  Vector3 normal = here.nhat;
  if (here.phi < 0.0) {
    double best = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) {
      if (!part.bounds_B.contains(p_B)) continue;
      const DistanceSample sample = CalcPart(part, p_B);
      if (sample.phi > 0.0 || -sample.phi >= best) continue;
      const Vector3 candidate = p_B - sample.phi * sample.nhat;
      if (Calc(candidate) < -kOnSurface) continue;
      best = -sample.phi;
      q_B = candidate;
      normal = sample.nhat;
    }
    constexpr int kMaxSteps = 64;
    for (int i = 0; i < kMaxSteps && best == std::numeric_limits<double>::infinity(); ++i) {
      const DistanceSample sample = CalcWithGradient(q_B);
      if (sample.phi >= -kOnSurface) break;
      q_B -= sample.phi * sample.nhat;
      normal = sample.nhat;
    }
  }
  if (nhat != nullptr) *nhat = normal;
  return q_B;
}

// Of the contacts that each part has near `near_B`, the one nearest to p_B that no other part
// covers, if that is nearer than the best so far.
void PartsDistance::OfferFaces(const Vector3& near_B, const Vector3& p_B, double* squared,
                               FacePoint* best) const {
  constexpr double kProbe = 1e-4;  // [m]; so far out from an inner face is still inside
  for (const Part& part : parts_) {
    if (part.bounds_B.squaredExteriorDistance(p_B) >= *squared) continue;
    FacePoint face = ProjectLeafToFace(part.leaf, part.X_PB * near_B);
    face.p_B = part.X_PB.inverse() * face.p_B;
    face.nhat_B = part.X_PB.linear().transpose() * face.nhat_B;
    const double face_squared = (face.p_B - p_B).squaredNorm();
    if (!(face_squared < *squared)) continue;
    if (Calc(face.p_B + kProbe * face.nhat_B) < 0.5 * kProbe) continue;
    *squared = face_squared;
    *best = face;
  }
}

// Near p_B itself and near the outer surface's point there. Where both lead into another part, the
// search widens about that point.
FacePoint PartsDistance::ProjectToFace(const Vector3& p_B) const {
  double squared = std::numeric_limits<double>::infinity();
  FacePoint best;
  best.p_B = Project(p_B, &best.nhat_B);
  const Vector3 surface_B = best.p_B;
  OfferFaces(p_B, p_B, &squared, &best);
  OfferFaces(surface_B, p_B, &squared, &best);
  constexpr double kFirst = 1e-3, kLast = 0.2;  // [m]
  for (double reach = kFirst; std::isinf(squared) && reach < kLast; reach *= 2.0) {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3i step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      OfferFaces(surface_B + reach * step.cast<double>(), p_B, &squared, &best);
    }
  }
  return best;
}

// All bodies but the object, at their start in W.
Union GatherEnvironment(const Scene& scene) {
  Union whole;
  for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
    whole.parts.push_back({scene.bodies[b].shape, scene.bodies[b].X_WB});
  }
  return whole;
}

}  // namespace

struct SignedDistance::Impl {
  bool is_union = false;
  Leaf leaf;            // of any other shape
  PartsDistance parts;  // of a union
  AlignedBox bounds;
};

SignedDistance::SignedDistance(const Shape& shape) {
  auto impl = std::make_unique<Impl>();
  impl->is_union = std::holds_alternative<Union>(shape);
  if (impl->is_union) {
    impl->parts.Add(shape, RigidTransform::Identity());
  } else {
    impl->leaf = MakeLeaf(shape);
  }
  impl->bounds = CalcBounds(shape);
  impl_ = std::move(impl);
}

SignedDistance::~SignedDistance() = default;
SignedDistance::SignedDistance(SignedDistance&&) noexcept = default;
SignedDistance& SignedDistance::operator=(SignedDistance&&) noexcept = default;

const AlignedBox& SignedDistance::bounds() const { return impl_->bounds; }

double SignedDistance::Calc(const Vector3& p_B) const {
  return impl_->is_union ? impl_->parts.Calc(p_B) : CalcLeaf(impl_->leaf, p_B);
}

DistanceSample SignedDistance::CalcWithGradient(const Vector3& p_B) const {
  return impl_->is_union ? impl_->parts.CalcWithGradient(p_B)
                         : CalcLeafWithGradient(impl_->leaf, p_B);
}

Vector3 SignedDistance::Project(const Vector3& p_B, Vector3* nhat) const {
  if (impl_->is_union) return impl_->parts.Project(p_B, nhat);
  const DistanceSample sample = CalcLeafWithGradient(impl_->leaf, p_B);
  if (nhat != nullptr) *nhat = sample.nhat;
  return p_B - sample.phi * sample.nhat;
}

FacePoint SignedDistance::ProjectToFace(const Vector3& p_B) const {
  return impl_->is_union ? impl_->parts.ProjectToFace(p_B) : ProjectLeafToFace(impl_->leaf, p_B);
}

EnvironmentDistance::EnvironmentDistance(const Scene& scene) : start_(GatherEnvironment(scene)) {
  for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
    distances_.emplace_back(scene.bodies[b].shape);
  }
}

DistanceSample EnvironmentDistance::Calc(const Vector3& p_W) const {
  return start_.CalcWithGradient(p_W);
}

DistanceSample EnvironmentDistance::Calc(const Vector3& p_W,
                                         const std::vector<RigidTransform>& X_WB) const {
  PREGRASP_CHECK(X_WB.size() == distances_.size() + 1, X_WB.size(), distances_.size());
  DistanceSample best{std::numeric_limits<double>::infinity(), Vector3::UnitZ()};
  for (std::size_t i = 0; i < distances_.size(); ++i) {
    const RigidTransform& X_WP = X_WB[i + 1];
    const Vector3 p_P = X_WP.linear().transpose() * (p_W - X_WP.translation());
    const double reach = std::max(best.phi, 0.0);
    if (distances_[i].bounds().squaredExteriorDistance(p_P) > reach * reach) continue;
    DistanceSample sample = distances_[i].CalcWithGradient(p_P);
    if (!(sample.phi < best.phi)) continue;
    best = {sample.phi, X_WP.linear() * sample.nhat};
  }
  return best;
}

}  // namespace pregrasp
