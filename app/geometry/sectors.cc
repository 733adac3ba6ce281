#include "app/geometry/sectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "app/geometry/triangle_samples.h"

namespace pregrasp {
namespace {

constexpr double kAxisShare = 1e-3;     // of the solid's diagonal: nearer is at the axis
constexpr int kFewest = 6, kMost = 64;  // sectors
constexpr int kMaxFacets = 40;          // that cuts follow, the largest of a piece

struct SectorPlan {
  int count = 0;                                                // of sectors
  std::vector<Piece> pieces;                                    // of the sector opposite `towards`
  double protrusion = std::numeric_limits<double>::infinity();  // the largest [m]
  double cost = std::numeric_limits<double>::infinity();        // pieces in all sectors
};

struct ProfileFacet {  // of a profile, as (distance from the axis, height along it)
  std::array<Vector2, 3> corners;
  Vector2 normal = Vector2::Zero();
};

struct ProfileLine {
  Vector2 nhat;
  double offset = 0.0;

  double Height(const Vector2& p) const { return nhat.dot(p) - offset; }
};

// The half plane in the middle of a sector.
struct Meridian {
  Vector3 p_B, axis, radial;

  Vector2 Point(const Vector3& p) const { return Direction(p - p_B); }
  Vector2 Direction(const Vector3& v) const { return {v.dot(radial), v.dot(axis)}; }
  Plane Lift(const ProfileLine& line) const {
    const Vector3 nhat = line.nhat.x() * radial + line.nhat.y() * axis;
    return {nhat, line.offset + nhat.dot(p_B)};
  }

  // The piece's triangles, and the axis between those of its corners that are as near to it as
  // `axis_radius` [m].
  std::vector<ProfileFacet> Project(const Piece& piece, double axis_radius) const {
    std::vector<ProfileFacet> profile;
    Vector2 low(0.0, std::numeric_limits<double>::infinity()), high(0.0, -low.y());
    for (const SolidPart& part : piece.parts) {
      for (const Triangle& t : part.surface) {
        ProfileFacet facet;
        facet.normal = Direction((t[1] - t[0]).cross(t[2] - t[0]));
        for (int i = 0; i < 3; ++i) {
          const Vector2& p = facet.corners[i] = Point(t[i]);
          if (p.x() > axis_radius) continue;
          low.y() = std::min(low.y(), p.y());
          high.y() = std::max(high.y(), p.y());
        }
        profile.push_back(facet);
      }
    }
    if (low.y() < high.y()) profile.push_back({{low, high, high}});
    return profile;
  }
};

// Volume of the solid of revolution of the points' convex hull, per radian [m^3].
double CalcRevolvedVolume(std::vector<Vector2>& points) {
  std::sort(points.begin(), points.end(), [](const Vector2& a, const Vector2& b) {
    return std::make_pair(a.x(), a.y()) < std::make_pair(b.x(), b.y());
  });
  const auto cross = [](const Vector2& a, const Vector2& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  std::vector<Vector2> hull;
  for (const int side : {1, -1}) {
    const std::size_t first = hull.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2& p = side > 0 ? points[i] : points[points.size() - 1 - i];
      while (hull.size() >= first + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
  }
  double moment = 0.0;  // of the area about the axis
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    moment += cross(a, b) * (a.x() + b.x()) / 6.0;
  }
  return moment;
}

// Of the parts of a profile on both sides of a line; infinite when one is empty. Heights within
// `snap` [m] are on the line; a facet on it goes to the side on which its solid is.
double CalcVolumeOfHulls(const std::vector<ProfileFacet>& profile, const ProfileLine& line,
                         double snap) {
  std::vector<Vector2> below, above;
  for (const ProfileFacet& facet : profile) {
    std::array<double, 3> height{};
    for (int i = 0; i < 3; ++i) {
      height[i] = line.Height(facet.corners[i]);
      if (std::abs(height[i]) < snap) height[i] = 0.0;
    }
    const auto [low, high] = std::minmax_element(height.begin(), height.end());
    const bool flat = *low == 0.0 && *high == 0.0;
    const bool is_below = *low < 0.0 || (flat && facet.normal.dot(line.nhat) > 0.0);
    const bool is_above = *high > 0.0 || (flat && !is_below);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if (is_below && height[i] <= 0.0) below.push_back(facet.corners[i]);
      if (is_above && height[i] >= 0.0) above.push_back(facet.corners[i]);
      if (height[i] * height[j] < 0.0) {
        const double s = height[i] / (height[i] - height[j]);
        below.emplace_back(facet.corners[i] + s * (facet.corners[j] - facet.corners[i]));
        above.push_back(below.back());
      }
    }
  }
  double volume = 0.0;
  for (std::vector<Vector2>* side : {&below, &above}) {
    const double one = CalcRevolvedVolume(*side);
    if (!(one > 0.0)) return std::numeric_limits<double>::infinity();
    volume += one;
  }
  return volume;
}

std::vector<const Triangle*> FindLargest(const Piece& piece, std::size_t count) {
  std::vector<const Triangle*> facets;
  for (const SolidPart& part : piece.parts) {
    for (const Triangle& t : part.surface) facets.push_back(&t);
  }
  std::stable_sort(facets.begin(), facets.end(),
                   [](const Triangle* a, const Triangle* b) { return AreaOf(*a) > AreaOf(*b); });
  if (facets.size() > count) facets.resize(count);
  return facets;
}

class SectorCutter {
 public:
  SectorCutter(const PieceMaker& maker, const Revolution& revolution, double limit, int max_pieces)
      : maker_(maker),
        revolution_(revolution),
        limit_(limit),
        max_pieces_(max_pieces),
        whole_(maker.MakeWhole()) {}

