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
// With more points than this, pairs are not solved together: those of different pieces would work
// against each other (a cup of 25 pieces did not settle).
constexpr std::size_t kMaxPairedPoints = 8;

// Gives a point a new normal impulse; returns the change [N s].
template <typename Velocity>
[[gnu::always_inline]] inline double SetNormalImpulse(double lambda_n, PointRows& point,
                                                      Velocity& v) {
  const double d = lambda_n - point.lambda.n;
  point.lambda.n = lambda_n;
  v.AddNormal(point, d);
  return std::abs(d);
}

// One Gauss-Seidel update of a point's friction; returns the largest change [N s]. Sticking solves
// the tangential block exactly. Sliding steps along the slip velocity with one scale for both
// tangents, so that at the fixed point friction opposes the slip exactly.
template <typename Velocity>
[[gnu::always_inline]] inline double SweepFriction(double friction, PointRows& point, Velocity& v) {
  const Vector2 old = point.lambda.t;
  const double limit = friction * point.lambda.n;
  if (limit == 0.0 && old[0] == 0.0 && old[1] == 0.0) return 0.0;
  const Vector2 slip = v.GetSlip(point);
  Vector2 next = old - point.inv_K_t.col(0) * slip[0] - point.inv_K_t.col(1) * slip[1];
  if (next.squaredNorm() > limit * limit) {
    next = old - point.inv_K_t_max * slip;
    const double norm2 = next.squaredNorm();
    // Root and quotient at the same time, where limit / sqrt(norm2) would wait for one another.
    if (norm2 > limit * limit) next *= (limit / norm2) * std::sqrt(norm2);
  }
  const Vector2 d = next - old;
  point.lambda.t = next;
  v.AddFriction(point, d);
  return d.cwiseAbs().maxCoeff();
}

// The normal impulses of two points that make both velocities v zero, or, where that would pull,
// those of the complementarity problem: at each point no pull, no approach, and no push where it
// departs. Its four cases are tried in turn.
inline void SolveNormalPair(const PointPair& pair, const PointRows& a, const PointRows& b,
                            double v_a, double v_b, double* lambda_a, double* lambda_b) {
  *lambda_a = a.lambda.n - pair.inv_aa * v_a - pair.inv_ab * v_b;
  *lambda_b = b.lambda.n - pair.inv_ab * v_a - pair.inv_bb * v_b;
  if (*lambda_a >= 0.0 && *lambda_b >= 0.0) return;
  // The velocities without both impulses.
  v_a -= a.K_n * a.lambda.n + pair.K_ab * b.lambda.n;
  v_b -= b.K_n * b.lambda.n + pair.K_ab * a.lambda.n;
  *lambda_a = std::max(0.0, -v_a * a.inv_K_n);
  *lambda_b = 0.0;
  if (v_b + pair.K_ab * *lambda_a >= 0.0) return;
  *lambda_a = 0.0;
  *lambda_b = std::max(0.0, -v_b * b.inv_K_n);
}

// One Gauss-Seidel update of a pair, or of a point; returns the largest change of an impulse [N s].
template <typename Velocity>
[[gnu::always_inline]] inline double SweepPair(const PointPair& pair, const ContactRows& rows,
                                               Velocity& v) {
  PointRows& a = rows.points[pair.a];
  const double v_a = v.GetNormal(a, a.bias);
  if (pair.b < 0) {
    const double change = SetNormalImpulse(std::max(0.0, a.lambda.n - v_a * a.inv_K_n), a, v);
    return std::max(change, SweepFriction(rows.friction, a, v));
  }
  PointRows& b = rows.points[pair.b];
  double lambda_a = 0.0, lambda_b = 0.0;
  SolveNormalPair(pair, a, b, v_a, v.GetNormal(b, b.bias), &lambda_a, &lambda_b);
  const double d_a = SetNormalImpulse(lambda_a, a, v), d_b = SetNormalImpulse(lambda_b, b, v);
  const double normal = std::max(d_a, d_b);
  const double friction_a = SweepFriction(rows.friction, a, v);
  return std::max(std::max(normal, friction_a), SweepFriction(rows.friction, b, v));
}

