#pragma once

namespace pregrasp {

/// From 0 to 1 as s does, slow at both ends, so that what moves by it starts and stops without a
/// jerk.
constexpr double Ease(double s) { return s * s * (3.0 - 2.0 * s); }

}  // namespace pregrasp
