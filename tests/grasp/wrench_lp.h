#pragma once

#include <span>

#include "app/grasp/wrench.h"

namespace pregrasp {

/// The same question asked of GLPK's simplex, which shares no code and no formulation with ours:
/// the smallest sum of absolute values by which the net wrench of admissible forces (with the
/// weight, if asked) misses zero, each cone replaced by a pyramid of `facets` edges, drawn inside
/// the circular cone or around it.
enum class Pyramid { kInscribed, kCircumscribed };
double CalcImbalanceByLp(std::span<const WrenchContact> contacts, const WrenchConfig& config,
                         bool with_weight, int facets, Pyramid pyramid);

}  // namespace pregrasp