// One Gauss-Seidel update of all points; returns the largest change of an impulse [N s].
double SweepRows(bool backward, const ContactRows& rows, BodyVelocity* y) {
  return VisitRelativeVelocity(rows, y, [&](auto v) {
    double change = 0.0;
    for (int i = 0; i < rows.num_pairs; ++i) {
      const PointPair& pair = rows.pairs[backward ? rows.num_pairs - 1 - i : i];
      change = std::max(change, SweepPair(pair, rows, v));
    }
    v.Store(y);
    return change;
  });
}

// One Gauss-Seidel update of all points' corrections; returns the largest change [N s].
double SweepCorrections(const ContactRows& rows, BodyVelocity* z) {
  return VisitRelativeVelocity(rows, z, [&](auto v) {
    double change = 0.0;
    for (PointRows& point : rows.points) {
      const double v_n = v.GetNormal(point, point.correction_bias);
      const double correction = std::max(0.0, point.correction - v_n * point.inv_K_n);
      const double d = correction - point.correction;
      point.correction = correction;
      v.AddNormal(point, d);
      change = std::max(change, std::abs(d));
    }
    v.Store(z);
    return change;
  });
}

// Says when to stop sweeping. In a crowd of points in which a body rests on a few that are near
// each other, and in stacks of bodies, sweeps converge so slowly that much is still to come when
// they change little: there what is to come is bounded, as the sum of a geometric series.
class StopRule {
 public:
  StopRule(double tolerance, bool is_slow) : tolerance_(tolerance), is_slow_(is_slow) {}

  /// @param change  largest change of an impulse over the mass in a sweep [m/s].
  bool IsMet(double change) {
    if (!is_slow_) return change < tolerance_;
    // From one sweep to the next but one, as those to and fro differ.
    const double rate =
        before_last_ > 0.0 ? std::min(kSlowest, std::sqrt(change / before_last_)) : kSlowest;
    before_last_ = std::exchange(last_, change);
    return change < tolerance_ && change * rate < tolerance_ * (1.0 - rate);
  }

 private:
  static constexpr double kSlowest = 0.99;
  const double tolerance_;
  const bool is_slow_;
  double last_ = 0.0, before_last_ = 0.0;
};

// The impulses that the contact's points bore in the last step; null for those that bore none.
// Looks in the two bodies' part of the cache, from `next` on first, as points keep their order as a
// rule.
void FindImpulses(const Contact& contact, std::span<const WorldState::CachedImpulse> cached,
                  std::size_t* next, std::array<const Vector3*, Manifold::kMaxPoints>* impulses_W) {
  for (int k = 0; k < contact.manifold.size; ++k) {
    const std::uint64_t key = contact.manifold.points[k].key;
    (*impulses_W)[k] = nullptr;
    for (std::size_t n = 0, i = *next; n < cached.size(); ++n, ++i) {
      if (i >= cached.size()) i = 0;
      if (cached[i].key != key) continue;
      (*impulses_W)[k] = &cached[i].impulse_W;
      *next = i + 1;
      break;
    }
  }
}

}  // namespace

