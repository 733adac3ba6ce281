#include "app/grasp/edge_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace pregrasp {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kArcLeaf = 0.02 * kDegree;
constexpr double kCornerLeaf = 0.1 * kDegree, kWidestCornerLeaf = 1.0 * kDegree;
constexpr int kFineCorners = 64;  // more corners than this share the work of so many
constexpr double kArcStep = 5.0 * kDegree, kCornerStep = 12.0 * kDegree;
constexpr double kRounding = 1e-9;  // [m]; a sphere that just touches is free
// So near an edge [m] the object looks like the two faces alone; a direction belongs to the fan if
// the surface is as far away as the point that it leads to.
constexpr double kNear = 1e-4;
constexpr double kNearRounding = 1e-3;  // of kNear

using Normals = std::vector<Vector3>;

double AngleBetween(const Vector3& a, const Vector3& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * (a - b).norm()));
}

// Directions on the arc from `from` to `to`.
class Arc {
 public:
  Arc(const Vector3& from, const Vector3& to)
      : from_(from), across_((to - from.dot(to) * from).normalized()) {
    width_ = std::atan2(to.dot(across_), to.dot(from_));
  }
  double width() const { return width_; }
  Vector3 At(double angle) const { return std::cos(angle) * from_ + std::sin(angle) * across_; }

 private:
  Vector3 from_, across_;
  double width_ = 0.0;
};

using SphereTriangle = std::array<Vector3, 3>;

std::vector<SphereTriangle> DivideSphere() {
  std::vector<SphereTriangle> octants;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        octants.push_back({x * Vector3::UnitX(), y * Vector3::UnitY(), z * Vector3::UnitZ()});
      }
    }
  }
  return octants;
}

// A spherical polygon as triangles around a direction inside it. A polygon that is not well within
// a half sphere, around the tip of a spike or where a mesh is folded, has no such direction: then
// all directions, of which those that do not belong to the fan miss it.
std::vector<SphereTriangle> DivideFan(const Normals& nhats) {
  constexpr double kLeastCosine = 0.05;
  Vector3 middle = Vector3::Zero();
  for (const Vector3& nhat : nhats) middle += nhat;
  middle.normalize();
  for (const Vector3& nhat : nhats) {
    if (nhat.dot(middle) < kLeastCosine) return DivideSphere();
  }
  if (nhats.size() == 3) return {{nhats[0], nhats[1], nhats[2]}};
  std::vector<SphereTriangle> triangles;
  for (std::size_t i = 0; i < nhats.size(); ++i) {
    triangles.push_back({middle, nhats[i], nhats[(i + 1) % nhats.size()]});
  }
  return triangles;
}

// The fingertip sphere around one point of an edge.
class TipAround {
 public:
  TipAround(const GraspWorld& world, const std::vector<RigidTransform>& X_WB, double radius,
            double slack, const Vector3& p_O)
      : world_(world), X_WB_(X_WB), radius_(radius), slack_(slack), p_O_(p_O) {}

  double radius() const { return radius_; }

  // How much free room there is [m], negative for none: it changes by no more than the centre
  // moves.
  double CalcRoom(const Vector3& nhat) const {
    const Vector3 centre = p_O_ + radius_ * nhat;
    const double object = world_.object().Calc(centre) - radius_ + slack_;
    const double around = world_.environment().Calc(X_WB_.at(0) * centre, X_WB_).phi - radius_;
    return std::min(object, around) + kRounding;
  }

  // How far the direction is from belonging to the fan [m], 0 if it does: where parts of a union
  // meet, an edge of one may lie on a face of another.
  double CalcMiss(const Vector3& nhat) const {
    return std::max(0.0, kNear * (1.0 - kNearRounding) - world_.object().Calc(p_O_ + kNear * nhat));
  }

  bool IsFree(const Vector3& nhat) const { return CalcRoom(nhat) >= 0.0 && CalcMiss(nhat) <= 0.0; }

 private:
  const GraspWorld& world_;
  const std::vector<RigidTransform>& X_WB_;
  double radius_, slack_;
  Vector3 p_O_;
};

enum class Part { kBlocked, kFree, kUndecided };

// Of all directions no more than `reach` [rad] from nhat.
Part Classify(const TipAround& tip, const Vector3& nhat, double reach) {
  const double room = tip.CalcRoom(nhat);
  if (room + tip.radius() * reach < 0.0) return Part::kBlocked;
  const double miss = tip.CalcMiss(nhat);
  if (miss > kNear * reach) return Part::kBlocked;
  return room >= tip.radius() * reach && miss <= 0.0 ? Part::kFree : Part::kUndecided;
}

void CoverArc(const TipAround& tip, const Arc& arc, double low, double high, Normals& found) {
  const double middle = 0.5 * (low + high);
  const Part part = Classify(tip, arc.At(middle), 0.5 * (high - low));
  if (part == Part::kBlocked) return;
  if (part == Part::kUndecided && high - low > kArcLeaf) {
    CoverArc(tip, arc, low, middle, found);
    CoverArc(tip, arc, middle, high, found);
    return;
  }
  found.push_back(arc.At(low));
  found.push_back(arc.At(high));
}

