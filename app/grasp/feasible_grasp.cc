#include "app/grasp/feasible_grasp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

GraspStatus ToStatus(KinematicStatus status) {
  switch (status) {
    case KinematicStatus::kFeasible:
      return GraspStatus::kFeasible;
    case KinematicStatus::kTipsTooClose:
      return GraspStatus::kTipsTooClose;
    case KinematicStatus::kTipError:
      return GraspStatus::kTipError;
    case KinematicStatus::kCone:
      return GraspStatus::kCone;
    case KinematicStatus::kCollision:
      return GraspStatus::kCollision;
    case KinematicStatus::kNotCertified:
      return GraspStatus::kNotCertified;
  }
  return GraspStatus::kTipError;
}

GraspStatus ToStatus(WrenchStatus status) {
  switch (status) {
    case WrenchStatus::kFeasible:
      return GraspStatus::kFeasible;
    case WrenchStatus::kNoInternalForces:
      return GraspStatus::kNoInternalForces;
    case WrenchStatus::kWeightNotBalanced:
      return GraspStatus::kWeightNotBalanced;
  }
  return GraspStatus::kNoInternalForces;
}

// How far a failed attempt came.
int Progress(GraspStatus status) {
  return status == GraspStatus::kFeasible ? static_cast<int>(GraspStatus::kNotCertified) + 1
                                          : static_cast<int>(status);
}

std::string JoinFingers(const std::vector<GraspContact>& contacts) {
  std::string names;
  for (const GraspContact& contact : contacts) {
    names += (names.empty() ? "" : ", ") + std::string(FingerName(contact.finger));
  }
  return names;
}

// The pair in the way in the best attempt: the one that goes beyond what it may the most.
std::optional<HandOverlap> FindOverlap(const GraspWorld& world, const IkConfig& config,
                                       const IkResult& ik) {
  const bool at_contact =
      ik.deepest_contact && (!ik.closest || ik.contact_overlap - config.contact_depth >
                                                config.min_clearance - ik.clearance);
  const std::optional<HandDistance>& pair = at_contact ? ik.deepest_contact : ik.closest;
  if (!pair) return std::nullopt;
  const std::vector<HandCapsule>& capsules = world.ik().hand().capsules;
  return HandOverlap{capsules.at(pair->capsule).name,
                     pair->pair == HandPair::kSelf ? capsules.at(pair->other).name
                                                   : world.scene().bodies.at(pair->other).name,
                     -pair->distance};
}

std::string DescribeOverlap(const std::optional<HandOverlap>& overlap) {
  if (!overlap) return "not without overlap";
  if (!(overlap->depth > 0.0))
    return fmt::format("{} is in the way of {}", overlap->other, overlap->link);
  return fmt::format("{} would overlap {} by {:.1f} mm", overlap->link, overlap->other,
                     1e3 * overlap->depth);
}

// The finger of the largest of some numbers.
Finger FindWorst(const std::array<double, kNumFingers>& values) {
  return static_cast<Finger>(std::max_element(values.begin(), values.end()) - values.begin());
}

// The first finger that no grasp is without, of those that are not among the contacts.
std::optional<Finger> FindMissing(const TipSpheres& tips,
                                  const std::vector<GraspContact>& contacts) {
  for (const Finger finger : {Finger::kThumb, Finger::kIndex, Finger::kMiddle}) {
    if (tips.has(finger) && FindContact(contacts, finger) == nullptr) return finger;
  }
  return std::nullopt;
}

GraspFault FindFault(const GraspWorld& world, const GraspConfig& config,
                     const GraspResult& result) {
  GraspFault fault;
  switch (result.status) {
    case GraspStatus::kFeasible:
      break;
    case GraspStatus::kNoPlace:
      fault.finger = FindMissing(world.tips(), result.contacts);
      break;
    case GraspStatus::kTipsTooClose:
      fault.tips = FindNearestTips(world.tips(), result.contacts);
      break;
    case GraspStatus::kNoInternalForces:
    case GraspStatus::kWeightNotBalanced:
      fault.missing_wrench = -result.wrench->separating;
      break;
    case GraspStatus::kTipError:
      fault.finger = FindWorst(result.kinematics->ik.tip_errors);
      break;
    case GraspStatus::kCone:
      fault.finger = FindWorst(result.kinematics->ik.cone_angles);
      break;
    case GraspStatus::kCollision:
    case GraspStatus::kNotCertified:
      fault.overlap = FindOverlap(world, config.kinematics.ik, result.kinematics->ik);
      break;
  }
  return fault;
}

}  // namespace

bool IsDroppable(Finger finger) { return finger == Finger::kRing || finger == Finger::kLittle; }

std::vector<std::vector<Finger>> DroppableSets(const TipSpheres& tips, bool may_drop) {
  if (!may_drop || !tips.has(Finger::kRing)) return {{}};
  if (!tips.has(Finger::kLittle)) return {{}, {Finger::kRing}};
  return {{}, {Finger::kLittle}, {Finger::kRing}, {Finger::kRing, Finger::kLittle}};
}

void GraspConfig::Validate() const {
  if (!(std::isfinite(f_min) && f_min >= 0.0)) {
    throw InputError("grasp", "f_min", "a force of at least 0 N", FormatDouble(f_min));
  }
  kinematics.Validate();
}

const char* GraspStatusName(GraspStatus status) {
  constexpr const char* kNames[] = {
      "feasible",  "no_place", "tips_too_close", "no_internal_forces", "weight_not_balanced",
      "tip_error", "cone",     "collision",      "not_certified"};
  return kNames[static_cast<int>(status)];
}