void ContactSolver::SetContacts(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                                const std::vector<BodyMotion>& motions,
                                const std::vector<Contact>& contacts,
                                const std::vector<WorldState::CachedImpulse>& cache) {
  y_.resize(kernels.size());
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const BodyKernel& kernel = kernels[i];
    y_[i].v_W = motions[i].v_WBcm;
    y_[i].w_P = (motions[i].R_WP.transpose() * motions[i].w_WB)
                    .cwiseProduct(kernel.I_P.cwiseProduct(kernel.inv_sqrt_I_P));
  }
  y_start_.assign(kernels.size(), {});
  fingers_.clear();
  std::size_t num_points = 0;
  for (const Contact& contact : contacts) num_points += contact.manifold.size;
  if (point_memory_.size() < num_points) point_memory_.resize(num_points);
  if (rows_memory_.size() < contacts.size()) rows_memory_.resize(contacts.size());
  rows_ = std::span(rows_memory_.data(), contacts.size());
  std::span<PointRows> points_left(point_memory_.data(), num_points);
  std::span<const WorldState::CachedImpulse> cache_left = cache, cached;
  std::size_t next = 0;  // in `cached`, the part of the two bodies
  std::array<const Vector3*, Manifold::kMaxPoints> start_W;
  crowded_ = false;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const std::size_t size = contacts[c].manifold.size;
    crowded_ = crowded_ || contacts[c].manifold.crowded;
    const std::uint64_t pair = PairOfKey(contacts[c].manifold.points[0].key);
    if (c == 0 || pair != PairOfKey(contacts[c - 1].manifold.points[0].key)) {
      cached = TakePair(pair, &cache_left);
      next = 0;
    }
    FindImpulses(contacts[c], cached, &next, &start_W);
    rows_[c].Set(kernels, motions, contacts[c], start_W, config.spread_support,
                 points_left.first(size), y_start_.data());
    rows_[c].SetPairs(num_points > kMaxPairedPoints);
    SetBias(config, rows_[c]);
    points_left = points_left.subspan(size);
  }
  // Only now, so that the bounce is computed from the velocities before any impulse.
  for (std::size_t i = 0; i < y_.size(); ++i) {
    y_[i].v_W += y_start_[i].v_W;
    y_[i].w_P += y_start_[i].w_P;
  }
}

// How fast a point may approach: so that it just closes its gap in this step; or, where it bounces,
// minus the speed it leaves with.
void ContactSolver::SetBias(const StepConfig& config, const ContactRows& rows) const {
  const double inv_dt = 1.0 / config.dt;
  for (PointRows& point : rows.points) point.bias = std::max(0.0, point.phi * inv_dt);
  if (config.restitution == 0.0) return;
  VisitRelativeVelocity(rows, y_.data(), [&](auto v) {
    for (PointRows& point : rows.points) {
      const double v_n = v.GetNormal(point);
      const bool bounces = v_n < -kMinBounceSpeed && point.phi + config.dt * v_n < 0.0;
      if (bounces) point.bias = config.restitution * v_n;
    }
  });
}

void ContactSolver::AddFinger(const FingertipLaw& law, int index, const FingertipState& finger,
                              const BodyState& state, const BodyKernel& kernel,
                              const BodyMotion& motion) {
  FingerRows& rows = fingers_.emplace_back();
  rows.Set(law, index, finger, state, kernel, motion);
  rows.AddImpulse(rows.lambda, &y_[0]);
}

void ContactSolver::AddPoints(const StepConfig& config, const std::vector<BodyKernel>& kernels,
                              const std::vector<BodyMotion>& motions,
                              const std::vector<Contact>& contacts) {
  SaveImpulses(contacts, &found_impulses_);
  found_fingers_ = fingers_;
  SetContacts(config, kernels, motions, contacts, found_impulses_);
  fingers_.swap(found_fingers_);
  for (const FingerRows& rows : fingers_) rows.AddImpulse(rows.lambda, &y_[0]);
}

