#include "app/geometry/mass_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "app/core/check.h"
#include "app/geometry/bounds.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/signed_distance.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

// Integrals of 1, p and p p^T over a volume, in one frame.
struct Moments {
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();

  void Add(const Moments& other, double weight = 1.0) {
    volume += weight * other.volume;
    first += weight * other.first;
    second += weight * other.second;
  }
};

// Of a volume centred on the origin whose second moments are diagonal.
Moments Centred(double volume, const Vector3& second) {
  return {volume, Vector3::Zero(), second.asDiagonal()};
}

Moments Moved(const Moments& m_P, const RigidTransform& X_BP) {
  const Matrix3 R = X_BP.linear();
  const Vector3 t = X_BP.translation();
  const Vector3 first = R * m_P.first;
  Moments m_B;
  m_B.volume = m_P.volume;
  m_B.first = first + m_P.volume * t;
  m_B.second = R * m_P.second * R.transpose() + first * t.transpose() + t * first.transpose() +
               m_P.volume * t * t.transpose();
  return m_B;
}

Moments OfBox(const Vector3& size) {
  const double volume = size.prod();
  return Centred(volume, volume / 12.0 * size.cwiseAbs2());
}

Moments OfSphere(double radius) {
  const double volume = 4.0 / 3.0 * kPi * std::pow(radius, 3);
  return Centred(volume, Vector3::Constant(volume * radius * radius / 5.0));
}

Moments OfCylinder(double radius, double height) {
  const double volume = kPi * radius * radius * height;
  const double across = volume * radius * radius / 4.0;
  return Centred(volume, {across, across, volume * height * height / 12.0});
}

Moments OfCapsule(double radius, double height) {
  Moments moments = OfCylinder(radius, height);
  // The two caps make a ball cut at the equator; half a ball's centroid is 3/8 r from the cut.
  const Moments ball = OfSphere(radius);
  const double shift = 0.5 * height;
  Matrix3 second = ball.second;
  second(2, 2) += ball.volume * (shift * shift + 2.0 * shift * 3.0 / 8.0 * radius);
  moments.Add({ball.volume, Vector3::Zero(), second});
  return moments;
}

// By signed tetrahedra from the first vertex.
Moments OfMesh(const TriangleMesh& mesh) {
  PREGRASP_CHECK(mesh.F.rows() > 0, "shape is not loaded");
  const Vector3 origin = mesh.V.row(0);
  Moments moments;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    Matrix3 corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = mesh.V.row(mesh.F(f, i)).transpose() - origin;
    const double volume = corners.determinant() / 6.0;
    const Vector3 sum = corners.rowwise().sum();
    moments.volume += volume;
    moments.first += volume / 4.0 * sum;
    moments.second += volume / 20.0 * (corners * corners.transpose() + sum * sum.transpose());
  }
  return Moved(moments, MakeTransform(Matrix3::Identity(), origin));
}

Moments CalcMoments(const Shape& shape);

struct PlacedPart {
  SignedDistance distance;
  RigidTransform X_PB;
  AlignedBox bounds_B;
  bool fills_bounds;  // a box along B's axes
};

// Integrates (number of parts over a point) - 1, where that is positive, over a cell.
class OverlapIntegral {
 public:
  /// @param finest  longest edge of a cell that is not split any more [m]
  OverlapIntegral(const std::vector<PlacedPart>& parts, double finest)
      : parts_(parts), finest_(finest) {}

  void AddCell(const AlignedBox& cell) {
    const Vector3 centre = cell.center();
    const double reach = 0.5 * cell.diagonal().norm();
    int around = 0;
    std::vector<int> crossing;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const double phi = parts_[i].distance.Calc(parts_[i].X_PB * centre);
      if (std::abs(phi) < reach && Crosses(parts_[i], cell)) {
        crossing.push_back(static_cast<int>(i));
      } else if (phi < 0.0) {
        ++around;
      }
    }
    if (around + crossing.size() < 2) return;
    int longest = 0;
    if (!crossing.empty() && cell.sizes().maxCoeff(&longest) > finest_) {
      Vector3 high = cell.max(), low = cell.min();
      high[longest] = low[longest] = centre[longest];
      AddCell({cell.min(), high});
      AddCell({low, cell.max()});
      return;
    }
    // The expected number beyond the first, where the surfaces cross the cell independently.
    double sum = around, none = around > 0 ? 0.0 : 1.0;
    for (const int i : crossing) {
      const double share = ShareInside(parts_[i], cell);
      sum += share;
      none *= 1.0 - share;
    }
    moments_.Add(Moved(OfBox(cell.sizes()), MakeTransform(Matrix3::Identity(), centre)),
                 sum - 1.0 + none);
  }

  const Moments& moments() const { return moments_; }

 private:
  // Whether the part's surface may pass through the cell. Faces of a box that lies along the axes
  // only touch the cells that were cut along them.
  static bool Crosses(const PlacedPart& part, const AlignedBox& cell) {
    if (!part.fills_bounds) return true;
    const AlignedBox both = part.bounds_B.intersection(cell);
    if (both.isEmpty() || both.volume() <= 0.0) return false;
    return !part.bounds_B.contains(cell);
  }

  // The share of a small cell that a part fills, as if its surface there were a plane.
  static double ShareInside(const PlacedPart& part, const AlignedBox& cell) {
    const DistanceSample sample = part.distance.CalcWithGradient(part.X_PB * cell.center());
    const Vector3 nhat_B = part.X_PB.linear().transpose() * sample.nhat;
    return std::clamp(0.5 - sample.phi / nhat_B.cwiseAbs().dot(cell.sizes()), 0.0, 1.0);
  }

  const std::vector<PlacedPart>& parts_;
  double finest_;
  Moments moments_;
};

