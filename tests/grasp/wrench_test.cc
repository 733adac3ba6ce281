#include "app/grasp/wrench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "app/core/error.h"
#include "tests/grasp/contact_sets.h"
#include "tests/grasp/wrench_lp.h"

namespace pregrasp {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

WrenchConfig Weightless(double mu) {
  WrenchConfig config;
  config.mu = mu;
  config.torque_scale = 0.1;
  return config;
}

Vector6 NetWrench(const std::vector<WrenchContact>& contacts, const WrenchConfig& config,
                  const MatrixX3& forces) {
  Vector6 net = Vector6::Zero();
  net.head<3>() = config.mass * config.gravity;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 f = forces.row(static_cast<int>(i));
    net.head<3>() += f;
    net.tail<3>() += contacts[i].p.cross(f) / config.torque_scale;
  }
  return net;
}

// The least that the net wrench of admissible forces, weight included, has along a direction: each
// cone as a ring of 720 forces, at the floor and at the cap.
double CalcLeastAlong(const std::vector<WrenchContact>& contacts, const WrenchConfig& config,
                      const Vector6& direction) {
  double least = direction.head<3>().dot(config.mass * config.gravity);
  for (const WrenchContact& contact : contacts) {
    const Matrix3 R = FrameFromNormal(contact.n.normalized());
    double smallest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 720; ++k) {
      const double angle = k * kPi / 360;
      const Vector3 f = R * Vector3(config.mu * std::cos(angle), config.mu * std::sin(angle), 1.0);
      const double along = direction.head<3>().dot(f) +
                           direction.tail<3>().dot(contact.p.cross(f)) / config.torque_scale;
      smallest = std::min({smallest, config.f_min * along, config.f_max * along});
    }
    least += smallest;
  }
  return least;
}

// A pinch along x: contacts at +-a on faces whose normals are turned by `tilt` about y.
std::vector<WrenchContact> Pinch(double a, double tilt) {
  const Vector3 n(std::cos(tilt), 0.0, std::sin(tilt));
  return {{Vector3(-a, 0.0, 0.0), n}, {Vector3(a, 0.0, 0.0), Vector3(-n.x(), 0.0, n.z())}};
}

TEST(WrenchLpTest, TheVerdictIsThatOfAnIndependentLinearProgramOn12000RandomSets) {
  // The circular cone lies between the pyramids of 64 edges inside and around it (0.12 % apart in
  // mu), so each verdict must be confirmed by the pyramid that makes it harder. Where that fails
  // the set is borderline, and then at least the other pyramid must not contradict.
  constexpr int kSets = 12000, kFacets = 64;
  constexpr double kTolerance = 1e-7;
  Rng rng(1, RngStream::kTest);
  int asked = 0, borderline = 0;
  std::array<int, 3> verdicts{};
  for (int set = 0; set < kSets; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    const WrenchConfig config = SampleWrenchConfig(rng);
    const WrenchStatus status = CalcWrenchStatus(contacts, config);
    ++verdicts[static_cast<int>(status)];
    const auto confirm = [&](bool with_weight, bool feasible) {
      ++asked;
      const Pyramid harder = feasible ? Pyramid::kInscribed : Pyramid::kCircumscribed;
      const Pyramid easier = feasible ? Pyramid::kCircumscribed : Pyramid::kInscribed;
      const auto lp_feasible = [&](Pyramid pyramid) {
        return CalcImbalanceByLp(contacts, config, with_weight, kFacets, pyramid) <= kTolerance;
      };
      if (lp_feasible(harder) == feasible) return;
      ++borderline;
      EXPECT_EQ(lp_feasible(easier), feasible) << "set " << set << ", weight " << with_weight;
    };
    confirm(false, status != WrenchStatus::kNoInternalForces);
    if (status != WrenchStatus::kNoInternalForces) {
      confirm(true, status == WrenchStatus::kFeasible);
    }
  }
  EXPECT_LE(borderline, asked / 500);
  for (const int count : verdicts) EXPECT_GT(count, kSets / 20);
  RecordProperty("asked", asked);
  RecordProperty("borderline", borderline);
}

