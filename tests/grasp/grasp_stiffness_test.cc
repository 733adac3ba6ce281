#include "app/grasp/grasp_stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "app/core/rng.h"
#include "app/dynamics/world.h"
#include "app/grasp/stiffest_forces.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

constexpr double kStiffness = 300.0;  // [N/m]

// Two contacts on the x axis, a half width a apart from the centre, pressed with F.
std::vector<WrenchContact> MakePair(double a) {
  return {{Vector3(a, 0, 0), -Vector3::UnitX()}, {Vector3(-a, 0, 0), Vector3::UnitX()}};
}

MatrixX3 Squeeze(double force) {
  MatrixX3 forces(2, 3);
  forces << -force, 0, 0, force, 0, 0;
  return forces;
}

TEST(GraspStiffnessTest, APairOfContactsTurnsTheObjectOverAboveForceStiffnessTimesHalfWidth) {
  const double a = 0.015, limit = kStiffness * a;
  for (const double force : {0.5 * limit, 0.99 * limit, 1.01 * limit, 2.0 * limit}) {
    const Matrix6 K = CalcGraspStiffness(MakePair(a), Squeeze(force), kStiffness);
    for (const int axis : {4, 5}) {  // about y and z
      EXPECT_NEAR(K(axis, axis), 2.0 * a * (kStiffness * a - force), 1e-12);
    }
    EXPECT_NEAR(K(3, 3), 0.0, 1e-12);  // nothing resists about the line of the contacts
    EXPECT_NEAR(K(0, 0), 2.0 * kStiffness, 1e-9);
    const LeastStiffness least = FindLeastStiffness(K, 0.04);
    EXPECT_EQ(least.value > -1e-9, force < limit);
    EXPECT_GT(least.turn.norm(), 0.999);
  }
}

// In a scene without gravity, far from the table.
double TurnOfASqueezedCube(double a, double force) {
  Scene scene = MakeScene("cube", Box{{2 * a, 2 * a, 2 * a}}, 0.05, Shift(0, 0, 1));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
  scene.gravity.setZero();
  const World world(scene);
  WorldState state = world.InitialState();
  const Vector3 outward[] = {Vector3::UnitX(), -Vector3::UnitX()};
  for (int f = 0; f < 2; ++f) {
    const Finger finger = static_cast<Finger>(f);
    world.PutFinger(state, finger, a * outward[f]);
    world.SetStiffness(state, finger, kStiffness);
    state.fingers[f].p_WTarget -= force / kStiffness * outward[f];
  }
  state.bodies.front().w_WB.y() = 0.02;  // [rad/s]
  for (int i = 0; i < 3 * 240; ++i) world.Step(state);
  return RadToDeg(RotationAngle(Matrix3::Identity(), state.bodies.front().X_WB().linear()));
}

TEST(GraspStiffnessTest, TheSimulationAgreesWithTheClosedForm) {
  const double a = 0.02, limit = kStiffness * a;  // 6 N
  EXPECT_LT(TurnOfASqueezedCube(a, 0.85 * limit), 0.5);
  EXPECT_GT(TurnOfASqueezedCube(a, 1.15 * limit), 20.0);
}

// A grasp of random contacts with forces whose net force is the weight's and whose torques cancel.
struct RandomGrasp {
  std::vector<WrenchContact> contacts;
  MatrixX3 forces;

  explicit RandomGrasp(std::uint64_t seed) {
    Rng rng(seed);
    const auto random = [&](double size) {
      return Vector3(rng.Uniform(-size, size), rng.Uniform(-size, size), rng.Uniform(-size, size));
    };
    const int n = 5;
    MatrixX W(6, 3 * n);
    for (int i = 0; i < n; ++i) {
      const Vector3 p = random(0.05);
      contacts.push_back({p, -p});
      for (int k = 0; k < 3; ++k) {
        W.block<3, 1>(0, 3 * i + k) = Vector3::Unit(k);
        W.block<3, 1>(3, 3 * i + k) = p.cross(Vector3(Vector3::Unit(k)));
      }
    }
    VectorX f(3 * n), wrench = VectorX::Zero(6);
    for (int i = 0; i < 3 * n; ++i) f[i] = rng.Uniform(-4.0, 4.0);
    wrench[2] = 2.0;
    f += W.transpose() * (W * W.transpose()).ldlt().solve(wrench - W * f);
    forces.resize(n, 3);
    for (int i = 0; i < n; ++i) forces.row(i) = f.segment<3>(3 * i);
  }

