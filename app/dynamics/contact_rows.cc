#include "app/dynamics/contact_rows.h"

#include <utility>

#include "app/dynamics/support_spread.h"

namespace pregrasp {
namespace {

// A number of each of four points. What is done to one point of a contact before the sweeps is done
// to all, and a contact has four as a rule.
using Lanes = Eigen::Array4d;
constexpr int kNumLanes = 4;

// A vector of each of four points.
struct Lanes3 {
  Lanes x, y, z;

  Lanes Dot(const Lanes3& v) const { return x * v.x + y * v.y + z * v.z; }
  Lanes Dot(const Vector3& v) const { return x * v.x() + y * v.y() + z * v.z(); }
  void Set(int k, const Vector3& v) {
    x[k] = v.x();
    y[k] = v.y();
    z[k] = v.z();
  }
};

// The arms of four points on one body, by row: tangent 1, tangent 2, normal.
struct ArmLanes {
  std::array<Lanes3, 3> A;

  // Sets the rows of `num_rows` axes: s times r x axis, for r from the centre of mass and s over
  // the square roots of the moments.
  void Set(const BodyKernel& kernel, const BodyMotion& motion, const Matrix3& axes_W,
           const Lanes3& p_W, double sign, int num_rows = 3) {
    const Vector3& c = motion.p_WBcm;
    const Matrix3& R = motion.R_WP;
    const Lanes3 r_W{p_W.x - c.x(), p_W.y - c.y(), p_W.z - c.z()};
    const Lanes3 r{r_W.Dot(Vector3(R.col(0))), r_W.Dot(Vector3(R.col(1))),
                   r_W.Dot(Vector3(R.col(2)))};
    const Vector3 s = sign * kernel.inv_sqrt_I_P;
    const Matrix3 axes = R.transpose() * axes_W;
    for (int i = 0; i < num_rows; ++i) {
      const Vector3 axis = axes.col(i);
      A[i].x = r.y * (s.x() * axis.z()) - r.z * (s.x() * axis.y());
      A[i].y = r.z * (s.y() * axis.x()) - r.x * (s.y() * axis.z());
      A[i].z = r.x * (s.z() * axis.y()) - r.y * (s.z() * axis.x());
    }
  }

  Lanes Product(int i, int j) const { return A[i].Dot(A[j]); }

  // The turn that impulses give the body.
  Vector3 CalcTurn(const std::array<Lanes, 3>& lambda) const {
    const Lanes x = A[0].x * lambda[0] + A[1].x * lambda[1] + A[2].x * lambda[2];
    const Lanes y = A[0].y * lambda[0] + A[1].y * lambda[1] + A[2].y * lambda[2];
    const Lanes z = A[0].z * lambda[0] + A[1].z * lambda[1] + A[2].z * lambda[2];
    return {x.sum(), y.sum(), z.sum()};
  }

  void Get(int k, PointArms* arms) const {
    for (int i = 0; i < 2; ++i) {
      arms->t(i, 0) = A[i].x[k];
      arms->t(i, 1) = A[i].y[k];
      arms->t(i, 2) = A[i].z[k];
    }
    arms->n[0] = A[2].x[k];
    arms->n[1] = A[2].y[k];
    arms->n[2] = A[2].z[k];
  }
};

// The effective masses of four points. The rows' linear parts are orthogonal, so only their angular
// parts couple.
struct MassLanes {
  Lanes K_n, inv_K_n, inv_K_11, inv_K_12, inv_K_22, inv_K_t_max;

  MassLanes(double inv_mass_sum, const ArmLanes& first, const ArmLanes* second) {
    K_n = inv_mass_sum + first.Product(2, 2);
    Lanes K_11 = inv_mass_sum + first.Product(0, 0);
    Lanes K_12 = first.Product(0, 1);
    Lanes K_22 = inv_mass_sum + first.Product(1, 1);
    if (second != nullptr) {
      K_n += second->Product(2, 2);
      K_11 += second->Product(0, 0);
      K_12 += second->Product(0, 1);
      K_22 += second->Product(1, 1);
    }
    inv_K_n = K_n.inverse();
    const Lanes inv_determinant = (K_11 * K_22 - K_12 * K_12).inverse();
    inv_K_11 = K_22 * inv_determinant;
    inv_K_12 = -K_12 * inv_determinant;
    inv_K_22 = K_11 * inv_determinant;
    const Lanes difference = 0.5 * (K_11 - K_22);
    inv_K_t_max = (0.5 * (K_11 + K_22) + (difference * difference + K_12 * K_12).sqrt()).inverse();
  }

