#pragma once

#include <memory>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/geometry/contact_faces.h"
#include "app/geometry/primitive_distance.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The signed distance of one loaded shape in its own frame B: closed form for primitives, a
/// bounding-volume hierarchy over triangles with angle-weighted pseudonormals for meshes
/// (Baerentzen and Aanaes 2005), the smallest part for a union (exact outside, a lower bound of
/// depth inside). The gradient is a unit vector everywhere, also inside and on medial axes.
/// Immutable, safe to share between threads.
class SignedDistance {
 public:
  explicit SignedDistance(const Shape& shape);
  ~SignedDistance();
  SignedDistance(SignedDistance&&) noexcept;
  SignedDistance& operator=(SignedDistance&&) noexcept;

  double Calc(const Vector3& p_B) const;
  DistanceSample CalcWithGradient(const Vector3& p_B) const;

  /// The surface point nearest to p_B, with its outward normal in `nhat` (which may be null). From
  /// inside overlapping parts of a union it is a point of the outer surface, not always the nearest
  /// one.
  Vector3 Project(const Vector3& p_B, Vector3* nhat) const;

  /// What a contact of a plan or grasp is, everywhere: a point near p_B of a face of the outer
  /// surface, at least kEdgeInset inside every sharp convex edge (CalcEdgeInset on narrow faces),
  /// with the outward unit normal of the true shape there. Deterministic. The nearest such point of
  /// box, cylinder, capsule and sphere; near the nearest on meshes and where parts of a union meet.
  FacePoint ProjectToFace(const Vector3& p_B) const;

  /// Of the shape, in B.
  const AlignedBox& bounds() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// Signed distance to the world around the object: the smallest over all bodies but body 0.
class EnvironmentDistance {
 public:
  explicit EnvironmentDistance(const Scene& scene);

  /// At a world point with every body at its start, or at `X_WB` (one pose per scene body; body 0's
  /// is not used).
  DistanceSample Calc(const Vector3& p_W) const;
  DistanceSample Calc(const Vector3& p_W, const std::vector<RigidTransform>& X_WB) const;

 private:
  std::vector<SignedDistance> distances_;  // of bodies 1, 2, ..
  SignedDistance start_;                   // all of them in W
};

}  // namespace pregrasp
