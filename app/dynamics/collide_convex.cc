#include <algorithm>
#include <array>
#include <limits>

#include "app/dynamics/collide.h"
#include "app/dynamics/feature.h"
#include "app/dynamics/gjk.h"
#include "app/dynamics/support.h"

namespace pregrasp::internal {
namespace {

// A contact is as deep as its axis says but for this [m]; if the features hold no such point, the
// nearest points themselves are the contact.
constexpr double kDepthTolerance = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  Vector3 nhat_W;  // from A to B
  double separation;
  double penalty;  // taken off the separation when candidates are compared
  bool is_face;    // its points must overlap by more than a sliver
  Vector3 p_WC;    // midway between the nearest points, unless it is a face
};

// The directions along which a pair may touch, best first.
class AxisSearch {
 public:
  AxisSearch(const PlacedConvex& a, const PlacedConvex& b, double margin)
      : a_(a), b_(b), margin_(margin) {}

  bool Collide(Manifold* manifold) {
    if (!AddFaces(a_, b_, false) || !AddFaces(b_, a_, true)) return false;
    if (count_ == 0 || candidates_[0].separation < -kMinOverlap) {
      if (!AddSides() || !AddRefined()) return false;
    }
    const double best = count_ > 0 ? Rank(0) : 0.0;
    for (int i = 0; i < count_ && Rank(i) >= best - kEdgeBias; ++i) {
      const OverlapResult result = AddContact(candidates_[i], manifold);
      const bool found = result == OverlapResult::kTouching;
      if (found &&
          !(candidates_[i].is_face && IsBesideFace(*manifold, candidates_[i].separation))) {
        return true;
      }
      if (found) {
        if (grazes_) return true;
        break;
      }
      // A face that overlaps in a sliver only is given up for another that is as near.
      grazes_ = grazes_ || result == OverlapResult::kSliver;
    }
    if (slides_) return false;
    return CollideNearestPoints(grazes_ ? kSlideReach : -kInfinity, manifold);
  }

  // Contact where the shapes are nearest, whatever features that involves.
  bool CollideNearestPoints(double min_distance, Manifold* manifold) {
    manifold->Clear();
    count_ = 0;
    if (!AddSides() || !AddRefined() || candidates_[0].separation < min_distance) return false;
    return AddContact(candidates_[0], manifold) == OverlapResult::kTouching;
  }

 private:
  double Rank(int i) const { return candidates_[i].separation - candidates_[i].penalty; }

  // Keeps the list in order. Returns false if the shapes are apart along the candidate.
  bool Add(const Candidate& candidate) {
    if (candidate.separation > margin_) return false;
    int i = count_++;
    for (; i > 0 && Rank(i - 1) < candidate.separation - candidate.penalty; --i) {
      candidates_[i] = candidates_[i - 1];
    }
    candidates_[i] = candidate;
    return true;
  }

  // The faces of `owner`, or a cylinder's ends: the one that separates most.
  bool AddFaces(const PlacedConvex& owner, const PlacedConvex& other, bool flip) {
    const Convex& convex = *owner.convex;
    Candidate best{Vector3::Zero(), -kInfinity, flip ? kFaceBias : 0.0, true, Vector3::Zero()};
    const auto consider = [&](const Vector3& nhat_W, double offset) {
      const double separation =
          nhat_W.dot(CalcSupport(other, -nhat_W) - owner.p_WP) - offset - CoreRadius(*other.convex);
      if (IsGrazing(separation)) {
        grazes_ = true;
        slides_ = slides_ || MoveAlong(owner, other, nhat_W);
      }
      if (separation <= best.separation) return;
      best.separation = separation;
      best.nhat_W = flip ? -nhat_W : nhat_W;
    };
    if (convex.kind == ConvexKind::kCylinder) {
      const Vector3 axis = owner.R_WP.col(2);
      consider(axis, convex.half_height);
      consider(-axis, convex.half_height);
    } else if (convex.kind != ConvexKind::kCapsule) {
      for (const Polytope::Face& face : convex.polytope->faces) {
        consider(owner.R_WP * face.nhat, face.offset);
        if (best.separation > margin_) return false;
      }
    } else {
      return true;
    }
    return Add(best);
  }