TEST(WrenchTest, EveryVerdictComesWithItsProof) {
  Rng rng(2, RngStream::kTest);
  for (int set = 0; set < 1500; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    WrenchConfig config = SampleWrenchConfig(rng);
    const WrenchResult result = CalcWrench(contacts, config);
    EXPECT_EQ(result.status, CalcWrenchStatus(contacts, config));
    double min_normal = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vector3 n = contacts[i].n.normalized();
      const Vector3 f = result.forces.row(static_cast<int>(i));
      const double normal = f.dot(n);
      EXPECT_GE(normal, config.f_min - 1e-9);
      EXPECT_LE(normal, config.f_max + 1e-9);
      EXPECT_LE((f - normal * n).norm(), config.mu * normal + 1e-9);
      min_normal = std::min(min_normal, normal);
    }
    EXPECT_DOUBLE_EQ(result.min_normal, min_normal);
    if (result.feasible()) {
      EXPECT_LE(NetWrench(contacts, config, result.forces).norm(), 1e-8 * config.f_max);
      continue;
    }
    if (result.status == WrenchStatus::kNoInternalForces) config.mass = 0.0;
    EXPECT_NEAR(NetWrench(contacts, config, result.forces).norm(), result.residual, 1e-9);
    EXPECT_GT(CalcLeastAlong(contacts, config, result.separating), 0.0);
  }
}

TEST(WrenchTest, TwoOpposedContactsCloseExactlyWhenBothConesHoldTheLineBetweenThem) {
  for (const double mu : {0.1, 0.4, 0.8, 1.5}) {
    for (const double share : {0.0, 0.5, 0.999999, 1.000001, 1.2}) {
      const double tilt = share * std::atan(mu);
      const WrenchStatus expected =
          share <= 1.0 ? WrenchStatus::kFeasible : WrenchStatus::kNoInternalForces;
      EXPECT_EQ(CalcWrenchStatus(Pinch(0.03, tilt), Weightless(mu)), expected)
          << mu << " " << share;
    }
  }
}

TEST(WrenchTest, TwoOpposedContactsOffsetSidewaysCloseExactlyWithinTheFrictionAngle) {
  for (const double mu : {0.2, 0.8}) {
    for (const double share : {0.99999, 1.00001}) {
      const double a = 0.02, offset = share * mu * a;
      const std::vector<WrenchContact> contacts{{{-a, -offset, 0}, {1, 0, 0}},
                                                {{a, offset, 0}, {-1, 0, 0}}};
      EXPECT_EQ(CalcWrenchStatus(contacts, Weightless(mu)) == WrenchStatus::kFeasible, share < 1.0);
    }
  }
}

TEST(WrenchTest, ThreeFrictionlessFingersAroundADiscObeyLamisRatios) {
  // Radial forces at angles 0, b and -b balance in the ratio 1 : 1/(2 cos(pi - b)).
  WrenchConfig config = Weightless(0.0);
  config.f_min = 1.0;
  for (const double b : {1.8, 2.0, 2.6, 3.0}) {
    std::vector<WrenchContact> contacts;
    for (const double angle : {0.0, b, -b}) {
      const Vector3 d(std::cos(angle), std::sin(angle), 0.0);
      contacts.push_back({0.05 * d, -d});
    }
    const double other = 1.0 / (2.0 * std::cos(kPi - b));
    const double ratio = std::max(other, 1.0 / other);
    config.f_max = ratio * (1.0 + 1e-6);
    EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kFeasible) << b;
    config.f_max = ratio * (1.0 - 1e-6);
    EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kNoInternalForces) << b;
  }
}

TEST(WrenchTest, APinchCarriesTwiceTheFrictionOfTheForceCap) {
  WrenchConfig config = Weightless(0.8);
  const double limit = 2.0 * config.mu * config.f_max / 9.81;
  config.mass = limit * (1.0 - 1e-7);
  EXPECT_EQ(CalcWrenchStatus(Pinch(0.03, 0.0), config), WrenchStatus::kFeasible);
  config.mass = limit * (1.0 + 1e-7);
  EXPECT_EQ(CalcWrenchStatus(Pinch(0.03, 0.0), config), WrenchStatus::kWeightNotBalanced);
}

