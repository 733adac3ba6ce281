#include "app/dynamics/contact_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pregrasp {
namespace {

// Overlap is pushed out by this share per step, no faster than the cap; overlap below the slop is
// left alone, which spares steps at rest the correction pass.
constexpr double kCorrectionShare = 0.5;
constexpr double kMaxCorrectionSpeed = 0.5;  // [m/s]
constexpr double kCorrectionSlop = 1e-6;     // [m]
// Slower impacts do not bounce [m/s].
constexpr double kMinBounceSpeed = 0.2;

// The larger eigenvalue of the symmetric 2 x 2 matrix (a, b; b, c).
inline double LargerEigenvalue(double a, double b, double c) {
  const double difference = 0.5 * (a - c);
  return 0.5 * (a + c) + std::sqrt(difference * difference + b * b);
}

// Rows normal, tangent 1, tangent 2 of point p_W on one body. frame_P holds the columns tangent 1,
// tangent 2, normal in the body's principal axes.
inline void SetJacobian(const BodyKernel& kernel, const BodyMotion& motion, const Matrix3& frame_W,
                        const Matrix3& frame_P, const Vector3& p_W, double sign,
                        std::array<Vector6, 3>* J) {
  const Vector3 r_P = motion.R_WP.transpose() * (p_W - motion.p_WBcm);
  constexpr std::array<int, 3> kColumn = {2, 0, 1};
  const double linear = sign * kernel.inv_sqrt_mass;
  const Vector3 angular = sign * kernel.inv_sqrt_I_P;
  for (int row = 0; row < 3; ++row) {
    (*J)[row].head<3>() = linear * frame_W.col(kColumn[row]);
    (*J)[row].tail<3>() = angular.cwiseProduct(r_P.cross(frame_P.col(kColumn[row])));
  }
}

// The effective masses of a point from its Jacobian. The rows' linear parts are orthogonal, so only
// their angular parts couple.
inline void SetEffectiveMasses(double inv_mass_sum, PointRows* row) {
  const auto K = [row](int i, int j) {
    double k = row->J_first[i].tail<3>().dot(row->J_first[j].tail<3>());
    if (row->second >= 0) k += row->J_second[i].tail<3>().dot(row->J_second[j].tail<3>());
    return k;
  };
  const double k_nn = inv_mass_sum + K(0, 0);
  const double k_11 = inv_mass_sum + K(1, 1), k_22 = inv_mass_sum + K(2, 2), k_12 = K(1, 2);
  row->K_nn = k_nn;
  const double determinant = k_11 * k_22 - k_12 * k_12;
  const double larger = LargerEigenvalue(k_11, k_12, k_22);
  const double inv_all = 1.0 / (k_nn * determinant * larger);  // one division for all three
  row->inv_K_nn = inv_all * determinant * larger;
  const double inv_determinant = inv_all * k_nn * larger;
  row->inv_K_11 = k_22 * inv_determinant;
  row->inv_K_12 = -k_12 * inv_determinant;
  row->inv_K_22 = k_11 * inv_determinant;
  row->inv_K_tt_max = inv_all * k_nn * determinant;
}

// Scales (a, b) back onto the circle of radius `limit` if it lies outside.
void ProjectOnCircle(double limit, double* a, double* b) {
  const double norm2 = *a * *a + *b * *b;
  if (norm2 <= limit * limit) return;
  const double scale = limit / std::sqrt(norm2);
  *a *= scale;
  *b *= scale;
}

// How an impulse along row `i` of point a changes the velocity along row `i` of point b, of the
// same contact.
inline double CalcCoupling(const PointRows& a, const PointRows& b, int i) {
  double k = a.J_first[i].dot(b.J_first[i]);
  if (a.second >= 0) k += a.J_second[i].dot(b.J_second[i]);
  return k;
}

inline double CalcVelocity(const PointRows& row, int i, const Vector6* y) {
  double v = row.J_first[i].dot(y[row.first]);
  if (row.second >= 0) v += row.J_second[i].dot(y[row.second]);
  return v;
}

// Adds a change of a point's impulse (normal, tangent 1, tangent 2) to the velocities.
inline void AddToVelocities(const PointRows& row, const Vector3& d, Vector6* y) {
  y[row.first] += row.J_first[0] * d[0] + row.J_first[1] * d[1] + row.J_first[2] * d[2];
  if (row.second < 0) return;
  y[row.second] += row.J_second[0] * d[0] + row.J_second[1] * d[1] + row.J_second[2] * d[2];
}

// Gives a point a new normal impulse; returns the change [N s].
inline double SetNormalImpulse(PointRows& row, double lambda_n, Vector6* y) {
  const double d = lambda_n - row.lambda_n;
  row.lambda_n = lambda_n;
  row.change[0] += d;
  y[row.first] += row.J_first[0] * d;
  if (row.second >= 0) y[row.second] += row.J_second[0] * d;
  return std::abs(d);
}

// One Gauss-Seidel update of a point's friction; returns the largest change [N s]. Sticking solves
// the tangential block exactly. Sliding steps along the slip velocity with one scale for both
// tangents, so that at the fixed point friction opposes the slip exactly.
inline double SweepFriction(PointRows& row, Vector6* y) {
  const double limit = row.friction * row.lambda_n;
  if (limit == 0.0 && row.lambda_1 == 0.0 && row.lambda_2 == 0.0) return 0.0;
  const double v_1 = CalcVelocity(row, 1, y), v_2 = CalcVelocity(row, 2, y);
  double lambda_1 = row.lambda_1 - row.inv_K_11 * v_1 - row.inv_K_12 * v_2;
  double lambda_2 = row.lambda_2 - row.inv_K_12 * v_1 - row.inv_K_22 * v_2;
  if (lambda_1 * lambda_1 + lambda_2 * lambda_2 > limit * limit) {
    lambda_1 = row.lambda_1 - row.inv_K_tt_max * v_1;
    lambda_2 = row.lambda_2 - row.inv_K_tt_max * v_2;
    ProjectOnCircle(limit, &lambda_1, &lambda_2);
  }
  const double d_1 = lambda_1 - row.lambda_1, d_2 = lambda_2 - row.lambda_2;
  row.lambda_1 = lambda_1;
  row.lambda_2 = lambda_2;
  row.change[1] += d_1;
  row.change[2] += d_2;
  y[row.first] += row.J_first[1] * d_1 + row.J_first[2] * d_2;
  if (row.second >= 0) y[row.second] += row.J_second[1] * d_1 + row.J_second[2] * d_2;
  return std::max(std::abs(d_1), std::abs(d_2));
}

// The normal impulses of two points that make both velocities v zero, or, where that would pull,
// those of the complementarity problem: at each point no pull, no approach, and no push where it
// departs. Its four cases are tried in turn.
inline void SolveNormalPair(const PointPair& pair, const PointRows& a, const PointRows& b,
                            double v_a, double v_b, double* lambda_a, double* lambda_b) {
  *lambda_a = a.lambda_n - pair.inv_aa * v_a - pair.inv_ab * v_b;
  *lambda_b = b.lambda_n - pair.inv_ab * v_a - pair.inv_bb * v_b;
  if (*lambda_a >= 0.0 && *lambda_b >= 0.0) return;
  // The velocities without both impulses.
  v_a -= a.K_nn * a.lambda_n + pair.K_ab * b.lambda_n;
  v_b -= b.K_nn * b.lambda_n + pair.K_ab * a.lambda_n;
  *lambda_a = std::max(0.0, -v_a * a.inv_K_nn);
  *lambda_b = 0.0;
  if (v_b + pair.K_ab * *lambda_a >= 0.0) return;
  *lambda_a = 0.0;
  *lambda_b = std::max(0.0, -v_b * b.inv_K_nn);
}

// One Gauss-Seidel update of a pair, or of a point; returns the largest change of an impulse [N s].
inline double SweepPair(const PointPair& pair, PointRows* points, Vector6* y) {
  PointRows& a = points[pair.a];
  const double v_a = a.bias + CalcVelocity(a, 0, y);
  if (pair.b < 0) {
    const double lambda = std::max(0.0, a.lambda_n - v_a * a.inv_K_nn);
    const double change = SetNormalImpulse(a, lambda, y);
    return std::max(change, SweepFriction(a, y));
  }
  PointRows& b = points[pair.b];
  double lambda_a = 0.0, lambda_b = 0.0;
  SolveNormalPair(pair, a, b, v_a, b.bias + CalcVelocity(b, 0, y), &lambda_a, &lambda_b);
  const double d_a = SetNormalImpulse(a, lambda_a, y), d_b = SetNormalImpulse(b, lambda_b, y);
  const double normal = std::max(d_a, d_b);
  const double friction_a = SweepFriction(a, y), friction_b = SweepFriction(b, y);
  return std::max(normal, std::max(friction_a, friction_b));
}

// One Gauss-Seidel update of a finger. The spring's impulse is cut to the friction cone, then to
// the ball of the force cap (scaling keeps a vector in the cone, so the result is in both). Each
// step is scaled so that its fixed point is the exact law: one scale for both tangents where the
// cone holds, one for all three rows where the cap does.
double SweepFinger(FingerRows& row, Vector6* y) {
  Vector6& y0 = y[0];
  Vector3 v(row.J[0].dot(y0), row.J[1].dot(y0), row.J[2].dot(y0));
  v += row.gamma * row.lambda - row.target;
  v[0] += row.gap_velocity;
  const double max2 = row.max_impulse * row.max_impulse;
  Vector3 lambda = row.lambda - row.inv_K * v;
  row.sliding = row.capped = false;
  const auto cut_to_cone = [&row](Vector3* lambda) {
    const double limit = row.friction * (*lambda)[0];
    row.sliding = lambda->tail<2>().squaredNorm() > limit * limit;
    ProjectOnCircle(limit, &(*lambda)[1], &(*lambda)[2]);
  };
  const double limit = row.friction * lambda[0];
  if (!(lambda[0] >= 0.0 && lambda.tail<2>().squaredNorm() <= limit * limit &&
        lambda.squaredNorm() <= max2)) {
    lambda[0] = std::max(0.0, row.lambda[0] - v[0] / row.K(0, 0));
    const Vector2 v_t = v.tail<2>() + row.K.block<2, 1>(1, 0) * (lambda[0] - row.lambda[0]);
    lambda.tail<2>() =
        row.lambda.tail<2>() - v_t / LargerEigenvalue(row.K(1, 1), row.K(1, 2), row.K(2, 2));
    cut_to_cone(&lambda);
    if (lambda.squaredNorm() > max2) {
      lambda = row.lambda - v / row.K.norm();  // which bounds the largest eigenvalue
      lambda[0] = std::max(0.0, lambda[0]);
      cut_to_cone(&lambda);
      const double norm = lambda.norm();
      row.capped = norm > row.max_impulse;
      if (row.capped) lambda *= row.max_impulse / norm;
    }
  }
  const Vector3 d = lambda - row.lambda;
  row.lambda = lambda;
  y0 += row.J[0] * d[0] + row.J[1] * d[1] + row.J[2] * d[2];
  return d.cwiseAbs().maxCoeff();
}

const Vector3* FindImpulse(const std::vector<WorldState::CachedImpulse>& cache, std::size_t begin,
                           std::uint64_t key) {
  const std::uint64_t pieces = key >> 20;
  for (std::size_t i = begin; i < cache.size() && (cache[i].key >> 20) == pieces; ++i) {
    if (cache[i].key == key) return &cache[i].impulse_W;
  }
  return nullptr;
}

}  // namespace

