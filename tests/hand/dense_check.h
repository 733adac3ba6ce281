#pragma once

#include <string>
#include <vector>

#include "app/hand/ik.h"

namespace pregrasp {

/// What is wrong with a configuration as a solution of a problem, found without the solver's
/// distances, kinematics or closed forms: Simbody's poses, and points sampled along every capsule's
/// axis against the signed distance of whole shapes. Empty if nothing is, within `slack` [m].
std::vector<std::string> FindFaults(const HandModel& hand, const std::vector<const Shape*>& shapes,
                                    const IkConfig& config, const IkProblem& problem,
                                    const HandConfiguration& configuration, double slack);

}  // namespace pregrasp