TEST(WrenchTest, APinchBesideTheCentreOfMassCannotHoldTheWeight) {
  WrenchConfig config = Weightless(0.8);
  config.mass = 0.1;
  std::vector<WrenchContact> contacts = Pinch(0.03, 0.0);
  for (WrenchContact& contact : contacts) contact.p.z() += 0.02;  // above it is fine
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kFeasible);
  for (WrenchContact& contact : contacts) contact.p.y() += 1e-4;
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kWeightNotBalanced);
}

TEST(WrenchTest, AFingerBelowCarriesTheWeightAndTheFloorOfTheFingerAbove) {
  const std::vector<WrenchContact> contacts{{{0, 0, -0.05}, {0, 0, 1}}, {{0, 0, 0.05}, {0, 0, -1}}};
  WrenchConfig config = Weightless(0.5);
  const double limit = (config.f_max - config.f_min) / 9.81;
  config.mass = limit * (1.0 - 1e-9);
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kFeasible);
  config.mass = limit * (1.0 + 1e-7);
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kWeightNotBalanced);
}

TEST(WrenchTest, AFingerThatMustPushCanSpoilAGraspThatHoldsWithoutIt) {
  std::vector<WrenchContact> contacts = Pinch(0.03, 0.0);
  WrenchConfig config = Weightless(0.05);
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kFeasible);
  contacts.push_back({{0, 0, 0.2}, {0, 0, -1}});
  config.f_min = 2.0;  // more than the 2 mu f_max that the pinch's friction can take up
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kNoInternalForces);
  config.f_min = 0.0;
  EXPECT_EQ(CalcWrenchStatus(contacts, config), WrenchStatus::kFeasible);
}

TEST(WrenchTest, PushingOneWayOnlyIsNotClosureEvenWhereItCarriesTheWeight) {
  // Three fingers below a box: the weight is balanced, but nothing pushes back without it.
  std::vector<WrenchContact> contacts;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0 * kPi * k / 3;
    contacts.push_back({{0.05 * std::cos(angle), 0.05 * std::sin(angle), -0.02}, {0, 0, 1}});
  }
  WrenchConfig config = Weightless(0.8);
  config.mass = 1.0;
  const WrenchResult result = CalcWrench(contacts, config);
  EXPECT_EQ(result.status, WrenchStatus::kNoInternalForces);
  EXPECT_FALSE(result.closed);
  // With f_min apiece the net upward force is at least 3 f_min.
  EXPECT_NEAR(result.residual, 3.0 * config.f_min, 1e-9);
}

TEST(WrenchTest, LeastEffortInAPinchIsTheWeightSharedAndTheNormalThatFrictionNeeds) {
  WrenchConfig config = Weightless(0.4);
  for (const double mass : {0.01, 0.1, 0.5, 0.9}) {
    config.mass = mass;
    const double weight = 9.81 * mass;
    const double normal = std::max(config.f_min, weight / (2.0 * config.mu));
    const WrenchResult result = CalcWrench(Pinch(0.03, 0.0), config);
    ASSERT_TRUE(result.feasible());
    MatrixX3 expected(2, 3);
    expected << normal, 0, weight / 2, -normal, 0, weight / 2;
    EXPECT_LT((result.forces - expected).norm(), 1e-9) << mass;
    EXPECT_NEAR(result.min_normal, normal, 1e-9);
  }
}

TEST(WrenchTest, NoOtherAdmissibleForcesHoldTheObjectWithLessEffort) {
  // Any other solution g satisfies |g| >= |f|, and the variational inequality f . (g - f) >= 0.
  Rng rng(5, RngStream::kTest);
  int compared = 0;
  for (int set = 0; set < 400; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    WrenchConfig config = SampleWrenchConfig(rng);
    const WrenchResult least = CalcWrench(contacts, config);
    config.f_min = config.f_min + 0.3 * rng.Uniform();  // what is feasible here is so there too
    config.mu *= rng.Uniform(0.7, 1.0);
    const WrenchResult other = CalcWrench(contacts, config);
    if (!least.feasible() || !other.feasible()) continue;
    ++compared;
    EXPECT_GE(least.forces.cwiseProduct(other.forces - least.forces).sum(), -1e-6);
  }
  EXPECT_GT(compared, 100);
}

