#include <algorithm>
#include <cstdint>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/grasp/contact_wrenches.h"

namespace pregrasp {
namespace {

constexpr int kEdges = 16;
constexpr int kMaxPoints = 1 << 12;  // so that five indices fit in one 64-bit key

// How far beyond a facet's plane a point must lie to count as beyond, as a share of the points'
// extent: well above rounding, so that no facet is built on a sliver of noise.
constexpr double kBeyond = 1e-10;
// And how thin a hull, or a shell around the origin, counts as none.
constexpr double kThin = 1e-9;

std::vector<Vector6> CalcEdgeWrenches(std::span<const WrenchContact> contacts, double mu,
                                      double torque_scale) {
  const int edges = mu > 0.0 ? kEdges : 1;
  std::vector<Vector6> wrenches;
  wrenches.reserve(contacts.size() * edges);
  for (const WrenchContact& contact : contacts) {
    const internal::ScaledContact scaled = internal::MakeScaledContact(contact, torque_scale);
    const Matrix3 R = FrameFromNormal(scaled.n);
    for (int k = 0; k < edges; ++k) {
      const double angle = 2.0 * kPi * k / edges;
      const Vector3 tangent = std::cos(angle) * R.col(0) + std::sin(angle) * R.col(1);
      wrenches.push_back(internal::CalcWrenchOf(scaled, scaled.n + mu * tangent));
    }
  }
  return wrenches;
}

int FindFarthest(const std::vector<Vector6>& points, const Vector6& direction) {
  int best = 0;
  double best_value = points[0].dot(direction);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double value = points[i].dot(direction);
    if (value > best_value) {
      best_value = value;
      best = static_cast<int>(i);
    }
  }
  return best;
}

// A growing simplicial polytope in R^6 with vertices among given points: the hull's facets near
// the origin are found without building the others (beneath-beyond insertion, always at the facet
// whose plane is nearest; as the expanding-polytope algorithm does in three dimensions).
class ExpandingPolytope {
 public:
  explicit ExpandingPolytope(const std::vector<Vector6>& points) : points_(points) {
    for (const Vector6& point : points) extent_ = std::max(extent_, point.norm());
  }

  // The distance of the origin, which must lie in the hull, from its nearest facet; 0 for a hull
  // without interior.
  double CalcNearest() {
    if (!StartWithSimplex()) return 0.0;
    std::vector<bool> inserted(points_.size());
    while (true) {
      const auto nearest =
          std::min_element(facets_.begin(), facets_.end(),
                           [](const Facet& a, const Facet& b) { return a.offset < b.offset; });
      const int farthest = FindFarthest(points_, nearest->normal);
      if (!IsBeyond(*nearest, points_[farthest]) || inserted[farthest]) {
        return nearest->offset > kThin * extent_ ? nearest->offset : 0.0;
      }
      inserted[farthest] = true;
      Insert(farthest);
      PREGRASP_CHECK(!facets_.empty());
    }
  }

 private:
  struct Facet {
    std::array<int, 6> vertex{};  // ascending
    Vector6 normal;               // unit, outward
    double offset = 0.0;          // of the plane, along the normal
  };

  bool IsBeyond(const Facet& facet, const Vector6& point) const {
    return facet.normal.dot(point) - facet.offset > kBeyond * extent_;
  }

  // Seven points, each the farthest from the affine hull of those before it.
  bool StartWithSimplex() {
    std::array<int, 7> simplex{};
    std::array<Vector6, 6> axes;  // orthonormal, spanning the hull so far
    for (std::size_t i = 1; i < points_.size(); ++i) {
      if (points_[i].squaredNorm() > points_[simplex[0]].squaredNorm()) {
        simplex[0] = static_cast<int>(i);
      }
    }
    for (int k = 0; k < 6; ++k) {
      double farthest = 0.0;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        Vector6 rest = points_[i] - points_[simplex[0]];
        for (int pass = 0; pass < 2; ++pass) {
          for (int j = 0; j < k; ++j) rest -= rest.dot(axes[j]) * axes[j];
        }
        const double distance = rest.norm();
        if (distance > farthest * (1.0 + 1e-12)) {
          farthest = distance;
          axes[k] = rest / distance;
          simplex[k + 1] = static_cast<int>(i);
        }
      }
      if (farthest <= kThin * extent_) return false;
    }
    inside_.setZero();
    for (const int i : simplex) inside_ += points_[i] / 7.0;
    std::sort(simplex.begin(), simplex.end());
    for (int left_out = 0; left_out < 7; ++left_out) {
      Facet facet;
      for (int i = 0, k = 0; i < 7; ++i) {
        if (i != left_out) facet.vertex[k++] = simplex[i];
      }
      SetPlane(facet);
      facets_.push_back(facet);
    }
    return true;
  }