Convergence ContactSolver::Solve(const StepConfig& config) {
  constexpr int kMoreSweeps = 5;  // as many times, in a crowd of points
  const int max_sweeps = (y_.size() <= 2 ? config.max_sweeps : config.max_sweeps_many) *
                         std::max(crowded_ ? kMoreSweeps : 1, CalcMassFactor());
  StopRule stop(y_.size() <= 2 ? config.tolerance : config.tolerance_many,
                crowded_ || y_.size() > 1);
  // On one body, sweeping to and fro converges faster. Along a row of bodies it does not: a push
  // travels in the order of the contacts.
  const bool alternate = y_.size() == 1;
  const std::size_t num_rows = rows_.size();
  Convergence convergence{false, 0.0};
  for (int sweep = 0; sweep < max_sweeps && !convergence.converged; ++sweep) {
    double change = 0.0;
    for (FingerRows& finger : fingers_) {
      change = std::max(change, finger.Sweep(&y_[0]) * finger.inv_mass);
    }
    const bool backward = alternate && sweep % 2 == 1;
    for (std::size_t i = 0; i < num_rows; ++i) {
      const ContactRows& rows = rows_[backward ? num_rows - 1 - i : i];
      change = std::max(change, SweepRows(backward, rows, y_.data()) * rows.inv_mass_lighter());
    }
    convergence.converged = stop.IsMet(change);
    if (!convergence.converged && sweep % 2 == 1 && sweep + 1 < max_sweeps) {
      Accelerate(sweep > 1 ? CalcStretch() : 0.0);
    }
  }
  if (!convergence.converged) convergence.residual = CalcApproach();
  z_.assign(y_.size(), {});
  double least_phi = 0.0;
  for (const ContactRows& rows : rows_) {
    for (const PointRows& point : rows.points) least_phi = std::min(least_phi, point.phi);
  }
  if (least_phi < -kCorrectionSlop) CorrectPositions(config, max_sweeps);
  return convergence;
}

// How many times as many sweeps the masses ask for. A heavy body on a light one: what a sweep moves
// it by is a share of what is needed that is as small as their ratio.
int ContactSolver::CalcMassFactor() const {
  constexpr double kOrdinary = 10.0;  // ratio of masses
  constexpr double kMost = 25.0;
  double ratio = 1.0;
  for (const ContactRows& rows : rows_) {
    if (rows.second < 0) continue;
    const double lighter = rows.inv_mass_lighter();
    ratio = std::max(ratio, lighter / (rows.inv_mass_sum - lighter));
  }
  return static_cast<int>(std::clamp(ratio / kOrdinary, 1.0, kMost));
}

// The fastest approach that is left, beyond what the points may [m/s].
double ContactSolver::CalcApproach() const {
  double approach = 0.0;
  for (const ContactRows& rows : rows_) {
    VisitRelativeVelocity(rows, y_.data(), [&](auto v) {
      for (const PointRows& point : rows.points) {
        approach = std::max(approach, -v.GetNormal(point, point.bias));
      }
    });
  }
  return approach;
}

// How far to go on, as a share of the progress since the last pair of sweeps (Anderson's
// acceleration of depth one; Walker and Ni 2011): where sweeps are slow, what a pair changes is
// nearly a multiple of what the pair before changed, and this leads to where the change vanishes.
// Where the last pair changed more than the one before there is no such line.
double ContactSolver::CalcStretch() const {
  constexpr double kMin = -0.5, kMax = 10.0, kGrain = 1.0 / 64.0;
  double along = 0.0, length2 = 0.0, last2 = 0.0, now2 = 0.0;
  for (const ContactRows& rows : rows_) {
    for (const PointRows& point : rows.points) {
      const PointImpulse change = point.lambda - point.start, d = change - point.last_change;
      along += change.dot(d);
      length2 += d.dot(d);
      last2 += point.last_change.dot(point.last_change);
      now2 += change.dot(change);
    }
  }
  if (!(now2 < last2 && length2 > 0.0 && std::isfinite(length2))) return 0.0;
  // In coarse grains, so that rounding errors are not magnified.
  return kGrain * static_cast<int>(std::clamp(-along / length2, kMin, kMax) / kGrain);
}

// Goes on by `stretch` and begins the next pair of sweeps.
void ContactSolver::Accelerate(double stretch) {
  for (const ContactRows& rows : rows_) {
    VisitRelativeVelocity(rows, y_.data(), [&](auto v) {
      for (PointRows& point : rows.points) {
        point.last_change = point.lambda - point.start;
        point.start = point.lambda + (point.jump + point.last_change) * stretch;
        point.start.CutToCone(rows.friction);
        point.jump = point.start - point.lambda;
        point.lambda = point.start;
        v.Add(point, point.jump);
      }
      v.Store(y_.data());
    });
  }
}

