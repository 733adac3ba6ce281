#include <algorithm>
#include <cmath>

#include "app/dynamics/collide.h"
#include "app/dynamics/feature.h"
#include "app/dynamics/rim.h"

namespace pregrasp {
namespace {

using Kind = Feature::Kind;

// Points this little outside an outline count as inside [m]: edges that coincide but for rounding
// would cross anywhere.
constexpr double kWeld = 1e-6;
// Faces steeper than this cosine against the contact's plane have no useful height over it.
constexpr double kMinCosine = 0.05;
// Discs tilted by less than this [rad] are circles seen along the normal but for 0.1 % of their
// size.
constexpr double kLeastSlope = 0.05;
// Lines within this angle [rad] lie along each other.
constexpr double kParallel = 2e-3;

constexpr int kMaxCandidates = FacePoints::kMaxSize;

// A feature seen along the contact normal: x and y in the tangent plane, heights along the normal.
struct Outline {
  Kind kind;
  int size;
  std::array<Vector3, Feature::kMaxCorners> points;  // x, y, height; the centre of a disc
  const std::uint32_t* ids;
  Vector2 gradient = Vector2::Zero();  // of the height over x and y, of polygons and discs
  double orientation = 1.0;            // -1 if the corners run clockwise
  Vector2 u = Vector2::Zero(), w = Vector2::Zero();  // a disc's half axes, projected
  double radius = 0.0;
  Eigen::Matrix2d to_unit;  // maps the projected disc to the unit disc
  bool steep = false;

  double Height(double x, double y) const {
    return points[0].z() + gradient.x() * (x - points[0].x()) + gradient.y() * (y - points[0].y());
  }
  bool is_region() const { return kind == Kind::kPolygon || kind == Kind::kDisc; }

  // Distance of (x, y) inside edge i of a polygon.
  double Inside(int i, double x, double y) const {
    const Vector3 &p = points[i], &q = points[i + 1 == size ? 0 : i + 1];
    const double dx = q.x() - p.x(), dy = q.y() - p.y();
    const double length = std::hypot(dx, dy);
    if (length == 0.0) return 1.0;
    return orientation * (dx * (y - p.y()) - dy * (x - p.x())) / length;
  }

  Vector2 ToUnitDisc(double x, double y) const {
    return to_unit * Vector2(x - points[0].x(), y - points[0].y());
  }

  bool Contains(double x, double y) const {
    if (kind == Kind::kDisc) {
      return ToUnitDisc(x, y).norm() <= 1.0 + kWeld * to_unit.norm();
    }
    for (int i = 0; i < size; ++i) {
      if (Inside(i, x, y) < -kWeld) return false;
    }
    return true;
  }
};

struct Candidate {
  double x, y, height_a, height_b;
  std::uint32_t id;
};

class Overlap {
 public:
  Overlap(const PlacedConvex& a, const PlacedConvex& b, const Feature& feature_a,
          const Feature& feature_b, const Vector3& nhat_W)
      : R_WT_(FrameFromNormal(nhat_W)),
        origin_(feature_a.points[0]),
        plane_{origin_, R_WT_.col(0), R_WT_.col(1), R_WT_.col(2)},
        approach_(a, b, nhat_W, plane_) {
    Project(feature_a, &a_);
    Project(feature_b, &b_);
  }

  OverlapResult Find(double margin, Manifold* manifold) {
    if (a_.steep || b_.steep) return OverlapResult::kNone;
    if (a_.is_region() && b_.is_region()) {
      AddRegions();
    } else if (a_.is_region()) {
      AddLine(a_, b_, false);
    } else if (b_.is_region()) {
      AddLine(b_, a_, true);
    } else {
      AddLines();
    }
    if (count_ == 0) return OverlapResult::kNone;
    if (IsSliver(a_) || IsSliver(b_)) return OverlapResult::kSliver;
    return Report(margin, manifold);
  }

