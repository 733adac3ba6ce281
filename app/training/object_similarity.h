#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {

/// An object that no training object may resemble: one that scenes use.
class ExcludedObject {
 public:
  /// @param shape  loaded.
  ExcludedObject(std::string name, const Shape& shape);

  const std::string& name() const { return name_; }
  /// What says which object it is, for a data set's description.
  const std::string& hash() const { return hash_; }

  /// Whether `shape` is too like it: nearer than kLeastUnlikeness, or all three sides within
  /// kLikeSides, whichever way either lies.
  bool Resembles(const Shape& shape) const;

  /// How unlike the surfaces are [m]: the mean distance from points of one to the other's true
  /// surface, averaged over both, at the best of the 24 ways in which their frames' axes can be
  /// laid upon each other, boxes centred. Its noise is that of a mean over kCompared points of
  /// distances that are exact, a tenth of their spread.
  double CalcUnlikeness(const Shape& shape) const;

 private:
  std::string name_, hash_;
  MatrixX3 P_;      // its surface, boxes centred
  Vector3 sides_;   // of its bounding box, sorted
  Vector3 centre_;  // of its bounding box
  std::shared_ptr<const SignedDistance> surface_;
};

/// Whether `shape` resembles one of them.
bool ResemblesAny(const Shape& shape, const std::vector<ExcludedObject>& excluded);

/// Evaluation objects are never training objects: nothing nearer than this to one of them [m].
inline constexpr double kLeastUnlikeness = 0.005;
/// Nor anything whose three sides, sorted, all lie within this share of one's.
inline constexpr double kLikeSides = 0.10;

}  // namespace pregrasp
