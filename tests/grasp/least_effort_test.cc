#include <gtest/gtest.h>

#include "app/core/rng.h"
#include "app/grasp/contact_wrenches.h"

namespace pregrasp {
namespace {

using internal::ProjectForce;

TEST(ProjectForceTest, TheProjectionIsAdmissibleAndNoAdmissibleForceIsNearer) {
  Rng rng(1, RngStream::kTest);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 n = rng.Direction();
    const double mu = rng.Uniform(0.0, 1.2), f_min = rng.Uniform(0.0, 1.0), f_max = 3.0;
    const Vector3 z = 5.0 * rng.Uniform() * rng.Direction();
    const Vector3 f = ProjectForce(z, n, mu, f_min, f_max, nullptr);
    const auto admissible = [&](const Vector3& g, double slack) {
      const double s = g.dot(n);
      return s >= f_min - slack && s <= f_max + slack && (g - s * n).norm() <= mu * s + slack;
    };
    ASSERT_TRUE(admissible(f, 1e-12));
    for (int k = 0; k < 20; ++k) {
      const double s = rng.Uniform(f_min, f_max);
      const Vector3 across = rng.Direction().cross(n);
      const Vector3 g = s * n + mu * s * rng.Uniform() * across;
      ASSERT_TRUE(admissible(g, 1e-12));
      EXPECT_LE((z - f).dot(g - f), 1e-9);
    }
  }
}

TEST(ProjectForceTest, ItsJacobianIsThatOfFiniteDifferences) {
  Rng rng(2, RngStream::kTest);
  int agree = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 n = rng.Direction();
    const Vector3 z = 5.0 * rng.Uniform() * rng.Direction();
    Matrix3 jacobian, difference;
    ProjectForce(z, n, 0.7, 0.5, 3.0, &jacobian);
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      difference.col(k) = (ProjectForce(z + h * Vector3::Unit(k), n, 0.7, 0.5, 3.0, nullptr) -
                           ProjectForce(z - h * Vector3::Unit(k), n, 0.7, 0.5, 3.0, nullptr)) /
                          (2.0 * h);
    }
    agree += (jacobian - difference).norm() < 1e-6;
  }
  EXPECT_GE(agree, 1996);  // all but those within h of a kink
}

}  // namespace
}  // namespace pregrasp
