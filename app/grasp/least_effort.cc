#include <Eigen/Cholesky>

#include "app/grasp/contact_wrenches.h"

namespace pregrasp::internal {

// The admissible set is the trapezoid 0 <= t <= mu s, f_min <= s <= f_max turned about the normal
// (s along it, t across), so the projection is one in the plane.
Vector3 ProjectForce(const Vector3& z, const Vector3& n, double mu, double f_min, double f_max,
                     Matrix3* jacobian) {
  const double s = z.dot(n);
  const Vector3 z_t = z - s * n;
  const double t = z_t.norm();
  const Vector3 that = t > 0.0 ? Vector3(z_t / t) : Vector3::Zero();
  const double s_clamped = std::clamp(s, f_min, f_max);

  if (t <= mu * s_clamped) {  // above or below the cap and the floor, or inside
    if (jacobian) {
      *jacobian = Matrix3::Identity();
      if (s != s_clamped) *jacobian -= n * n.transpose();
    }
    return s_clamped * n + z_t;
  }
  // Nearest point of the cone's line t = mu s, cut at the corners.
  const double on_line = (s + mu * t) / (1.0 + mu * mu);
  const double s_line = std::clamp(on_line, f_min, f_max);
  if (jacobian) {
    const Matrix3 around = Matrix3::Identity() - n * n.transpose() - that * that.transpose();
    *jacobian = (mu * s_line / t) * around;
    if (s_line == on_line) {
      const Vector3 u = (n + mu * that) / std::sqrt(1.0 + mu * mu);
      *jacobian += u * u.transpose();
    }
  }
  return s_line * (n + mu * that);
}

namespace {

// phi(y) = sum of |z|^2/2 - |z - P z|^2/2 at z = -W' y, minus y load: convex, once differentiable,
// with gradient -(W P(-W' y) + load). Its minimiser is the multiplier of the balance.
struct Dual {
  const std::vector<ScaledContact>& contacts;
  const Vector6& load;
  const WrenchConfig& config;

  double Calc(const Vector6& y, Vector6& gradient, Eigen::Matrix<double, 6, 6>* hessian,
              MatrixX3& forces) const {
    double phi = -y.dot(load);
    gradient = -load;
    if (hessian) hessian->setZero();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const ScaledContact& contact = contacts[i];
      const Vector3 z = -CalcForceDirection(contact, y);
      Matrix3 jacobian;
      const Vector3 f = ProjectForce(z, contact.n, config.mu, config.f_min, config.f_max,
                                     hessian ? &jacobian : nullptr);
      phi += z.dot(f) - 0.5 * f.squaredNorm();
      gradient -= CalcWrenchOf(contact, f);
      forces.row(static_cast<int>(i)) = f;
      if (!hessian) continue;
      Eigen::Matrix<double, 6, 3> W;
      for (int k = 0; k < 3; ++k) W.col(k) = CalcWrenchOf(contact, Vector3::Unit(k));
      *hessian += W * jacobian * W.transpose();
    }
    return phi;
  }
};

}  // namespace

// Semismooth Newton on the dual of min sum |f|^2/2 (Qi and Sun, "A nonsmooth version of Newton's
// method", Math. Programming 58, 1993): six unknowns however many contacts.
double SolveLeastEffort(const std::vector<ScaledContact>& contacts, const Vector6& load,
                        const WrenchConfig& config, MatrixX3& forces) {
  const Dual dual{contacts, load, config};
  const double scale = config.f_max;
  Vector6 y = Vector6::Zero(), gradient, trial_gradient;
  Eigen::Matrix<double, 6, 6> hessian;
  MatrixX3 current = forces, trial = forces, best = forces;

  Vector6 net = load;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    net += CalcWrenchOf(contacts[i], forces.row(static_cast<int>(i)));
  }
  double best_residual = std::max(net.norm(), 1e-9 * scale);

  double phi = dual.Calc(y, gradient, &hessian, current);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double residual = gradient.norm();
    if (residual <= best_residual) {
      best_residual = residual;
      best = current;
    }
    if (residual <= 1e-13 * scale) break;
    hessian.diagonal().array() +=
        1e-12 * hessian.trace() + 1e-6 * std::min(1.0, residual / scale) + 1e-14;
    const Vector6 step = -hessian.ldlt().solve(gradient);
    const double slope = gradient.dot(step);
    double length = 1.0, trial_phi = 0.0;
    bool moved = false;
    for (int halving = 0; halving < 40 && !moved; ++halving, length *= 0.5) {
      trial_phi = dual.Calc(y + length * step, trial_gradient, nullptr, trial);
      moved = trial_phi <= phi + 1e-4 * length * slope + 1e-15 * std::abs(phi);
    }
    if (!moved) break;
    y += 2.0 * length * step;  // the loop has halved once more
    phi = dual.Calc(y, gradient, &hessian, current);
  }
  forces = best;
  net = load;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    net += CalcWrenchOf(contacts[i], forces.row(static_cast<int>(i)));
  }
  return net.norm();
}

}  // namespace pregrasp::internal