void ContactSolver::SetContacts(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                                const std::vector<BodyMotion>& motions,
                                const std::vector<Contact>& contacts,
                                const std::vector<WorldState::CachedImpulse>& cache) {
  y_.resize(kernels.size());
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const BodyKernel& kernel = kernels[i];
    y_[i].head<3>() = motions[i].v_WBcm * (kernel.mass * kernel.inv_sqrt_mass);
    y_[i].tail<3>() = (motions[i].R_WP.transpose() * motions[i].w_WB)
                          .cwiseProduct(kernel.I_P.cwiseProduct(kernel.inv_sqrt_I_P));
  }
  std::size_t num_points = 0;
  for (const Contact& contact : contacts) num_points += contact.manifold.size;
  if (rows_.size() < num_points) rows_.resize(num_points);
  points_ = std::span(rows_.data(), num_points);
  pairs_.clear();
  fingers_.clear();
  frames_.resize(contacts.size());
  std::size_t next = 0;
  std::size_t cached = 0;  // contacts and cache are in the same order of pieces
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    frames_[c] = FrameFromNormal(contact.manifold.nhat_W);
    const bool a_moves = contact.movable_a >= 0;
    const int first = a_moves ? contact.movable_a : contact.movable_b;
    const double sign = a_moves ? -1.0 : 1.0;
    const int second = a_moves ? contact.movable_b : -1;
    const Matrix3 frame_first = motions[first].R_WP.transpose() * frames_[c];
    Matrix3 frame_second = Matrix3::Zero();
    if (second >= 0) frame_second = motions[second].R_WP.transpose() * frames_[c];
    while (cached < cache.size() && (cache[cached].key >> 20) < (contact.key >> 20)) ++cached;
    const double inv_mass_first = 1.0 / kernels[first].mass;
    const double inv_mass_second = second >= 0 ? 1.0 / kernels[second].mass : 0.0;
    for (int k = 0; k < contact.manifold.size; ++k) {
      PointRows& row = points_[next++];
      row.point = k;
      const ManifoldPoint& point = contact.manifold.points[k];
      row.first = first;
      row.second = second;
      row.contact = static_cast<int>(c);
      row.friction = contact.friction;
      row.phi = point.phi;
      row.inv_mass = std::max(inv_mass_first, inv_mass_second);
      SetJacobian(kernels[first], motions[first], frames_[c], frame_first, point.p_W, sign,
                  &row.J_first);
      if (second >= 0) {
        SetJacobian(kernels[second], motions[second], frames_[c], frame_second, point.p_W, 1.0,
                    &row.J_second);
      }
      SetEffectiveMasses(inv_mass_first + inv_mass_second, &row);
      row.bias = CalcBias(config, row);
      row.lambda_n = row.lambda_1 = row.lambda_2 = row.correction = 0.0;
      row.change.setZero();
      row.jump.setZero();
      const Vector3* impulse_W = FindImpulse(cache, cached, contact.key + point.feature);
      if (impulse_W != nullptr) {
        row.lambda_n = std::max(0.0, frames_[c].col(2).dot(*impulse_W));
        row.lambda_1 = frames_[c].col(0).dot(*impulse_W);
        row.lambda_2 = frames_[c].col(1).dot(*impulse_W);
        ProjectOnCircle(row.friction * row.lambda_n, &row.lambda_1, &row.lambda_2);
      }
    }
    AddPairs(static_cast<int>(next) - contact.manifold.size, contact.manifold.size);
  }
  // Only now, so that the bounce is computed from the velocities before any impulse.
  for (const PointRows& row : points_) {
    AddToVelocities(row, Vector3(row.lambda_n, row.lambda_1, row.lambda_2), y_.data());
  }
}

