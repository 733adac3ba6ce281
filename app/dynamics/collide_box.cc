#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/dynamics/collide.h"

namespace pregrasp::internal {
namespace {

// Corners this little outside a side of the reference face [m] are not clipped: edges that coincide
// but for rounding would meet anywhere.
constexpr double kWeld = 1e-6;
constexpr double kRejected = -std::numeric_limits<double>::infinity();

// A corner of the incident face while it is clipped: coordinates along the two axes of the
// reference face, height over it, and the edge that leaves the corner (0-3 of the incident face,
// 4-7 of the reference face).
struct ClipPoint {
  double x, y, height;
  std::uint32_t edge;
};

struct ClipPolygon {
  int size = 0;
  std::array<ClipPoint, 8> points;
};

// Cuts away what lies beyond coordinate (x or y) * sign > limit.
template <int kAxis>
void ClipSide(double sign, double limit, std::uint32_t plane, const ClipPolygon& in,
              ClipPolygon* out) {
  out->size = 0;
  for (int i = 0; i < in.size; ++i) {
    const ClipPoint& from = in.points[i];
    const ClipPoint& to = in.points[i + 1 == in.size ? 0 : i + 1];
    const double d0 = sign * (kAxis == 0 ? from.x : from.y) - (limit + kWeld);
    const double d1 = sign * (kAxis == 0 ? to.x : to.y) - (limit + kWeld);
    if (d0 <= 0.0) out->points[out->size++] = from;
    if ((d0 <= 0.0) == (d1 <= 0.0)) continue;
    const double t = d0 / (d0 - d1);
    out->points[out->size++] = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                                from.height + t * (to.height - from.height),
                                d0 <= 0.0 ? 4U + plane : from.edge};
  }
}

// The pair of boxes in A's frame, and the separations along the fifteen axes.
class BoxPair {
 public:
  BoxPair(const PlacedConvex& a, const PlacedConvex& b, double margin)
      : a_(a),
        b_(b),
        margin_(margin),
        R_(a.R_WP.transpose() * b.R_WP),
        t_(a.R_WP.transpose() * (b.p_WP - a.p_WP)),
        t_B_(R_.transpose() * t_) {}

  bool Collide(Manifold* manifold) {
    if (!CalcFaceSeparations()) return false;
    // A face whose clipped outline is a sliver is given up for the next best, if that is as near.
    const double best = face_[FindBestFace()];
    for (int attempt = 0; attempt < 3; ++attempt) {
      const int axis = FindBestFace();
      const double separation = face_[axis];
      if (separation < best - kEdgeBias) return false;
      if (attempt == 0 && !IsFlush(axis)) {
        if (!CalcBestEdge()) return false;
        if (edge_separation_ > separation + kEdgeBias) return AddEdgeContact(manifold);
      }
      const FaceResult result =
          axis < 3 ? AddFaceContact(axis, a_, b_, R_, t_, false, manifold)
                   : AddFaceContact(axis - 3, b_, a_, R_.transpose(), -t_B_, true, manifold);
      if (result == FaceResult::kSliver) {
        face_[axis] = kRejected;
        continue;
      }
      const bool found = result == FaceResult::kTouching;
      if ((found && !IsBesideFace(*manifold, separation)) || attempt > 0) return found;
      const bool grazes = std::any_of(face_.begin(), face_.end(), IsGrazing);
      if (found && grazes) return true;
      return CollideNearestPoints(a_, b_, margin_, grazes ? kSlideReach : kRejected, manifold);
    }
    return false;
  }

 private:
  enum class FaceResult { kApart, kTouching, kSliver };

  bool CalcFaceSeparations() {
    abs_R_ = R_.cwiseAbs();
    const Vector3 &a = a_.convex->half, &b = b_.convex->half;
    for (int i = 0; i < 3; ++i) {
      face_[i] = std::abs(t_[i]) - a[i] - abs_R_.row(i).dot(b);
      face_[3 + i] = std::abs(t_B_[i]) - b[i] - abs_R_.col(i).dot(a);
      if (face_[i] > margin_ || face_[3 + i] > margin_) return false;
    }
    return true;
  }

