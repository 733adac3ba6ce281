#include "app/dynamics/contact_set.h"

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/dynamics/collide.h"

namespace pregrasp {
namespace {

// Key layout: body a, body b (12 bits each), piece a, piece b (10 bits each), feature (20 bits).
constexpr int kMaxBodies = 1 << 12, kMaxPieces = 1 << 10;

// Overlap that the solver leaves alone anyway [m].
constexpr double kMaxOverlap = 1e-6;
constexpr double kMaxSinking = 1e-7;

std::uint64_t MakeKey(int body_a, int body_b, int piece_a, int piece_b) {
  return (static_cast<std::uint64_t>(body_a) << 52) | (static_cast<std::uint64_t>(body_b) << 40) |
         (static_cast<std::uint64_t>(piece_a) << 30) |
         (static_cast<std::uint64_t>(piece_b) << kFeatureBits);
}

CollisionScene::Scratch::Bounds BoundsOf(const Matrix3& R_WB, const Vector3& p_WB,
                                         const Vector3& p_BBox, const Vector3& half) {
  const Vector3 center = p_WB + R_WB * p_BBox;
  const Vector3 extent = R_WB.cwiseAbs() * half;
  return {center - extent, center + extent, 0.0};
}

bool Overlaps(const CollisionScene::Scratch::Bounds& a, const CollisionScene::Scratch::Bounds& b,
              double margin) {
  return a.low.x() - b.high.x() <= margin && b.low.x() - a.high.x() <= margin &&
         a.low.y() - b.high.y() <= margin && b.low.y() - a.high.y() <= margin &&
         a.low.z() - b.high.z() <= margin && b.low.z() - a.high.z() <= margin;
}

PlacedConvex Place(const Convex& convex, const Matrix3& R_WB, const Vector3& p_WB) {
  PlacedConvex placed;
  placed.convex = &convex;
  placed.R_WP = convex.is_aligned ? R_WB : Matrix3(R_WB * convex.X_BP.linear());
  placed.p_WP = p_WB + R_WB * convex.X_BP.translation();
  return placed;
}

// Names the points of the pieces `key` that bore load, and takes them and all before them off
// `cache`, which is in the order of the keys.
void TakeLoaded(std::uint64_t key, std::span<const WorldState::CachedImpulse>* cache,
                Manifold* manifold) {
  while (!cache->empty() && cache->front().key < key) *cache = cache->subspan(1);
  while (!cache->empty() && cache->front().key >> kFeatureBits == key >> kFeatureBits) {
    manifold->loaded[manifold->num_loaded++] = static_cast<std::uint32_t>(cache->front().key - key);
    *cache = cache->subspan(1);
  }
}

// How the gap of a contact changes in the step.
Approach CalcApproach(const Contact& contact, const std::vector<BodyMotion>& motions,
                      const std::vector<BodyStep>& steps) {
  const ContactPlane& plane = contact.manifold.plane;
  Vector3 shift = Vector3::Zero(), turn = Vector3::Zero();  // of b relative to a
  const auto add = [&](int movable, double sign) {
    if (movable < 0) return;
    const BodyStep& step = steps[movable];
    shift += sign * (step.shift_W + step.turn_W.cross(plane.p_WO - motions[movable].p_WBcm));
    turn += sign * step.turn_W;
  };
  add(contact.movable_a, -1.0);
  add(contact.movable_b, 1.0);
  return Approach(shift, turn, contact.manifold.nhat_W, plane);
}

// The deepest point at the end of the step, if it is left out, if it sinks in, and if it is deeper
// than those that are not.
const PlanarPoint* FindOverlapping(const Manifold& manifold, const Approach& approach,
                                   const PlanarPoint* points) {
  const PlanarPoint* deepest = nullptr;
  double least = -kMaxSinking;
  for (int i = 0; i < manifold.num_face_points; ++i) {
    const double gap = points[i].phi + approach.At(points[i].x, points[i].y);
    if (gap > least) continue;
    if (gap > points[i].phi - kMaxSinking && gap > -kMaxOverlap) continue;
    if (manifold.Has(points[i].feature)) continue;
    least = gap;
    deepest = &points[i];
  }
  if (deepest == nullptr) return nullptr;
  for (int i = 0; i < manifold.num_face_points; ++i) {
    const double gap = points[i].phi + approach.At(points[i].x, points[i].y);
    if (gap < least + kMaxSinking && manifold.Has(points[i].feature)) return nullptr;
  }
  return deepest;
}

}  // namespace

CollisionScene::CollisionScene(const Scene& scene, double margin) : margin_(margin) {
  const int num_bodies = static_cast<int>(scene.bodies.size());
  PREGRASP_CHECK(num_bodies < kMaxBodies, num_bodies);
  int movable = 0;
  for (const Body& body : scene.bodies) {
    CollisionBody& collision = bodies_.emplace_back();
    collision.pieces = BuildConvexPieces(body.shape);
    if (collision.pieces.empty()) {
      throw InputError(body.where, body.name + ".shape", "a shape with volume",
                       std::string("a ") + ShapeKind(body.shape));
    }
    PREGRASP_CHECK(static_cast<int>(collision.pieces.size()) < kMaxPieces, body.name);
    Vector3 low = Vector3::Constant(1e300), high = -low;
    for (const Convex& piece : collision.pieces) {
      const auto box =
          BoundsOf(piece.X_BP.linear(), piece.X_BP.translation(), Vector3::Zero(), piece.half);
      low = low.cwiseMin(box.low);
      high = high.cwiseMax(box.high);
    }
    collision.p_BBox = 0.5 * (low + high);
    collision.half = 0.5 * (high - low);
    fixed_bounds_.push_back(
        BoundsOf(body.X_WB.linear(), body.X_WB.translation(), collision.p_BBox, collision.half));
    if (body.movable()) {
      collision.movable = movable++;
      collision.first_placed = num_movable_pieces_;
      num_movable_pieces_ += static_cast<int>(collision.pieces.size());
    } else {
      collision.first_placed = static_cast<int>(placed_.size());
      for (const Convex& piece : collision.pieces) {
        placed_.push_back(Place(piece, body.X_WB.linear(), body.X_WB.translation()));
      }
    }
  }
  // placed_ points into bodies_, which has stopped growing; vectors keep their storage when moved.
  std::size_t next = 0;
  for (CollisionBody& collision : bodies_) {
    if (collision.movable >= 0) continue;
    for (const Convex& piece : collision.pieces) placed_[next++].convex = &piece;
  }
  for (int a = 0; a < num_bodies; ++a) {
    for (int b = a + 1; b < num_bodies; ++b) {
      if (!scene.bodies[a].movable() && !scene.bodies[b].movable()) continue;
      pairs_.push_back({a, b, std::min(scene.bodies[a].friction, scene.bodies[b].friction)});
    }
  }
}

double CollisionScene::CalcReach(int body, const Vector3& p_B) const {
  double reach = 0.0;
  for (const Convex& piece : bodies_[body].pieces) {
    // The farthest corner of the piece's bounding box.
    const Vector3 p_P = piece.X_BP.inverse() * p_B;
    reach = std::max(reach, (p_P.cwiseAbs() + piece.half).norm());
  }
  return reach;
}

void CollisionScene::PlaceMovables(const std::vector<BodyKernel>& kernels,
                                   const std::vector<BodyMotion>& motions, double dt,
                                   Scratch* scratch) const {
  scratch->pieces.resize(num_movable_pieces_);
  scratch->bounds.resize(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const CollisionBody& body = bodies_[kernels[i].body];
    const BodyMotion& motion = motions[i];
    for (std::size_t k = 0; k < body.pieces.size(); ++k) {
      PlacedConvex& placed = scratch->pieces[body.first_placed + k];
      placed = Place(body.pieces[k], motion.R_WB, motion.p_WB);
      placed.turn_W = dt * motion.w_WB;
      placed.shift_W = dt * motion.v_WBcm + placed.turn_W.cross(placed.p_WP - motion.p_WBcm);
    }
    scratch->bounds[i] = BoundsOf(motion.R_WB, motion.p_WB, body.p_BBox, body.half);
    scratch->bounds[i].margin = dt * (motion.v_WBcm.norm() + motion.w_WB.norm() * kernels[i].reach);
  }
}

void CollisionScene::CollidePair(const Pair& pair, double margin, Scratch* scratch,
                                 std::span<const WorldState::CachedImpulse>* cache,
                                 std::vector<Contact>* contacts) const {
  const CollisionBody &a = bodies_[pair.a], &b = bodies_[pair.b];
  const auto placed = [&](const CollisionBody& body) {
    return (body.movable < 0 ? placed_.data() : scratch->pieces.data()) + body.first_placed;
  };
  const PlacedConvex *pieces_a = placed(a), *pieces_b = placed(b);
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    for (std::size_t j = 0; j < b.pieces.size(); ++j) {
      Contact& contact = contacts->emplace_back();
      contact.key = MakeKey(pair.a, pair.b, static_cast<int>(i), static_cast<int>(j));
      contact.manifold.face_points = &scratch->face_points;
      TakeLoaded(contact.key, cache, &contact.manifold);
      if (!Collide(pieces_a[i], pieces_b[j], margin, &contact.manifold)) {
        contacts->pop_back();
        continue;
      }
      contact.movable_a = a.movable;
      contact.movable_b = b.movable;
      contact.body_a = pair.a;
      contact.body_b = pair.b;
      contact.friction = pair.friction;
    }
  }
}

