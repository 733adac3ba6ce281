#include "app/grasp/grasp_completion.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

bool IsFixed(const std::vector<GraspContact>& fixed, Finger finger) {
  return std::any_of(fixed.begin(), fixed.end(),
                     [&](const GraspContact& contact) { return contact.finger == finger; });
}

std::vector<GraspContact> ProjectGrasp(const GraspWorld& world, const GraspPoints& generated,
                                       const std::vector<GraspContact>& fixed) {
  std::vector<GraspContact> contacts = fixed;
  for (int f = 0; f < kNumFingers; ++f) {
    const Finger finger = static_cast<Finger>(f);
    if (IsFixed(fixed, finger)) continue;
    contacts.push_back(world.ContactNear(finger, generated[f]));
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const GraspContact& a, const GraspContact& b) { return a.finger < b.finger; });
  return contacts;
}

// `contacts` with those that are not fixed moved at random by up to `reach` along the surface.
std::vector<GraspContact> MoveAlongSurface(const GraspWorld& world,
                                           const std::vector<GraspContact>& contacts,
                                           const std::vector<GraspContact>& fixed, double reach,
                                           double max_reach, Rng& rng) {
  std::vector<GraspContact> moved = contacts;
  for (GraspContact& contact : moved) {
    if (IsFixed(fixed, contact.finger)) continue;
    const Vector3 start = contact.p_OC;
    const double distance = reach * std::cbrt(rng.Uniform());
    const Vector3 p_O = start + distance * rng.Direction();
    const GraspContact candidate = world.ContactNear(contact.finger, p_O);
    if ((candidate.p_OC - start).norm() <= max_reach) contact = candidate;
  }
  return moved;
}

double LargestMove(const std::vector<GraspContact>& a, const std::vector<GraspContact>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i].p_OC - b[i].p_OC).norm());
  }
  return largest;
}

bool HasForces(GraspStatus status) {
  return status != GraspStatus::kNoInternalForces && status != GraspStatus::kWeightNotBalanced &&
         status != GraspStatus::kTipsTooClose;
}

}  // namespace

CompletedGrasp CompleteGrasp(const GraspWorld& world, const CompletionConfig& config,
                             const GraspPoints& generated, const std::vector<GraspContact>& fixed,
                             const std::vector<RigidTransform>& X_WB, const Rng& rng) {
  PREGRASP_CHECK(config.max_refinement >= 0.0, config.max_refinement);
  CompletedGrasp grasp;
  grasp.projected = ProjectGrasp(world, generated, fixed);
  grasp.raw = TestGrasp(world, config.grasp, grasp.projected, X_WB, rng);
  grasp.result = grasp.raw;
  if (grasp.raw.feasible()) return grasp;
  Rng moves = rng.Split(RngStream::kGraspRefinement);
  int solves = 0;
  while (grasp.refinements < config.max_refinements && solves < config.max_solves) {
    ++grasp.refinements;
    const double share = static_cast<double>(grasp.refinements) / config.max_refinements;
    const std::vector<GraspContact> moved = MoveAlongSurface(
        world, grasp.projected, fixed, share * config.max_refinement, config.max_refinement, moves);
    const GraspResult result = TestGrasp(world, config.grasp, moved, X_WB,
                                         rng.Split(RngStream::kRefinedGraspIk, grasp.refinements));
    solves += HasForces(result.status);
    if (result.feasible()) {
      grasp.result = result;
      grasp.moved = LargestMove(grasp.projected, moved);
      break;
    }
  }
  return grasp;
}

}  // namespace pregrasp