// Joins the points of one contact in pairs whose normal impulses are solved together. Of four round
// a face, opposite ones leave the other pair's tilt alone. On a long narrow face both pairs would
// tilt it the same way; there the ends of each long side go together. Among many points, pairs of
// different pieces work against each other (a cup of 25 pieces did not settle): there each point is
// on its own.
void ContactSolver::AddPairs(int first, int size) {
  constexpr double kNarrow = 0.5;
  constexpr std::size_t kMany = 8;
  const auto coupling = [&](int i, int j) {
    return CalcCoupling(points_[first + i], points_[first + j], 0);
  };
  if (size == 1 || points_.size() > kMany) {
    for (int i = 0; i < size; ++i) pairs_.push_back({first + i});
    return;
  }
  if (size < 4) {
    AddPair(first, first + 1, coupling(0, 1));
    if (size == 3) pairs_.push_back({first + 2});
    return;
  }
  // Opposite to the first point is the one that is coupled to it least.
  std::array<double, 4> k = {0.0, coupling(0, 1), coupling(0, 2), coupling(0, 3)};
  int opposite = 1;
  for (int i = 2; i < 4; ++i) {
    if (k[i] < k[opposite]) opposite = i;
  }
  int near = opposite == 1 ? 2 : 1, far = opposite == 3 ? 2 : 3;
  if (k[far] > k[near]) std::swap(near, far);
  if (k[near] - k[far] < kNarrow * (points_[first].K_nn - k[opposite])) {
    AddPair(first, first + opposite, k[opposite]);
    AddPair(first + near, first + far, coupling(near, far));
  } else {
    AddPair(first, first + far, k[far]);
    AddPair(first + opposite, first + near, coupling(opposite, near));
  }
  for (int i = 4; i < size; ++i) pairs_.push_back({first + i});
}

