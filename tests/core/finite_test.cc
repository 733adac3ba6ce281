#include "app/core/finite.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace pregrasp {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(FiniteTest, OneBadNumberAnywhereIsSeen) {
  EXPECT_TRUE(IsFinite(-1e300));
  EXPECT_FALSE(IsFinite(kNan));
  EXPECT_FALSE(IsFinite(-kInf));
  EXPECT_TRUE(IsFinite(Vector3(1, 2, 3)));
  EXPECT_FALSE(IsFinite(Vector3(1, kInf, 3)));
  EXPECT_FALSE(IsFinite(Vector3(1, 2, 3) * kNan));  // an expression
  EXPECT_FALSE(IsFinite(Quaternion(1, 0, kNan, 0)));
  RigidTransform X = RigidTransform::Identity();
  EXPECT_TRUE(IsFinite(X));
  X.translation().z() = kNan;
  EXPECT_FALSE(IsFinite(X));
}

TEST(FiniteTest, RangesAndListsOfFactsAreSearchedToTheirEnd) {
  std::vector<Vector3> points(5, Vector3::Ones());
  std::array<std::vector<double>, 2> nested{std::vector<double>{1.0}, {2.0, 3.0}};
  EXPECT_TRUE(AreFinite(1.0, points, nested, std::vector<double>{}));
  points[4].y() = kInf;
  EXPECT_FALSE(AreFinite(1.0, points, nested));
  points[4].y() = 0.0;
  nested[1][1] = kNan;
  EXPECT_FALSE(AreFinite(1.0, points, nested));
}

}  // namespace
}  // namespace pregrasp
