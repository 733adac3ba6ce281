#pragma once

#include <array>
#include <vector>

#include "app/geometry/bounds.h"

namespace pregrasp {

/// How many neighbours a plane is fitted to; even.
inline constexpr int kCloudNeighbours = 16;

/// Points on a surface with what reconstruction works out about them, step by step.
struct SampledCloud {
  MatrixX3 P;
  MatrixX3 N;               ///< unit normals; outward once they are oriented
  double spacing = 0.0;     ///< median distance to the nearest four [m]
  double widest = 0.0;      ///< 98th percentile of the distance to the sixth nearest [m]
  double near_plane = 0.0;  ///< how near to its plane a neighbour counts as on it [m]
  AlignedBox bounds;
  std::vector<std::array<int, kCloudNeighbours>> near;  ///< nearest first, without the point itself
};

/// The given rows of M.
MatrixX3 TakeRows(const MatrixX3& M, const std::vector<int>& rows);

/// The value that `share` of the values do not exceed.
double Percentile(std::vector<double> values, double share);

/// Fills in bounds, neighbours and distances from P, which has more than kCloudNeighbours rows.
void FindNeighbourhoods(SampledCloud& cloud);

/// Fills in N, as planes without a sense of out. At an edge or a thin wall, where a
/// plane through all neighbours would lie across both sides, it follows one of them.
void FitPlanes(SampledCloud& cloud);

/// Leaves out points whose normal no neighbour shares: at corners, and where noise had the better
/// of the planes. The neighbours are void after it.
void DropStrays(SampledCloud& cloud);

}  // namespace pregrasp
