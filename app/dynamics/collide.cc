#include "app/dynamics/collide.h"

namespace pregrasp {

using internal::CollideBoxes;
using internal::CollideConvex;
using internal::CollideWithBoxFace;
using internal::FaceOutcome;
using internal::kFaceOfB;

bool Collide(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold) {
  manifold->Clear();
  // The box with the larger face first: it is the table, the shelf, the wall.
  const bool a_larger = a.convex->half.sum() >= b.convex->half.sum();
  for (const bool a_first : {a_larger, !a_larger}) {
    const PlacedConvex& face = a_first ? a : b;
    if (face.convex->kind != ConvexKind::kBox) continue;
    const FaceOutcome outcome = CollideWithBoxFace(face, a_first ? b : a, margin, manifold);
    if (outcome == FaceOutcome::kApart) return false;
    if (outcome == FaceOutcome::kTouching) {
      if (!a_first) {
        manifold->nhat_W = -manifold->nhat_W;
        for (int i = 0; i < manifold->size; ++i) manifold->points[i].feature |= kFaceOfB;
      }
      return true;
    }
  }
  if (a.convex->kind == ConvexKind::kBox && b.convex->kind == ConvexKind::kBox) {
    return CollideBoxes(a, b, margin, manifold);
  }
  return CollideConvex(a, b, margin, manifold);
}

}  // namespace pregrasp