void CollisionScene::FindContacts(const std::vector<BodyKernel>& kernels,
                                  const std::vector<BodyMotion>& motions,
                                  const std::vector<WorldState::CachedImpulse>& cache, double dt,
                                  Scratch* scratch, std::vector<Contact>* contacts) const {
  PlaceMovables(kernels, motions, dt, scratch);
  std::span<const WorldState::CachedImpulse> cache_left = cache;
  contacts->clear();
  scratch->face_points.clear();
  for (const Pair& pair : pairs_) {
    const int movable_a = bodies_[pair.a].movable, movable_b = bodies_[pair.b].movable;
    const auto& bounds_a = movable_a < 0 ? fixed_bounds_[pair.a] : scratch->bounds[movable_a];
    const auto& bounds_b = movable_b < 0 ? fixed_bounds_[pair.b] : scratch->bounds[movable_b];
    const double margin = margin_ + bounds_a.margin + bounds_b.margin;
    if (Overlaps(bounds_a, bounds_b, margin)) {
      CollidePair(pair, margin, scratch, &cache_left, contacts);
    }
  }
}

bool CollisionScene::AddOverlapping(const std::vector<BodyMotion>& motions,
                                    const std::vector<BodyStep>& steps, const Scratch& scratch,
                                    std::vector<Contact>* contacts) {
  bool added = false;
  for (Contact& contact : *contacts) {
    Manifold& manifold = contact.manifold;
    if (manifold.num_face_points == 0 || manifold.size == Manifold::kMaxPoints) continue;
    const PlanarPoint* point =
        FindOverlapping(manifold, CalcApproach(contact, motions, steps),
                        scratch.face_points.data() + manifold.first_face_point);
    if (point == nullptr) continue;
    manifold.Add(manifold.plane.At(point->x, point->y, point->phi), point->phi, point->feature);
    added = true;
  }
  return added;
}

}  // namespace pregrasp
