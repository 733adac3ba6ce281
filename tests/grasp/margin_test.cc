#include <gtest/gtest.h>

#include <limits>

#include "app/grasp/wrench.h"
#include "tests/grasp/contact_sets.h"
#include "tests/grasp/qhull_margin.h"

namespace pregrasp {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

std::vector<WrenchContact> Ring(int count, double radius) {
  std::vector<WrenchContact> contacts;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * kPi * k / count;
    const Vector3 d(std::cos(angle), std::sin(angle), 0.0);
    contacts.push_back({radius * d, -d});
  }
  return contacts;
}

std::vector<WrenchContact> SixAxes(double radius) {
  std::vector<WrenchContact> contacts;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      contacts.push_back({side * radius * Vector3::Unit(axis), -side * Vector3::Unit(axis)});
    }
  }
  return contacts;
}

TEST(MarginTest, ItIsTheDistanceToTheNearestFacetOfTheWholeHullThatQhullBuilds) {
  Rng rng(1, RngStream::kTest);
  int compared = 0;
  while (compared < 60) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    const double mu = rng.Uniform(0.2, 1.2), scale = rng.Uniform(0.05, 0.2);
    const double margin = CalcMargin(contacts, mu, scale);
    if (margin <= 0.0) continue;
    EXPECT_NEAR(margin, CalcNearestFacetByQhull(CalcEdgeWrenches(contacts, mu, scale)), 1e-8);
    ++compared;
  }
  for (const auto& contacts : {Ring(3, 0.05), Ring(4, 0.05), Ring(6, 0.05), SixAxes(0.1)}) {
    EXPECT_NEAR(CalcMargin(contacts, 0.8, 0.1),
                CalcNearestFacetByQhull(CalcEdgeWrenches(contacts, 0.8, 0.1)), 1e-8);
  }
}

TEST(MarginTest, NoDirectionOfDisturbanceIsResistedLessAndOutsideItIsTheDistance) {
  Rng rng(2, RngStream::kTest);
  int negative = 0;
  for (int set = 0; set < 300; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    const double margin = CalcMargin(contacts, 0.8, 0.1);
    const MatrixX6 points = CalcEdgeWrenches(contacts, 0.8, 0.1);
    negative += margin < 0.0;
    for (int k = 0; k < 200; ++k) {
      Vector6 y;
      for (int i = 0; i < 6; ++i) y[i] = rng.Normal();
      EXPECT_GE((points * y.normalized()).maxCoeff(), margin - 1e-9);
    }
    // A convex combination is in the hull, so never nearer than its distance.
    VectorX weights(points.rows());
    for (int i = 0; i < weights.size(); ++i) weights[i] = -std::log(1.0 - rng.Uniform());
    if (margin < 0.0) {
      EXPECT_LE(-margin, (points.transpose() * weights / weights.sum()).norm() + 1e-12);
    }
  }
  EXPECT_GT(negative, 50);
}

TEST(MarginTest, KnownSetsHaveTheirClosedForm) {
  // One frictionless contact: the hull is a point.
  const std::vector<WrenchContact> one{{{0.0, 0.3, 0.0}, {1.0, 0.0, 0.0}}};
  EXPECT_NEAR(CalcMargin(one, 0.0, 0.1), -std::sqrt(1.0 + 9.0), 1e-12);
  // Two contacts that push the same way: the nearest wrench is the shared normal.
  const std::vector<WrenchContact> same{{{-0.1, 0, 0}, {0, 0, 1}}, {{0.1, 0, 0}, {0, 0, 1}}};
  EXPECT_NEAR(CalcMargin(same, 0.8, 0.1), -1.0, 1e-12);
  // Six contacts along the axes at distance 1 resist a torque about the diagonal least: only by
  // friction, mu each, at the angle between the diagonal and the axes.
  EXPECT_NEAR(CalcMargin(SixAxes(0.1), 0.8, 0.1), 0.8 * std::sqrt(2.0 / 3.0), 1e-9);
}

TEST(MarginTest, HullsWithoutInteriorHaveMarginZeroOrLess) {
  const std::vector<WrenchContact> pinch{{{-0.03, 0, 0}, {1, 0, 0}}, {{0.03, 0, 0}, {-1, 0, 0}}};
  EXPECT_EQ(CalcMargin(pinch, 0.8, 0.1), 0.0);
  std::vector<WrenchContact> twice = pinch;
  twice.insert(twice.end(), pinch.begin(), pinch.end());
  EXPECT_EQ(CalcMargin(twice, 0.8, 0.1), 0.0);
  std::vector<WrenchContact> line = pinch;  // three contacts on one line still turn about it
  line.push_back({{0.01, 0, 0}, {0, 1, 0}});
  EXPECT_LE(CalcMargin(line, 0.8, 0.1), 0.0);
  // A pinch and a third contact whose torque about the pinch's line has one sign only: the hull has
  // an interior, and the origin is on its boundary.
  std::vector<WrenchContact> third = pinch;
  third.push_back({{0, 0.1, 0}, {0, 0, 1}});
  EXPECT_EQ(CalcMargin(third, 0.8, 0.1), 0.0);
  EXPECT_EQ(CalcMargin(Ring(4, 0.05), 0.0, 0.1), 0.0);  // frictionless in a plane
  EXPECT_LT(CalcMargin({pinch.data(), 1}, 0.8, 0.1), 0.0);
}

TEST(MarginTest, ItGrowsWithFrictionAndDoesNotDependOnTheUnitOfLength) {
  for (const auto& contacts : {Ring(3, 0.05), Ring(5, 0.05), SixAxes(0.05)}) {
    double last = 0.0;
    for (const double mu : {0.2, 0.4, 0.8, 1.2}) {
      const double margin = CalcMargin(contacts, mu, 0.05);
      EXPECT_GT(margin, last);
      last = margin;
      std::vector<WrenchContact> larger = contacts;
      for (WrenchContact& contact : larger) contact.p *= 10.0;
      EXPECT_NEAR(CalcMargin(larger, mu, 0.5), margin, 1e-9);
    }
  }
}

TEST(MarginTest, ClosureAndEquilibriumWithoutForceLimitsAgree) {
  // Above 0 means every wrench can be resisted, so certainly none needs resisting.
  Rng rng(3, RngStream::kTest);
  for (int set = 0; set < 400; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    WrenchConfig config;
    config.f_min = 0.0;
    config.f_max = 1e4;
    config.mass = 0.5;
    config.torque_scale = 0.1;
    const WrenchResult result = CalcWrench(contacts, config);
    EXPECT_EQ(result.closed, result.margin > 0.0);
    if (result.margin > 1e-2) {
      EXPECT_TRUE(result.feasible());
    }
    if (result.margin < -1e-2) {
      config.f_min = 1.0;
      config.mu *= std::cos(kPi / 16);  // inside the 16-gon, so that the circle has no more than it
      EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kNoInternalForces);
    }
  }
}

}  // namespace
}  // namespace pregrasp
