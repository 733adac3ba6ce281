#include "app/grasp/grasp_room.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/core/check.h"
#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

// A distal axis may lean so far over the inward normal (IkConfig::max_cone_deg), less a margin.
constexpr double kLean = 50.0 * kPi / 180.0;
constexpr int kLeanDirections = 6;
// Sets that weigh less than this do not change a mean that anyone could tell apart.
constexpr double kNegligible = 0.01;
// Whether a set balances the weight is looked up where gravity is within so much of the start's.
constexpr double kSameGravity = 1.0 * kPi / 180.0;

SamplerConfig WithoutSurroundings(SamplerConfig config) {
  config.slack.environment = 1e3;  // [m]: no overlap is more
  return config;
}

}  // namespace

void GraspRoomConfig::Validate() const {
  sampler.Validate();
  PREGRASP_CHECK(sets >= 1 && max_drawn >= sets, sets, max_drawn);
  PREGRASP_CHECK(softness > 0.0 && link_length >= 0.0 && f_min >= 0.0, softness, link_length,
                 f_min);
  PREGRASP_CHECK(half_share > 0.0 && kept_share >= 0.0, half_share, kept_share);
}

GraspRoom::GraspRoom(const GraspWorld& world, const GraspRoomConfig& config, std::uint64_t seed)
    : world_(world),
      config_(config),
      seed_(seed),
      alone_(world, world.StartPoses(), WithoutSurroundings(config.sampler).slack),
      sampler_(alone_, WithoutSurroundings(config.sampler)) {
  config.Validate();
  WrenchConfig weightless = world.MakeWrenchConfig(config.f_min, Matrix3::Identity());
  weightless.mass = 0.0;
  int drawn = 0;
  while (drawn < config.max_drawn && num_sets() < config.sets) {
    ThrowIfInterrupted();
    Rng rng(seed_, RngStream::kGraspRoom, drawn++);
    auto contacts = sampler_.Sample({}, rng);
    if (!contacts) continue;
    const WrenchStatus status = CalcWrenchStatus(world_.ToWrenchContacts(*contacts), weightless);
    if (status == WrenchStatus::kFeasible) sets_.push_back(std::move(*contacts));
  }
  held_share_ = static_cast<double>(num_sets()) / drawn;
  const Matrix3 R_WO = world.StartPoses().front().linear();
  gravity_O_ = (R_WO.transpose() * world.scene().gravity).normalized();
  const WrenchConfig at_start = world.MakeWrenchConfig(config.f_min, R_WO);
  for (const std::vector<GraspContact>& contacts : sets_) {
    balanced_there_.push_back(CalcWrenchStatus(world_.ToWrenchContacts(contacts), at_start) ==
                              WrenchStatus::kFeasible);
  }
}

double GraspRoom::CalcOverlap(const GraspContact& contact,
                              const std::vector<RigidTransform>& X_WB) const {
  const double radius = world_.tips().radius(contact.finger);
  const Vector3 p_WTip = X_WB.front() * TipCentre(world_.tips(), contact);
  const double tip = radius - world_.environment().Calc(p_WTip, X_WB).phi;
  const Matrix3 R_WC = X_WB.front().linear() * FrameFromNormal(contact.nhat_O);
  double link = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kLeanDirections && link > 0.0; ++i) {
    const double lean = i == 0 ? 0.0 : kLean, turn = 2.0 * kPi * i / kLeanDirections;
    const Vector3 away_C(std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn),
                         std::cos(lean));
    const Vector3 p_WLink = p_WTip + config_.link_length * (R_WC * away_C);
    link = std::min(link, radius - world_.environment().Calc(p_WLink, X_WB).phi);
  }
  return std::max({0.0, tip, link});
}

double GraspRoom::CalcFreedom(const std::vector<GraspContact>& contacts,
                              const std::vector<RigidTransform>& X_WB,
                              const std::vector<GraspContact>& fixed) const {
  double overlap = 0.0;
  for (const GraspContact& contact : contacts) {
    if (FindContact(fixed, contact.finger) != nullptr) continue;
    overlap = std::max(overlap, CalcOverlap(contact, X_WB));
    if (std::exp(-overlap / config_.softness) < kNegligible) return 0.0;
  }
  return std::exp(-overlap / config_.softness);
}

double GraspRoom::CalcShare(const std::vector<RigidTransform>& X_WB) const {
  if (sets_.empty()) return 0.0;
  const WrenchConfig wrench = world_.MakeWrenchConfig(config_.f_min, X_WB.front().linear());
  const bool as_at_start = wrench.gravity.normalized().dot(gravity_O_) > std::cos(kSameGravity);
  double sum = 0.0;
  for (int i = 0; i < num_sets(); ++i) {
    if (as_at_start && !balanced_there_[i]) continue;
    const double freedom = CalcFreedom(sets_[i], X_WB, {});
    if (freedom == 0.0) continue;
    const bool balanced = as_at_start || CalcWrenchStatus(world_.ToWrenchContacts(sets_[i]),
                                                          wrench) == WrenchStatus::kFeasible;
    if (balanced) sum += freedom;
  }
  return sum / num_sets();
}

double GraspRoom::SumGiven(const std::vector<RigidTransform>& X_WB,
                           const std::vector<GraspContact>& given,
                           const std::vector<GraspContact>& pressing) const {
  const WrenchConfig wrench = world_.MakeWrenchConfig(config_.f_min, X_WB.front().linear());
  double sum = 0.0;
  for (int i = 0; i < config_.sets; ++i) {
    Rng rng(seed_, RngStream::kGraspRoomKept, i);
    const auto contacts = sampler_.Sample(given, rng);
    if (!contacts) continue;
    const double freedom = CalcFreedom(*contacts, X_WB, pressing);
    if (freedom == 0.0) continue;
    const WrenchStatus status = CalcWrenchStatus(world_.ToWrenchContacts(*contacts), wrench);
    if (status == WrenchStatus::kFeasible) sum += freedom;
  }
  return sum;
}

double GraspRoom::CalcSumAlone() const { return std::max(held_share_, kNegligible) * config_.sets; }

double GraspRoom::CalcWith(const std::vector<RigidTransform>& X_WB,
                           const std::vector<GraspContact>& given,
                           const std::vector<GraspContact>& pressing) const {
  const double share = SumGiven(X_WB, given, pressing) / CalcSumAlone();
  PREGRASP_CHECK(std::isfinite(share) && share >= 0.0, share);
  return share / (share + 1.0);
}

double GraspRoom::Calc(const std::vector<RigidTransform>& X_WB,
                       const std::vector<GraspContact>& fixed) const {
  const double share = fixed.empty()
                           ? CalcShare(X_WB)
                           : config_.kept_share * SumGiven(X_WB, fixed, fixed) / CalcSumAlone();
  PREGRASP_CHECK(std::isfinite(share) && share >= 0.0, share);
  return share / (share + config_.half_share);
}

}  // namespace pregrasp