  void Get(int k, PointRows* point) const {
    point->K_n = K_n[k];
    point->inv_K_n = inv_K_n[k];
    point->inv_K_t(0, 0) = inv_K_11[k];
    point->inv_K_t(1, 0) = point->inv_K_t(0, 1) = inv_K_12[k];
    point->inv_K_t(1, 1) = inv_K_22[k];
    point->inv_K_t_max = inv_K_t_max[k];
  }
};

// Impulses along the axes, cut to the friction cone.
std::array<Lanes, 3> CutToCone(double friction, const Matrix3& axes_W, const Lanes3& impulse_W) {
  std::array<Lanes, 3> lambda;
  for (int i = 0; i < 3; ++i) lambda[i] = impulse_W.Dot(Vector3(axes_W.col(i)));
  lambda[2] = lambda[2].max(0.0);
  const Lanes limit = friction * lambda[2];
  const Lanes norm2 = lambda[0] * lambda[0] + lambda[1] * lambda[1];
  if ((norm2 <= limit * limit).all()) return lambda;
  const Lanes scale = limit / norm2.sqrt().max(limit).max(1e-300);
  lambda[0] *= scale;
  lambda[1] *= scale;
  return lambda;
}

}  // namespace

void ContactRows::Set(const std::vector<BodyKernel>& kernels,
                      const std::vector<BodyMotion>& motions, const Contact& contact,
                      const std::array<const Vector3*, Manifold::kMaxPoints>& start_W,
                      bool spread_support, std::span<PointRows> memory, BodyVelocity* y_start) {
  const bool a_moves = !contact.movable_a.is_none();
  axes_W = FrameFromNormal(contact.manifold.nhat_W);
  first = a_moves ? contact.movable_a.value : contact.movable_b.value;
  second = a_moves ? contact.movable_b.value : -1;
  sign_first = a_moves ? -1.0 : 1.0;
  inv_mass_first = kernels[first].inv_mass;
  inv_mass_second = second >= 0 ? kernels[second].inv_mass : 0.0;
  inv_mass_sum = inv_mass_first + inv_mass_second;
  friction = contact.friction;
  points = memory;
  spread = 1.0;
  if (spread_support) SetSpread(contact.manifold, start_W);
  const int size = contact.manifold.size;
  for (int begin = 0; begin < size; begin += kNumLanes) {
    const int count = std::min(kNumLanes, size - begin);
    Lanes3 p_W, impulse_W;
    for (int k = 0; k < kNumLanes; ++k) {
      // Lanes without a point repeat the first, without an impulse.
      const Vector3* start = k < count ? start_W[begin + k] : nullptr;
      p_W.Set(k, contact.manifold.points[begin + (k < count ? k : 0)].p_W);
      impulse_W.Set(k, start != nullptr ? *start : Vector3::Zero());
    }
    ArmLanes arms_first, arms_second;
    arms_first.Set(kernels[first], motions[first], axes_W, p_W, sign_first);
    if (second >= 0) arms_second.Set(kernels[second], motions[second], axes_W, p_W, 1.0);
    if (spread != 1.0) {
      Lanes3 q_W;
      for (int k = 0; k < kNumLanes; ++k) {
        q_W.Set(k, FrictionPoint(Vector3(p_W.x[k], p_W.y[k], p_W.z[k])));
      }
      arms_first.Set(kernels[first], motions[first], axes_W, q_W, sign_first, 2);
      if (second >= 0) arms_second.Set(kernels[second], motions[second], axes_W, q_W, 1.0, 2);
    }
    const MassLanes mass(inv_mass_sum, arms_first, second >= 0 ? &arms_second : nullptr);
    const std::array<Lanes, 3> lambda = CutToCone(friction, axes_W, impulse_W);

    const Vector3 sum_W = ToWorld({Vector2(lambda[0].sum(), lambda[1].sum()), lambda[2].sum()});
    y_start[first].v_W += sign_first * inv_mass_first * sum_W;
    y_start[first].w_P += arms_first.CalcTurn(lambda);
    if (second >= 0) {
      y_start[second].v_W += inv_mass_second * sum_W;
      y_start[second].w_P += arms_second.CalcTurn(lambda);
    }
    for (int k = 0; k < count; ++k) {
      PointRows& point = points[begin + k];
      arms_first.Get(k, &point.first);
      if (second >= 0) arms_second.Get(k, &point.second);
      mass.Get(k, &point);
      point.lambda = {Vector2(lambda[0][k], lambda[1][k]), lambda[2][k]};
      point.start = point.lambda;
      point.jump = {};
      point.phi = contact.manifold.points[begin + k].phi;
      point.correction = 0.0;
    }
  }
}

// The centre is that of the pressure in the last step, so that a body that slides without turning
// is not turned by its friction; of all points alike if none bore load.
void ContactRows::SetSpread(const Manifold& manifold,
                            const std::array<const Vector3*, Manifold::kMaxPoints>& start_W) {
  spread = CalcSupportSpread(manifold);
  Vector3 mean_W = Vector3::Zero(), sum_W = Vector3::Zero();
  double load = 0.0;
  for (int i = 0; i < manifold.size; ++i) {
    const Vector3& p_W = manifold.points[i].p_W;
    const double n = start_W[i] != nullptr ? std::max(0.0, axes_W.col(2).dot(*start_W[i])) : 0.0;
    mean_W += p_W / manifold.size;
    sum_W += n * p_W;
    load += n;
  }
  center_W = load > 0.0 ? Vector3(sum_W / load) : mean_W;
}

double ContactRows::CalcCoupling(int a, int b) const {
  const double K = inv_mass_sum + points[a].first.n.dot(points[b].first.n);
  return second < 0 ? K : K + points[a].second.n.dot(points[b].second.n);
}

void ContactRows::AddPair(int a, int b) {
  constexpr double kMinDeterminant = 1e-4;  // as a share of the diagonal's
  const double K_aa = points[a].K_n, K_bb = points[b].K_n, K_ab = CalcCoupling(a, b);
  const double determinant = K_aa * K_bb - K_ab * K_ab;
  if (determinant < kMinDeterminant * K_aa * K_bb) {
    // Almost one point: either can carry all.
    pairs[num_pairs++] = {a};
    pairs[num_pairs++] = {b};
    return;
  }
  const double inverse = 1.0 / determinant;
  pairs[num_pairs++] = {a, b, K_ab, K_bb * inverse, K_aa * inverse, -K_ab * inverse};
}

// Of four round a face, opposite ones leave the other pair's tilt alone. On a long narrow face both
// pairs would tilt it the same way; there the ends of each long side go together.
void ContactRows::SetPairs(bool alone) {
  constexpr double kNarrow = 0.5;
  num_pairs = 0;
  const int size = static_cast<int>(points.size());
  int next = 0;
  if (!alone && size >= 4) {
    // Opposite to the first point is the one that is coupled to it least.
    const std::array<double, 4> K = {0.0, CalcCoupling(0, 1), CalcCoupling(0, 2),
                                     CalcCoupling(0, 3)};
    int opposite = 1;
    for (int i = 2; i < 4; ++i) {
      if (K[i] < K[opposite]) opposite = i;
    }
    int near = opposite == 1 ? 2 : 1, far = opposite == 3 ? 2 : 3;
    if (K[far] > K[near]) std::swap(near, far);
    if (K[near] - K[far] < kNarrow * (points[0].K_n - K[opposite])) {
      AddPair(0, opposite);
      AddPair(near, far);
    } else {
      AddPair(0, far);
      AddPair(opposite, near);
    }
    next = 4;
  } else if (!alone && size >= 2) {
    AddPair(0, 1);
    next = 2;
  }
  for (; next < size; ++next) pairs[num_pairs++] = {next};
}

}  // namespace pregrasp