void CoverTriangle(const TipAround& tip, const SphereTriangle& corners, double leaf,
                   Normals& found) {
  const Vector3 middle = (corners[0] + corners[1] + corners[2]).normalized();
  double reach = 0.0, longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    reach = std::max(reach, AngleBetween(middle, corners[i]));
    longest = std::max(longest, AngleBetween(corners[i], corners[(i + 1) % 3]));
  }
  const Part part = Classify(tip, middle, reach);
  if (part == Part::kBlocked) return;
  if (part == Part::kUndecided && longest > leaf) {
    std::array<Vector3, 3> halfway;
    for (int i = 0; i < 3; ++i) halfway[i] = (corners[i] + corners[(i + 1) % 3]).normalized();
    for (int i = 0; i < 3; ++i) {
      CoverTriangle(tip, {corners[i], halfway[i], halfway[(i + 2) % 3]}, leaf, found);
    }
    CoverTriangle(tip, halfway, leaf, found);
    return;
  }
  found.insert(found.end(), corners.begin(), corners.end());
}

// Neighbouring parts share their ends.
void DropRepeated(Normals& nhats) {
  const auto key = [](const Vector3& n) { return std::tuple(n.x(), n.y(), n.z()); };
  std::sort(nhats.begin(), nhats.end(),
            [&](const Vector3& a, const Vector3& b) { return key(a) < key(b); });
  nhats.erase(std::unique(nhats.begin(), nhats.end()), nhats.end());
}

// The directions on an arc at equal steps that are free, and the last free one beside each that is
// not.
void CollectFreeOnArc(const TipAround& tip, const Arc& arc, Normals& found) {
  const int count = std::max(1, static_cast<int>(std::ceil(arc.width() / kArcStep)));
  double last = 0.0;
  bool last_free = false;
  for (int i = 0; i <= count; ++i) {
    const double angle = arc.width() * i / count;
    const bool free = tip.IsFree(arc.At(angle));
    if (i > 0 && free != last_free) {
      double inside = free ? angle : last, outside = free ? last : angle;
      while (std::abs(inside - outside) > kArcLeaf) {
        const double middle = 0.5 * (inside + outside);
        (tip.IsFree(arc.At(middle)) ? inside : outside) = middle;
      }
      found.push_back(arc.At(inside));
    }
    if (free) found.push_back(arc.At(angle));
    last = angle;
    last_free = free;
  }
}

void CollectFreeInTriangle(const TipAround& tip, const SphereTriangle& corners, Normals& found) {
  double longest = 0.0;
  for (int i = 0; i < 3; ++i) {
    longest = std::max(longest, AngleBetween(corners[i], corners[(i + 1) % 3]));
  }
  const int rows = std::max(1, static_cast<int>(std::ceil(longest / kCornerStep)));
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= rows - i; ++j) {
      const Vector3 nhat =
          (i * corners[0] + j * corners[1] + (rows - i - j) * corners[2]).normalized();
      if (tip.IsFree(nhat)) found.push_back(nhat);
    }
  }
}

std::vector<GraspContact> ToContacts(const std::vector<EdgePoint>& points,
                                     const std::vector<Normals>& nhats) {
  std::vector<GraspContact> contacts;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Vector3& nhat : nhats[i]) {
      contacts.push_back({Finger::kIndex, points[i].p_B, nhat, true});
    }
  }
  return contacts;
}

}  // namespace

std::vector<GraspContact> FindOuterEdgeContacts(const GraspWorld& world,
                                                const std::vector<EdgePoint>& points, double radius,
                                                double slack,
                                                const std::vector<RigidTransform>& X_WB,
                                                ThreadPool& pool) {
  const auto corners = std::count_if(points.begin(), points.end(),
                                     [](const EdgePoint& point) { return point.corner(); });
  const double leaf = std::clamp(kCornerLeaf * static_cast<double>(corners) / kFineCorners,
                                 kCornerLeaf, kWidestCornerLeaf);
  std::vector<Normals> nhats(points.size());
  pool.ParallelFor(static_cast<int>(points.size()), [&](int i, int) {
    const EdgePoint& point = points[i];
    const TipAround tip(world, X_WB, radius, slack, point.p_B);
    if (!point.corner()) {
      const Arc arc(point.nhats_B[0], point.nhats_B[1]);
      CoverArc(tip, arc, 0.0, arc.width(), nhats[i]);
    } else {
      for (const SphereTriangle& triangle : DivideFan(point.nhats_B)) {
        CoverTriangle(tip, triangle, leaf, nhats[i]);
      }
    }
    DropRepeated(nhats[i]);
  });
  return ToContacts(points, nhats);
}

std::vector<GraspContact> FindFreeEdgeContacts(const GraspWorld& world,
                                               const std::vector<EdgePoint>& points, double radius,
                                               double slack,
                                               const std::vector<RigidTransform>& X_WB) {
  std::vector<Normals> nhats(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const EdgePoint& point = points[i];
    const TipAround tip(world, X_WB, radius, slack, point.p_B);
    if (!point.corner()) {
      CollectFreeOnArc(tip, Arc(point.nhats_B[0], point.nhats_B[1]), nhats[i]);
      continue;
    }
    for (const SphereTriangle& triangle : DivideFan(point.nhats_B)) {
      CollectFreeInTriangle(tip, triangle, nhats[i]);
    }
    DropRepeated(nhats[i]);
  }
  return ToContacts(points, nhats);
}

}  // namespace pregrasp
