#include "app/grasp/kinematic_feasibility.h"

#include <cmath>
#include <limits>

#include "app/core/error.h"
#include "app/core/text.h"

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
  if (!(std::isfinite(min_tip_distance) && min_tip_distance >= 0.0)) {
    throw InputError("grasp", "min_tip_distance", "a length of at least 0 m",
                     FormatDouble(min_tip_distance));
  }
  ik.Validate();
}

KinematicResult CalcKinematicFeasibility(const GraspWorld& world, const KinematicConfig& config,
                                         const std::vector<GraspContact>& contacts,
                                         const std::vector<RigidTransform>& X_WB, Rng rng,
                                         const HandConfiguration* warm_start) {
  KinematicResult result;
  result.tip_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double distance = (TipCentre(contacts[i]) - TipCentre(contacts[k])).norm();
      if (distance >= result.tip_distance) continue;
      result.tip_distance = distance;
      result.nearest_tips = {contacts[k].finger, contacts[i].finger};
    }
  }
  if (result.tip_distance < config.min_tip_distance) {
    result.status = KinematicStatus::kTipsTooClose;
    return result;
  }
  IkProblem problem = world.ToIkProblem(contacts, X_WB);
  if (warm_start != nullptr) problem.warm_start = *warm_start;
  result.ik = world.ik().Solve(config.ik, problem, rng);
  result.status = ToStatus(result.ik.status);
  return result;
}

}  // namespace pregrasp