bool GraspResult::uses(Finger finger) const { return FindContact(contacts, finger) != nullptr; }

std::string Explain(const GraspResult& result) {
  std::string fingers = JoinFingers(result.contacts);
  switch (result.status) {
    case GraspStatus::kFeasible:
      return fmt::format("{}: feasible; smallest normal force {:.2f} N, margin {:.3f}{}", fingers,
                         result.wrench->min_normal, result.wrench->margin,
                         result.wrench->closed ? "" : " (no force closure)");
    case GraspStatus::kNoPlace:
      return fmt::format("{}: the {} finds no place on the object",
                         fingers.empty() ? "no finger" : fingers, FingerName(*result.fault.finger));
    case GraspStatus::kTipsTooClose:
      return fmt::format("{}: the fingertips of {} and {} would overlap by {:.1f} mm", fingers,
                         FingerName(result.fault.tips->fingers[0]),
                         FingerName(result.fault.tips->fingers[1]), -1e3 * result.fault.tips->gap);
    case GraspStatus::kNoInternalForces:
      return fmt::format(
          "{}: no forces within cones and limits cancel out; those tried miss by {:.2f} N", fingers,
          result.wrench->residual);
    case GraspStatus::kWeightNotBalanced:
      return fmt::format(
          "{}: no forces within cones and limits balance the weight; those tried miss by {:.2f} N",
          fingers, result.wrench->residual);
    case GraspStatus::kTipError:
      return fmt::format("{}: no hand pose was found that reaches; a fingertip stays {:.1f} mm off",
                         fingers, 1e3 * result.kinematics->ik.tip_error);
    case GraspStatus::kCone:
      return fmt::format("{}: in the best hand pose found a finger touches at {:.0f} deg", fingers,
                         RadToDeg(result.kinematics->ik.cone_angle));
    case GraspStatus::kCollision:
      return fmt::format("{}: within reach, but {}", fingers,
                         DescribeOverlap(result.fault.overlap));
    case GraspStatus::kNotCertified:
      return fmt::format("{}: the only poses found are denied by the collision check", fingers);
  }
  return fingers;
}

GraspStatus CalcForceStatus(const GraspWorld& world, const GraspConfig& config,
                            const std::vector<GraspContact>& contacts, const Matrix3& R_WO,
                            Vector6* missing) {
  if (!(FindNearestTips(world.tips(), contacts).gap >= 0.0)) return GraspStatus::kTipsTooClose;
  Vector6 direction;
  return ToStatus(CalcWrenchStatus(world.ToWrenchContacts(contacts),
                                   world.MakeWrenchConfig(config.f_min, R_WO),
                                   missing != nullptr ? missing : &direction));
}

GraspAttempt TryContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start) {
  GraspAttempt attempt;
  attempt.contacts = contacts;
  attempt.status = CalcForceStatus(world, config, contacts, X_WB.at(0).linear());
  if (attempt.feasible()) {
    attempt.kinematics =
        CalcKinematicFeasibility(world, config.kinematics, contacts, X_WB, rng, warm_start);
    attempt.status = ToStatus(attempt.kinematics->status);
  }
  return attempt;
}

GraspResult ReportGrasp(const GraspWorld& world, const GraspConfig& config,
                        const GraspAttempt& attempt, const std::vector<RigidTransform>& X_WB) {
  GraspResult result;
  result.status = attempt.status;
  result.contacts = attempt.contacts;
  result.kinematics = attempt.kinematics;
  if (attempt.status != GraspStatus::kTipsTooClose && attempt.status != GraspStatus::kNoPlace) {
    result.wrench = CalcWrench(world.ToWrenchContacts(attempt.contacts),
                               world.MakeWrenchConfig(config.f_min, X_WB.at(0).linear()));
  }
  result.fault = FindFault(world, config, result);
  return result;
}

GraspResult TestContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start) {
  return ReportGrasp(world, config, TryContacts(world, config, contacts, X_WB, rng, warm_start),
                     X_WB);
}

std::vector<GraspContact> WithoutFingers(const std::vector<GraspContact>& contacts,
                                         const std::vector<Finger>& fingers) {
  std::vector<GraspContact> rest;
  for (const GraspContact& contact : contacts) {
    if (std::find(fingers.begin(), fingers.end(), contact.finger) == fingers.end()) {
      rest.push_back(contact);
    }
  }
  return rest;
}

GraspAttempt TryGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start) {
  if (FindMissing(world.tips(), contacts)) {
    GraspAttempt none;
    none.contacts = contacts;
    none.status = GraspStatus::kNoPlace;
    return none;
  }
  std::optional<GraspAttempt> best;
  for (const std::vector<Finger>& dropped : DroppableSets(world.tips(), config.may_drop)) {
    const std::vector<GraspContact> rest = WithoutFingers(contacts, dropped);
    if (rest.size() + dropped.size() != contacts.size()) continue;  // not among the contacts
    GraspAttempt attempt = TryContacts(world, config, rest, X_WB, rng, warm_start);
    if (!best || Progress(attempt.status) > Progress(best->status)) best = std::move(attempt);
    if (best->feasible()) break;
  }
  PREGRASP_CHECK(best.has_value());
  return *best;
}

GraspResult TestGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start) {
  config.Validate();
  return ReportGrasp(world, config, TryGrasp(world, config, contacts, X_WB, rng, warm_start), X_WB);
}

}  // namespace pregrasp
