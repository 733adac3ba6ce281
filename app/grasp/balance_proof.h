#pragma once

#include <limits>
#include <span>

#include "app/grasp/min_norm_point.h"
#include "app/grasp/wrench.h"

namespace pregrasp {

/// Whether any forces at all, from any number of contacts of a given set at once and of any size,
/// can balance an object's weight.
struct BalanceProof {
  bool impossible = false;
  /// If impossible, the proof (Farkas): a unit direction y in wrench space (force, then torque over
  /// torque_scale) with y w >= slack > 0 for the weight's direction w and for the wrench w of every
  /// force in every contact's circular cone with normal component 1. Forces only push, so the net
  /// wrench always has a part along y.
  Vector6 direction = Vector6::Zero();
  double slack = 0.0;
  /// How far [m] a flat face's points may be from those given, and still be covered by the proof:
  /// a contact moved by d changes y w by at most |y's torque| sqrt(1 + mu^2) d / torque_scale.
  double covered = 0.0;
};

/// Looks for the proof: the origin apart from the hull of all unit wrenches and the weight.
/// @param contacts  relative to the centre of mass; none is a set too.
BalanceProof FindBalanceProof(std::span<const WrenchContact> contacts, double mu,
                              const Vector3& gravity, double torque_scale);

/// The slack of a given direction, recomputed from pyramids of 32 edges around the cones: positive
/// for a valid proof, whoever made it.
double CalcProofSlack(std::span<const WrenchContact> contacts, double mu, const Vector3& gravity,
                      double torque_scale, const Vector6& direction);

/// Whether forces in the contacts' circular cones, their normal components at most `total` times
/// the weight in sum, balance the weight. Between a proof and this there is a boundary case: forces
/// that cancel out, and still nothing that lifts.
bool CanBalanceWeight(std::span<const WrenchContact> contacts, double mu, const Vector3& gravity,
                      double torque_scale, double total);

/// The largest friction that FindProofLimit tries, and how closely it is found.
inline constexpr double kMostProofFriction = 3.0;
inline constexpr double kProofLimitStep = 5e-4;

/// How far the proof goes.
struct ProofLimit {
  /// mu*: the friction up to which there is a proof that covers the points between those given. 0
  /// if there is none even without friction, infinity if there is one at kMostProofFriction.
  double mu = 0.0;
  /// The proof there, which is one at any lower friction too: narrower cones lie in wider ones.
  BalanceProof proof;
};

/// mu*, by bisection, for cones drawn around those of CalcProofSlack (0.5 % wider than the circular
/// ones): how far a proof is from failing.
/// @param spacing  how far a flat face's points may be from those given [m].
ProofLimit FindProofLimit(std::span<const WrenchContact> contacts, const Vector3& gravity,
                          double torque_scale, double spacing);

}  // namespace pregrasp
