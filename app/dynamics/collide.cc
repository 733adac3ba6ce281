#include "app/dynamics/collide.h"

namespace pregrasp {

using internal::CollideBoxes;
using internal::CollideConvex;
using internal::CollideWithBoxFace;
using internal::FaceOutcome;
using internal::kFaceOfB;

namespace {

// Contact of `larger` and `smaller`, normal from the first to the second. The larger shape's faces
// come first: it is the table, the shelf, the wall, and a plane that does not sway.
bool CollideOrdered(const PlacedConvex& larger, const PlacedConvex& smaller, double margin,
                    Manifold* manifold) {
  const bool box_larger = larger.convex->kind == ConvexKind::kBox;
  const bool box_smaller = smaller.convex->kind == ConvexKind::kBox;
  if (box_larger) {
    const FaceOutcome outcome = CollideWithBoxFace(larger, smaller, margin, 0, manifold);
    if (outcome != FaceOutcome::kNotApplicable) return outcome == FaceOutcome::kTouching;
  }
  if (box_smaller) {
    const FaceOutcome outcome = CollideWithBoxFace(smaller, larger, margin, kFaceOfB, manifold);
    if (outcome == FaceOutcome::kTouching) manifold->nhat_W = -manifold->nhat_W;
    if (outcome != FaceOutcome::kNotApplicable) return outcome == FaceOutcome::kTouching;
  }
  return box_larger && box_smaller ? CollideBoxes(larger, smaller, margin, manifold)
                                   : CollideConvex(larger, smaller, margin, manifold);
}

}  // namespace

bool Collide(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold) {
  manifold->Clear();
  if (a.convex->half.sum() >= b.convex->half.sum()) {
    return CollideOrdered(a, b, margin, manifold);
  }
  const bool found = CollideOrdered(b, a, margin, manifold);
  manifold->nhat_W = -manifold->nhat_W;
  return found;
}

}  // namespace pregrasp