void FlattenParts(const Union& whole, std::vector<PlacedPart>& parts, Moments& sum) {
  const auto add = [&](const Shape& leaf, const RigidTransform& X_BP) {
    sum.Add(Moved(CalcMoments(leaf), X_BP));
    const Matrix3 turn = X_BP.linear().cwiseAbs();
    const bool fills_bounds =
        std::holds_alternative<Box>(leaf) && turn.isApprox(turn.array().round().matrix(), 1e-15);
    parts.push_back({SignedDistance(leaf), X_BP.inverse(), CalcBounds(leaf, X_BP), fills_bounds});
  };
  for (const PlacedShape& part : whole.parts) ForEachLeaf(part.shape, part.X_BP, add);
}

// The coordinates along `axis` at which the parts' bounds begin and end within `whole`, with its
// own.
std::vector<double> FindCuts(const std::vector<PlacedPart>& parts, const AlignedBox& whole,
                             int axis) {
  std::vector<double> cuts{whole.min()[axis], whole.max()[axis]};
  for (const PlacedPart& part : parts) {
    for (const double x : {part.bounds_B.min()[axis], part.bounds_B.max()[axis]}) {
      if (x > whole.min()[axis] && x < whole.max()[axis]) cuts.push_back(x);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

// What is counted too often when the parts are summed. The region is first cut where the parts'
// bounds begin and end, so that boxes along the axes come out exactly.
Moments OfOverlaps(const std::vector<PlacedPart>& parts) {
  constexpr double kFlush = 1e-9;  // [m]; overlaps thinner than this are rounding
  AlignedBox overlap;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const AlignedBox both = parts[i].bounds_B.intersection(parts[j].bounds_B);
      if (!both.isEmpty() && both.sizes().minCoeff() > kFlush) overlap.extend(both);
    }
  }
  if (overlap.isEmpty()) return {};
  std::array<std::vector<double>, 3> cuts;
  for (int i = 0; i < 3; ++i) cuts[i] = FindCuts(parts, overlap, i);
  constexpr std::size_t kMaxCells = 4096;
  if (cuts[0].size() * cuts[1].size() * cuts[2].size() > kMaxCells) {
    for (int i = 0; i < 3; ++i) cuts[i] = {overlap.min()[i], overlap.max()[i]};
  }
  OverlapIntegral integral(parts, overlap.sizes().maxCoeff() / 64.0);
  for (std::size_t i = 0; i + 1 < cuts[0].size(); ++i) {
    for (std::size_t j = 0; j + 1 < cuts[1].size(); ++j) {
      for (std::size_t k = 0; k + 1 < cuts[2].size(); ++k) {
        integral.AddCell({Vector3(cuts[0][i], cuts[1][j], cuts[2][k]),
                          Vector3(cuts[0][i + 1], cuts[1][j + 1], cuts[2][k + 1])});
      }
    }
  }
  return integral.moments();
}

Moments OfUnion(const Union& whole) {
  std::vector<PlacedPart> parts;
  Moments moments;
  FlattenParts(whole, parts, moments);
  moments.Add(OfOverlaps(parts), -1.0);
  return moments;
}

struct MomentsOf {
  Moments operator()(const Box& box) const { return OfBox(box.size); }
  Moments operator()(const Cylinder& c) const { return OfCylinder(c.radius, c.height); }
  Moments operator()(const Capsule& c) const { return OfCapsule(c.radius, c.height); }
  Moments operator()(const Sphere& sphere) const { return OfSphere(sphere.radius); }
  Moments operator()(const Mesh& mesh) const { return OfMesh(mesh.mesh); }
  Moments operator()(const Cloud& cloud) const { return OfMesh(cloud.mesh); }
  Moments operator()(const Union& whole) const { return OfUnion(whole); }
};

Moments CalcMoments(const Shape& shape) { return std::visit(MomentsOf{}, shape); }

}  // namespace

MassProperties CalcMassProperties(const Shape& shape, double mass) {
  const Moments moments = CalcMoments(shape);
  PREGRASP_CHECK(moments.volume > 0.0, moments.volume);
  MassProperties result;
  result.mass = mass;
  result.p_BoBcm = moments.first / moments.volume;
  const Matrix3 covariance =
      moments.second / moments.volume - result.p_BoBcm * result.p_BoBcm.transpose();
  result.I_BBcm = mass * (covariance.trace() * Matrix3::Identity() - covariance);
  return result;
}

double CalcVolume(const Shape& shape) { return CalcMoments(shape).volume; }

}  // namespace pregrasp
