#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "app/dynamics/contact_set.h"
#include "app/dynamics/motion.h"

namespace pregrasp {

/// Velocity of one movable body, as the contact solver changes it.
struct BodyVelocity {
  Vector3 v_W = Vector3::Zero();  ///< of the centre of mass [m/s]
  /// In the principal axes, times the square root of the moments: then a Jacobian row both measures
  /// a velocity and applies an impulse.
  Vector3 w_P = Vector3::Zero();
};

/// Impulse at a point, along the contact's two tangents and its normal [N s].
struct PointImpulse {
  Vector2 t = Vector2::Zero();
  double n = 0.0;

  PointImpulse operator+(const PointImpulse& d) const { return {t + d.t, n + d.n}; }
  PointImpulse operator-(const PointImpulse& d) const { return {t - d.t, n - d.n}; }
  PointImpulse operator*(double s) const { return {t * s, n * s}; }
  double dot(const PointImpulse& d) const { return t.dot(d.t) + n * d.n; }

  /// Cuts it to the friction cone.
  void CutToCone(double friction) {
    n = std::max(0.0, n);
    const double limit = friction * n, norm2 = t.squaredNorm();
    if (norm2 > limit * limit) t *= limit / std::sqrt(norm2);
  }
};

/// The angular parts of a point's rows on one body, in its w_P: of the two tangents, and the
/// normal.
struct PointArms {
  Eigen::Matrix<double, 2, 3> t;
  Vector3 n;
};

/// One contact point.
struct PointRows {
  PointArms first, second;
  Eigen::Matrix2d inv_K_t;   ///< inverse of the tangential block of K = J M^-1 J^T
  double inv_K_t_max = 0.0;  ///< 1 / its larger eigenvalue
  double K_n = 0.0, inv_K_n = 0.0;
  double phi = 0.0;          ///< gap [m]
  double bias = 0.0;         ///< the normal velocity may not fall below -bias [m/s]
  PointImpulse lambda;       ///< on body b
  PointImpulse start;        ///< at the start of this pair of sweeps
  PointImpulse last_change;  ///< in the pair before
  PointImpulse jump;         ///< between the two, by Accelerate
  double correction = 0.0;   ///< pseudo-impulse of the position correction [N s]
  double correction_bias = 0.0;
};

/// Two points of a contact whose normal impulses are solved together, or a single point.
struct PointPair {
  int a = 0, b = -1;                                ///< b is -1 for a single one
  double K_ab = 0.0;                                ///< coupling of the normals
  double inv_aa = 0.0, inv_bb = 0.0, inv_ab = 0.0;  ///< inverse of their K
};

/// The rows of one contact's points. Their linear parts are the contact's axes.
struct ContactRows {
  Matrix3 axes_W;              ///< columns tangent 1, tangent 2, normal (from body a to b)
  int first = 0, second = -1;  ///< of MovableIndex; second is -1 against a fixed body
  double sign_first = 1.0;     ///< -1 if the first is body a
  double inv_mass_first = 0.0, inv_mass_second = 0.0, inv_mass_sum = 0.0;
  double friction = 0.0;
  /// Friction acts at the points moved towards the centre of pressure, to this share of their
  /// distance; at 1 it acts at the points themselves.
  double spread = 1.0;
  Vector3 center_W = Vector3::Zero();
  std::span<PointRows> points;
  std::array<PointPair, Manifold::kMaxPoints> pairs;
  int num_pairs = 0;

  double inv_mass_lighter() const { return std::max(inv_mass_first, inv_mass_second); }

  /// Sets everything but the points' bias and the pairs.
  /// @param spread_support  whether friction acts nearer to the centre; see StepConfig.
  /// @param start_W  impulses on body b that the points start from, null for none [N s].
  /// @param memory  for the points.
  /// @param y_start  where to add what the starting impulses do to the velocities, by movable.
  void Set(const std::vector<BodyKernel>& kernels, const std::vector<BodyMotion>& motions,
           const Contact& contact, const std::array<const Vector3*, Manifold::kMaxPoints>& start_W,
           bool spread_support, std::span<PointRows> memory, BodyVelocity* y_start);

  /// Says which points are solved together; `alone` if none are.
  void SetPairs(bool alone);

  /// Where the friction of the point at p_W acts.
  Vector3 FrictionPoint(const Vector3& p_W) const {
    return spread == 1.0 ? p_W : Vector3(center_W + spread * (p_W - center_W));
  }

  /// An impulse on body b [N s].
  Vector3 ToWorld(const PointImpulse& d) const {
    return axes_W.col(0) * d.t[0] + axes_W.col(1) * d.t[1] + axes_W.col(2) * d.n;
  }