  // Of the springs and of the weight, after a motion (shift, turn) of the object.
  double CalcEnergy(const Eigen::Matrix<double, 6, 1>& motion) const {
    const Vector3 turn = motion.tail<3>();
    const Matrix3 R = turn.norm() > 0.0
                          ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                          : Matrix3::Identity();
    double energy = 2.0 * motion[2];
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vector3 f = forces.row(static_cast<Eigen::Index>(i));
      const Vector3 target = contacts[i].p + f / kStiffness;
      const Vector3 p = motion.head<3>() + R * contacts[i].p;
      energy += 0.5 * kStiffness * (target - p).squaredNorm();
    }
    return energy;
  }
};

TEST(GraspStiffnessTest, IsTheSecondDerivativeOfTheSpringsEnergy) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RandomGrasp grasp(seed);
    const Matrix6 K = CalcGraspStiffness(grasp.contacts, grasp.forces, kStiffness);
    const double h = 1e-4;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const auto at = [&](double x, double y) {
          Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
          motion[i] += x;
          motion[j] += y;
          return grasp.CalcEnergy(motion);
        };
        const double numeric = (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4.0 * h * h);
        EXPECT_NEAR(K(i, j), numeric, 1e-4 * kStiffness) << i << ", " << j;
      }
    }
  }
}

TEST(GraspStiffnessTest, TheLeastDirectionIsTheWeakestOfAllWithTurningMeasuredByTheLength) {
  const RandomGrasp grasp(3);
  const Matrix6 K = CalcGraspStiffness(grasp.contacts, grasp.forces, kStiffness);
  const double length = 0.04;
  const LeastStiffness least = FindLeastStiffness(K, length);
  const auto along = [&](const Vector3& shift, const Vector3& turn) {
    Eigen::Matrix<double, 6, 1> motion;
    motion << shift, turn / length;
    return motion.dot(K * motion);
  };
  EXPECT_NEAR(least.shift.squaredNorm() + least.turn.squaredNorm(), 1.0, 1e-12);
  EXPECT_NEAR(along(least.shift, least.turn), least.value, 1e-9 * kStiffness);
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    Eigen::Matrix<double, 6, 1> x;
    for (int k = 0; k < 6; ++k) x[k] = rng.Uniform(-1.0, 1.0);
    x.normalize();
    EXPECT_GE(along(x.head<3>(), x.tail<3>()), least.value - 1e-9);
  }
}

// Thumb against two fingers across a bar of half width a.
std::vector<WrenchContact> MakePinch(double a) {
  return {{Vector3(0, -a, 0), Vector3::UnitY()},
          {Vector3(0.012, a, 0), -Vector3::UnitY()},
          {Vector3(-0.012, a, 0), -Vector3::UnitY()}};
}

TEST(GraspForcesTest, BalanceTheWeightInsideTheReserveAndAreStifferThanLeastEffortAtAnySqueeze) {
  const std::vector<WrenchContact> contacts = MakePinch(0.02);
  WrenchConfig wrench;
  wrench.mass = 0.1;
  wrench.torque_scale = 0.05;
  const GraspForcesConfig config;
  const std::optional<GraspForces> found = ChooseGraspForces(contacts, wrench, 300.0, config);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->is_stiff);
  EXPECT_EQ(found->reserve, config.friction_reserve);
  Vector3 net = wrench.mass * wrench.gravity, torque = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3 f = found->forces.row(i);
    const double normal = f.dot(contacts[i].n);
    EXPECT_GE(normal, wrench.f_min - 1e-9);
    EXPECT_LE((f - normal * contacts[i].n).norm(), 0.6 * wrench.mu * normal + 1e-9);
    net += f;
    torque += contacts[i].p.cross(f);
  }
  EXPECT_LT(net.norm(), 1e-8);
  EXPECT_LT(torque.norm(), 1e-9);
  for (const double squeeze : {0.5, 1.0, 2.0, 4.0}) {
    WrenchConfig harder = wrench;
    harder.mu *= config.friction_reserve;
    harder.f_min = squeeze;
    const MatrixX3 forces = CalcWrench(contacts, harder).forces;
    const double stiffness =
        FindLeastStiffness(CalcGraspStiffness(contacts, forces, 300.0), config.turn_length).value;
    EXPECT_LE(stiffness, found->least.value + 1e-6) << squeeze;
  }
}

