#include "app/grasp/balance_proof.h"

#include <gtest/gtest.h>

#include <vector>

#include "app/core/rng.h"
#include "tests/grasp/wrench_lp.h"

namespace pregrasp {
namespace {

const Vector3 kGravity(0.0, 0.0, -9.81);
constexpr double kScale = 0.1;

// Any contacts on the top and on the front of a box.
std::vector<WrenchContact> TopAndFront(Rng& rng, int count) {
  std::vector<WrenchContact> contacts;
  for (int i = 0; i < count; ++i) {
    const double y = rng.Uniform(-0.1, 0.1);
    if (rng.Uniform() < 0.5) {
      contacts.push_back({{rng.Uniform(-0.1, 0.1), y, 0.1}, {0, 0, -1}});
    } else {
      contacts.push_back({{0.1, y, rng.Uniform(-0.1, 0.1)}, {-1, 0, 0}});
    }
  }
  return contacts;
}

TEST(BalanceProofTest, FromAboveOrWithoutContactsNothingCarriesTheWeight) {
  std::vector<WrenchContact> contacts;
  for (int pass = 0; pass < 2; ++pass) {
    const BalanceProof proof = FindBalanceProof(contacts, 3.0, kGravity, kScale);
    EXPECT_TRUE(proof.impossible);
    EXPECT_NEAR(proof.slack, 1.0, 1e-9);
    EXPECT_LT((proof.direction.head<3>() + Vector3::UnitZ()).norm(), 1e-9);
    contacts = {{{0.1, 0, 0}, {0, 0, -1}}, {{-0.1, 0.05, 0}, {0, 0, -1}}};
  }
}

TEST(BalanceProofTest, APushFromBelowTheCentreOfMassCarriesIt) {
  EXPECT_FALSE(
      FindBalanceProof(std::vector<WrenchContact>{{{0, 0, -0.1}, {0, 0, 1}}}, 0.0, kGravity, kScale)
          .impossible);
}

TEST(BalanceProofTest, TopAndFrontOfABoxCarryNothingUpToFrictionOne) {
  // Along (-1, 0, -1) / sqrt 2 the top gives at least (1 - mu) / sqrt 2, and so does the front.
  Rng rng(1, RngStream::kTest);
  const std::vector<WrenchContact> contacts = TopAndFront(rng, 200);
  for (const double mu : {0.2, 0.5, 0.8, 0.99}) {
    const BalanceProof proof = FindBalanceProof(contacts, mu, kGravity, kScale);
    EXPECT_TRUE(proof.impossible);
    EXPECT_NEAR(proof.slack, (1.0 - mu) / std::sqrt(2.0), 1e-6);
  }
  EXPECT_FALSE(FindBalanceProof(contacts, 1.01, kGravity, kScale).impossible);
  // The proof's cones lie around the pyramids with 32 edges that check it.
  const double limit = std::cos(kPi / 32.0);
  const double mu_star = FindProofLimit(contacts, kGravity, kScale, 0.0).mu;
  EXPECT_LE(mu_star, limit);
  EXPECT_GE(mu_star, limit - 1.1 * kProofLimitStep);
}

// What is said to be proved up to mu* is proved there, and below it, between the points too.
TEST(BalanceProofTest, TheLimitIsThatOfAProofThatCoversWhatLiesBetweenThePoints) {
  Rng rng(3, RngStream::kTest);
  // On both sides of a bar, tilted so that the proof needs torques.
  std::vector<WrenchContact> contacts = TopAndFront(rng, 200);
  for (int i = 0; i < 20; ++i) {
    contacts.push_back({{0.1, 0.02 * rng.Normal(), 0.01 * rng.Normal()}, {0, 0, 1}});
  }
  double before = 4.0;
  for (const double spacing : {0.0, 0.002, 0.02, 1.0}) {
    const ProofLimit limit = FindProofLimit(contacts, kGravity, kScale, spacing);
    EXPECT_LE(limit.mu, before) << "a wider spacing proves no more";
    before = limit.mu;
    if (limit.mu == 0.0) continue;
    EXPECT_GE(limit.proof.covered, spacing);
    for (const double share : {1.0, 0.7}) {
      const double mu = share * std::min(limit.mu, kMostProofFriction);
      EXPECT_GT(CalcProofSlack(contacts, mu, kGravity, kScale, limit.proof.direction), 0.0);
    }
  }
}

TEST(BalanceProofTest, OnTheBoundaryForcesCancelOutAndStillCarryNothing) {
  Rng rng(1, RngStream::kTest);
  const std::vector<WrenchContact> contacts = TopAndFront(rng, 200);
  EXPECT_FALSE(FindBalanceProof(contacts, 1.0 + 1e-9, kGravity, kScale).impossible);
  EXPECT_FALSE(CanBalanceWeight(contacts, 1.0, kGravity, kScale, 1e3));
  EXPECT_TRUE(CanBalanceWeight(contacts, 1.1, kGravity, kScale, 1e3));
}

TEST(BalanceProofTest, APinchCarriesItAtAnyFrictionButNeedsForceInProportion) {
  const std::vector<WrenchContact> pinch{{{-0.03, 0, 0}, {1, 0, 0}}, {{0.03, 0, 0}, {-1, 0, 0}}};
  for (const double mu : {0.1, 0.8}) {
    EXPECT_FALSE(FindBalanceProof(pinch, mu, kGravity, kScale).impossible);
    EXPECT_TRUE(CanBalanceWeight(pinch, mu, kGravity, kScale, 1.001 / mu));
    EXPECT_FALSE(CanBalanceWeight(pinch, mu, kGravity, kScale, 0.999 / mu));
  }
}

TEST(BalanceProofTest, TheProofHoldsForEveryForceAndItsSlackIsCheckedByOtherMeans) {
  Rng rng(2, RngStream::kTest);
  int proofs = 0;
  for (int set = 0; set < 300; ++set) {
    const Vector3 bias = rng.Direction();
    std::vector<WrenchContact> contacts;
    for (int i = 0; i < 30; ++i) {
      contacts.push_back({0.1 * rng.Uniform() * rng.Direction(),
                          (rng.Direction() + rng.Uniform(0.5, 2.0) * bias).normalized()});
    }
    const double mu = rng.Uniform(0.1, 1.0);
    const BalanceProof proof = FindBalanceProof(contacts, mu, kGravity, kScale);
    if (!proof.impossible) continue;
    ++proofs;
    EXPECT_NEAR(proof.direction.norm(), 1.0, 1e-12);
    const double slack = CalcProofSlack(contacts, mu, kGravity, kScale, proof.direction);
    EXPECT_LE(slack, proof.slack + 1e-9);              // the pyramids lie around the cones
    EXPECT_GE(slack, proof.slack - 0.006 * mu * 2.0);  // closely: 1/cos(pi/32) - 1 = 0.5 %
    EXPECT_LT(CalcProofSlack(contacts, mu, kGravity, kScale, -proof.direction), 0.0);
    // Moved by less than what it covers, every contact still pushes the same way.
    for (int k = 0; k < 50; ++k) {
      const WrenchContact& contact = contacts[rng.UniformInt(contacts.size())];
      const Vector3 p = contact.p + 0.999 * std::min(proof.covered, 1.0) * rng.Direction();
      const double angle = rng.Uniform(0.0, 2.0 * kPi);
      const Vector3 f =
          FrameFromNormal(contact.n) * Vector3(mu * std::cos(angle), mu * std::sin(angle), 1.0);
      EXPECT_GE(
          proof.direction.head<3>().dot(f) + proof.direction.tail<3>().dot(p.cross(f)) / kScale,
          0.0);
    }
  }
  EXPECT_GT(proofs, 50);
}

TEST(BalanceProofTest, AnIndependentLinearProgramAgrees) {
  Rng rng(3, RngStream::kTest);
  int proofs = 0, balances = 0, between = 0;
  for (int set = 0; set < 1000; ++set) {
    std::vector<WrenchContact> contacts;
    const Vector3 bias = rng.Direction();
    for (int i = 0; i < 6; ++i) {
      contacts.push_back({0.1 * rng.Uniform() * rng.Direction(),
                          (rng.Direction() + rng.Uniform(0.0, 1.5) * bias).normalized()});
    }
    WrenchConfig lp;
    lp.mu = rng.Uniform(0.1, 1.0);
    lp.mass = 1.0 / 9.81;
    lp.f_min = 0.0;
    lp.f_max = 1e3;
    lp.torque_scale = kScale;
    const bool impossible = FindBalanceProof(contacts, lp.mu, kGravity, kScale).impossible;
    const bool balanced = CanBalanceWeight(contacts, lp.mu, kGravity, kScale, 1e3);
    EXPECT_FALSE(impossible && balanced);
    if (impossible) {
      ++proofs;
      EXPECT_GT(CalcImbalanceByLp(contacts, lp, true, 64, Pyramid::kInscribed), 1e-7);
    } else if (balanced) {
      ++balances;
      EXPECT_LT(CalcImbalanceByLp(contacts, lp, true, 64, Pyramid::kCircumscribed), 1e-5);
    } else {
      ++between;
    }
  }
  EXPECT_GT(proofs, 100);
  EXPECT_GT(balances, 100);
  EXPECT_LE(between, 20);
}

}  // namespace
}  // namespace pregrasp
