#include "app/grasp/grasp_refinement.h"

#include <algorithm>
#include <limits>

#include "app/core/check.h"

namespace pregrasp {
namespace {

constexpr int kFailuresToLeaveOut = 6;  // of one set of fingers
constexpr int kStiffAttempts = 16;      // since a feasible set, for one that is stiff as well
constexpr int kDisturbances = 16;       // draws for a set that was not tried yet
// A contact goes farther than its fingertip came, since the hand gives way only part of the way.
constexpr double kOvershoot = 1.5;

// The finger that a link belongs to; none for the palm.
std::optional<Finger> FindFinger(const HandModel& hand, int link) {
  for (int f = 0; f < hand.num_fingers; ++f) {
    const int tip = hand.tips[f].link;
    if (link <= tip && link > hand.chain_begin[tip]) return static_cast<Finger>(f);
  }
  return std::nullopt;
}

}  // namespace

// Where each contact's tip centre should go, in O [m], by Finger.
struct GraspRefinement::Pull {
  std::array<Vector3, kNumFingers> way_O;
  Finger worst = Finger::kThumb;
  Pull() { way_O.fill(Vector3::Zero()); }
};

GraspRefinement::GraspRefinement(const ContactPlaces& places, const RefinementConfig& config,
                                 std::vector<GraspContact> projected,
                                 const std::vector<GraspContact>& fixed, const Rng& rng)
    : places_(places),
      config_(config),
      projected_(std::move(projected)),
      R_WO_(places.X_WB().at(0).linear()),
      rng_(rng.Split(RngStream::kGraspRefinement)),
      choices_(FindChoices(places, projected_, fixed, config.reach)),
      holds_(places.world(), config.grasp, choices_, R_WO_),
      stiffness_(places.world(), config.grasp, config.forces, choices_, R_WO_,
                 config.max_stiffness_tests),
      choice_(projected_.size(), 0) {}

bool GraspRefinement::open() const {
  if (exhausted_ || stiff_) return false;
  return !feasible_ || attempts_since_ < kStiffAttempts;
}

void GraspRefinement::Start(const GraspAttempt& raw) {
  if (!raw.kinematics) return;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (FindContact(raw.contacts, choices_[i].finger) == nullptr) choice_[i] = kLeftOut;
  }
  tried_.insert(choice_);
  last_ = raw.kinematics->ik;
  if (raw.feasible()) NoteFeasible();
}

void GraspRefinement::NoteFeasible() {
  stiff_ = config_.max_stiffness_tests == 0 || stiffness_.IsStiff(choice_);
  if (!feasible_) attempts_since_ = 0;
  feasible_ = true;
}

bool GraspRefinement::Step(const std::vector<HandConfiguration>& solved) {
  if (!open()) return false;
  if (!Propose()) {
    exhausted_ = true;
    return false;
  }
  tried_.insert(choice_);
  GraspConfig config = config_.grasp;
  config.kinematics.ik.reason_starts = 0;
  std::optional<HandConfiguration> start = FindNearest(solved);
  if (!start && last_) start = last_->configuration();
  GraspAttempt attempt =
      TryContacts(places_.world(), config, ToContacts(choices_, choice_), places_.X_WB(),
                  rng_.Split(RngStream::kRefinedGraspIk, solves_), start ? &*start : nullptr);
  ++solves_;
  PREGRASP_CHECK(attempt.kinematics.has_value());
  ++attempts_since_;
  last_ = attempt.kinematics->ik;
  if (!attempt.feasible()) {
    ++failures_;
    return false;
  }
  failures_ = 0;
  const bool is_first = !feasible_;
  NoteFeasible();
  if (!is_first && !stiff_) return false;
  found_ = std::move(attempt);
  return true;
}

// The next set of contacts that holds, stiffly where one is found, and was not tried.
bool GraspRefinement::Propose() {
  if (last_ && failures_ >= kFailuresToLeaveOut) LeaveOut();
  if (last_) FollowHand();
  for (int i = 0; i <= kDisturbances; ++i) {
    if (!Hold()) return false;
    const bool is_stiff = stiffness_.Run(choice_);
    if (feasible_ && !is_stiff) {
      Disturb();
      continue;
    }
    if (tried_.find(choice_) == tried_.end()) return true;
    Disturb();
  }
  return false;
}

// Moves contacts until forces hold: from the set as it is, from the projected one, with fewer
// fingers.
bool GraspRefinement::Hold() {
  ContactChoice start = choice_;
  if (holds_.Run(choice_)) return true;
  for (int& place : start) place = std::min(place, 0);
  for (const std::vector<Finger>& left_out : DroppableSets(tips(), config_.grasp.may_drop)) {
    choice_ = start;
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      if (std::find(left_out.begin(), left_out.end(), choices_[i].finger) != left_out.end()) {
        choice_[i] = kLeftOut;
      }
    }
    if (holds_.Run(choice_)) {
      last_.reset();
      return true;
    }
  }
  return false;
}

