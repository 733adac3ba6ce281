#include "app/geometry/surface_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pregrasp {
namespace {

constexpr double kReachPerSpacing = 1.1;

}  // namespace

SurfaceHeight::SurfaceHeight(const SampledCloud& cloud)
    : cloud_(cloud),
      reach_(kReachPerSpacing * cloud.spacing + cloud.near_plane),
      least_share_(std::clamp(1.25 * cloud.near_plane / cloud.spacing, 0.15, 0.3)),
      index_(cloud.P, 2.0 * reach_) {}

double SurfaceHeight::Calc(const Vector3& x) {
  index_.FindWithin(x, 2.0 * reach_, found_);
  constexpr int kFew = 12;
  if (static_cast<int>(found_.size()) < kFew) index_.FindNearest(x, kFew, found_);
  order_.clear();
  for (const int i : found_) {
    order_.emplace_back((cloud_.P.row(i).transpose() - x).squaredNorm(), i);
  }
  std::sort(order_.begin(), order_.end());
  SplitIntoSheets(x);
  return Combine();
}

double SurfaceHeight::Combine() const {
  const std::size_t n = sheets_.size();
  std::array<std::size_t, kMaxSheets> hollow{};  // sheets with the same number bound one hollow
  for (std::size_t i = 0; i < n; ++i) {
    hollow[i] = i;
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 between = sheets_[j].p - sheets_[i].p;
      const bool facing = sheets_[i].nhat.dot(between) > 0.0 && sheets_[j].nhat.dot(between) < 0.0;
      if (!facing || hollow[i] == hollow[j]) continue;
      const std::size_t old = hollow[i];
      for (std::size_t k = 0; k <= i; ++k) {
        if (hollow[k] == old) hollow[k] = hollow[j];
      }
    }
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double largest = -kInfinity;
  for (std::size_t h = 0; h < n; ++h) {
    double smallest = kInfinity;
    for (std::size_t i = 0; i < n; ++i) {
      if (hollow[i] == h) smallest = std::min(smallest, sheets_[i].height);
    }
    if (smallest < kInfinity) largest = std::max(largest, smallest);
  }
  return largest;
}

void SurfaceHeight::SplitIntoSheets(const Vector3& x) {
  constexpr double kCosSame = 0.6;
  sheets_.clear();
  const double nearest = order_.front().first;
  for (const auto& [squared, i] : order_) {
    const Vector3 nhat = cloud_.N.row(i), p = cloud_.P.row(i);
    auto sheet = std::find_if(sheets_.begin(), sheets_.end(), [&](const Sheet& other) {
      const Vector3 between = p - other.seed;
      // A step's two levels are not one plane, but curvature must not part neighbours.
      const double off = std::abs((other.seed_nhat + nhat).dot(between));
      return other.seed_nhat.dot(nhat) > kCosSame && off < 0.7 * between.norm() + 1e-12;
    });
    if (sheet == sheets_.end()) {
      if (sheets_.size() == kMaxSheets) continue;
      sheets_.push_back({p, nhat});
      sheet = sheets_.end() - 1;
    }
    // Relative to the nearest, and wider with its distance, so that a far node hears all sheets.
    const double w = std::exp(-(squared - nearest) / (reach_ * reach_ + nearest));
    sheet->weight += w;
    sheet->height += w * nhat.dot(x - p);
    sheet->p += w * p;
    sheet->nhat += w * nhat;
  }
  double most = 0.0;
  for (const Sheet& sheet : sheets_) most = std::max(most, sheet.weight);
  sheets_.erase(
      std::remove_if(sheets_.begin(), sheets_.end(),
                     [&](const Sheet& sheet) { return sheet.weight < least_share_ * most; }),
      sheets_.end());
  for (Sheet& sheet : sheets_) sheet.Finish();
}

}  // namespace pregrasp
