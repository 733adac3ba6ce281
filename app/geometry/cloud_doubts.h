#pragma once

#include "app/geometry/cloud_planes.h"

namespace pregrasp {

/// What speaks against a cloud being points all over one closed surface.
struct CloudDoubts {
  /// Points at which the surface ends: all that is around them lies in a plane, and on one side of
  /// them. None on a closed surface, whose edges have points on both of their faces.
  int rim_points = 0;
  Vector3 p_rim = Vector3::Zero();  ///< one of them [m]
  /// The share of the points that lie in a sheet which reaches beyond all others on three sides at
  /// least, as a table does around what stands on it; 0 for none. A plate is none: its other face
  /// reaches as far.
  double sheet_share = 0.0;

  /// Whether the points end along a rim, not at a chance gap.
  bool has_rim() const { return rim_points >= kFewestOfARim; }
  static constexpr int kFewestOfARim = 20;
};

/// @param cloud  with its neighbourhoods; points evenly spread or by chance.
CloudDoubts FindCloudDoubts(const SampledCloud& cloud);

/// The same of points as they are read, more than kCloudNeighbours; of very many an even share.
CloudDoubts FindCloudDoubts(const MatrixX3& points);

}  // namespace pregrasp