  // The plane through the facet's vertices: Gaussian elimination with full pivoting on the five
  // differences; the sign is the one that leaves `inside_` behind.
  void SetPlane(Facet& facet) const {
    Eigen::Matrix<double, 5, 6> rows;
    for (int i = 0; i < 5; ++i) {
      rows.row(i) = points_[facet.vertex[i + 1]] - points_[facet.vertex[0]];
    }
    std::array<int, 6> column{0, 1, 2, 3, 4, 5};
    for (int k = 0; k < 5; ++k) {
      int row = k, col = k;
      for (int i = k; i < 5; ++i) {
        for (int j = k; j < 6; ++j) {
          if (std::abs(rows(i, j)) > std::abs(rows(row, col))) {
            row = i;
            col = j;
          }
        }
      }
      rows.row(k).swap(rows.row(row));
      rows.col(k).swap(rows.col(col));
      std::swap(column[k], column[col]);
      for (int i = k + 1; i < 5; ++i) {
        const double factor = rows(i, k) / rows(k, k);
        for (int j = k; j < 6; ++j) rows(i, j) -= factor * rows(k, j);
      }
    }
    Vector6 normal;
    normal[column[5]] = 1.0;
    std::array<double, 6> x{};
    x[5] = 1.0;
    for (int k = 4; k >= 0; --k) {
      double sum = 0.0;
      for (int j = k + 1; j < 6; ++j) sum += rows(k, j) * x[j];
      x[k] = -sum / rows(k, k);
      normal[column[k]] = x[k];
    }
    facet.normal = normal.normalized();
    facet.offset = facet.normal.dot(points_[facet.vertex[0]]);
    if (facet.normal.dot(inside_) > facet.offset) {
      facet.normal = -facet.normal;
      facet.offset = -facet.offset;
    }
  }

  // Replaces the facets that see the point by the cone from the point over their rim: the ridges
  // that belong to only one of them.
  void Insert(int point) {
    ridges_.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      if (!IsBeyond(facets_[i], points_[point])) {
        facets_[kept++] = facets_[i];
        continue;
      }
      for (int left_out = 0; left_out < 6; ++left_out) {
        std::uint64_t ridge = 0;
        for (int k = 0; k < 6; ++k) {
          if (k != left_out) ridge = ridge << 12 | static_cast<std::uint64_t>(facets_[i].vertex[k]);
        }
        ridges_.push_back(ridge);
      }
    }
    facets_.resize(kept);
    std::sort(ridges_.begin(), ridges_.end());
    for (std::size_t i = 0; i < ridges_.size(); ++i) {
      if (i + 1 < ridges_.size() && ridges_[i] == ridges_[i + 1]) {
        ++i;
        continue;
      }
      Facet facet;
      for (int k = 0; k < 5; ++k)
        facet.vertex[k] = static_cast<int>(ridges_[i] >> (12 * k) & 0xFFF);
      facet.vertex[5] = point;
      std::sort(facet.vertex.begin(), facet.vertex.end());
      SetPlane(facet);
      facets_.push_back(facet);
    }
  }

  const std::vector<Vector6>& points_;
  double extent_ = 0.0;
  Vector6 inside_ = Vector6::Zero();
  std::vector<Facet> facets_;
  std::vector<std::uint64_t> ridges_;
};

}  // namespace

double CalcMargin(std::span<const WrenchContact> contacts, double mu, double torque_scale) {
  internal::ValidateContacts(contacts);
  WrenchConfig config;
  config.mu = mu;
  config.torque_scale = torque_scale;
  config.Validate();
  if (contacts.size() * kEdges > kMaxPoints) {
    throw InputError("wrench", "p", "at most 256 contacts", std::to_string(contacts.size()));
  }
  const std::vector<Vector6> points = CalcEdgeWrenches(contacts, mu, torque_scale);
  const auto support = [&](const Vector6& direction, int, Vector6& point) {
    point = points[FindFarthest(points, direction)];
  };
  MinNormConfig solver;
  solver.separation = std::numeric_limits<double>::infinity();
  const MinNormPoint nearest = FindMinNormPoint(points[0], support, solver);
  if (nearest.status == MinNormPoint::Status::kSeparated) return -nearest.v.norm();
  return ExpandingPolytope(points).CalcNearest();
}

}  // namespace pregrasp
