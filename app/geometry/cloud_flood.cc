#include "app/geometry/cloud_flood.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "app/core/interrupt.h"
#include "app/geometry/point_index.h"

namespace pregrasp {
namespace {

constexpr int kMaxNodes = 3'000'000;

// The cosine of the planes of i and j where j lies about in the plane of i; else 0. The opposite
// side of a thin wall does not.
double Along(const SampledCloud& cloud, int i, int j) {
  const Vector3 between = cloud.P.row(j) - cloud.P.row(i);
  if (std::abs(cloud.N.row(i).dot(between)) > 0.25 * between.norm()) return 0.0;
  const double along = cloud.N.row(i).dot(cloud.N.row(j));
  return std::abs(along) > 0.8 ? along : 0.0;
}

// Neighbours in the same plane agree on which way is out; lets each follow its neighbours.
void Vote(const SampledCloud& cloud, std::vector<int>& sign) {
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<int> next = sign;
    for (int i = 0; i < cloud.P.rows(); ++i) {
      double sum = 0.5 * sign[i];
      for (const int j : cloud.near[i]) sum += Along(cloud, i, j) * sign[j];
      if (sum != 0.0) next[i] = sum > 0.0 ? 1 : -1;
    }
    if (next == sign) return;
    sign = std::move(next);
  }
}

// Share of pairs of neighbours in the same plane that disagree, or of which one does not know.
double CountDoubts(const SampledCloud& cloud, const std::vector<int>& sign) {
  int pairs = 0, doubts = 0;
  for (int i = 0; i < cloud.P.rows(); ++i) {
    for (int k = 0; k < kCloudNeighbours / 2; ++k) {
      const int j = cloud.near[i][k];
      const double along = Along(cloud, i, j);
      if (along == 0.0) continue;
      ++pairs;
      if (along * sign[i] * sign[j] <= 0.0) ++doubts;
    }
  }
  return pairs == 0 ? 1.0 : static_cast<double>(doubts) / pairs;
}

// Whether the flood says so of most points that it tells something of. It may be wrong about the
// inside of a vessel, which has less of the points than the outside.
bool PointInward(const std::vector<int>& sign) {
  constexpr double kMost = 0.67;
  const auto inward = std::count(sign.begin(), sign.end(), -1);
  const auto outward = std::count(sign.begin(), sign.end(), 1);
  return static_cast<double>(inward) > kMost * static_cast<double>(inward + outward);
}

}  // namespace

ScalarGrid GridAround(const SampledCloud& cloud, double cell, double margin) {
  AlignedBox bounds = cloud.bounds;
  bounds.min().array() -= margin;
  bounds.max().array() += margin;
  double count = 1.0;
  for (int k = 0; k < 3; ++k) count *= bounds.sizes()[k] / cell + 3.0;
  if (count > kMaxNodes) return MakeGrid(bounds, kMaxNodes, 1);
  return MakeGrid(bounds, static_cast<int>(count), 1);
}

CloudFlood::CloudFlood(const SampledCloud& cloud, double radius)
    : grid_(GridAround(cloud, 0.3 * radius, 1.5 * radius)),
      marks_(grid_.values.size(), kOpen),
      radius_(radius) {
  for (int i = 0; i < cloud.P.rows(); ++i) {
    ThrowIfInterrupted();
    VisitBall(grid_, cloud.P.row(i), radius,
              [&](int x, int y, int z) { marks_[grid_.Index(x, y, z)] = kNear; });
  }
  FloodFromCorner(grid_, marks_);
}

bool CloudFlood::Reaches(const Vector3& p) const {
  const std::array<int, 3> at = NodeNear(grid_, p);
  return marks_[grid_.Index(at[0], at[1], at[2])] == kReached;
}

// Nodes that the flood reaches beside some that it does not.
MatrixX3 CloudFlood::ListFront() const {
  std::vector<Vector3> front;
  VisitInner(grid_, [&](int x, int y, int z) {
    if (IsFront(grid_, marks_, grid_.Index(x, y, z), kReached)) {
      front.push_back(grid_.Node(x, y, z));
    }
  });
  MatrixX3 result(static_cast<int>(front.size()), 3);
  for (std::size_t i = 0; i < front.size(); ++i) result.row(static_cast<int>(i)) = front[i];
  return result;
}

std::vector<int> CloudFlood::Orient(const SampledCloud& cloud) const {
  const MatrixX3 front = ListFront();
  std::vector<int> sign(cloud.P.rows(), 0);
  if (front.rows() == 0) return sign;
  const PointIndex index(front, 0.5 * radius_);
  std::vector<int> found;
  const auto distance_to_flood = [&](const Vector3& p) {
    index.FindNearest(p, 1, found);
    return (front.row(found[0]).transpose() - p).norm();
  };
  for (int i = 0; i < cloud.P.rows(); ++i) {
    ThrowIfInterrupted();
    const Vector3 p = cloud.P.row(i), step = 0.5 * radius_ * cloud.N.row(i);
    const double ahead = distance_to_flood(p + step), behind = distance_to_flood(p - step);
    constexpr double kAlike = 0.2;
    if (std::abs(ahead - behind) > kAlike * radius_) sign[i] = ahead < behind ? 1 : -1;
  }
  return sign;
}

CloudFlood OrientOutward(SampledCloud& cloud, bool has_normals) {
  double fewest = std::numeric_limits<double>::infinity();
  std::optional<CloudFlood> best;
  std::vector<int> sign;
  for (const double factor : {0.7, 0.85, 1.0, 1.25, 1.6, 2.0}) {
    CloudFlood flood(cloud, factor * cloud.widest);
    std::vector<int> now = flood.Orient(cloud);
    const double doubts = CountDoubts(cloud, now);
    constexpr double kBetter = 0.005;  // by less, the smaller radius is taken
    if (doubts >= fewest - kBetter) continue;
    fewest = doubts;
    best = std::move(flood);
    sign = std::move(now);
  }
  if (has_normals) {
    if (PointInward(sign)) cloud.N *= -1.0;
  } else {
    Vote(cloud, sign);
    for (int i = 0; i < cloud.P.rows(); ++i) {
      if (sign[i] < 0) cloud.N.row(i) *= -1.0;
    }
  }
  return std::move(*best);
}

}  // namespace pregrasp
