#include "app/dynamics/contact_set.h"

#include <algorithm>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/dynamics/collide.h"

namespace pregrasp {
namespace {

// Key layout: body a, body b (12 bits each), piece a, piece b (10 bits each), feature (20 bits).
constexpr int kMaxBodies = 1 << 12, kMaxPieces = 1 << 10, kFeatureBits = 20;

// Overlap that the solver leaves alone anyway [m].
constexpr double kMaxOverlap = 1e-6;
constexpr double kMaxSinking = 1e-7;
// Depths [m] closer than this count as equal: below it rounding errors would choose between the
// corners that two pieces have in common.
constexpr double kDepthTie = 1e-9;

std::uint64_t MakeKey(BodyIndex body_a, BodyIndex body_b, int piece_a, int piece_b) {
  return (static_cast<std::uint64_t>(body_a.value) << 52) |
         (static_cast<std::uint64_t>(body_b.value) << 40) |
         (static_cast<std::uint64_t>(piece_a) << 30) |
         (static_cast<std::uint64_t>(piece_b) << kFeatureBits);
}

Bounds BoundsOf(const Matrix3& R_WB, const Vector3& p_WBox, const Vector3& half) {
  const Vector3 extent = R_WB.cwiseAbs() * half;
  return {p_WBox - extent, p_WBox + extent};
}

void Place(const Convex& convex, const Matrix3& R_WB, const Vector3& p_WB, PlacedConvex* placed) {
  placed->convex = &convex;
  placed->R_WP = convex.is_aligned ? R_WB : Matrix3(R_WB * convex.X_BP.linear());
  placed->p_WP = p_WB + R_WB * convex.X_BP.translation();
  placed->bounds = BoundsOf(placed->R_WP, placed->p_WP, convex.half);
}

// The tangent plane of a contact, on the surface of the body that does not move, or of a.
ContactPlane PlaneOf(const Contact& contact) {
  const Manifold& manifold = contact.manifold;
  const Matrix3 frame = FrameFromNormal(manifold.nhat_W);
  const double to_other = contact.movable_b.is_none() ? -1.0 : 1.0;
  const ManifoldPoint& point = manifold.points[0];
  return {point.p_W - 0.5 * to_other * point.phi * manifold.nhat_W, frame.col(0), frame.col(1),
          to_other * manifold.nhat_W};
}

bool IsCoplanar(const ContactPlane& plane, const ContactPlane& other) {
  constexpr double kMaxTurn2 = 1e-8, kMaxShift = 1e-5;  // [rad^2], [m]
  return 1.0 - plane.nhat_W.dot(other.nhat_W) < 0.5 * kMaxTurn2 &&
         std::abs(plane.nhat_W.dot(other.p_WO - plane.p_WO)) < kMaxShift;
}

// Adds all points of a contact, those that it leaves out too, as seen in `plane`; none if there is
// no room. Returns whether there is.
bool CollectPoints(const Manifold& manifold, const ContactPlane& plane, FacePoints* points) {
  const FacePoints* face = manifold.face;
  if (points->size + (face != nullptr ? face->size : manifold.size) > FacePoints::kMaxSize) {
    return false;
  }
  const auto add = [&](const Vector3& p_W, double phi, std::uint64_t key) {
    const Vector3 p = p_W - plane.p_WO;
    points->Add(plane.x_W.dot(p), plane.y_W.dot(p), phi, key);
  };
  for (int i = 0; face != nullptr && i < face->size; ++i) {
    add(manifold.plane.At(face->x[i], face->y[i], face->phi[i]), face->phi[i],
        manifold.key + face->keys[i]);
  }
  for (int i = 0; face == nullptr && i < manifold.size; ++i) {
    const ManifoldPoint& point = manifold.points[i];
    add(point.p_W, point.phi, point.key);
  }
  return true;
}

// Pieces that overlap or adjoin have corners in common, of which one is enough. Of more than four
// points the choice sees to that.
void RemoveCopies(FacePoints* points) {
  constexpr double kSame = 1e-7;  // [m]
  const int size = points->size;
  if (size > 4) return;
  points->size = 0;
  for (int i = 0; i < size; ++i) {
    bool is_copy = false;
    for (int j = 0; j < points->size; ++j) {
      is_copy = is_copy || (std::abs(points->x[j] - points->x[i]) < kSame &&
                            std::abs(points->y[j] - points->y[i]) < kSame &&
                            std::abs(points->phi[j] - points->phi[i]) < kSame);
    }
    if (!is_copy) points->Add(points->x[i], points->y[i], points->phi[i], points->keys[i]);
  }
}

// How the gap of a contact changes in the step.
Approach CalcApproach(const Contact& contact, const std::vector<BodyMotion>& motions,
                      const std::vector<BodyStep>& steps) {
  const ContactPlane& plane = contact.manifold.plane;
  Vector3 shift = Vector3::Zero(), turn = Vector3::Zero();  // of b relative to a
  const auto add = [&](MovableIndex movable, double sign) {
    if (movable.is_none()) return;
    const BodyStep& step = steps[movable.value];
    shift += sign * (step.shift_W + step.turn_W.cross(plane.p_WO - motions[movable.value].p_WBcm));
    turn += sign * step.turn_W;
  };
  add(contact.movable_a, -1.0);
  add(contact.movable_b, 1.0);
  return Approach(shift, turn, contact.manifold.nhat_W, plane);
}

// The deepest point at the end of the step, if it is left out, if it sinks in, and if it is deeper
// than those that are not; -1 otherwise.
int FindOverlapping(const Manifold& manifold, const Approach& approach) {
  const FacePoints& points = *manifold.face;
  std::array<double, FacePoints::kMaxSize> memory;
  Eigen::Map<Eigen::ArrayXd> gaps(memory.data(), points.size);
  gaps = approach.GapsAfter(points);
  if (gaps.minCoeff() > -kMaxSinking) return -1;
  const auto is_in = [&](int i) { return manifold.Has(manifold.key + points.keys[i]); };
  int deepest = -1;
  for (int i = 0; i < points.size; ++i) {
    if (gaps[i] > (deepest < 0 ? -kMaxSinking : gaps[deepest] - kDepthTie)) continue;
    if (gaps[i] > points.phi[i] - kMaxSinking && gaps[i] > -kMaxOverlap) continue;
    if (!is_in(i)) deepest = i;
  }
  for (int i = 0; deepest >= 0 && i < points.size; ++i) {
    if (gaps[i] < gaps[deepest] + kMaxSinking && is_in(i)) return -1;
  }
  return deepest;
}

}  // namespace

std::span<const WorldState::CachedImpulse> TakePair(
    std::uint64_t pair, std::span<const WorldState::CachedImpulse>* cache) {
  std::size_t begin = 0;
  while (begin < cache->size() && PairOfKey((*cache)[begin].key) < pair) ++begin;
  std::size_t end = begin;
  while (end < cache->size() && PairOfKey((*cache)[end].key) == pair) ++end;
  const auto impulses = cache->subspan(begin, end - begin);
  *cache = cache->subspan(end);
  return impulses;
}

CollisionScene::CollisionScene(const Scene& scene, double margin) : margin_(margin) {
  const int num_bodies = static_cast<int>(scene.bodies.size());
  PREGRASP_CHECK(num_bodies < kMaxBodies, num_bodies);
  MovableIndex movable{0};
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
      const auto box = BoundsOf(piece.X_BP.linear(), piece.X_BP.translation(), piece.half);
      low = low.cwiseMin(box.low);
      high = high.cwiseMax(box.high);
    }
    collision.p_BBox = 0.5 * (low + high);
    collision.half = 0.5 * (high - low);
    fixed_bounds_.push_back(
        BoundsOf(body.X_WB.linear(), body.X_WB * collision.p_BBox, collision.half));
    if (body.movable()) {
      collision.movable = movable;
      ++movable.value;
      collision.first_placed = num_movable_pieces_;
      num_movable_pieces_ += static_cast<int>(collision.pieces.size());
    } else {
      collision.first_placed = static_cast<int>(placed_.size());
      for (const Convex& piece : collision.pieces) {
        PlacedConvex& placed = placed_.emplace_back();
        Place(piece, body.X_WB.linear(), body.X_WB.translation(), &placed);
        placed.is_upright = placed.R_WP == Matrix3::Identity();
      }
    }
  }
  // placed_ points into bodies_, which has stopped growing; vectors keep their storage when moved.
  std::size_t next = 0;
  for (CollisionBody& collision : bodies_) {
    if (!collision.movable.is_none()) continue;
    for (const Convex& piece : collision.pieces) placed_[next++].convex = &piece;
  }
  for (int a = 0; a < num_bodies; ++a) {
    for (int b = a + 1; b < num_bodies; ++b) {
      if (!scene.bodies[a].movable() && !scene.bodies[b].movable()) continue;
      pairs_.push_back({{a}, {b}, std::min(scene.bodies[a].friction, scene.bodies[b].friction)});
    }
  }
}

