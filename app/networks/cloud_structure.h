#pragma once

#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// One level of grouping (PointNet++, Qi et al. 2017): centroids chosen among the points of the
/// level before, each with the points near it.
struct SetLevelConfig {
  int centroids = 64;            ///< number of centroids, at least 1
  double radius = 0.05;          ///< of a neighbourhood [m]
  int neighbors = 16;            ///< at most this many points in it, the nearest ones
  std::vector<int> widths = {};  ///< of the layers over a neighbourhood
};

/// Neighbourhoods of one level, as indices into the points of the level before. Ragged: a centroid
/// has as many neighbours as there are, itself among them.
struct SetLevel {
  std::vector<int> centroids;
  std::vector<int> begin;  ///< centroid i has neighbors[begin[i]] .. neighbors[begin[i + 1] - 1]
  std::vector<int> neighbors;  ///< nearest first
};

/// Everything about an object's cloud that no pose and no surroundings change; built once per
/// object.
struct CloudStructure {
  MatrixX3 P_O;                         ///< the cloud (#points x 3) [m]
  Vector3 p_OC = Vector3::Zero();       ///< centre of its bounding box: the networks' origin
  Matrix3 R_WO0 = Matrix3::Identity();  ///< the object's orientation at the start
  std::vector<SetLevel> levels;

  int size() const { return static_cast<int>(P_O.rows()); }

  /// The networks' frame G, in which up is +z and which turns with the object about the vertical,
  /// so that what they say cannot depend on the heading: R_GO = R R_WO0 with R the smallest
  /// rotation that takes R_WO0 up_O to +z. Smooth in up_O, but for the object upside down.
  Matrix3 CalcUprightFrame(const Vector3& up_O) const;
};

/// Chooses centroids by farthest-point sampling and finds their neighbourhoods; equal choices are
/// decided by the points' coordinates, so that the order of the points cannot matter.
/// @param P_O    #points x 3; at least as many points as the first level has centroids.
/// @param R_WO0  the object's orientation at the start.
CloudStructure BuildCloudStructure(const MatrixX3& P_O, const Matrix3& R_WO0,
                                   const std::vector<SetLevelConfig>& levels);

}  // namespace pregrasp