 private:
  void Project(const Feature& feature, Outline* outline) const {
    outline->kind = feature.kind;
    outline->size = feature.size;
    outline->ids = feature.ids.data();
    for (int i = 0; i < feature.size; ++i) {
      outline->points[i] = R_WT_.transpose() * (feature.points[i] - origin_);
    }
    if (!outline->is_region()) return;
    const Vector3 nhat = R_WT_.transpose() * feature.nhat_W;
    outline->steep = std::abs(nhat.z()) < kMinCosine;
    if (outline->steep) return;
    outline->gradient = -nhat.head<2>() / nhat.z();
    outline->orientation = nhat.z() > 0.0 ? 1.0 : -1.0;
    if (feature.kind == Kind::kDisc) {
      outline->u = (R_WT_.transpose() * feature.u_W).head<2>();
      outline->w = (R_WT_.transpose() * feature.w_W).head<2>();
      outline->radius = feature.u_W.norm();
      Eigen::Matrix2d from_unit;
      from_unit << outline->u, outline->w;
      outline->to_unit = from_unit.inverse();
    }
  }

  void Add(double x, double y, double height_a, double height_b, std::uint32_t id) {
    if (count_ == kMaxCandidates) return;
    candidates_[count_++] = {x, y, height_a, height_b, id};
  }
  void AddAt(double x, double y, std::uint32_t id) {
    Add(x, y, a_.Height(x, y), b_.Height(x, y), id);
  }

  // Corners, or four points of the rim, of `region` that lie over `other`. Returns whether all do.
  bool AddCorners(const Outline& region, const Outline& other, std::uint32_t base) {
    bool all = true;
    if (region.kind == Kind::kPolygon) {
      for (int i = 0; i < region.size; ++i) {
        const double x = region.points[i].x(), y = region.points[i].y();
        if (other.Contains(x, y)) {
          AddAt(x, y, base + region.ids[i]);
        } else {
          all = false;
        }
      }
      return all;
    }
    const Vector2 slope = b_.gradient - a_.gradient;
    const Vector2 slope_next = slope + Vector2(approach_.per_x, approach_.per_y);
    const auto down = [&region](const Vector2& s) -> Vector2 {
      return Vector2(-s.dot(region.u), -s.dot(region.w)) / region.radius;
    };
    const RimPoints rim = ChooseRimPoints(region.radius, down(slope), down(slope_next));
    for (int k = 0; k < 4; ++k) {
      const Vector2& r = rim.directions[k];
      const Vector2 p = region.points[0].head<2>() + r.x() * region.u + r.y() * region.w;
      if (other.Contains(p.x(), p.y())) {
        AddAt(p.x(), p.y(), base + rim.ids[k]);
      } else {
        all = false;
      }
    }
    if (!all || other.kind == Kind::kDisc) return all;
    // Four points inside a polygon do not mean that the whole disc is.
    for (int i = 0; i < other.size; ++i) {
      const double reach = RimReach(region, other, i);
      if (other.Inside(i, region.points[0].x(), region.points[0].y()) < reach) return false;
    }
    return true;
  }

  // How far a disc reaches beyond its centre towards edge i of a polygon.
  static double RimReach(const Outline& disc, const Outline& polygon, int i) {
    const double x = disc.points[0].x(), y = disc.points[0].y();
    const double at_center = polygon.Inside(i, x, y);
    return std::hypot(polygon.Inside(i, x + disc.u.x(), y + disc.u.y()) - at_center,
                      polygon.Inside(i, x + disc.w.x(), y + disc.w.y()) - at_center);
  }

  void AddRegions() {
    const bool b_within = AddCorners(b_, a_, 0);
    round_ = b_within && b_.kind == Kind::kDisc;
    if (b_within) return;
    count_b_ = count_;
    const bool a_within = AddCorners(a_, b_, 512);
    round_ = a_within && a_.kind == Kind::kDisc;
    if (a_within) return;
    if (a_.kind == Kind::kPolygon && b_.kind == Kind::kPolygon) {
      AddEdgeCrossings();
    } else if (a_.kind == Kind::kPolygon) {
      AddRimCrossings(a_, b_);
    } else if (b_.kind == Kind::kPolygon) {
      AddRimCrossings(b_, a_);
    } else {
      AddDiscCrossings();
    }
  }

