#include "app/geometry/sectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "app/geometry/triangle_samples.h"

namespace pregrasp {
namespace {

constexpr double kAxisShare = 1e-3;     // of the solid's diagonal: nearer is at the axis
constexpr int kFewest = 6, kMost = 64;  // sectors
constexpr int kMaxFacets = 40;          // that cuts follow, the largest of a piece

struct SectorPlan {
  int count = 0;              // of sectors
  double first = 0.0;         // angle from `towards` to the middle of sector 0
  std::vector<Piece> pieces;  // of the sector opposite `towards`
  double protrusion = std::numeric_limits<double>::infinity();  // the largest [m]
  double cost = std::numeric_limits<double>::infinity();        // pieces in all sectors
};

struct Segment {  // of a profile, as (distance from the axis, height along it)
  Vector2 a, b;
};

struct Line {
  Vector2 nhat;
  double offset = 0.0;

  double Height(const Vector2& p) const { return nhat.dot(p) - offset; }
};

// The half plane in the middle of a sector.
struct Meridian {
  Vector3 p_B, axis, radial;

  Vector2 Point(const Vector3& p) const { return Direction(p - p_B); }
  Vector2 Direction(const Vector3& v) const { return {v.dot(radial), v.dot(axis)}; }
  Plane Lift(const Line& line) const {
    const Vector3 nhat = line.nhat.x() * radial + line.nhat.y() * axis;
    return {nhat, line.offset + nhat.dot(p_B)};
  }

  // The piece's edges, and the axis between those of its corners that are as near to it as
  // `axis_radius` [m].
  std::vector<Segment> Project(const Piece& piece, double axis_radius) const {
    std::vector<Segment> segments;
    Vector2 low(0.0, std::numeric_limits<double>::infinity()), high(0.0, -low.y());
    for (const SolidPart& part : piece.parts) {
      for (const Triangle& t : part.surface) {
        std::array<Vector2, 3> p;
        for (int i = 0; i < 3; ++i) {
          p[i] = Point(t[i]);
          if (p[i].x() > axis_radius) continue;
          low.y() = std::min(low.y(), p[i].y());
          high.y() = std::max(high.y(), p[i].y());
        }
        for (int i = 0; i < 3; ++i) segments.push_back({p[i], p[(i + 1) % 3]});
      }
    }
    if (low.y() < high.y()) segments.push_back({low, high});
    return segments;
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

// Of the parts of a profile on both sides of a line; infinite when one is empty.
double CalcVolumeOfHulls(const std::vector<Segment>& profile, const Line& line) {
  std::array<std::vector<Vector2>, 2> sides;
  for (const Segment& segment : profile) {
    const double h = line.Height(segment.a), k = line.Height(segment.b);
    sides[h > 0.0 ? 1 : 0].push_back(segment.a);
    if (h * k < 0.0) {
      const Vector2 p = segment.a + h / (h - k) * (segment.b - segment.a);
      for (std::vector<Vector2>& side : sides) side.push_back(p);
    }
    if (h == 0.0) sides[1].push_back(segment.a);
  }
  double volume = 0.0;
  for (std::vector<Vector2>& side : sides) {
    const double one = CalcRevolvedVolume(side);
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

  // A polygon's sectors begin at corners; others have what spoils the symmetry in their middle.
  double FirstMiddle(int count) const { return revolution_.sides > 0 ? kPi / count : 0.0; }

  Plane PlaneAt(double angle) const {
    const Vector3 nhat = revolution_.Turn(angle) * revolution_.axis.cross(revolution_.towards);
    return {nhat, nhat.dot(revolution_.p_B)};
  }

  Piece CutSector(int count, int k) const {
    const double middle = FirstMiddle(count) + 2.0 * kPi * k / count, half = kPi / count;
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
  std::vector<Line> ListLines(const Piece& piece, const Meridian& meridian,
                              const std::vector<Segment>& profile) const {
    std::vector<Line> lines;
    constexpr int kDirections = 8, kAcross = 7;
    for (int d = 0; d < kDirections; ++d) {
      const double angle = kPi * d / kDirections;
      const Vector2 nhat(std::cos(angle), std::sin(angle));
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Segment& segment : profile) {
        low = std::min(low, nhat.dot(segment.a));
        high = std::max(high, nhat.dot(segment.a));
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
    const std::vector<Segment> profile = meridian.Project(piece, kAxisShare * maker_.size());
    std::vector<std::pair<double, Line>> ranked;
    std::vector<Line> tried;
    for (const Line& line : ListLines(piece, meridian, profile)) {
      const bool similar = std::any_of(tried.begin(), tried.end(), [&](const Line& other) {
        const double along = other.nhat.dot(line.nhat);
        const double apart = other.offset - std::copysign(1.0, along) * line.offset;
        return std::abs(along) > 0.9999 && std::abs(apart) < 0.001 * maker_.size();
      });
      if (similar) continue;
      tried.push_back(line);
      const double volume = CalcVolumeOfHulls(profile, line);
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
    const double middle = FirstMiddle(count) + 2.0 * kPi * opposite / count;
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
      for (const Piece& piece : ring) members.push_back(&piece);
      Piece joined;
      if (!ring.empty() && IsAtAxis(ring.front()) && maker_.Join(members, joined) &&
          joined.protrusion <= limit_) {
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
