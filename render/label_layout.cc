#include "render/label_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pregrasp {
namespace {

// Costs are in pixels of leader that the reader would rather follow.
constexpr double kCrossing = 120.0;    // two leaders cross
constexpr double kUnderBox = 300.0;    // a leader runs under another's box
constexpr double kOverShape = 70.0;    // the box hides part of a thing
constexpr double kPastAnchor = 60.0;   // a leader passes close by another's anchor
constexpr double kGap = 5.0;           // between boxes
constexpr double kAnchorRadius = 5.0;  // kept free around anchors
constexpr int kRounds = 3;
constexpr int kDirections = 16;
constexpr std::array<double, 11> kDistances = {20, 32, 48, 68, 92, 120, 155, 200, 260, 340, 440};

bool SegmentMeetsRect(const Vector2& a, const Vector2& b, const Rect& rect) {
  double enter = 0.0, leave = 1.0;
  const Vector2 d = b - a;
  const Vector2 low(rect.x, rect.y), high(rect.right(), rect.bottom());
  for (int axis = 0; axis < 2; ++axis) {
    if (d[axis] == 0.0) {
      if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
      continue;
    }
    const double t0 = (low[axis] - a[axis]) / d[axis], t1 = (high[axis] - a[axis]) / d[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}

double Cross(const Vector2& u, const Vector2& v) { return u.x() * v.y() - u.y() * v.x(); }

bool SegmentsCross(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
  return Cross(b - a, c - a) * Cross(b - a, d - a) < 0.0 &&
         Cross(d - c, a - c) * Cross(d - c, b - c) < 0.0;
}

double DistanceToSegment(const Vector2& p, const Vector2& a, const Vector2& b) {
  const Vector2 d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

// Separating axes of a convex outline and a rectangle.
bool ConvexMeetsRect(const std::vector<Vector2>& outline, const Rect& rect) {
  const std::array<Vector2, 4> corners = {Vector2(rect.x, rect.y), Vector2(rect.right(), rect.y),
                                          Vector2(rect.right(), rect.bottom()),
                                          Vector2(rect.x, rect.bottom())};
  const auto separated_along = [&](const Vector2& axis) {
    double low_a = std::numeric_limits<double>::infinity(), high_a = -low_a;
    double low_b = low_a, high_b = high_a;
    for (const Vector2& p : outline) {
      low_a = std::min(low_a, p.dot(axis));
      high_a = std::max(high_a, p.dot(axis));
    }
    for (const Vector2& p : corners) {
      low_b = std::min(low_b, p.dot(axis));
      high_b = std::max(high_b, p.dot(axis));
    }
    return high_a < low_b || high_b < low_a;
  };
  if (separated_along(Vector2::UnitX()) || separated_along(Vector2::UnitY())) return false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2 edge = outline[(i + 1) % outline.size()] - outline[i];
    if (separated_along(Vector2(-edge.y(), edge.x()))) return false;
  }
  return true;
}

// Of a convex outline that runs either way round.
bool IsInside(const Vector2& p, const std::vector<Vector2>& outline) {
  bool left = true, right = true;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2& a = outline[i];
    const double side = Cross(outline[(i + 1) % outline.size()] - a, p - a);
    left = left && side >= 0.0;
    right = right && side <= 0.0;
  }
  return outline.size() > 2 && (left || right);
}

class Layout {
 public:
  Layout(const std::vector<LabelRequest>& requests, const LabelArea& area)
      : requests_(requests), area_(area), boxes_(requests.size()) {}

  std::vector<std::optional<Rect>> Solve() {
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < requests_.size(); ++i) Place(i);
    }
    return boxes_;
  }

 private:
  void Place(std::size_t i) {
    boxes_[i].reset();
    double best = std::numeric_limits<double>::infinity();
    const auto consider = [&](const Rect& box) {
      if (!Allowed(i, box)) return;
      const double cost = Cost(i, box);
      if (cost < best) {
        best = cost;
        boxes_[i] = box;
      }
    };
    const Vector2& anchor = requests_[i].anchor;
    const Vector2& size = requests_[i].size;
    for (const double distance : kDistances) {
      for (int k = 0; k < kDirections; ++k) {
        const double angle = 2.0 * kPi * (k + 0.5) / kDirections;
        const Vector2 dir(std::cos(angle), -std::sin(angle));
        const Vector2 center = anchor + area_.scale * distance * dir + 0.5 * size.cwiseProduct(dir);
        consider(Snapped(center - 0.5 * size, size));
      }
    }
    if (boxes_[i]) return;
    const double step_x = std::max(4.0, 0.25 * size.x()), step_y = std::max(2.0, 0.5 * size.y());
    for (double y = area_.picture.y; y + size.y() <= area_.picture.bottom(); y += step_y) {
      for (double x = area_.picture.x; x + size.x() <= area_.picture.right(); x += step_x) {
        consider(Snapped(Vector2(x, y), size));
      }
    }
  }

