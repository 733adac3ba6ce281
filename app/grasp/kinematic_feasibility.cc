#include "app/grasp/kinematic_feasibility.h"

#include <algorithm>
#include <string>

#include "app/core/error.h"

namespace pregrasp {
namespace {

KinematicStatus ToStatus(IkStatus status) {
  switch (status) {
    case IkStatus::kSolved:
      return KinematicStatus::kFeasible;
    case IkStatus::kTipError:
    case IkStatus::kJointLimits:  // never from Solve
      return KinematicStatus::kTipError;
    case IkStatus::kCone:
      return KinematicStatus::kCone;
    case IkStatus::kCollision:
      return KinematicStatus::kCollision;
    case IkStatus::kNotCertified:
      return KinematicStatus::kNotCertified;
  }
  return KinematicStatus::kTipError;
}

}  // namespace

void KinematicConfig::Validate() const {
  if (reach_starts < 0) {
    throw InputError("grasp", "reach_starts", "no negative count", std::to_string(reach_starts));
  }
  ik.Validate();
}

KinematicResult CalcKinematicFeasibility(const GraspWorld& world, const KinematicConfig& config,
                                         const std::vector<GraspContact>& contacts,
                                         const std::vector<RigidTransform>& X_WB, Rng rng,
                                         const HandConfiguration* warm_start) {
  KinematicResult result;
  result.nearest_tips = FindNearestTips(world.tips(), contacts);
  if (!(result.nearest_tips.gap >= 0.0)) {
    result.status = KinematicStatus::kTipsTooClose;
    return result;
  }
  IkProblem problem = world.ToIkProblem(contacts, X_WB);
  if (warm_start != nullptr) {
    problem.warm_start = *warm_start;
  } else if (config.ik.collision && config.reach_starts > 0) {
    IkConfig reach = config.ik;
    reach.collision = false;
    reach.slsqp = false;
    reach.max_starts = std::min(config.reach_starts, config.ik.max_starts);
    result.ik = world.ik().Solve(reach, problem, rng);
    result.status = ToStatus(result.ik.status);
    if (!result.feasible()) return result;
    problem.warm_start = result.ik.configuration();
  }
  result.ik = world.ik().Solve(config.ik, problem, rng);
  result.status = ToStatus(result.ik.status);
  result.reached = result.status == KinematicStatus::kFeasible ||
                   result.status == KinematicStatus::kCollision ||
                   result.status == KinematicStatus::kNotCertified;
  return result;
}

}  // namespace pregrasp
