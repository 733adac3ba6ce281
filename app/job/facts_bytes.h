#pragma once

#include <cstddef>

#include "app/job/step_facts.h"

namespace pregrasp {

/// What the facts of a step hold, about [bytes].
std::size_t CalcBytes(const StepFacts& facts);

/// What the physics steps hold that an action of a simulation by hand took, about [bytes]; 0 of any
/// other step.
std::size_t CalcPastBytes(const StepFacts& facts);

}  // namespace pregrasp
