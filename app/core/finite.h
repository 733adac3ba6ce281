#pragma once

#include <cmath>
#include <ranges>

#include "app/core/math.h"

namespace pregrasp {

// Whether a fact is made of finite numbers only: what a stage asserts of its result before it hands
// it on (PREGRASP_CHECK(AreFinite(..))), because a NaN compares false and so could pass a verdict.

inline bool IsFinite(double value) { return std::isfinite(value); }

template <typename Derived>
bool IsFinite(const Eigen::DenseBase<Derived>& values) {
  return values.allFinite();
}

inline bool IsFinite(const Quaternion& q) { return q.coeffs().allFinite(); }

inline bool IsFinite(const RigidTransform& X) { return X.matrix().allFinite(); }

/// Of every element.
template <std::ranges::range Range>
requires(!requires(const Range& range) { range.allFinite(); }) bool IsFinite(const Range& values) {
  for (const auto& value : values) {
    if (!IsFinite(value)) return false;
  }
  return true;
}

template <typename... Facts>
bool AreFinite(const Facts&... facts) {
  return (IsFinite(facts) && ...);
}

}  // namespace pregrasp