// Leaves out the finger, of those that may be, that stands in the way the most.
void GraspRefinement::LeaveOut() {
  if (!config_.grasp.may_drop) return;
  const Pull pull = CalcPull();
  int worst = kLeftOut;
  double most = -1.0;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const Finger finger = choices_[i].finger;
    if (choice_[i] == kLeftOut || !IsDroppable(finger) || choices_[i].places.size() < 2) continue;
    const double way = pull.way_O[static_cast<int>(finger)].norm();
    if (way < most) continue;
    most = way;
    worst = static_cast<int>(i);
  }
  if (worst == kLeftOut) return;
  choice_[worst] = kLeftOut;
  failures_ = 0;
}

// How far each fingertip stays off its contact in the last attempt, and which way to get out of
// what the hand overlaps.
GraspRefinement::Pull GraspRefinement::CalcPull() const {
  Pull pull;
  const HandModel& hand = places_.world().ik().hand();
  const auto add = [&](int capsule, const Vector3& way_W) {
    const Vector3 way_O = R_WO_.transpose() * way_W;
    const std::optional<Finger> finger = FindFinger(hand, hand.capsules.at(capsule).link);
    for (int f = 0; f < kNumFingers; ++f) {
      if (!finger || static_cast<int>(*finger) == f) pull.way_O[f] += way_O;
    }
  };
  const IkConfig& ik = config_.grasp.kinematics.ik;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choice_[i] == kLeftOut) continue;
    const GraspContact& contact = choices_[i].places[choice_[i]];
    const Vector3 way =
        CalcTip(last_->configuration(), contact.finger) - TipCentre(tips(), contact);
    pull.way_O[static_cast<int>(contact.finger)] = kOvershoot * way;
  }
  if (last_->closest) {
    const HandDistance& near = *last_->closest;
    const double deep = ik.min_clearance + ik.clearance_buffer - near.distance;
    if (deep > 0.0) {
      const bool self = near.pair == HandPair::kSelf;
      add(near.capsule, (self ? 0.5 : 1.0) * kOvershoot * deep * near.nhat_W);
      if (self) add(near.other, -0.5 * kOvershoot * deep * near.nhat_W);
    }
  }
  double most = -1.0;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const int f = static_cast<int>(choices_[i].finger);
    if (choice_[i] == kLeftOut || choices_[i].places.size() < 2) continue;
    if (!(pull.way_O[f].norm() > most)) continue;
    most = pull.way_O[f].norm();
    pull.worst = choices_[i].finger;
  }
  return pull;
}

Vector3 GraspRefinement::CalcTip(const HandConfiguration& configuration, Finger finger) const {
  const HandModel& hand = places_.world().ik().hand();
  HandPose pose;
  CalcHandPose(hand, configuration.X_WH, configuration.q, &pose);
  const Fingertip& tip = hand.tip(finger);
  return places_.X_WB().at(0).inverse() * pose.CalcPoint(tip.link, tip.p_LT);
}

// Every contact to the place whose tip is nearest to where the pull wants it.
void GraspRefinement::FollowHand() {
  const Pull pull = CalcPull();
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choice_[i] == kLeftOut || choices_[i].places.size() < 2) continue;
    const ContactChoices& choices = choices_[i];
    const Vector3 wish = TipCentre(tips(), choices.places[choice_[i]]) +
                         pull.way_O[static_cast<int>(choices.finger)];
    double least = std::numeric_limits<double>::infinity();
    int nearest = choice_[i];
    for (int place = 0; place < static_cast<int>(choices.places.size()); ++place) {
      const double distance = (TipCentre(tips(), choices.places[place]) - wish).norm();
      if (!(distance < least)) continue;
      if (!HasRoom(tips(), choices_, choice_, static_cast<int>(i), place)) continue;
      least = distance;
      nearest = place;
    }
    choice_[i] = nearest;
  }
}

// Moves a contact at random: the one that is worst, or any that can be moved.
void GraspRefinement::Disturb() {
  std::vector<int> movable;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choice_[i] != kLeftOut && choices_[i].places.size() > 1)
      movable.push_back(static_cast<int>(i));
  }
  if (movable.empty()) return;
  int contact = movable[rng_.UniformInt(static_cast<std::uint32_t>(movable.size()))];
  if (last_ && rng_.Uniform() < 0.5) {
    const Finger worst = CalcPull().worst;
    for (const int i : movable) {
      if (choices_[i].finger == worst) contact = i;
    }
  }
  ContactChoice moved = choice_;
  moved[contact] = static_cast<int>(
      rng_.UniformInt(static_cast<std::uint32_t>(choices_[contact].places.size())));
  if (FindNearestTips(tips(), ToContacts(choices_, moved)).gap >= 0.0) choice_ = moved;
}

std::optional<HandConfiguration> GraspRefinement::FindNearest(
    const std::vector<HandConfiguration>& solved) const {
  std::optional<HandConfiguration> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const HandConfiguration& hand : solved) {
    double distance = 0.0;
    for (const GraspContact& contact : ToContacts(choices_, choice_)) {
      distance += (CalcTip(hand, contact.finger) - TipCentre(tips(), contact)).squaredNorm();
    }
    if (!(distance < least)) continue;
    least = distance;
    nearest = hand;
  }
  return nearest;
}

}  // namespace pregrasp