  int FindBestFace() const {
    int best_a = 0, best_b = 3;
    for (int i = 1; i < 3; ++i) {
      if (face_[i] > face_[best_a]) best_a = i;
      if (face_[3 + i] > face_[best_b]) best_b = 3 + i;
    }
    return face_[best_b] > face_[best_a] + kFaceBias ? best_b : best_a;
  }

  // Whether the other box has a face parallel to this one; then no pair of edges can do better.
  bool IsFlush(int axis) const {
    const double alignment =
        axis < 3 ? abs_R_.row(axis).maxCoeff() : abs_R_.col(axis - 3).maxCoeff();
    return alignment > 1.0 - 1e-8;
  }

  bool CalcBestEdge() {
    const Vector3 &a = a_.convex->half, &b = b_.convex->half;
    edge_separation_ = kRejected;
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const double length2 = 1.0 - R_(i, j) * R_(i, j);
        if (length2 < 1e-6) continue;  // parallel: the faces cover it
        const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const double inv_length = 1.0 / std::sqrt(length2);
        const double distance = std::abs(t_[i2] * R_(i1, j) - t_[i1] * R_(i2, j));
        const double extent = a[i1] * abs_R_(i2, j) + a[i2] * abs_R_(i1, j) +
                              b[j1] * abs_R_(i, j2) + b[j2] * abs_R_(i, j1);
        const double separation = (distance - extent) * inv_length;
        if (separation > margin_) return false;
        if (separation > edge_separation_) {
          edge_separation_ = separation;
          edge_i_ = i;
          edge_j_ = j;
        }
      }
    }
    return true;
  }

  // One point, where the two edges pass each other.
  bool AddEdgeContact(Manifold* manifold) const {
    const Vector3 &a = a_.convex->half, &b = b_.convex->half;
    const Vector3 u = Vector3::Unit(edge_i_), v = R_.col(edge_j_);
    Vector3 nhat = u.cross(v).normalized();
    if (nhat.dot(t_) < 0.0) nhat = -nhat;
    Vector3 p_a = Vector3::Zero(), p_b = t_;
    std::uint32_t corner_a = 0, corner_b = 0;
    for (int k = 0; k < 3; ++k) {
      if (k != edge_i_) {
        const bool plus = nhat[k] > 0.0;
        p_a[k] = plus ? a[k] : -a[k];
        corner_a |= (plus ? 1U : 0U) << k;
      }
      if (k != edge_j_) {
        const bool plus = nhat.dot(R_.col(k)) < 0.0;
        p_b += R_.col(k) * (plus ? b[k] : -b[k]);
        corner_b |= (plus ? 1U : 0U) << k;
      }
    }
    const double uv = u.dot(v);
    const Vector3 d = p_b - p_a;
    const double denominator = 1.0 - uv * uv;
    const double su = std::clamp((u.dot(d) - uv * v.dot(d)) / denominator, -a[edge_i_], a[edge_i_]);
    const double sv = std::clamp((uv * u.dot(d) - v.dot(d)) / denominator, -b[edge_j_], b[edge_j_]);
    const Vector3 q_a = p_a + su * u, q_b = p_b + sv * v;
    manifold->nhat_W = a_.R_WP * nhat;
    manifold->Add(a_.p_WP + a_.R_WP * (0.5 * (q_a + q_b)), nhat.dot(q_b - q_a),
                  256U + ((edge_i_ * 3U + edge_j_) * 8U + corner_a) * 8U + corner_b);
    return true;
  }

  // Face `i` of `ref` against the face of `inc` that looks at it most directly; R and t place inc
  // in ref's frame.
  FaceResult AddFaceContact(int i, const PlacedConvex& ref, const PlacedConvex& inc,
                            const Matrix3& R, const Vector3& t, bool flip,
                            Manifold* manifold) const {
    const Vector3 &half = ref.convex->half, &inc_half = inc.convex->half;
    const int ix = (i + 1) % 3, iy = (i + 2) % 3;
    const double s = t[i] < 0.0 ? -1.0 : 1.0;
    int k = 0;
    R.row(i).cwiseAbs().maxCoeff(&k);
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const bool plus = s * R(i, k) < 0.0;
    const Vector3 center = t + R.col(k) * (plus ? inc_half[k] : -inc_half[k]);
    const Vector3 du = R.col(u) * inc_half[u], dv = R.col(v) * inc_half[v];
    const std::uint32_t base = plus ? 1U << k : 0U;
    const std::array<std::uint32_t, 4> corner = {base | 1U << u | 1U << v, base | 1U << v, base,
                                                 base | 1U << u};
    const std::array<Vector3, 4> p = {center + du + dv, center - du + dv, center - du - dv,
                                      center + du - dv};
    ClipPolygon polygon, other;
    double max_x = 0.0, max_y = 0.0;
    for (std::uint32_t c = 0; c < 4; ++c) {
      polygon.points[c] = {p[c][ix], p[c][iy], s * p[c][i] - half[i], c};
      max_x = std::max(max_x, std::abs(p[c][ix]));
      max_y = std::max(max_y, std::abs(p[c][iy]));
    }
    polygon.size = 4;
    if (max_x > half[ix] + kWeld) {
      ClipSide<0>(1.0, half[ix], 0, polygon, &other);
      ClipSide<0>(-1.0, half[ix], 1, other, &polygon);
    }
    if (max_y > half[iy] + kWeld) {
      ClipSide<1>(1.0, half[iy], 2, polygon, &other);
      ClipSide<1>(-1.0, half[iy], 3, other, &polygon);
    }
    if (polygon.size == 0) return FaceResult::kApart;
    if (IsSliver(polygon, half[ix], half[iy])) return FaceResult::kSliver;

    manifold->nhat_W = (flip ? -s : s) * ref.R_WP.col(i);
    FacePoints own;
    FacePoints& points = manifold->NextFace(&own);
    for (int n = 0; n < polygon.size; ++n) {
      const ClipPoint& point = polygon.points[n];
      if (point.height > margin_) continue;
      const std::uint32_t in = polygon.points[n == 0 ? polygon.size - 1 : n - 1].edge;
      const bool is_corner = point.edge < 4 && in < 4;
      const std::uint32_t id = is_corner ? corner[point.edge] : 32U + 8U * in + point.edge;
      points.Add(point.x, point.y, point.height, id | (flip ? kFaceOfB : 0U));
    }
    if (points.size == 0) return FaceResult::kApart;
    const ContactPlane plane{ref.p_WP + s * half[i] * ref.R_WP.col(i), ref.R_WP.col(ix),
                             ref.R_WP.col(iy), s * ref.R_WP.col(i)};
    AddFacePoints(points, plane, Approach(ref, inc, plane.nhat_W, plane), manifold);
    return FaceResult::kTouching;
  }

  static bool IsSliver(const ClipPolygon& polygon, double half_x, double half_y) {
    double min_x = polygon.points[0].x, max_x = min_x;
    double min_y = polygon.points[0].y, max_y = min_y;
    for (int i = 1; i < polygon.size; ++i) {
      min_x = std::min(min_x, polygon.points[i].x);
      max_x = std::max(max_x, polygon.points[i].x);
      min_y = std::min(min_y, polygon.points[i].y);
      max_y = std::max(max_y, polygon.points[i].y);
    }
    return min_x > half_x - kMinOverlap || max_x < kMinOverlap - half_x ||
           min_y > half_y - kMinOverlap || max_y < kMinOverlap - half_y;
  }

  const PlacedConvex &a_, &b_;
  const double margin_;
  const Matrix3 R_;
  const Vector3 t_, t_B_;
  Matrix3 abs_R_;
  std::array<double, 6> face_{};
  double edge_separation_ = kRejected;
  int edge_i_ = 0, edge_j_ = 0;
};

}  // namespace

bool CollideBoxes(const PlacedConvex& a, const PlacedConvex& b, double margin, Manifold* manifold) {
  return BoxPair(a, b, margin).Collide(manifold);
}

}  // namespace pregrasp::internal
