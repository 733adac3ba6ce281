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

// What overlaps in the best attempt.
std::string DescribeOverlap(const IkResult& ik, const GraspWorld& world) {
  const std::vector<HandCapsule>& capsules = world.ik().hand().capsules;
  if (ik.clearance >= 0.0 || !ik.closest) {
    return fmt::format("a fingertip would enter the object by {:.1f} mm", 1e3 * ik.contact_overlap);
  }
  const bool self = ik.closest->pair == HandPair::kSelf;
  return fmt::format(
      "{} would overlap {} by {:.1f} mm", capsules[ik.closest->capsule].name,
      self ? capsules[ik.closest->other].name : world.scene().bodies[ik.closest->other].name,
      -1e3 * ik.clearance);
}

bool TipsTooClose(const std::vector<GraspContact>& contacts, double min_distance) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if ((TipCentre(contacts[i]) - TipCentre(contacts[k])).norm() < min_distance) return true;
    }
  }
  return false;
}

}  // namespace

void GraspConfig::Validate() const {
  if (!(std::isfinite(f_min) && f_min >= 0.0)) {
    throw InputError("grasp", "f_min", "a force of at least 0 N", FormatDouble(f_min));
  }
  kinematics.Validate();
}

const char* GraspStatusName(GraspStatus status) {
  constexpr const char* kNames[] = {
      "feasible",  "tips_too_close", "no_internal_forces", "weight_not_balanced",
      "tip_error", "cone",           "collision",          "not_certified"};
  return kNames[static_cast<int>(status)];
}

bool GraspResult::uses(Finger finger) const {
  return std::any_of(contacts.begin(), contacts.end(),
                     [&](const GraspContact& contact) { return contact.finger == finger; });
}

std::string Explain(const GraspResult& result, const GraspWorld& world) {
  std::string fingers = JoinFingers(result.contacts);
  switch (result.status) {
    case GraspStatus::kFeasible:
      return fmt::format("{}: feasible; smallest normal force {:.2f} N, margin {:.3f}{}", fingers,
                         result.wrench->min_normal, result.wrench->margin,
                         result.wrench->closed ? "" : " (no force closure)");
    case GraspStatus::kTipsTooClose:
      return fmt::format("{}: the fingertips of {} and {} would be {:.1f} mm apart", fingers,
                         FingerName(result.kinematics->nearest_tips[0]),
                         FingerName(result.kinematics->nearest_tips[1]),
                         1e3 * result.kinematics->tip_distance);
    case GraspStatus::kNoInternalForces:
      return fmt::format("{}: no forces within the cones cancel out; those tried miss by {:.2f} N",
                         fingers, result.wrench->residual);
    case GraspStatus::kWeightNotBalanced:
      return fmt::format(
          "{}: no forces within the cones balance the weight; those tried miss by {:.2f} N",
          fingers, result.wrench->residual);
    case GraspStatus::kTipError:
      return fmt::format("{}: no hand pose was found that reaches; a fingertip stays {:.1f} mm off",
                         fingers, 1e3 * result.kinematics->ik.tip_error);
    case GraspStatus::kCone:
      return fmt::format("{}: in the best hand pose found a finger touches at {:.0f} degrees",
                         fingers, RadToDeg(result.kinematics->ik.cone_angle));
    case GraspStatus::kCollision:
      return fmt::format("{}: within reach, but {}", fingers,
                         DescribeOverlap(result.kinematics->ik, world));
    case GraspStatus::kNotCertified:
      return fmt::format("{}: the only poses found are denied by the collision check", fingers);
  }
  return fingers;
}

GraspResult TestContacts(const GraspWorld& world, const GraspConfig& config,
                         const std::vector<GraspContact>& contacts,
                         const std::vector<RigidTransform>& X_WB, Rng rng,
                         const HandConfiguration* warm_start) {
  GraspResult result;
  result.contacts = contacts;
  if (!TipsTooClose(contacts, config.kinematics.min_tip_distance)) {
    const WrenchConfig wrench = world.MakeWrenchConfig(config.f_min, X_WB.at(0).linear());
    result.wrench = CalcWrench(world.ToWrenchContacts(contacts), wrench);
    if (!result.wrench->feasible()) {
      result.status = result.wrench->status == WrenchStatus::kNoInternalForces
                          ? GraspStatus::kNoInternalForces
                          : GraspStatus::kWeightNotBalanced;
      return result;
    }
  }
  result.kinematics =
      CalcKinematicFeasibility(world, config.kinematics, contacts, X_WB, rng, warm_start);
  result.status = ToStatus(result.kinematics->status);
  return result;
}

GraspResult TestGrasp(const GraspWorld& world, const GraspConfig& config,
                      const std::vector<GraspContact>& contacts,
                      const std::vector<RigidTransform>& X_WB, Rng rng,
                      const HandConfiguration* warm_start) {
  config.Validate();
  const std::vector<std::vector<Finger>> left_out =
      config.may_drop ? std::vector<std::vector<Finger>>{{},
                                                         {Finger::kLittle},
                                                         {Finger::kRing},
                                                         {Finger::kRing, Finger::kLittle}}
                      : std::vector<std::vector<Finger>>{{}};
  std::optional<GraspResult> best;
  for (const std::vector<Finger>& dropped : left_out) {
    std::vector<GraspContact> rest;
    for (const GraspContact& contact : contacts) {
      if (std::find(dropped.begin(), dropped.end(), contact.finger) == dropped.end()) {
        rest.push_back(contact);
      }
    }
    if (rest.size() + dropped.size() != contacts.size()) continue;  // not among the contacts
    GraspResult result = TestContacts(world, config, rest, X_WB, rng, warm_start);
    if (!best || Progress(result.status) > Progress(best->status)) best = std::move(result);
    if (best->feasible()) break;
  }
  PREGRASP_CHECK(best.has_value());
  return *best;
}

}  // namespace pregrasp
