#include "app/geometry/cloud_doubts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "app/core/interrupt.h"
#include "app/geometry/cloud_planes.h"
#include "app/geometry/point_index.h"

namespace pregrasp {
namespace {

constexpr double kReach = 5.0;     // in spacings: what is around a point
constexpr double kFlat = 0.5;      // in spacings: how far off a plane that may be to lie in it
constexpr double kLeastGap = 2.6;  // [rad], of 2 pi around a point at the end of a sheet
// In spacings: how near to its plane a point of a sheet is, and how far off it another one.
constexpr double kInSheet = 0.75, kBeside = 0.9;
constexpr double kLeastShare = 0.2, kLeastBeyond = 1.5;  // of the points; of the others' area
constexpr double kBorder = 3.0;                          // in spacings, on a side

// The plane through some points: its axes, the normal first.
struct FittedPlane {
  Vector3 centre;
  Matrix3 axes;

  FittedPlane(const MatrixX3& P, const std::vector<int>& rows) {
    const MatrixX3 near = TakeRows(P, rows);
    centre = near.colwise().mean();
    const MatrixX3 D = near.rowwise() - centre.transpose();
    const Matrix3 spread = D.transpose() * D;
    axes = Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors();
  }
  double Height(const Vector3& p) const { return axes.col(0).dot(p - centre); }
};

// The widest angle around point `i` in which there is none of the others.
double CalcWidestGap(const MatrixX3& P, int i, const std::vector<int>& near,
                     const FittedPlane& plane) {
  std::vector<double> angles;
  for (const int j : near) {
    if (j == i) continue;
    const Vector3 d = (P.row(j) - P.row(i)).transpose();
    angles.push_back(std::atan2(plane.axes.col(2).dot(d), plane.axes.col(1).dot(d)));
  }
  if (angles.empty()) return 0.0;
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2.0 * kPi - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    widest = std::max(widest, angles[k] - angles[k - 1]);
  }
  return widest;
}

void FindRim(const SampledCloud& cloud, CloudDoubts& doubts) {
  const double reach = kReach * cloud.spacing;
  const PointIndex index(cloud.P, reach);
  std::vector<int> near;
  for (int i = 0; i < cloud.P.rows(); ++i) {
    ThrowIfInterrupted();
    index.FindWithin(cloud.P.row(i), reach, near);
    const FittedPlane plane(cloud.P, near);
    const bool flat = std::all_of(near.begin(), near.end(), [&](int j) {
      return std::abs(plane.Height(cloud.P.row(j))) <= kFlat * cloud.spacing;
    });
    if (!flat || CalcWidestGap(cloud.P, i, near, plane) < kLeastGap) continue;
    if (doubts.rim_points++ == 0) doubts.p_rim = cloud.P.row(i);
  }
}

// The box around some points, along the axes in a plane.
Eigen::AlignedBox2d CalcExtent(const MatrixX3& P, const std::vector<int>& rows,
                               const FittedPlane& plane) {
  Eigen::AlignedBox2d box;
  for (const int i : rows) {
    const Vector3 d = P.row(i).transpose() - plane.centre;
    box.extend(Vector2(plane.axes.col(1).dot(d), plane.axes.col(2).dot(d)));
  }
  return box;
}

// On how many of its four sides a box ends well within another.
int CountSidesWithin(const Eigen::AlignedBox2d& inner, const Eigen::AlignedBox2d& outer,
                     double well) {
  return static_cast<int>((inner.min().array() > outer.min().array() + well).count() +
                          (inner.max().array() < outer.max().array() - well).count());
}

// Of planes through neighbours at places all over the cloud, the one with the most points.
void FindSheet(const SampledCloud& cloud, CloudDoubts& doubts) {
  constexpr int kTried = 200;
  const double reach = kReach * cloud.spacing;
  const PointIndex index(cloud.P, reach);
  const auto count = static_cast<int>(cloud.P.rows());
  std::vector<int> near, sheet;
  for (int k = 0; k < kTried; ++k) {
    ThrowIfInterrupted();
    const auto i = static_cast<int>(static_cast<std::int64_t>(k) * count / kTried);
    index.FindWithin(cloud.P.row(i), reach, near);
    if (near.size() < 4) continue;
    // Twice, the second time through all that lies in the first plane.
    std::vector<int> within = near;
    for (int round = 0; round < 2; ++round) {
      const FittedPlane plane(cloud.P, within);
      within.clear();
      for (int j = 0; j < count; ++j) {
        if (std::abs(plane.Height(cloud.P.row(j))) <= kInSheet * cloud.spacing) within.push_back(j);
      }
      if (within.size() < 4) break;
    }
    if (within.size() > sheet.size()) sheet = within;
  }
  if (static_cast<double>(sheet.size()) < kLeastShare * count) return;
  const FittedPlane plane(cloud.P, sheet);
  std::vector<int> others;
  for (int j = 0; j < count; ++j) {
    if (std::abs(plane.Height(cloud.P.row(j))) > kBeside * cloud.spacing) others.push_back(j);
  }
  if (others.empty()) return;
  const Eigen::AlignedBox2d extent = CalcExtent(cloud.P, sheet, plane);
  const Eigen::AlignedBox2d footprint = CalcExtent(cloud.P, others, plane);
  if (extent.volume() < kLeastBeyond * footprint.volume()) return;
  // One side of a box may end at the border of another; what stands on a table does so once at
  // most.
  if (CountSidesWithin(footprint, extent, kBorder * cloud.spacing) < 3) return;
  doubts.sheet_share = static_cast<double>(sheet.size()) / count;
}

}  // namespace

CloudDoubts FindCloudDoubts(const SampledCloud& cloud) {
  CloudDoubts doubts;
  FindRim(cloud, doubts);
  FindSheet(cloud, doubts);
  return doubts;
}

CloudDoubts FindCloudDoubts(const MatrixX3& points) {
  constexpr std::size_t kMost = 15'000;
  // Each place once: a point has neighbours elsewhere.
  std::map<std::array<double, 3>, int> places;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    places.emplace(std::array{points(i, 0), points(i, 1), points(i, 2)}, static_cast<int>(i));
  }
  std::vector<int> all, rows;
  for (const auto& [place, row] : places) all.push_back(row);
  std::sort(all.begin(), all.end());
  const std::size_t count = std::min(all.size(), kMost);
  for (std::size_t k = 0; k < count; ++k) rows.push_back(all[k * all.size() / count]);
  if (rows.size() <= kCloudNeighbours) return {};
  SampledCloud cloud;
  cloud.P = TakeRows(points, rows);
  FindNeighbourhoods(cloud);
  return FindCloudDoubts(cloud);
}

}  // namespace pregrasp