 private:
  void SetSpread(const Manifold& manifold,
                 const std::array<const Vector3*, Manifold::kMaxPoints>& start_W);
  void AddPair(int a, int b);
  double CalcCoupling(int a, int b) const;
};

/// The relative velocity of the bodies of a contact, taken apart into what the rows need, while the
/// points are visited one by one. `kTwo` tells whether both bodies move. Angular velocities are
/// plain numbers, which stay in registers.
template <bool kTwo>
class RelativeVelocity {
 public:
  RelativeVelocity(const ContactRows& rows, const BodyVelocity* y)
      : rows_(rows), first_(y[rows.first].w_P) {
    Vector3 v_W = rows.sign_first * y[rows.first].v_W;
    if constexpr (kTwo) {
      v_W += y[rows.second].v_W;
      second_ = Turn(y[rows.second].w_P);
    }
    v_t_[0] = rows.axes_W.col(0).dot(v_W);
    v_t_[1] = rows.axes_W.col(1).dot(v_W);
    v_t_start_ = v_t_;
    v_n_ = v_n_start_ = rows.axes_W.col(2).dot(v_W);
  }

  /// Velocity along the normal, on top of `bias`.
  double GetNormal(const PointRows& point, double bias = 0.0) const {
    const double v = first_.AddNormal(point.first, bias + v_n_);
    if constexpr (kTwo) return second_.AddNormal(point.second, v);
    return v;
  }

  Vector2 GetSlip(const PointRows& point) const {
    Vector2 v = first_.AddTangents(point.first, v_t_);
    if constexpr (kTwo) return second_.AddTangents(point.second, v);
    return v;
  }

  void AddNormal(const PointRows& point, double d) {
    v_n_ += rows_.inv_mass_sum * d;
    first_.Add(point.first, d);
    if constexpr (kTwo) second_.Add(point.second, d);
  }

  void AddFriction(const PointRows& point, const Vector2& d) {
    v_t_ += rows_.inv_mass_sum * d;
    first_.Add(point.first, d);
    if constexpr (kTwo) second_.Add(point.second, d);
  }

  void Add(const PointRows& point, const PointImpulse& d) {
    AddNormal(point, d.n);
    AddFriction(point, d.t);
  }

  void Store(BodyVelocity* y) const {
    const double mass = 1.0 / rows_.inv_mass_sum;
    const Vector3 impulse_W =
        rows_.ToWorld({(v_t_ - v_t_start_) * mass, (v_n_ - v_n_start_) * mass});
    y[rows_.first].v_W += rows_.sign_first * rows_.inv_mass_first * impulse_W;
    first_.Store(&y[rows_.first].w_P);
    if constexpr (kTwo) {
      y[rows_.second].v_W += rows_.inv_mass_second * impulse_W;
      second_.Store(&y[rows_.second].w_P);
    }
  }

 private:
  struct Turn {
    double x, y, z;

    Turn() = default;
    explicit Turn(const Vector3& w) : x(w.x()), y(w.y()), z(w.z()) {}
    // v plus the velocity along rows A. In pairs, which a processor adds at the same time.
    double AddNormal(const PointArms& A, double v) const {
      return (v + A.n[0] * x) + (A.n[1] * y + A.n[2] * z);
    }
    Vector2 AddTangents(const PointArms& A, const Vector2& v) const {
      return (v + A.t.col(0) * x) + (A.t.col(1) * y + A.t.col(2) * z);
    }
    void Add(const PointArms& A, double d) {
      x += A.n[0] * d;
      y += A.n[1] * d;
      z += A.n[2] * d;
    }
    void Add(const PointArms& A, const Vector2& d) {
      x += A.t.col(0).dot(d);
      y += A.t.col(1).dot(d);
      z += A.t.col(2).dot(d);
    }
    void Store(Vector3* w) const { *w = Vector3(x, y, z); }
  };

  const ContactRows& rows_;
  Vector2 v_t_, v_t_start_;
  double v_n_, v_n_start_;
  Turn first_, second_;
};

/// What f returns, called with the relative velocity of the bodies of `rows`.
template <typename F>
auto VisitRelativeVelocity(const ContactRows& rows, const BodyVelocity* y, F&& f) {
  if (rows.second < 0) return f(RelativeVelocity<false>(rows, y));
  return f(RelativeVelocity<true>(rows, y));
}

/// The larger eigenvalue of the symmetric 2 x 2 matrix (a, b; b, c).
inline double LargerEigenvalue(double a, double b, double c) {
  const double difference = 0.5 * (a - c);
  return 0.5 * (a + c) + std::sqrt(difference * difference + b * b);
}

}  // namespace pregrasp