  Sectors Run() const {
    SectorPlan best;
    for (const int count : ListCounts()) {
      SectorPlan plan = MakePlan(count);
      const auto rank = [&](const SectorPlan& p) {
        return std::make_pair(std::max(p.protrusion, limit_), p.cost);
      };
      if (rank(plan) < rank(best)) best = std::move(plan);
    }
    return {Replicate(best), best.protrusion};
  }

 private:
  // Whole numbers of a polygon's sides, so that cuts go through its corners.
  std::vector<int> ListCounts() const {
    std::vector<int> counts;
    for (int span = 1; span * kFewest <= revolution_.sides; ++span) {
      if (revolution_.sides % span == 0 && revolution_.sides <= kMost * span) {
        counts.push_back(revolution_.sides / span);
      }
    }
    if (!counts.empty()) return counts;
    return {48, 40, 32, 28, 24, 22, 20, 18, 16, 14, 12, 10, 8};
  }

  // Sectors begin at corners.
  static double CalcMiddle(int count, int k) { return (2 * k + 1) * kPi / count; }

  Plane PlaneAt(double angle) const {
    const Vector3 nhat = revolution_.Turn(angle) * revolution_.axis.cross(revolution_.towards);
    return {nhat, nhat.dot(revolution_.p_B)};
  }

  Piece CutSector(int count, int k) const {
    const double middle = CalcMiddle(count, k), half = kPi / count;
    return maker_.CutBelow(maker_.CutBelow(whole_, PlaneAt(middle + half)),
                           PlaneAt(middle - half).Turned());
  }

  bool IsAtAxis(const Piece& piece) const {
    const MatrixX3 R = piece.hull.V.rowwise() - revolution_.p_B.transpose();
    const VectorX along = R * revolution_.axis;
    const MatrixX3 across = R - along * revolution_.axis.transpose();
    return across.rowwise().norm().minCoeff() < kAxisShare * maker_.size();
  }

  // Lines that may cut a profile: in even directions and distances, and at the corners of its
  // largest facets, along and across them.
  std::vector<ProfileLine> ListLines(const Piece& piece, const Meridian& meridian,
                                     const std::vector<ProfileFacet>& profile) const {
    std::vector<ProfileLine> lines;
    constexpr int kDirections = 8, kAcross = 7;
    for (int d = 0; d < kDirections; ++d) {
      const double angle = kPi * d / kDirections;
      const Vector2 nhat(std::cos(angle), std::sin(angle));
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const ProfileFacet& facet : profile) {
        for (const Vector2& p : facet.corners) {
          low = std::min(low, nhat.dot(p));
          high = std::max(high, nhat.dot(p));
        }
      }
      for (int i = 1; i <= kAcross; ++i) {
        lines.push_back({nhat, low + (high - low) * i / (kAcross + 1)});
      }
    }
    for (const Triangle* t : FindLargest(piece, kMaxFacets)) {
      const Vector2 n = meridian.Direction(((*t)[1] - (*t)[0]).cross((*t)[2] - (*t)[0]));
      if (!(n.norm() > 0.0)) continue;
      const Vector2 nhat = n.normalized(), along(-nhat.y(), nhat.x());
      for (const Vector3& corner : *t) {
        const Vector2 p = meridian.Point(corner);
        lines.push_back({nhat, nhat.dot(p)});
        lines.push_back({along, along.dot(p)});
      }
    }
    return lines;
  }

