#include "app/dynamics/contact_solver.h"

#include <algorithm>
#include <cmath>

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
  row->K_n1 = K(0, 1);
  row->K_n2 = K(0, 2);
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

// Adds a change of a point's impulse (normal, tangent 1, tangent 2) to the velocities.
inline void AddToVelocities(const PointRows& row, const Vector3& d, Vector6* y) {
  y[row.first] += row.J_first[0] * d[0] + row.J_first[1] * d[1] + row.J_first[2] * d[2];
  if (row.second < 0) return;
  y[row.second] += row.J_second[0] * d[0] + row.J_second[1] * d[1] + row.J_second[2] * d[2];
}

// One Gauss-Seidel update of a point; returns the largest change of its impulse [N s].
inline double SweepPoint(PointRows& row, Vector6* y) {
  const Vector6& y1 = y[row.first];
  double v_n = row.bias + row.J_first[0].dot(y1);
  if (row.second >= 0) v_n += row.J_second[0].dot(y[row.second]);
  const double lambda_n = std::max(0.0, row.lambda_n - v_n * row.inv_K_nn);
  const double d_n = lambda_n - row.lambda_n;
  if (lambda_n == 0.0 && d_n == 0.0) return 0.0;  // apart, and was before

  double v_1 = row.J_first[1].dot(y1), v_2 = row.J_first[2].dot(y1);
  if (row.second >= 0) {
    const Vector6& y2 = y[row.second];
    v_1 += row.J_second[1].dot(y2);
    v_2 += row.J_second[2].dot(y2);
  }
  v_1 += row.K_n1 * d_n;
  v_2 += row.K_n2 * d_n;
  // Sticking solves the tangential block exactly. Sliding steps along the slip velocity with one
  // scale for both tangents, so that at the fixed point friction opposes the slip exactly.
  const double limit = row.friction * lambda_n;
  double lambda_1 = row.lambda_1 - row.inv_K_11 * v_1 - row.inv_K_12 * v_2;
  double lambda_2 = row.lambda_2 - row.inv_K_12 * v_1 - row.inv_K_22 * v_2;
  if (lambda_1 * lambda_1 + lambda_2 * lambda_2 > limit * limit) {
    lambda_1 = row.lambda_1 - row.inv_K_tt_max * v_1;
    lambda_2 = row.lambda_2 - row.inv_K_tt_max * v_2;
    ProjectOnCircle(limit, &lambda_1, &lambda_2);
  }
  const Vector3 d(d_n, lambda_1 - row.lambda_1, lambda_2 - row.lambda_2);
  row.change += d;
  row.lambda_n = lambda_n;
  row.lambda_1 = lambda_1;
  row.lambda_2 = lambda_2;
  AddToVelocities(row, d, y);
  return std::max(std::abs(d[0]), std::max(std::abs(d[1]), std::abs(d[2])));
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
  }
  // Only now, so that the bounce is computed from the velocities before any impulse.
  for (const PointRows& row : points_) {
    AddToVelocities(row, Vector3(row.lambda_n, row.lambda_1, row.lambda_2), y_.data());
  }
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
    for (std::size_t i = 0; i < points_.size(); ++i) {
      PointRows& row = points_[backward ? points_.size() - 1 - i : i];
      change = std::max(change, SweepPoint(row, y_.data()) * row.inv_mass);
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