TEST(WrenchTest, VerdictAndForcesTurnWithTheWorldAndFollowTheOrderOfTheContacts) {
  Rng rng(3, RngStream::kTest);
  for (int set = 0; set < 500; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    const WrenchConfig config = SampleWrenchConfig(rng);
    const WrenchResult result = CalcWrench(contacts, config);
    const Matrix3 R = rng.Rotation().toRotationMatrix();
    std::vector<WrenchContact> turned;
    for (auto it = contacts.rbegin(); it != contacts.rend(); ++it) {
      turned.push_back({R * it->p, 3.7 * R * it->n});  // normals of any length
    }
    WrenchConfig turned_config = config;
    turned_config.gravity = R * config.gravity;
    const WrenchResult other = CalcWrench(turned, turned_config);
    ASSERT_EQ(other.status, result.status);
    if (!result.feasible()) continue;
    EXPECT_NEAR(other.residual, result.residual, 1e-6 * config.f_max);
    const MatrixX3 back = (other.forces * R).colwise().reverse();
    EXPECT_LT((back - result.forces).norm(), 1e-4 * config.f_max) << set;
  }
}

TEST(WrenchTest, VerdictDoesNotDependOnTheUnitsOfForceAndLength) {
  Rng rng(4, RngStream::kTest);
  for (int set = 0; set < 1000; ++set) {
    std::vector<WrenchContact> contacts = SampleContactSet(rng);
    WrenchConfig config = SampleWrenchConfig(rng);
    const WrenchStatus status = CalcWrenchStatus(contacts, config);
    config.mass *= 1000.0;
    config.f_min *= 1000.0;
    config.f_max *= 1000.0;
    config.torque_scale *= 0.01;
    for (WrenchContact& contact : contacts) contact.p *= 0.01;
    EXPECT_EQ(CalcWrenchStatus(contacts, config), status);
  }
}

TEST(WrenchTest, TheVerdictIsMonotoneInFrictionAndInTheForceRange) {
  Rng rng(6, RngStream::kTest);
  for (int set = 0; set < 1000; ++set) {
    const std::vector<WrenchContact> contacts = SampleContactSet(rng);
    const WrenchConfig config = SampleWrenchConfig(rng);
    if (CalcWrenchStatus(contacts, config) != WrenchStatus::kFeasible) continue;
    WrenchConfig wider = config;
    wider.mu += 0.1;
    wider.f_max += 1.0;
    wider.f_min *= 0.5;
    EXPECT_EQ(CalcWrenchStatus(contacts, wider), WrenchStatus::kFeasible);
  }
}

TEST(WrenchTest, SetsOnTheBoundaryHaveAVerdictAndItsProof) {
  // Points on a grid, normals along axes, friction 1: cones that just touch are common here, and
  // forces that balance only at the cones' very edge count as balancing.
  Rng rng(8, RngStream::kTest);
  std::array<int, 3> verdicts{};
  for (int set = 0; set < 3000; ++set) {
    std::vector<WrenchContact> contacts = SampleContactSet(rng);
    for (WrenchContact& contact : contacts) {
      int axis = 0;
      contact.n.cwiseAbs().maxCoeff(&axis);
      contact.n = std::copysign(1.0, contact.n[axis]) * Vector3::Unit(axis);
      for (int k = 0; k < 3; ++k) contact.p[k] = std::round(contact.p[k] * 50.0) / 50.0;
    }
    WrenchConfig config = SampleWrenchConfig(rng);
    config.mu = 1.0;
    const WrenchResult result = CalcWrench(contacts, config);
    ++verdicts[static_cast<int>(result.status)];
    if (result.feasible()) {
      EXPECT_LE(NetWrench(contacts, config, result.forces).norm(), 1e-7 * config.f_max);
    } else {
      if (result.status == WrenchStatus::kNoInternalForces) config.mass = 0.0;
      EXPECT_GT(CalcLeastAlong(contacts, config, result.separating), 0.0);
    }
  }
  for (const int count : verdicts) EXPECT_GT(count, 100);
}