  // The cut whose two hulls, as solids of revolution, hold least.
  std::vector<Piece> FindHalves(const Piece& piece, const Meridian& meridian) const {
    const std::vector<ProfileFacet> profile = meridian.Project(piece, kAxisShare * maker_.size());
    std::vector<std::pair<double, ProfileLine>> ranked;
    std::vector<ProfileLine> tried;
    for (const ProfileLine& line : ListLines(piece, meridian, profile)) {
      const bool similar = std::any_of(tried.begin(), tried.end(), [&](const ProfileLine& other) {
        const double along = other.nhat.dot(line.nhat);
        const double apart = other.offset - std::copysign(1.0, along) * line.offset;
        return std::abs(along) > 0.9999 && std::abs(apart) < 0.001 * maker_.size();
      });
      if (similar) continue;
      tried.push_back(line);
      const double volume = CalcVolumeOfHulls(profile, line, maker_.snap());
      if (std::isfinite(volume)) ranked.emplace_back(volume, line);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [volume, line] : ranked) {
      const Plane plane = meridian.Lift(line);
      std::vector<Piece> halves;
      for (const Plane& side : {plane, plane.Turned()}) {
        Piece half = maker_.CutBelow(piece, side);
        if (half.parts.empty() || !maker_.Close(half)) break;
        maker_.Measure(half);
        halves.push_back(std::move(half));
      }
      if (halves.size() == 2) return halves;
    }
    return {};
  }

  double CalcCost(const SectorPlan& plan) const {
    double cost = 0.0;
    for (const Piece& piece : plan.pieces) cost += IsAtAxis(piece) ? 1.0 : plan.count;
    return cost;
  }

  // Cuts the worst piece again and again, until all are good enough or there are too many.
  SectorPlan MakePlan(int count) const {
    SectorPlan plan;
    plan.count = count;
    const int opposite = count / 2;
    const double middle = CalcMiddle(count, opposite);
    const Meridian meridian{revolution_.p_B, revolution_.axis,
                            revolution_.Turn(middle) * revolution_.towards};
    Piece sector = CutSector(count, opposite);
    if (sector.parts.empty() || !maker_.Close(sector)) return plan;
    maker_.Measure(sector);
    plan.pieces.push_back(std::move(sector));
    for (;;) {
      const auto worst = std::max_element(
          plan.pieces.begin(), plan.pieces.end(),
          [](const Piece& a, const Piece& b) { return a.protrusion < b.protrusion; });
      plan.protrusion = worst->protrusion;
      plan.cost = CalcCost(plan);
      if (plan.protrusion <= limit_ || plan.cost + (IsAtAxis(*worst) ? 1 : count) > max_pieces_) {
        return plan;
      }
      std::vector<Piece> halves = FindHalves(*worst, meridian);
      if (halves.empty()) return plan;
      plan.pieces.erase(worst);
      for (Piece& half : halves) plan.pieces.push_back(std::move(half));
    }
  }

  std::vector<Piece> Replicate(const SectorPlan& plan) const {
    const int opposite = plan.count / 2;
    std::vector<std::vector<Piece>> copies(plan.pieces.size());
    for (int k = 0; k < plan.count; ++k) {
      const Piece sector = CutSector(plan.count, k);
      const Matrix3 turn = revolution_.Turn(2.0 * kPi * (k - opposite) / plan.count);
      for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        Piece copy = CutAlike(sector, plan.pieces[i], turn);
        if (copy.parts.empty() || !maker_.Close(copy)) continue;
        maker_.Measure(copy);
        copies[i].push_back(std::move(copy));
      }
    }
    std::vector<Piece> pieces;
    for (std::vector<Piece>& ring : copies) {
      std::vector<const Piece*> members;
      members.reserve(ring.size());
      for (const Piece& piece : ring) members.push_back(&piece);
      Piece joined;
      if (!ring.empty() && IsAtAxis(ring.front()) && maker_.Join(members, joined) &&
          joined.protrusion <= limit_) {
        for (Piece& piece : ring) {
          std::move(piece.parts.begin(), piece.parts.end(), std::back_inserter(joined.parts));
        }
        pieces.push_back(std::move(joined));
      } else {
        for (Piece& piece : ring) pieces.push_back(std::move(piece));
      }
    }
    return pieces;
  }

  // What of `sector` lies where `piece` lies in the sector it was planned in.
  Piece CutAlike(const Piece& sector, const Piece& piece, const Matrix3& turn) const {
    Piece alike;
    for (const SolidPart& part : piece.parts) {
      Piece below = sector;
      for (std::size_t i = 2; i < part.cell.size(); ++i) {  // the first two bound the sector
        const Vector3 nhat = turn * part.cell[i].nhat;
        const double offset =
            part.cell[i].Height(revolution_.p_B) * -1.0 + nhat.dot(revolution_.p_B);
        below = maker_.CutBelow(below, {nhat, offset});
      }
      for (SolidPart& one : below.parts) alike.parts.push_back(std::move(one));
    }
    return alike;
  }

  const PieceMaker& maker_;
  const Revolution& revolution_;
  double limit_;
  int max_pieces_;
  Piece whole_;
};

}  // namespace

Sectors CutIntoSectors(const PieceMaker& maker, const Revolution& revolution, double limit,
                       int max_pieces) {
  return SectorCutter(maker, revolution, limit, max_pieces).Run();
}

}  // namespace pregrasp