void ContactSolver::AddPair(int a, int b, double K_ab) {
  constexpr double kMinDeterminant = 1e-4;  // as a share of the diagonal's
  const double K_aa = points_[a].K_nn, K_bb = points_[b].K_nn;
  const double determinant = K_aa * K_bb - K_ab * K_ab;
  if (determinant < kMinDeterminant * K_aa * K_bb) {
    // Almost one point: either can carry all.
    pairs_.push_back({a});
    pairs_.push_back({b});
    return;
  }
  const double inverse = 1.0 / determinant;
  pairs_.push_back({a, b, K_ab, K_bb * inverse, K_aa * inverse, -K_ab * inverse});
}

// How fast a point may approach: so that it just closes its gap in this step; or, where it bounces,
// minus the speed it leaves with.
double ContactSolver::CalcBias(const StepConfig& config, const PointRows& row) const {
  if (config.restitution > 0.0) {
    double v_n = row.J_first[0].dot(y_[row.first]);
    if (row.second >= 0) v_n += row.J_second[0].dot(y_[row.second]);
    if (v_n < -kMinBounceSpeed && row.phi + config.dt * v_n < 0.0) return config.restitution * v_n;
  }
  return row.phi > 0.0 ? row.phi / config.dt : 0.0;
}

void ContactSolver::AddFinger(const BodyKernel& kernel, const BodyMotion& motion,
                              const FingerRows& rows) {
  FingerRows& finger = fingers_.emplace_back(rows);
  // The rows push inward: minus the outward normal, with the tangents as they are.
  Matrix3 frame_W = finger.R_WC;
  frame_W.col(2) = -finger.R_WC.col(2);
  SetJacobian(kernel, motion, frame_W, motion.R_WP.transpose() * frame_W,
              motion.p_WBcm + finger.r_W, 1.0, &finger.J);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      finger.K(i, j) = finger.K(j, i) = finger.J[i].dot(finger.J[j]);
    }
    finger.K(i, i) += finger.gamma;
  }
  finger.inv_K = finger.K.inverse();
  finger.inv_mass = 1.0 / kernel.mass;
  y_[0] += finger.J[0] * finger.lambda[0] + finger.J[1] * finger.lambda[1] +
           finger.J[2] * finger.lambda[2];
}

