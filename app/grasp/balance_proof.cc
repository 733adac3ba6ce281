#include "app/grasp/balance_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/grasp/contact_wrenches.h"

namespace pregrasp {
namespace {

using internal::ScaledContact;

// A proof must have more slack than rounding could make; unit wrenches have norms of about 1.
constexpr double kLeastSlack = 1e-7;

constexpr int kPyramidEdges = 32;

std::vector<ScaledContact> Scale(std::span<const WrenchContact> contacts, double torque_scale) {
  std::vector<ScaledContact> scaled;
  scaled.reserve(contacts.size());
  for (const WrenchContact& contact : contacts) {
    scaled.push_back(internal::MakeScaledContact(contact, torque_scale));
  }
  return scaled;
}

Vector6 WeightDirection(const Vector3& gravity) {
  PREGRASP_CHECK(gravity.norm() > 0.0);
  Vector6 weight = Vector6::Zero();
  weight.head<3>() = gravity.normalized();
  return weight;
}

// The wrench of unit normal force that is farthest along a direction, over all contacts.
struct UnitWrenches {
  const std::vector<ScaledContact>& contacts;
  double mu;

  // Leaves `point` alone and returns `least` if none goes beyond that.
  double FindFarthest(const Vector6& direction, double least, Vector6& point) const {
    const ScaledContact* farthest = nullptr;
    for (const ScaledContact& contact : contacts) {
      const Vector3 a = internal::CalcForceDirection(contact, direction);
      const double normal = a.dot(contact.n);
      const double across = std::sqrt(std::max(0.0, a.squaredNorm() - normal * normal));
      if (normal + mu * across <= least) continue;
      least = normal + mu * across;
      farthest = &contact;
    }
    if (farthest != nullptr) {
      double value = 0.0;
      const Vector3 f = internal::CalcConeSupport(*farthest, mu, direction, &value);
      point = internal::CalcWrenchOf(*farthest, f);
    }
    return least;
  }
};

// The point nearest to the origin in the hull of the weight and all unit wrenches.
MinNormPoint FindNearest(const UnitWrenches& wrenches, const Vector6& weight,
                         const MinNormConfig& solver) {
  const auto support = [&](const Vector6& direction, int, Vector6& point) {
    ThrowIfInterrupted();
    point = weight;
    wrenches.FindFarthest(direction, direction.dot(weight), point);
  };
  return FindMinNormPoint(weight, support, solver);
}

}  // namespace

BalanceProof FindBalanceProof(std::span<const WrenchContact> contacts, double mu,
                              const Vector3& gravity, double torque_scale) {
  const std::vector<ScaledContact> scaled = Scale(contacts, torque_scale);
  MinNormConfig solver;
  solver.tolerance = kLeastSlack;
  solver.separation = std::numeric_limits<double>::infinity();  // the nearest point has most slack
  const MinNormPoint nearest = FindNearest({scaled, mu}, WeightDirection(gravity), solver);

  BalanceProof proof;
  proof.impossible =
      nearest.status == MinNormPoint::Status::kSeparated && nearest.lower_bound > kLeastSlack;
  if (!proof.impossible) return proof;
  proof.direction = nearest.v.normalized();
  proof.slack = nearest.lower_bound;
  const double torque = proof.direction.tail<3>().norm();
  proof.covered = torque > 1e-12 ? proof.slack * torque_scale / (torque * std::sqrt(1.0 + mu * mu))
                                 : std::numeric_limits<double>::infinity();
  return proof;
}

bool CanBalanceWeight(std::span<const WrenchContact> contacts, double mu, const Vector3& gravity,
                      double torque_scale, double total) {
  const std::vector<ScaledContact> scaled = Scale(contacts, torque_scale);
  const UnitWrenches wrenches{scaled, mu};
  const Vector6 weight = WeightDirection(gravity);
  const auto support = [&](const Vector6& direction, int, Vector6& point) {
    Vector6 unit = Vector6::Zero();  // no force is a choice too
    wrenches.FindFarthest(direction, 0.0, unit);
    point = weight + total * unit;
  };
  MinNormConfig solver;
  solver.tolerance = 1e-6;  // of the weight
  solver.separation = 1e-6;
  const MinNormPoint nearest = FindMinNormPoint(weight, support, solver);
  return nearest.status == MinNormPoint::Status::kContainsOrigin;
}

double CalcProofSlack(std::span<const WrenchContact> contacts, double mu, const Vector3& gravity,
                      double torque_scale, const Vector6& direction) {
  const Vector3 y_force = direction.head<3>();
  const Vector3 y_torque = direction.tail<3>();
  double slack = y_force.dot(gravity.normalized());
  const double outer_mu = mu / std::cos(kPi / kPyramidEdges);
  for (const WrenchContact& contact : contacts) {
    const Matrix3 R = FrameFromNormal(contact.n.normalized());
    for (int k = 0; k < kPyramidEdges; ++k) {
      const double angle = 2.0 * kPi * k / kPyramidEdges;
      const Vector3 f = R * Vector3(outer_mu * std::cos(angle), outer_mu * std::sin(angle), 1.0);
      slack = std::min(slack, y_force.dot(f) + y_torque.dot(contact.p.cross(f)) / torque_scale);
    }
  }
  return slack;
}

ProofLimit FindProofLimit(std::span<const WrenchContact> contacts, const Vector3& gravity,
                          double torque_scale, double spacing) {
  ProofLimit limit;
  // For cones that hold the pyramids of CalcProofSlack, so that it agrees.
  const auto holds = [&](double mu) {
    ThrowIfInterrupted();
    const BalanceProof proof =
        FindBalanceProof(contacts, mu / std::cos(kPi / kPyramidEdges), gravity, torque_scale);
    if (!(proof.impossible && proof.covered >= spacing)) return false;
    limit.mu = mu;
    limit.proof = proof;
    return true;
  };
  // A narrower cone lies in a wider one, so the proof holds below any friction at which it does.
  double low = 0.0, high = kMostProofFriction;
  if (holds(high)) {
    limit.mu = std::numeric_limits<double>::infinity();
    return limit;
  }
  if (!holds(low)) return limit;
  while (high - low > kProofLimitStep) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return limit;
}

}  // namespace pregrasp