double CollisionScene::CalcReach(BodyIndex body, const Vector3& p_B) const {
  double reach = 0.0;
  for (const Convex& piece : bodies_[body.value].pieces) {
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
  scratch->distances.resize(motions.size());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const CollisionBody& body = bodies_[kernels[i].body.value];
    const BodyMotion& motion = motions[i];
    for (std::size_t k = 0; k < body.pieces.size(); ++k) {
      PlacedConvex& placed = scratch->pieces[body.first_placed + k];
      Place(body.pieces[k], motion.R_WB, motion.p_WB, &placed);
      placed.turn_W = dt * motion.w_WB;
      placed.shift_W = dt * motion.v_WBcm + placed.turn_W.cross(placed.p_WP - motion.p_WBcm);
    }
    scratch->bounds[i] =
        body.pieces.size() == 1
            ? scratch->pieces[body.first_placed].bounds
            : BoundsOf(motion.R_WB, motion.p_WB + motion.R_WB * body.p_BBox, body.half);
    scratch->distances[i] = dt * (motion.v_WBcm.norm() + motion.w_WB.norm() * kernels[i].reach);
  }
}

void CollisionScene::CollidePair(const Pair& pair, double margin, Scratch* scratch,
                                 std::span<const WorldState::CachedImpulse> loaded,
                                 std::vector<Contact>* contacts) const {
  const CollisionBody &a = bodies_[pair.a.value], &b = bodies_[pair.b.value];
  const PlacedConvex *pieces_a = Placed(a, *scratch), *pieces_b = Placed(b, *scratch);
  const Bounds& bounds_b = GetBounds(pair.b, *scratch);
  // Where each body is one piece, their bounds have met already.
  const bool several = a.pieces.size() > 1 || b.pieces.size() > 1;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    if (several && !pieces_a[i].bounds.IsWithin(margin, bounds_b)) continue;
    for (std::size_t j = 0; j < b.pieces.size(); ++j) {
      if (several && !pieces_a[i].bounds.IsWithin(margin, pieces_b[j].bounds)) continue;
      Contact& contact = contacts->emplace_back();
      contact.manifold.key = MakeKey(pair.a, pair.b, static_cast<int>(i), static_cast<int>(j));
      contact.manifold.loaded = loaded;
      contact.manifold.store = &scratch->faces;
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
  scratch->faces.Clear();
  const auto distance = [&](MovableIndex movable) {
    return movable.is_none() ? 0.0 : scratch->distances[movable.value];
  };
  for (const Pair& pair : pairs_) {
    const CollisionBody &a = bodies_[pair.a.value], &b = bodies_[pair.b.value];
    const double margin = margin_ + distance(a.movable) + distance(b.movable);
    if (GetBounds(pair.a, *scratch).IsWithin(margin, GetBounds(pair.b, *scratch))) {
      const auto loaded = TakePair(PairOfKey(MakeKey(pair.a, pair.b, 0, 0)), &cache_left);
      const std::size_t first = contacts->size();
      CollidePair(pair, margin, scratch, loaded, contacts);
      if (contacts->size() > first + 1) MergeCoplanar(first, scratch, contacts);
    }
  }
}

// Where several pieces of the two bodies touch along one plane, their points make one contact: a
// cup on a table rests on four points, not on four for each sector of its foot.
void CollisionScene::MergeCoplanar(std::size_t first, Scratch* scratch,
                                   std::vector<Contact>* contacts) const {
  std::size_t kept = first;
  for (std::size_t i = first; i < contacts->size(); ++i) {
    Contact& contact = (*contacts)[i];
    if (contact.manifold.size == 0) continue;  // taken by one before
    FacePoints* points = scratch->faces.Next();
    const ContactPlane plane = PlaneOf(contact);
    CollectPoints(contact.manifold, plane, points);
    bool merged = false;
    for (std::size_t j = i + 1; j < contacts->size(); ++j) {
      Contact& other = (*contacts)[j];
      if (other.manifold.size == 0 || !IsCoplanar(plane, PlaneOf(other))) continue;
      if (!CollectPoints(other.manifold, plane, points)) continue;
      other.manifold.size = 0;
      merged = true;
    }
    if (merged) {
      Manifold& manifold = contact.manifold;
      manifold.Clear();
      manifold.key = 0;  // the points' keys are whole
      RemoveCopies(points);
      // All pieces of a body move as one.
      const PlacedConvex& a = *Placed(bodies_[contact.body_a.value], *scratch);
      const PlacedConvex& b = *Placed(bodies_[contact.body_b.value], *scratch);
      AddFacePoints(*points, plane, Approach(a, b, manifold.nhat_W, plane), &manifold);
    }
    if (kept != i) (*contacts)[kept] = contact;
    ++kept;
  }
  contacts->resize(kept);
}

bool CollisionScene::AddOverlapping(const std::vector<BodyMotion>& motions,
                                    const std::vector<BodyStep>& steps,
                                    std::vector<Contact>* contacts) {
  bool added = false;
  for (Contact& contact : *contacts) {
    Manifold& manifold = contact.manifold;
    if (manifold.face == nullptr || manifold.size == Manifold::kMaxPoints) continue;
    const int i = FindOverlapping(manifold, CalcApproach(contact, motions, steps));
    if (i < 0) continue;
    const FacePoints& face = *manifold.face;
    manifold.Add(manifold.plane.At(face.x[i], face.y[i], face.phi[i]), face.phi[i], face.keys[i]);
    added = true;
  }
  return added;
}

}  // namespace pregrasp