TEST(WrenchTest, AForceCapFarBeyondNeedBlursNothing) {
  // 10 g at a pinch whose faces lean apart just too far: no force helps, 1 kN or 1 GN.
  WrenchConfig config = Weightless(0.5);
  config.mass = 0.01;
  for (const double cap : {12.0, 1e3, 1e6, 1e9}) {
    config.f_max = cap;
    EXPECT_EQ(CalcWrenchStatus(Pinch(0.03, 1.001 * std::atan(0.5)), config),
              WrenchStatus::kNoInternalForces)
        << cap;
    EXPECT_EQ(CalcWrenchStatus(Pinch(0.03, 0.999 * std::atan(0.5)), config),
              WrenchStatus::kFeasible)
        << cap;
    // And none makes a pinch hold a weight that turns about it.
    std::vector<WrenchContact> beside = Pinch(0.03, 0.0);
    for (WrenchContact& contact : beside) contact.p.y() += 1e-3;
    EXPECT_EQ(CalcWrenchStatus(beside, config), WrenchStatus::kWeightNotBalanced) << cap;
  }
}

TEST(WrenchTest, AnyNumberOfContactsIsASet) {
  const std::vector<WrenchContact> one{{{0, 0, -0.05}, {0, 0, 1}}};
  EXPECT_EQ(CalcWrench(one, Weightless(0.8)).status, WrenchStatus::kNoInternalForces);
  WrenchConfig config = Weightless(0.8);
  config.f_min = 0.0;  // a finger that need not push
  config.mass = 0.1;
  const WrenchResult carried = CalcWrench(one, config);
  ASSERT_TRUE(carried.feasible());
  EXPECT_LT((carried.forces.row(0) - Vector3(0, 0, 0.981).transpose()).norm(), 1e-9);
  std::vector<WrenchContact> many;
  for (int k = 0; k < 12; ++k) {
    const Vector3 d(std::cos(k * kPi / 6), std::sin(k * kPi / 6), 0.0);
    many.push_back({0.05 * d, -d});
  }
  config.f_min = 0.1;
  const WrenchResult shared = CalcWrench(many, config);
  ASSERT_TRUE(shared.feasible());
  for (int k = 0; k < 12; ++k) EXPECT_NEAR(shared.forces(k, 2), 0.981 / 12, 1e-9);
}

TEST(WrenchTest, BadInputIsAnInputErrorThatNamesTheField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<WrenchContact> good = Pinch(0.03, 0.0);
  const auto field_of = [](const std::vector<WrenchContact>& contacts, const WrenchConfig& config) {
    try {
      CalcWrenchStatus(contacts, config);
    } catch (const InputError& error) {
      return error.field();
    }
    return std::string("none");
  };
  EXPECT_EQ(field_of(good, {}), "none");
  EXPECT_EQ(field_of({}, {}), "p");
  EXPECT_EQ(field_of({good[0], {{nan, 0, 0}, {1, 0, 0}}}, {}), "p[2]");
  EXPECT_EQ(field_of({{{0, 0, 0}, {0, 0, 0}}, good[1]}, {}), "n[1]");
  EXPECT_EQ(field_of({{{0, 0, 0}, {0, nan, 0}}, good[1]}, {}), "n[1]");
  const auto field_with = [&](double WrenchConfig::*member, double value) {
    WrenchConfig config;
    config.*member = value;
    return field_of(good, config);
  };
  for (const double bad : {nan, -0.1, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(field_with(&WrenchConfig::mu, bad), "mu");
    EXPECT_EQ(field_with(&WrenchConfig::mass, bad), "mass");
    EXPECT_EQ(field_with(&WrenchConfig::f_min, bad), "f_min");
    EXPECT_EQ(field_with(&WrenchConfig::f_max, bad), "f_max");
    EXPECT_EQ(field_with(&WrenchConfig::torque_scale, bad), "torque_scale");
  }
  EXPECT_EQ(field_with(&WrenchConfig::f_max, 0.4), "f_max");  // below f_min
  EXPECT_EQ(field_with(&WrenchConfig::torque_scale, 0.0), "torque_scale");
  EXPECT_THROW(MakeWrenchContacts(MatrixX3::Zero(2, 3), MatrixX3::Ones(3, 3)), InputError);
}

}  // namespace
}  // namespace pregrasp