  // Whether two distances lie on opposite sides of a line, both by more than rounding.
  static bool Straddles(double d0, double d1) {
    return std::min(d0, d1) < -kWeld && std::max(d0, d1) > kWeld;
  }

  void AddEdgeCrossings() {
    for (int i = 0; i < a_.size; ++i) {
      const Vector3 &p = a_.points[i], &q = a_.points[i + 1 == a_.size ? 0 : i + 1];
      for (int j = 0; j < b_.size; ++j) {
        const Vector3 &r = b_.points[j], &s = b_.points[j + 1 == b_.size ? 0 : j + 1];
        const double d_r = a_.Inside(i, r.x(), r.y()), d_s = a_.Inside(i, s.x(), s.y());
        if (!Straddles(d_r, d_s)) continue;
        if (!Straddles(b_.Inside(j, p.x(), p.y()), b_.Inside(j, q.x(), q.y()))) continue;
        const double t = d_r / (d_r - d_s);
        AddAt(r.x() + t * (s.x() - r.x()), r.y() + t * (s.y() - r.y()),
              1024U + static_cast<std::uint32_t>(i * Feature::kMaxCorners + j));
      }
    }
  }

  // Where the rim of a disc crosses the edges of a polygon.
  void AddRimCrossings(const Outline& polygon, const Outline& disc) {
    for (int i = 0; i < polygon.size; ++i) {
      const Vector3& p = polygon.points[i];
      const Vector3& q = polygon.points[i + 1 == polygon.size ? 0 : i + 1];
      double t[2];
      const int crossings =
          CrossUnitCircle(disc.ToUnitDisc(p.x(), p.y()), disc.ToUnitDisc(q.x(), q.y()), t);
      for (int k = 0; k < crossings; ++k) {
        if (t[k] < 0.0 || t[k] > 1.0) continue;
        AddAt(p.x() + t[k] * (q.x() - p.x()), p.y() + t[k] * (q.y() - p.y()),
              1024U + static_cast<std::uint32_t>(2 * i + k));
      }
    }
  }

  // Parameters where the line from p to q meets the unit circle, ascending; none if it only grazes.
  static int CrossUnitCircle(const Vector2& p, const Vector2& q, double t[2]) {
    const Vector2 d = q - p;
    const double a = d.squaredNorm(), b = p.dot(d), c = p.squaredNorm() - 1.0;
    const double discriminant = b * b - a * c;
    if (a == 0.0 || discriminant <= 1e-10 * a) return 0;
    const double root = std::sqrt(discriminant);
    t[0] = (-b - root) / a;
    t[1] = (-b + root) / a;
    return 2;
  }

  // Discs that lie on each other are circles seen along the normal but for the square of their
  // tilt.
  void AddDiscCrossings() {
    if (a_.gradient.norm() > kLeastSlope || b_.gradient.norm() > kLeastSlope) return;
    const Vector2 c_a = a_.points[0].head<2>(), d = b_.points[0].head<2>() - c_a;
    const double r_a = std::max(a_.u.norm(), a_.w.norm());
    const double r_b = std::max(b_.u.norm(), b_.w.norm());
    const double distance = d.norm();
    if (distance < kWeld || distance >= r_a + r_b || distance <= std::abs(r_a - r_b)) return;
    const double along = 0.5 * (distance * distance + r_a * r_a - r_b * r_b) / distance;
    const double across = std::sqrt(std::max(0.0, r_a * r_a - along * along));
    const Vector2 x = d / distance, y(-x.y(), x.x());
    for (int k = 0; k < 2; ++k) {
      const Vector2 p = c_a + along * x + (k == 0 ? across : -across) * y;
      AddAt(p.x(), p.y(), 1024U + k);
    }
  }

