#include "app/grasp/grasp_stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/grasp/stiffest_forces.h"

namespace pregrasp {
namespace {

Matrix3 CrossMatrix(const Vector3& p) {
  Matrix3 S;
  S << 0.0, -p.z(), p.y(), p.z(), 0.0, -p.x(), -p.y(), p.x(), 0.0;
  return S;
}

// The stiffest of the forces inside `reserve` of the friction cone and of the cap.
std::optional<GraspForces> ChooseInside(double reserve, std::span<const WrenchContact> contacts,
                                        WrenchConfig wrench, double k,
                                        const GraspForcesConfig& config) {
  wrench.mu *= reserve;
  // The cap bounds the whole force, f_max its normal part.
  if (reserve < 1.0) wrench.f_max *= reserve / std::sqrt(1.0 + wrench.mu * wrench.mu);
  if (!(wrench.f_min <= wrench.f_max)) return {};
  if (CalcWrenchStatus(contacts, wrench) != WrenchStatus::kFeasible) return {};
  GraspForces found;
  found.forces = FindStiffestForces(contacts, wrench, k, config.turn_length,
                                    CalcWrench(contacts, wrench).forces);
  found.reserve = reserve;
  found.squeeze = wrench.f_max;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 f = found.forces.row(static_cast<Eigen::Index>(i));
    found.squeeze = std::min(found.squeeze, f.dot(contacts[i].n.normalized()));
  }
  found.least =
      FindLeastStiffness(CalcGraspStiffness(contacts, found.forces, k), config.turn_length);
  found.is_stiff = found.least.value > config.min_stiffness * k;
  return found;
}

}  // namespace

void GraspForcesConfig::Validate() const {
  if (!(friction_reserve > 0.0 && friction_reserve <= 1.0)) {
    throw InputError("", "friction_reserve", "a share above 0 and at most 1",
                     FormatDouble(friction_reserve));
  }
  if (!(turn_length > 0.0 && turn_length <= 10.0)) {
    throw InputError("", "turn_length", "a length above 0 and at most 10 m",
                     FormatDouble(turn_length));
  }
  if (!(min_stiffness >= 0.0 && min_stiffness <= 1.0)) {
    throw InputError("", "min_stiffness", "a share from 0 to 1", FormatDouble(min_stiffness));
  }
}

Matrix6 CalcGraspStiffness(std::span<const WrenchContact> contacts, const MatrixX3& forces,
                           double k) {
  PREGRASP_CHECK(forces.rows() == static_cast<Eigen::Index>(contacts.size()));
  Matrix6 K = Matrix6::Zero();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3& p = contacts[i].p;
    const Vector3 f = forces.row(static_cast<Eigen::Index>(i));
    Eigen::Matrix<double, 3, 6> J;  // the contact's motion: d + theta x p
    J << Matrix3::Identity(), -CrossMatrix(p);
    K += k * J.transpose() * J;
    K.bottomRightCorner<3, 3>() +=
        f.dot(p) * Matrix3::Identity() - 0.5 * (f * p.transpose() + p * f.transpose());
  }
  return K;
}

LeastStiffness FindLeastStiffness(const Matrix6& K, double turn_length) {
  Eigen::Matrix<double, 6, 1> scale;
  scale << Vector3::Ones(), Vector3::Constant(1.0 / turn_length);
  const Matrix6 scaled = scale.asDiagonal() * K * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(scaled);
  Eigen::Matrix<double, 6, 1> direction = eigen.eigenvectors().col(0);
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  if (direction[largest] < 0.0) direction = -direction;  // the sign is arbitrary: make it one
  return {eigen.eigenvalues()[0], direction.head<3>(), direction.tail<3>()};
}

std::optional<GraspForces> ChooseGraspForces(std::span<const WrenchContact> contacts,
                                             const WrenchConfig& wrench, double k,
                                             const GraspForcesConfig& config) {
  std::optional<GraspForces> best;
  const double half_way = 0.5 * (config.friction_reserve + 1.0);
  for (const double reserve : {config.friction_reserve, half_way, 1.0}) {
    std::optional<GraspForces> found = ChooseInside(reserve, contacts, wrench, k, config);
    if (!found) continue;
    if (found->is_stiff) return found;
    if (!best || found->least.value > best->least.value) best = std::move(found);
  }
  return best;
}

}  // namespace pregrasp
