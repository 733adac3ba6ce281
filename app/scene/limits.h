#pragma once

#include "app/core/number_range.h"

namespace pregrasp {

// What the numbers of a scene may be, in a file and by --set alike. Wide: beyond them a number is a
// wrong unit, or the physics has no answer. The project's rules are narrower (RuleDepartures).

inline constexpr NumberRange kLengthRange{1e-6, 100.0, 0, "m"};        ///< of a shape
inline constexpr NumberRange kPositionRange{-1000.0, 1000.0, 0, "m"};  ///< each coordinate
inline constexpr NumberRange kAngleRange{-3600.0, 3600.0, 0, "deg"};   ///< each of rpy_deg
inline constexpr NumberRange kScaleRange{1e-6, 1e6};                   ///< of a file's units
inline constexpr NumberRange kMassRange{1e-6, 1e6, 0, "kg"};
inline constexpr NumberRange kFrictionRange{0.0, 10.0};
inline constexpr NumberRange kForceRange{0.01, 1000.0, 0, "N"};          ///< fingertips.max_force
inline constexpr NumberRange kStiffnessRange{0.1, 100'000.0, 0, "N/m"};  ///< of a fingertip
inline constexpr NumberRange kDampingRange{0.0, 100.0};  ///< of a fingertip, over sqrt(k m)
inline constexpr NumberRange kGravityRange{-100.0, 100.0, 0, "m/s^2"};
inline constexpr int kMostBodies = 500;  ///< of a scene
inline constexpr NumberRange kFovRange{1.0, 150.0, 0, "deg"};

}  // namespace pregrasp