void ContactSolver::Solve(const StepConfig& config) {
  const int max_sweeps = y_.size() <= 2 ? config.max_sweeps : config.max_sweeps_many;
  // On one body, sweeping to and fro converges faster. Along a row of bodies it does not: a push
  // travels in the order of the pairs.
  const bool alternate = y_.size() == 1;
  bool overlap = false;
  for (const PointRows& row : points_) overlap = overlap || row.phi < -kCorrectionSlop;
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    double change = 0.0;
    for (FingerRows& row : fingers_) {
      change = std::max(change, SweepFinger(row, y_.data()) * row.inv_mass);
    }
    const bool backward = alternate && sweep % 2 == 1;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const PointPair& pair = pairs_[backward ? pairs_.size() - 1 - i : i];
      const double impulse = SweepPair(pair, points_.data(), y_.data());
      change = std::max(change, impulse * points_[pair.a].inv_mass);
    }
    if (change < config.tolerance) break;
    if (sweep % 2 == 1 && sweep + 1 < max_sweeps) Accelerate(sweep > 1 ? CalcStretch() : 0.0);
  }
  z_.assign(y_.size(), Vector6::Zero());
  if (overlap) CorrectPositions(config, max_sweeps);
}

// How far to go on, as a share of the progress since the last pair of sweeps (Anderson's
// acceleration of depth one; Walker and Ni 2011): where sweeps are slow, what a pair changes is
// nearly a multiple of what the pair before changed, and this leads to where the change vanishes.
// Where the last pair changed more than the one before there is no such line.
double ContactSolver::CalcStretch() const {
  constexpr double kMin = -0.5, kMax = 10.0, kGrain = 1.0 / 64.0;
  double along = 0.0, length2 = 0.0, last2 = 0.0, now2 = 0.0;
  for (const PointRows& row : points_) {
    const Vector3 d = row.change - row.last_change;
    along += row.change.dot(d);
    length2 += d.squaredNorm();
    last2 += row.last_change.squaredNorm();
    now2 += row.change.squaredNorm();
  }
  if (!(now2 < last2 && length2 > 0.0 && std::isfinite(length2))) return 0.0;
  // In coarse grains, so that rounding errors are not magnified.
  return kGrain * static_cast<int>(std::clamp(-along / length2, kMin, kMax) / kGrain);
}

