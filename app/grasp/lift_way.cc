#include "app/grasp/lift_way.h"

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kGraze = 1e-3;       // a point may overlap the surroundings by this [m]
constexpr double kMinStep = 2.5e-4;   // along a way where the surroundings are near [m]
constexpr double kLengthStep = 5e-3;  // between lengths after which the object may be free [m]

// Tells whether the points of the object can move.
class Sweep {
 public:
  Sweep(const std::vector<RigidTransform>& X_WB, const PointCloud& cloud,
        const EnvironmentDistance& environment)
      : X_WB_(X_WB), environment_(environment) {
    for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
      points_.emplace_back(X_WB.front() * Vector3(cloud.P.row(i)));
    }
  }

  // Whether all points can move from `shift` along the unit direction by `length`.
  bool IsFree(const Vector3& shift, const Vector3& direction, double length) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (IsPointFree(points_[i] + shift, direction, length)) continue;
      // The next direction is asked about this point first.
      std::rotate(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(i),
                  points_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return false;
    }
    return true;
  }

  // Whether everything is farther away than `clearance` after a shift.
  bool IsClear(const Vector3& shift, double clearance) const {
    return std::all_of(points_.begin(), points_.end(), [&](const Vector3& p_W) {
      return environment_.Calc(p_W + shift, X_WB_).phi > clearance;
    });
  }

 private:
  // The distance changes by at most the way, so the way to the next look is the distance itself.
  bool IsPointFree(const Vector3& p_W, const Vector3& direction, double length) const {
    for (double s = 0.0;;) {
      const double room = environment_.Calc(p_W + s * direction, X_WB_).phi + kGraze;
      if (!(room >= 0.0)) return false;
      if (s >= length) return true;
      s = std::min(length, s + std::max(room, kMinStep));
    }
  }

  const std::vector<RigidTransform>& X_WB_;
  const EnvironmentDistance& environment_;
  std::vector<Vector3> points_;
};

// Makes the way longer until the object is free at its end. False if something is in the way, or
// if the length is at its bound.
bool GoOnUntilFree(Sweep& sweep, const LiftWayConfig& config, LiftWay* way) {
  const double rise = way->rise_W.norm();
  const Vector3 up_W = rise > 0.0 ? Vector3(way->rise_W / rise) : way->direction_W;
  for (;;) {
    const Vector3 shift = way->length * way->direction_W;
    if (sweep.IsFree(shift, up_W, rise) && sweep.IsClear(shift + way->rise_W, config.clearance)) {
      return true;
    }
    if (way->length >= config.max_length) return false;
    if (!sweep.IsFree(shift, way->direction_W, kLengthStep)) return false;
    way->length += kLengthStep;
  }
}

void RequireLength(const char* field, double value, double high) {
  if (!(value > 0.0 && value <= high)) {
    throw InputError("", field, "a length above 0 and at most " + FormatDouble(high) + " m",
                     FormatDouble(value));
  }
}

}  // namespace

void LiftWayConfig::Validate() const {
  RequireLength("height", height, 1.0);
  RequireLength("max_length", max_length, 10.0);
  RequireLength("rise", rise, 1.0);
  RequireLength("clearance", clearance, 1.0);
}

LiftWay FindLiftWay(const std::vector<RigidTransform>& X_WB, const PointCloud& cloud,
                    const EnvironmentDistance& environment, const Vector3& up_W,
                    const LiftWayConfig& config) {
  Sweep sweep(X_WB, cloud, environment);
  const Matrix3 R_WUp = FrameFromNormal(up_W);
  LiftWay way;
  for (int tilt = 0; tilt <= 90; ++tilt) {
    const double a = DegToRad(tilt);
    const int azimuths = std::max(1, static_cast<int>(std::ceil(360.0 * std::sin(a))));
    for (int i = 0; i < azimuths; ++i) {
      ThrowIfInterrupted();
      const double b = 2.0 * kPi * i / azimuths;
      way.direction_W =
          R_WUp * Vector3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      if (!sweep.IsFree(Vector3::Zero(), way.direction_W, config.height)) continue;
      way.length = config.height;
      way.rise_W = tilt == 0 ? Vector3(Vector3::Zero()) : Vector3(config.rise * up_W);
      const bool comes_free = GoOnUntilFree(sweep, config, &way);
      if (comes_free || tilt == 0) {
        way.status = LiftWayStatus::kFree;
        // Under a low ceiling, straight up is as far as is asked.
        if (!comes_free) way.length = config.height;
        return way;
      }
      way.status = LiftWayStatus::kNeverFree;
      if (way.length >= config.max_length) return way;
    }
  }
  return way;
}

}  // namespace pregrasp