  // Whole pixels keep the edges of boxes crisp.
  static Rect Snapped(const Vector2& corner, const Vector2& size) {
    return {std::round(corner.x()), std::round(corner.y()), size.x(), size.y()};
  }

  bool Allowed(std::size_t i, const Rect& box) const {
    const Rect& picture = area_.picture;
    if (box.x < picture.x || box.y < picture.y || box.right() > picture.right() ||
        box.bottom() > picture.bottom()) {
      return false;
    }
    for (const Rect& obstacle : area_.obstacles) {
      if (box.Overlaps(obstacle)) return false;
    }
    const Rect grown = box.Grown(kGap * area_.scale);
    for (std::size_t j = 0; j < requests_.size(); ++j) {
      if (j != i && boxes_[j] && grown.Overlaps(*boxes_[j])) return false;
      if (box.Grown(kAnchorRadius * area_.scale).Contains(requests_[j].anchor)) return false;
    }
    return true;
  }

  double Cost(std::size_t i, const Rect& box) const {
    const Vector2& anchor = requests_[i].anchor;
    const Vector2 start = LeaderStart(box, anchor);
    double cost = (start - anchor).norm() / area_.scale;
    for (const auto& shape : area_.shapes) {
      if (ConvexMeetsRect(shape, box)) cost += kOverShape;
    }
    for (const Rect& obstacle : area_.obstacles) {
      if (SegmentMeetsRect(start, anchor, obstacle)) cost += kUnderBox;
    }
    for (std::size_t j = 0; j < requests_.size(); ++j) {
      if (j == i) continue;
      const Vector2& other = requests_[j].anchor;
      if (DistanceToSegment(other, start, anchor) < 6.0 * area_.scale &&
          (other - anchor).norm() > 6.0 * area_.scale) {
        cost += kPastAnchor;
      }
      if (!boxes_[j]) continue;
      const Vector2 other_start = LeaderStart(*boxes_[j], other);
      if (SegmentMeetsRect(start, anchor, *boxes_[j])) cost += kUnderBox;
      if (SegmentMeetsRect(other_start, other, box)) cost += kUnderBox;
      if (SegmentsCross(start, anchor, other_start, other)) cost += kCrossing;
    }
    return cost;
  }

  const std::vector<LabelRequest>& requests_;
  const LabelArea& area_;
  std::vector<std::optional<Rect>> boxes_;
};

}  // namespace

double CalcHiddenShares(const Rect& rect, const std::vector<std::vector<Vector2>>& outlines) {
  constexpr int kSamples = 16;  // along each side of what is around an outline
  double shares = 0.0;
  for (const std::vector<Vector2>& outline : outlines) {
    if (outline.size() < 3) continue;
    Vector2 low = outline.front(), high = outline.front();
    for (const Vector2& p : outline) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if (!rect.Overlaps({low.x(), low.y(), high.x() - low.x(), high.y() - low.y()})) continue;
    int all = 0, hidden = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const Vector2 at((i % kSamples + 0.5) / kSamples, (i / kSamples + 0.5) / kSamples);
      const Vector2 p = low + at.cwiseProduct(high - low);
      if (!IsInside(p, outline)) continue;
      ++all;
      hidden += rect.Contains(p) ? 1 : 0;
    }
    if (all > 0) shares += static_cast<double>(hidden) / all;
  }
  return shares;
}

Vector2 LeaderStart(const Rect& box, const Vector2& anchor) {
  return {std::clamp(anchor.x(), box.x, box.right()), std::clamp(anchor.y(), box.y, box.bottom())};
}

std::vector<std::optional<Rect>> LayOutLabels(const std::vector<LabelRequest>& requests,
                                              const LabelArea& area) {
  return Layout(requests, area).Solve();
}

}  // namespace pregrasp
