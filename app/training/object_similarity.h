#pragma once

#include <string>
#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// How unlike two surfaces are, whatever their frames [m]: the mean distance from a point of one
/// to the nearest of the other, averaged over both, at the best of the 24 alignments of their
/// principal axes.
/// @param P, Q  points spread evenly over each surface (#points x 3).
double CalcAlignedChamfer(const MatrixX3& P, const MatrixX3& Q);

/// An object that no training object may resemble: one that scenes use.
struct ExcludedObject {
  std::string name;
  MatrixX3 P;  ///< about 500 points of its surface
};

/// Evaluation objects are never training objects: nothing nearer than this to one of them [m].
inline constexpr double kLeastUnlikeness = 0.005;

}  // namespace pregrasp
