#include "app/dynamics/motion.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace pregrasp {

BodyKernel MakeBodyKernel(BodyIndex body, double mass, const Vector3& p_BoBcm,
                          const Matrix3& I_BBcm, double reach) {
  BodyKernel kernel;
  kernel.body = body;
  kernel.mass = mass;
  kernel.p_BoBcm = p_BoBcm;
  kernel.reach = reach;
  const double off_diagonal =
      std::abs(I_BBcm(0, 1)) + std::abs(I_BBcm(0, 2)) + std::abs(I_BBcm(1, 2));
  if (off_diagonal <= 1e-12 * I_BBcm.trace()) {
    kernel.I_P = I_BBcm.diagonal();
  } else {
    const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(I_BBcm);
    kernel.is_aligned = false;
    kernel.R_BP = eigen.eigenvectors();
    if (kernel.R_BP.determinant() < 0.0) kernel.R_BP.col(0) *= -1.0;
    kernel.I_P = eigen.eigenvalues();
  }
  kernel.inv_mass = 1.0 / mass;
  kernel.inv_sqrt_I_P = kernel.I_P.cwiseSqrt().cwiseInverse();
  return kernel;
}

}  // namespace pregrasp
