#pragma once

#include <cstddef>

#include "app/job/step_facts.h"

namespace pregrasp {

/// What the facts of a step hold, about [bytes]; with those of a simulation by hand, the physics
/// steps that it took.
std::size_t CalcBytes(const StepFacts& facts);

}  // namespace pregrasp