  // The part of a segment, or the point, that lies over a region.
  void AddLine(const Outline& region, const Outline& line, bool swapped) {
    const auto add = [&](double x, double y, double height, std::uint32_t id) {
      const double under = region.Height(x, y);
      Add(x, y, swapped ? height : under, swapped ? under : height, id);
    };
    const Vector3& p = line.points[0];
    const Vector3& q = line.points[line.size - 1];
    double low = 0.0, high = 1.0;
    std::uint32_t low_id = 0, high_id = 1;
    if (region.kind == Kind::kPolygon) {
      for (int i = 0; i < region.size; ++i) {
        const double d0 = region.Inside(i, p.x(), p.y()) + kWeld;
        const double d1 = region.Inside(i, q.x(), q.y()) + kWeld;
        if (d0 < 0.0 && d1 < 0.0) return;
        if (d0 < 0.0 && d0 / (d0 - d1) > low) {
          low = d0 / (d0 - d1);
          low_id = 1024U + i;
        } else if (d1 < 0.0 && d0 / (d0 - d1) < high) {
          high = d0 / (d0 - d1);
          high_id = 1024U + i;
        }
      }
    } else {
      double t[2];
      const Vector2 p_unit = region.ToUnitDisc(p.x(), p.y());
      if (CrossUnitCircle(p_unit, region.ToUnitDisc(q.x(), q.y()), t) == 2) {
        if (t[0] > low) low_id = 1024U;
        if (t[1] < high) high_id = 1025U;
        low = std::max(low, t[0]);
        high = std::min(high, t[1]);
      } else if (p_unit.norm() > 1.0) {
        return;
      }
    }
    if (low > high) return;
    const Vector3 from = p + low * (q - p), to = p + high * (q - p);
    add(from.x(), from.y(), from.z(), low_id);
    if ((to - from).head<2>().norm() > kWeld || std::abs(to.z() - from.z()) > kWeld) {
      add(to.x(), to.y(), to.z(), high_id);
    }
  }

  // Two lines: along each other over a stretch, or crossing at a point.
  void AddLines() {
    const Vector3 &p = a_.points[0], &q = a_.points[a_.size - 1];
    const Vector3 &r = b_.points[0], &s = b_.points[b_.size - 1];
    const Vector3 d = q - p, e = s - r;
    const double length_d = d.head<2>().norm(), length_e = e.head<2>().norm();
    if (length_d < kWeld || length_e < kWeld) {
      // Seen from an end at least one is a point; its deepest end counts.
      const Vector3& top = length_d < kWeld && d.z() > 0.0 ? q : p;
      const Vector3& bottom = length_e < kWeld && e.z() < 0.0 ? s : r;
      AddNearestEnds(top, bottom, length_d < kWeld, length_e < kWeld);
      return;
    }
    const double cross = d.x() * e.y() - d.y() * e.x();
    if (std::abs(cross) > kParallel * length_d * length_e) {
      const double t = ((r.x() - p.x()) * e.y() - (r.y() - p.y()) * e.x()) / cross;
      const double u = ((r.x() - p.x()) * d.y() - (r.y() - p.y()) * d.x()) / cross;
      if (t < 0.0 || t > 1.0 || u < 0.0 || u > 1.0) return;
      Add(p.x() + t * d.x(), p.y() + t * d.y(), p.z() + t * d.z(), r.z() + u * e.z(), 1024U);
      return;
    }
    const auto along = [&](const Vector3& x) {
      return (x - p).head<2>().dot(d.head<2>()) / (length_d * length_d);
    };
    const double t_r = along(r), t_s = along(s);
    const double low = std::max(0.0, std::min(t_r, t_s)), high = std::min(1.0, std::max(t_r, t_s));
    if (low > high) return;
    for (int k = 0; k < 2; ++k) {
      const double t = k == 0 ? low : high;
      const double u = (t - t_r) / (t_s - t_r);
      const Vector3 on_a = p + t * d, on_b = r + u * e;
      Add(0.5 * (on_a.x() + on_b.x()), 0.5 * (on_a.y() + on_b.y()), on_a.z(), on_b.z(), k);
    }
  }