// Goes on by `stretch` and begins the next pair of sweeps.
void ContactSolver::Accelerate(double stretch) {
  for (PointRows& row : points_) {
    const Vector3 progress = row.jump + row.change;
    const double lambda_n = std::max(0.0, row.lambda_n + stretch * progress[0]);
    double lambda_1 = row.lambda_1 + stretch * progress[1];
    double lambda_2 = row.lambda_2 + stretch * progress[2];
    ProjectOnCircle(row.friction * lambda_n, &lambda_1, &lambda_2);
    row.jump = Vector3(lambda_n - row.lambda_n, lambda_1 - row.lambda_1, lambda_2 - row.lambda_2);
    row.lambda_n = lambda_n;
    row.lambda_1 = lambda_1;
    row.lambda_2 = lambda_2;
    AddToVelocities(row, row.jump, y_.data());
    row.last_change = row.change;
    row.change.setZero();
  }
}

// Pseudo-velocities z move overlapping bodies apart in this step and are then forgotten, so that
// the correction adds no energy (split impulses).
void ContactSolver::CorrectPositions(const StepConfig& config, int max_sweeps) {
  for (PointRows& row : points_) {
    double v_n = row.J_first[0].dot(y_[row.first]);
    if (row.second >= 0) v_n += row.J_second[0].dot(y_[row.second]);
    const double gap_velocity =
        row.phi >= 0.0 ? row.phi / config.dt
                       : std::max(-kMaxCorrectionSpeed, kCorrectionShare * row.phi / config.dt);
    row.correction_bias = v_n + gap_velocity;
  }
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    double change = 0.0;
    for (PointRows& row : points_) {
      double v_n = row.correction_bias + row.J_first[0].dot(z_[row.first]);
      if (row.second >= 0) v_n += row.J_second[0].dot(z_[row.second]);
      const double correction = std::max(0.0, row.correction - v_n * row.inv_K_nn);
      const double d = correction - row.correction;
      row.correction = correction;
      z_[row.first] += row.J_first[0] * d;
      if (row.second >= 0) z_[row.second] += row.J_second[0] * d;
      change = std::max(change, std::abs(d) * row.inv_mass);
    }
    if (change < config.tolerance) break;
  }
}

Vector3 ContactSolver::CalcSlipVelocity(const PointRows& row) const {
  double v_1 = row.J_first[1].dot(y_[row.first]), v_2 = row.J_first[2].dot(y_[row.first]);
  if (row.second >= 0) {
    v_1 += row.J_second[1].dot(y_[row.second]);
    v_2 += row.J_second[2].dot(y_[row.second]);
  }
  return frame(row).col(0) * v_1 + frame(row).col(1) * v_2;
}

Vector3 ContactSolver::CalcObjectVelocity(const FingerRows& finger) const {
  return {finger.J[0].dot(y_[0]), finger.J[1].dot(y_[0]), finger.J[2].dot(y_[0])};
}

void ContactSolver::SumImpulses(const std::vector<BodyMotion>& motions,
                                const std::vector<Contact>& contacts,
                                std::vector<BodyImpulse>* impulses) const {
  impulses->assign(motions.size(), {});
  const auto add = [&](int i, const Vector3& p_W, const Vector3& impulse_W,
                       const Vector3& correction_W) {
    BodyImpulse& sum = (*impulses)[i];
    const Vector3 r_W = p_W - motions[i].p_WBcm;
    sum.linear += impulse_W;
    sum.angular += r_W.cross(impulse_W);
    sum.linear_correction += correction_W;
    sum.angular_correction += r_W.cross(correction_W);
  };
  for (const PointRows& row : points_) {
    const Contact& contact = contacts[row.contact];
    const Vector3& p_W = contact.manifold.points[row.point].p_W;
    const Vector3 impulse = impulse_W(row), correction = frame(row).col(2) * row.correction;
    if (contact.movable_a >= 0) add(contact.movable_a, p_W, -impulse, -correction);
    if (contact.movable_b >= 0) add(contact.movable_b, p_W, impulse, correction);
  }
  for (const FingerRows& row : fingers_) {
    add(0, motions[0].p_WBcm + row.r_W, row.ToWorld(row.lambda), Vector3::Zero());
  }
}

void ContactSolver::SaveImpulses(const std::vector<Contact>& contacts,
                                 std::vector<WorldState::CachedImpulse>* cache) const {
  cache->clear();
  for (const PointRows& row : points_) {
    if (row.lambda_n <= 0.0) continue;
    const Contact& contact = contacts[row.contact];
    cache->push_back({contact.key + contact.manifold.points[row.point].feature, impulse_W(row)});
  }
}

}  // namespace pregrasp