// Pseudo-velocities z move overlapping bodies apart in this step and are then forgotten, so that
// the correction adds no energy (split impulses).
void ContactSolver::CorrectPositions(const StepConfig& config, int max_sweeps) {
  for (const ContactRows& rows : rows_) {
    VisitRelativeVelocity(rows, y_.data(), [&](auto v) {
      for (PointRows& point : rows.points) {
        const double gap_velocity = point.phi / config.dt;
        point.correction_bias =
            v.GetNormal(point) +
            (gap_velocity >= 0.0 ? gap_velocity
                                 : std::max(-kMaxCorrectionSpeed, kCorrectionShare * gap_velocity));
      }
    });
  }
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    double change = 0.0;
    for (const ContactRows& rows : rows_) {
      change = std::max(change, SweepCorrections(rows, z_.data()) * rows.inv_mass_lighter());
    }
    if (change < config.tolerance) break;
  }
}

void ContactSolver::GetPoints(const std::vector<Contact>& contacts, double dt,
                              std::vector<ContactPoint>* points) const {
  points->clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactRows& rows = rows_[c];
    VisitRelativeVelocity(rows, y_.data(), [&](auto v) {
      for (std::size_t k = 0; k < rows.points.size(); ++k) {
        const PointRows& point = rows.points[k];
        points->push_back({contacts[c].body_a, contacts[c].body_b,
                           contacts[c].manifold.points[k].p_W, contacts[c].manifold.nhat_W,
                           rows.ToWorld(point.lambda) / dt, point.phi,
                           rows.axes_W.leftCols<2>() * v.GetSlip(point)});
      }
    });
  }
}

void ContactSolver::SumImpulses(const std::vector<BodyMotion>& motions,
                                const std::vector<Contact>& contacts,
                                std::vector<BodyImpulse>* impulses) const {
  impulses->assign(motions.size(), {});
  const auto add = [&](MovableIndex movable, const Vector3& p_W, const Vector3& impulse_W,
                       const Vector3& correction_W) {
    if (movable.is_none()) return;
    BodyImpulse& sum = (*impulses)[movable.value];
    const Vector3 r_W = p_W - motions[movable.value].p_WBcm;
    sum.linear += impulse_W;
    sum.angular += r_W.cross(impulse_W);
    sum.linear_correction += correction_W;
    sum.angular_correction += r_W.cross(correction_W);
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactRows& rows = rows_[c];
    for (std::size_t k = 0; k < rows.points.size(); ++k) {
      const PointRows& point = rows.points[k];
      const Vector3& p_W = contacts[c].manifold.points[k].p_W;
      const Vector3 q_W = rows.FrictionPoint(p_W);
      const Vector3 friction_W = rows.ToWorld({point.lambda.t, 0.0});
      const Vector3 normal_W = rows.axes_W.col(2) * point.lambda.n;
      const Vector3 correction_W = rows.axes_W.col(2) * point.correction;
      add(contacts[c].movable_a, p_W, -normal_W, -correction_W);
      add(contacts[c].movable_a, q_W, -friction_W, Vector3::Zero());
      add(contacts[c].movable_b, p_W, normal_W, correction_W);
      add(contacts[c].movable_b, q_W, friction_W, Vector3::Zero());
    }
  }
  for (const FingerRows& row : fingers_) {
    add(MovableIndex{0}, motions[0].p_WBcm + row.r_W, row.axes_W * row.lambda, Vector3::Zero());
  }
}

void ContactSolver::SaveImpulses(const std::vector<Contact>& contacts,
                                 std::vector<WorldState::CachedImpulse>* cache) const {
  cache->clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactRows& rows = rows_[c];
    for (std::size_t k = 0; k < rows.points.size(); ++k) {
      const PointImpulse& lambda = rows.points[k].lambda;
      if (lambda.n <= 0.0) continue;
      cache->push_back({contacts[c].manifold.points[k].key, rows.ToWorld(lambda)});
    }
  }
}

}  // namespace pregrasp