// Three contacts on one side of a thin bar and two on the other, 8 to 12 cm from its centre.
std::vector<WrenchContact> MakeEndGrasp() {
  const double a = 0.015;
  return {{Vector3(0.10, -a, 0), Vector3::UnitY()},
          {Vector3(0.08, -a, 0), Vector3::UnitY()},
          {Vector3(0.12, a, 0), -Vector3::UnitY()},
          {Vector3(0.10, a, 0), -Vector3::UnitY()},
          {Vector3(0.08, a, 0), -Vector3::UnitY()}};
}

TEST(StiffestForcesTest, NoOtherForcesOfBalanceAreStiffer) {
  const std::vector<WrenchContact> contacts = MakeEndGrasp();
  WrenchConfig wrench;
  wrench.mass = 0.025;
  wrench.torque_scale = 0.15;
  wrench.f_max = 6.0;
  const double k = 300.0, length = 0.038;
  const auto least_of = [&](const MatrixX3& forces) {
    return FindLeastStiffness(CalcGraspStiffness(contacts, forces, k), length).value;
  };
  ASSERT_EQ(CalcWrenchStatus(contacts, wrench), WrenchStatus::kFeasible);
  const MatrixX3 start = CalcWrench(contacts, wrench).forces;
  const MatrixX3 best = FindStiffestForces(contacts, wrench, k, length, start);
  EXPECT_GT(least_of(best), least_of(start) + 0.5);
  Vector3 net = wrench.mass * wrench.gravity, torque = Vector3::Zero();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vector3 f = best.row(static_cast<Eigen::Index>(i));
    const double normal = f.dot(contacts[i].n);
    EXPECT_GE(normal, wrench.f_min - 1e-7);
    EXPECT_LE(normal, wrench.f_max + 1e-7);
    EXPECT_LE((f - normal * contacts[i].n).norm(), wrench.mu * normal + 1e-7);
    net += f;
    torque += contacts[i].p.cross(f);
  }
  EXPECT_LT(net.norm(), 1e-9);
  EXPECT_LT(torque.norm(), 1e-9);
  // Forces of balance in random directions: those of least effort with each contact's own bounds,
  // and all that lie between them and the best.
  Rng rng(7);
  for (int i = 0; i < 200; ++i) {
    WrenchConfig other = wrench;
    other.f_min = rng.Uniform(0.5, 5.0);
    other.mu = rng.Uniform(0.3, 0.8);
    if (CalcWrenchStatus(contacts, other) != WrenchStatus::kFeasible) continue;
    const MatrixX3 forces = CalcWrench(contacts, other).forces;
    const double s = rng.Uniform(0.0, 1.0);
    EXPECT_LE(least_of(s * forces + (1.0 - s) * best), least_of(best) * (1.0 + 0.03));
  }
}

TEST(GraspForcesTest, WithSoftFingersAHeavyBarIsNotHeldStiffly) {
  WrenchConfig wrench;
  wrench.mass = 0.5;
  wrench.torque_scale = 0.05;
  const std::optional<GraspForces> soft = ChooseGraspForces(MakePinch(0.01), wrench, 50.0, {});
  const std::optional<GraspForces> stiff = ChooseGraspForces(MakePinch(0.01), wrench, 600.0, {});
  ASSERT_TRUE(soft.has_value() && stiff.has_value());
  EXPECT_FALSE(soft->is_stiff);
  EXPECT_LT(soft->least.value, 0.0);
  EXPECT_GT(soft->least.turn.norm(), soft->least.shift.norm());
  EXPECT_GT(stiff->least.value, 0.0);
}

TEST(GraspForcesTest, WhatNothingBalancesHasNoForces) {
  WrenchConfig wrench;
  wrench.mass = 20.0;  // 196 N on three fingers of 12 N
  wrench.torque_scale = 0.05;
  EXPECT_FALSE(ChooseGraspForces(MakePinch(0.02), wrench, 300.0, {}).has_value());
}

}  // namespace
}  // namespace pregrasp
