#pragma once

#include <vector>

#include "app/core/rng.h"
#include "app/trajectory/action.h"

namespace pregrasp {

/// Ways of pushing that are tried as wholes. Independent noise in every knot pushes to and fro, and
/// where only a determined push changes anything its plans are all worth the same; these are drawn
/// from contact normals and gravity alone, the same for all objects.
enum class Proposal {
  kSlide,  ///< press and go along the surface in one direction
  kTilt,   ///< press hard, the target following inwards, hardly aside
  kLift,   ///< press and go up at the limit of the friction cone: pivots, and lids
  kPinch,  ///< both fingers press and go up, by friction
};
inline constexpr int kNumProposals = 4;

/// A plan of one kind, the same in all stages, with directions, forces and places drawn at random.
/// @param R_WO  the object's orientation at the start. @param up_W  against gravity.
std::vector<double> DrawProposal(const ActionSpace& space, Proposal kind, const Matrix3& R_WO,
                                 const Vector3& up_W, Rng& rng);

}  // namespace pregrasp
