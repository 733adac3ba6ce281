#pragma once

#include "app/grasp/start_certificate.h"
#include "app/job/planner.h"

namespace pregrasp {

/// What the generator is asked at a start (design, section 4): so many grasps for each of so many
/// nodes, the best by s_c.
inline constexpr int kProposedNodes = 10, kProposedPerNode = 20;

/// Scores the contact graph at the planner's start and has the generator complete its best nodes:
/// thumb alone, index alone and both in turn, anywhere on the node's triangles where their tips can
/// be, or where it is drawn first if they can be nowhere there. All grasps are completed and tested
/// as on a certified trajectory (CompleteGrasps), with 20 restarts of inverse kinematics, whether
/// they would lift or not; a node at a time, until one is feasible. @throws Interrupted.
ProposedGrasps ProposeAtStart(const Planner& planner);

}  // namespace pregrasp
