#include "app/training/object_similarity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "app/core/rng.h"
#include "app/core/sha256.h"
#include "app/geometry/bounds.h"
#include "app/geometry/point_cloud.h"

namespace pregrasp {
namespace {

constexpr int kCompared = 250;  // points of each surface

// The smallest of `calc` over the 24 rotations that take axes to axes.
double FindLeastOverAxes(const std::function<double(const Matrix3&)>& calc) {
  double least = std::numeric_limits<double>::infinity();
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x == y) continue;
      for (const double sx : {1.0, -1.0}) {
        for (const double sy : {1.0, -1.0}) {
          Matrix3 R = Matrix3::Zero();
          R(0, x) = sx;
          R(1, y) = sy;
          R.row(2) = R.row(0).cross(R.row(1));
          least = std::min(least, calc(R));
        }
      }
    }
  }
  return least;
}

MatrixX3 SampleCentred(const Shape& shape, const Vector3& centre) {
  MatrixX3 P = SamplePointCloud(shape, kCompared, Rng(0, RngStream::kComparedCloud)).P;
  P.rowwise() -= centre.transpose();
  return P;
}

Vector3 SortedSides(const AlignedBox& box) {
  Vector3 sides = box.sizes();
  std::sort(sides.begin(), sides.end());
  return sides;
}

// From points, turned by R, to the surface of a shape whose box is centred at `centre`.
double MeanDistanceToSurface(const MatrixX3& P, const Matrix3& R, const SignedDistance& surface,
                             const Vector3& centre) {
  double sum = 0.0;
  for (int i = 0; i < P.rows(); ++i) {
    sum += std::abs(surface.Calc(centre + R * Vector3(P.row(i))));
  }
  return sum / static_cast<double>(P.rows());
}

}  // namespace

ExcludedObject::ExcludedObject(std::string name, const Shape& shape)
    : name_(std::move(name)),
      centre_(CalcBounds(shape).center()),
      surface_(std::make_shared<const SignedDistance>(shape)) {
  P_ = SampleCentred(shape, centre_);
  sides_ = SortedSides(CalcBounds(shape));
  hash_ = Sha256(
      std::string_view(reinterpret_cast<const char*>(P_.data()), P_.size() * sizeof(double)));
}

double ExcludedObject::CalcUnlikeness(const Shape& shape) const {
  const Vector3 centre = CalcBounds(shape).center();
  const SignedDistance surface(shape);
  const MatrixX3 P = SampleCentred(shape, centre);
  return FindLeastOverAxes([&](const Matrix3& R) {
    return 0.5 * (MeanDistanceToSurface(P, R, *surface_, centre_) +
                  MeanDistanceToSurface(P_, R.transpose(), surface, centre));
  });
}

bool ExcludedObject::Resembles(const Shape& shape) const {
  const Vector3 sides = SortedSides(CalcBounds(shape));
  if (((sides - sides_).array().abs() <= kLikeSides * sides_.array()).all()) return true;
  return CalcUnlikeness(shape) < kLeastUnlikeness;
}

bool ResemblesAny(const Shape& shape, const std::vector<ExcludedObject>& excluded) {
  return std::any_of(excluded.begin(), excluded.end(),
                     [&](const ExcludedObject& other) { return other.Resembles(shape); });
}

}  // namespace pregrasp