  void AddNearestEnds(const Vector3& top, const Vector3& bottom, bool a_is_point, bool b_is_point) {
    // The point lies on the other's line where they touch; use the point's own place.
    const Vector3& place = a_is_point ? top : bottom;
    const Outline& line = a_is_point ? b_ : a_;
    if (a_is_point && b_is_point) {
      Add(0.5 * (top.x() + bottom.x()), 0.5 * (top.y() + bottom.y()), top.z(), bottom.z(), 0);
      return;
    }
    const Vector3 &p = line.points[0], d = line.points[1] - p;
    const double t =
        std::clamp((place - p).head<2>().dot(d.head<2>()) / d.head<2>().squaredNorm(), 0.0, 1.0);
    const double height = p.z() + t * d.z();
    Add(place.x(), place.y(), a_is_point ? place.z() : height, a_is_point ? height : place.z(), 0);
  }

  // Whether all points found lie within a hair of one edge of a polygon.
  bool IsSliver(const Outline& outline) const {
    if (outline.kind != Kind::kPolygon) return false;
    for (int i = 0; i < outline.size; ++i) {
      double deepest = -1.0;
      for (int k = 0; k < count_ && deepest < internal::kMinOverlap; ++k) {
        deepest = std::max(deepest, outline.Inside(i, candidates_[k].x, candidates_[k].y));
      }
      if (deepest < internal::kMinOverlap) return true;
    }
    return false;
  }

  OverlapResult Report(double margin, Manifold* manifold) {
    manifold->nhat_W = plane_.nhat_W;
    if (!(a_.is_region() && b_.is_region())) {
      for (int i = 0; i < count_; ++i) {
        const Candidate& c = candidates_[i];
        if (c.height_b - c.height_a > margin) continue;
        manifold->Add(origin_ + R_WT_ * Vector3(c.x, c.y, 0.5 * (c.height_a + c.height_b)),
                      c.height_b - c.height_a, c.id);
      }
      return manifold->size > 0 ? OverlapResult::kTouching : OverlapResult::kNone;
    }
    FacePoints own;
    FacePoints& points = manifold->NextFace(&own);
    for (int i = 0; i < count_; ++i) {
      const Candidate& c = candidates_[i];
      const double phi = c.height_b - c.height_a;
      if (phi <= margin) points.Add(c.x, c.y, phi, c.id);
    }
    if (points.size == 0) return OverlapResult::kNone;
    ContactPlane on_a = plane_;
    on_a.x_W += a_.gradient.x() * plane_.nhat_W;
    on_a.y_W += a_.gradient.y() * plane_.nhat_W;
    AddFacePoints(points, on_a, approach_, manifold);
    manifold->round = round_ && manifold->size == 4;
    return OverlapResult::kTouching;
  }

  const Matrix3 R_WT_;
  const Vector3 origin_;
  const ContactPlane plane_;  // at feature a's first point
  const Approach approach_;
  Outline a_, b_;
  std::array<Candidate, kMaxCandidates> candidates_;
  int count_ = 0, count_b_ = 0;
  bool round_ = false;  // all of a disc lies over the other outline
};

}  // namespace

OverlapResult OverlapFeatures(const PlacedConvex& a, const PlacedConvex& b,
                              const Feature& feature_a, const Feature& feature_b,
                              const Vector3& nhat_W, double margin, Manifold* manifold) {
  manifold->Clear();
  return Overlap(a, b, feature_a, feature_b, nhat_W).Find(margin, manifold);
}

}  // namespace pregrasp
