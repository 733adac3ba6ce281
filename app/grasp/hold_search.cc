#include "app/grasp/hold_search.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "app/grasp/contact_wrenches.h"

namespace pregrasp {
namespace {

constexpr int kMaxCuts = 24;      // of one run
constexpr int kMovesPerCut = 3;   // contacts moved for one missing wrench
constexpr double kEnough = 0.02;  // of the cap on a force: how much of a wrench is enough

}  // namespace

std::vector<ContactChoices> FindChoices(const ContactPlaces& places,
                                        const std::vector<GraspContact>& contacts,
                                        const std::vector<GraspContact>& fixed, double reach) {
  std::vector<ContactChoices> all;
  for (const GraspContact& contact : contacts) {
    ContactChoices choices{contact.finger, {contact}, {0.0}};
    std::vector<std::pair<double, int>> near;
    if (FindContact(fixed, contact.finger) == nullptr) {
      for (const int place : places.FindWithin(contact.finger, contact.p_OC, reach)) {
        near.emplace_back((places.At(contact.finger, place).p_OC - contact.p_OC).norm(), place);
      }
    }
    std::sort(near.begin(), near.end());
    for (const auto& [distance, place] : near) {
      choices.places.push_back(places.At(contact.finger, place));
      choices.moved.push_back(distance);
    }
    all.push_back(std::move(choices));
  }
  return all;
}

std::vector<GraspContact> ToContacts(const std::vector<ContactChoices>& choices,
                                     const ContactChoice& choice) {
  std::vector<GraspContact> contacts;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choice[i] != kLeftOut) contacts.push_back(choices[i].places[choice[i]]);
  }
  return contacts;
}

bool HasRoom(const TipSpheres& tips, const std::vector<ContactChoices>& choices,
             const ContactChoice& choice, int contact, int place) {
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (static_cast<int>(i) == contact || choice[i] == kLeftOut) continue;
    if (!(CalcTipGap(tips, choices[i].places[choice[i]], choices[contact].places[place]) >= 0.0)) {
      return false;
    }
  }
  return true;
}

HoldSearch::HoldSearch(const GraspWorld& world, const GraspConfig& config,
                       const std::vector<ContactChoices>& choices, const Matrix3& R_WO)
    : world_(world),
      config_(config),
      choices_(choices),
      R_WO_(R_WO),
      wrench_(world.MakeWrenchConfig(config.f_min, R_WO)),
      gain_(choices.size()) {}

bool HoldSearch::Run(ContactChoice& choice) {
  for (int i = 0; i < kMaxCuts; ++i) {
    Vector6 missing = Vector6::Zero();
    const GraspStatus status =
        CalcForceStatus(world_, config_, ToContacts(choices_, choice), R_WO_, &missing);
    if (status == GraspStatus::kFeasible) return true;
    if (status == GraspStatus::kTipsTooClose || !missing.allFinite()) return false;
    AddCut(missing);
    if (IsHopeless(choice) || !Improve(choice)) return false;
  }
  return false;
}

// What each contact at each of its places gives of the missing wrench at most.
void HoldSearch::AddCut(const Vector6& missing) {
  cuts_.push_back(missing);
  const Vector3& p_OOcm = world_.scene().object().mass_properties->p_BoBcm;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    std::vector<float>& gain = gain_[i].emplace_back();
    for (const GraspContact& contact : choices_[i].places) {
      const auto scaled = internal::MakeScaledContact({contact.p_OC - p_OOcm, -contact.nhat_O},
                                                      wrench_.torque_scale);
      double value = 0.0;
      internal::CalcConeSupport(scaled, wrench_.mu, missing, &value);
      gain.push_back(static_cast<float>(value * (value > 0.0 ? wrench_.f_max : wrench_.f_min)));
    }
  }
}

// How much of every missing wrench the contacts give at most, with the weight or without it, which
// is less; `without` leaves a contact out.
std::vector<double> HoldSearch::CalcTotals(const ContactChoice& choice, int without) const {
  std::vector<double> totals(cuts_.size());
  for (std::size_t k = 0; k < cuts_.size(); ++k) {
    const double weight = wrench_.mass * wrench_.gravity.dot(cuts_[k].head<3>());
    totals[k] = std::min(0.0, weight);
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      if (choice[i] == kLeftOut || static_cast<int>(i) == without) continue;
      totals[k] += gain_[i][k][choice[i]];
    }
  }
  return totals;
}

// Whether even the best place of every contact leaves the latest wrench missing.
bool HoldSearch::IsHopeless(const ContactChoice& choice) const {
  double most = std::min(0.0, wrench_.mass * wrench_.gravity.dot(cuts_.back().head<3>()));
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choice[i] == kLeftOut) continue;
    const std::vector<float>& gain = gain_[i].back();
    const double best = *std::max_element(gain.begin(), gain.end());
    most += IsDroppable(choices_[i].finger) ? std::max(0.0, best) : best;
  }
  return most < 0.0;
}

// Moves single contacts while that brings more of the wrench that is missing most.
bool HoldSearch::Improve(ContactChoice& choice) const {
  const double enough = kEnough * wrench_.f_max;
  const auto least = [](const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
  };
  bool moved = false;
  double score = least(CalcTotals(choice, kLeftOut));
  for (int move = 0; move < kMovesPerCut && score < enough; ++move) {
    std::size_t best_contact = choices_.size();
    int best_place = 0;
    double best_score = score, best_way = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < choices_.size(); ++i) {
      if (choice[i] == kLeftOut || choices_[i].places.size() < 2) continue;
      const std::vector<double> others = CalcTotals(choice, static_cast<int>(i));
      for (int place = 0; place < static_cast<int>(choices_[i].places.size()); ++place) {
        if (place == choice[i]) continue;
        double trial = enough;
        for (std::size_t k = 0; k < others.size() && trial >= best_score; ++k) {
          trial = std::min(trial, others[k] + gain_[i][k][place]);
        }
        const double way = choices_[i].moved[place];
        const bool better = trial > best_score || (trial == enough && way < best_way);
        if (!better || !HasRoom(world_.tips(), choices_, choice, static_cast<int>(i), place))
          continue;
        best_contact = i;
        best_place = place;
        best_score = trial;
        best_way = way;
      }
    }
    if (best_contact == choices_.size()) break;
    choice[best_contact] = best_place;
    score = best_score;
    moved = true;
  }
  return moved;
}

}  // namespace pregrasp
