#include "app/grasp/stiffest_forces.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "app/core/check.h"
#include "app/grasp/contact_wrenches.h"
#include "app/grasp/grasp_stiffness.h"

namespace pregrasp {
namespace {

constexpr int kSteps = 80;          // of the ascent
constexpr double kFirstStep = 2.0;  // [N]; then falling as 1 / sqrt(step)
constexpr int kRounds = 20;         // of Dykstra's projection in a step
constexpr int kLastRounds = 400;    // and for the forces that are returned
constexpr double kShrink = 0.01;    // they are sought so far inside the bounds, and so end inside
constexpr double kAlike = 0.02;     // eigenvalues within this share of k are raised together

// Forces one below the other, contact by contact (3 #contacts).
class ForceSet {
 public:
  ForceSet(std::span<const WrenchContact> contacts, const WrenchConfig& wrench)
      : wrench_(wrench), W_(6, 3 * static_cast<Eigen::Index>(contacts.size())) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      contacts_.push_back(internal::MakeScaledContact(contacts[i], wrench.torque_scale));
      for (int k = 0; k < 3; ++k) {
        W_.col(static_cast<Eigen::Index>(3 * i) + k) =
            internal::CalcWrenchOf(contacts_.back(), Vector3::Unit(k));
      }
    }
    balance_ = Vector6::Zero();
    balance_.head<3>() = -wrench.mass * wrench.gravity;
    solver_.compute(W_ * W_.transpose());
  }

  // Onto the forces of balance.
  VectorX Balance(const VectorX& f) const {
    return f + W_.transpose() * solver_.solve(balance_ - W_ * f);
  }

  // Dykstra's algorithm (1983): converges to the projection onto both.
  VectorX Project(VectorX f, int rounds) const {
    VectorX correction = VectorX::Zero(f.size());
    for (int round = 0; round < rounds; ++round) {
      f = Balance(f);
      const VectorX outside = f + correction;
      f = Confine(outside);
      correction = outside - f;
    }
    return Balance(f);
  }

  bool Admits(const VectorX& f, double tolerance) const {
    return (Bound(f, wrench_) - f).cwiseAbs().maxCoeff() <= tolerance &&
           (W_ * f - balance_).norm() <= tolerance;
  }

 private:
  VectorX Confine(const VectorX& f) const {
    WrenchConfig inside = wrench_;
    inside.mu *= 1.0 - kShrink;
    inside.f_min *= 1.0 + kShrink;
    inside.f_max *= 1.0 - kShrink;
    return Bound(f, inside);
  }

  VectorX Bound(const VectorX& f, const WrenchConfig& bounds) const {
    VectorX bounded(f.size());
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      bounded.segment<3>(at) = internal::ProjectForce(f.segment<3>(at), contacts_[i].n, bounds.mu,
                                                      bounds.f_min, bounds.f_max, nullptr);
    }
    return bounded;
  }

  WrenchConfig wrench_;
  std::vector<internal::ScaledContact> contacts_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> W_;
  Vector6 balance_;
  Eigen::LDLT<Matrix6> solver_;
};

MatrixX3 ToRows(const VectorX& f) {
  MatrixX3 rows(f.size() / 3, 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = f.segment<3>(3 * i);
  return rows;
}

VectorX ToColumn(const MatrixX3& rows) {
  VectorX f(3 * rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) f.segment<3>(3 * i) = rows.row(i);
  return f;
}

// The least eigenvalue at forces f, and the direction in which it grows fastest: the mean over the
// eigenvectors whose eigenvalues are nearly as small.
double CalcLeast(std::span<const WrenchContact> contacts, const VectorX& f, double k,
                 double turn_length, VectorX* gradient) {
  Vector6 scale;
  scale << Vector3::Ones(), Vector3::Constant(1.0 / turn_length);
  const Matrix6 K =
      scale.asDiagonal() * CalcGraspStiffness(contacts, ToRows(f), k) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(K);
  const double least = eigen.eigenvalues()[0];
  gradient->setZero(f.size());
  for (int j = 0; j < 6 && eigen.eigenvalues()[j] <= least + kAlike * k; ++j) {
    const Vector3 turn = eigen.eigenvectors().col(j).tail<3>() / turn_length;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vector3& p = contacts[i].p;
      gradient->segment<3>(static_cast<Eigen::Index>(3 * i)) +=
          turn.squaredNorm() * p - turn.dot(p) * turn;
    }
  }
  return least;
}

}  // namespace

MatrixX3 FindStiffestForces(std::span<const WrenchContact> contacts, const WrenchConfig& wrench,
                            double k, double turn_length, const MatrixX3& start) {
  PREGRASP_CHECK(start.rows() == static_cast<Eigen::Index>(contacts.size()));
  const ForceSet set(contacts, wrench);
  VectorX f = ToColumn(start), best = f, gradient;
  const double at_start = CalcLeast(contacts, f, k, turn_length, &gradient);
  double most = at_start;
  for (int step = 1; step <= kSteps; ++step) {
    const double size = gradient.norm();
    if (!(size > 0.0)) break;
    f = set.Project(f + (kFirstStep / std::sqrt(step) / size) * gradient, kRounds);
    const double least = CalcLeast(contacts, f, k, turn_length, &gradient);
    if (least <= most) continue;
    most = least;
    best = f;
  }
  best = set.Project(best, kLastRounds);
  const bool is_better = CalcLeast(contacts, best, k, turn_length, &gradient) > at_start;
  return is_better && set.Admits(best, 1e-9 * wrench.f_max) ? ToRows(best) : start;
}

}  // namespace pregrasp
