#include "app/dynamics/rim.h"

#include <cmath>

namespace pregrasp {
namespace {

// Tilted by less than this [rad] a disc touches with four fixed points of its rim: its lowest point
// would follow rounding errors.
constexpr double kFlat = 3e-5;
// Tilted by less than this [rad] its lowest point is one of kSectors, which is too high by 1.2e-6
// of the radius at most: a direction computed from so small a tilt would magnify rounding errors.
constexpr double kAlmostLevel = 1e-3;
constexpr int kSectors = 64;
// A point of the rim that sinks deeper than this [m] below the one that is lowest now, while the
// disc rolls from the one to the other, is a point of its own.
constexpr double kRolls = 1e-5;

Vector2 CalcDirection(const Vector2& down, double tilt) {
  if (tilt > kAlmostLevel) return down / tilt;
  constexpr double kSector = 2.0 * kPi / kSectors;
  const double angle = kSector * std::round(std::atan2(down.y(), down.x()) / kSector);
  return {std::cos(angle), std::sin(angle)};
}

Vector2 QuarterTurn(const Vector2& v) { return {-v.y(), v.x()}; }

}  // namespace

RimPoints ChooseRimPoints(double radius, const Vector2& down, const Vector2& down_next) {
  const double tilt = down.norm(), tilt_next = down_next.norm();
  const Vector2 now = tilt > kFlat ? CalcDirection(down, tilt) : Vector2(Vector2::UnitX());
  if (tilt > kFlat && tilt_next > kFlat) {
    const Vector2 next = CalcDirection(down_next, tilt_next);
    const double cosine = now.dot(next);
    if (cosine > 0.0 && radius * tilt_next * (1.0 - cosine) > kRolls) {
      // Both, and two a third of the rim away from the middle of them.
      const Vector2 far = -(now + next).normalized(), aside = std::sqrt(3.0) * QuarterTurn(far);
      return {{now, next, 0.5 * (far + aside), 0.5 * (far - aside)}, {0, 4, 5, 6}};
    }
  }
  const Vector2 aside = QuarterTurn(now);
  return {{now, aside, -now, -aside}, {0, 1, 2, 3}};
}

}  // namespace pregrasp