  // Round sides: the direction between the nearest points of the shapes' axes, made radial.
  bool AddSides() {
    const bool round_a = IsRound(a_), round_b = IsRound(b_);
    if (!round_a && !round_b) return true;
    Convex axis_a, axis_b;
    const PlacedConvex core_a = AxisOf(a_, &axis_a), core_b = AxisOf(b_, &axis_b);
    const CoreDistance cores = CalcCoreDistance(core_a, core_b);
    if (!cores.apart) return true;
    Candidate candidate{cores.nhat_W, 0.0, 0.0, false, Vector3::Zero()};
    for (const PlacedConvex* placed : {&a_, &b_}) {
      if (placed->convex->kind != ConvexKind::kCylinder) continue;
      const Vector3 axis = placed->R_WP.col(2);
      const double c = axis.dot(candidate.nhat_W);
      if (std::abs(c) > 0.5) return true;  // an end, not the side
      candidate.nhat_W = (candidate.nhat_W - c * axis).normalized();
    }
    candidate.separation = CalcSeparation(a_, b_, candidate.nhat_W);
    const double radii = CoreRadius(*core_a.convex) - CoreRadius(*core_b.convex);
    candidate.p_WC = 0.5 * (cores.p_WA + cores.p_WB + radii * candidate.nhat_W);
    return Add(candidate);
  }

  static bool IsRound(const PlacedConvex& placed) {
    return placed.convex->kind == ConvexKind::kCylinder ||
           placed.convex->kind == ConvexKind::kCapsule;
  }

  // A cylinder as the capsule around its axis, held by `axis`; others as they are.
  static PlacedConvex AxisOf(const PlacedConvex& placed, Convex* axis) {
    if (placed.convex->kind != ConvexKind::kCylinder) return placed;
    axis->kind = ConvexKind::kCapsule;
    axis->radius = placed.convex->radius;
    axis->half_height = placed.convex->half_height;
    PlacedConvex placed_axis = placed;
    placed_axis.convex = axis;
    return placed_axis;
  }

  // Edges against edges and rims: climbs from the best direction so far.
  bool AddRefined() {
    if (count_ > 0 && !candidates_[0].is_face && !HasEdges(a_) && !HasEdges(b_)) return true;
    const Vector3 start =
        count_ > 0 ? candidates_[0].nhat_W
                   : Vector3((b_.p_WP - a_.p_WP + 1e-12 * Vector3::UnitZ()).normalized());
    const ContactAxis axis = RefineAxis(a_, b_, start);
    return Add({axis.nhat_W, axis.separation, kEdgeBias, false, 0.5 * (axis.p_WA + axis.p_WB)});
  }

  static bool HasEdges(const PlacedConvex& placed) {
    return placed.convex->kind != ConvexKind::kCapsule;
  }

  OverlapResult AddContact(const Candidate& candidate, Manifold* manifold) {
    FindFeature(a_, candidate.nhat_W, &feature_a_);
    FindFeature(b_, -candidate.nhat_W, &feature_b_);
    const OverlapResult result =
        OverlapFeatures(a_, b_, feature_a_, feature_b_, candidate.nhat_W, margin_, manifold);
    if (candidate.is_face) return result;
    double deepest = kInfinity;
    for (int i = 0; i < manifold->size; ++i) deepest = std::min(deepest, manifold->points[i].phi);
    if (deepest > candidate.separation + kDepthTolerance) {
      manifold->Clear();
      manifold->nhat_W = candidate.nhat_W;
      manifold->Add(candidate.p_WC, candidate.separation, 0);
    }
    return OverlapResult::kTouching;
  }

  const PlacedConvex &a_, &b_;
  const double margin_;
  std::array<Candidate, 4> candidates_;
  int count_ = 0;
  bool grazes_ = false;  // one shape may pass along a face of the other without touching
  bool slides_ = false;  // and moves that way
  Feature feature_a_, feature_b_;
};

}  // namespace

bool CollideNearestPoints(const PlacedConvex& a, const PlacedConvex& b, double margin,
                          double min_distance, Manifold* manifold) {
  return AxisSearch(a, b, margin).CollideNearestPoints(min_distance, manifold);
}

bool CollideConvex(const PlacedConvex& a, const PlacedConvex& b, double margin,
                   Manifold* manifold) {
  return AxisSearch(a, b, margin).Collide(manifold);
}

}  // namespace pregrasp::internal
