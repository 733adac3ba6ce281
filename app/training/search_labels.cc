#include "app/training/search_labels.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "app/core/interrupt.h"
#include "app/core/thread_pool.h"
#include "app/grasp/grasp_stiffness.h"
#include "app/training/labels.h"
#include "app/training/training_scene.h"

namespace pregrasp {
namespace {

constexpr double kSpacing = 0.005;  // two grasps differ by this in some contact [m]
constexpr double kPairSpan = 0.13;  // between the contacts of a pair (findings: a hand's span) [m]
constexpr double kSameSide = 0.5;   // of the normals' cosine: a contact fits a donor's
constexpr int kTries = 8;

using Contacts = std::vector<GraspContact>;

struct Donor {
  Contacts contacts;
  HandConfiguration hand;
};

bool IsNewGrasp(const Contacts& contacts, const std::vector<Contacts>& known) {
  return std::none_of(known.begin(), known.end(), [&](const Contacts& other) {
    if (other.size() != contacts.size()) return false;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (other[i].finger != contacts[i].finger ||
          (other[i].p_OC - contacts[i].p_OC).norm() >= kSpacing) {
        return false;
      }
    }
    return true;
  });
}

class StateLabeler {
 public:
  StateLabeler(const World* world, const GraspWorld& grasp_world, const GraspRoom& room,
               const PointCloud& cloud, const ReachedState& state, const SearchLabelConfig& config,
               std::uint64_t seed)
      : world_(world),
        grasp_world_(grasp_world),
        room_(room),
        state_(state),
        config_(config),
        seed_(seed),
        X_WB_(world ? world->GetPoses(state.state) : grasp_world.StartPoses()) {
    Scene scene = grasp_world.scene();
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) scene.bodies[b].X_WB = X_WB_[b];
    for (int r = 0; r < kNumReliefs; ++r) {
      X_WB_at_[r] = MoveSurroundingsAway(scene, cloud.P, kReliefs[r]);
      places_[r] = std::make_unique<ContactPlaces>(grasp_world, X_WB_at_[r]);
    }
    way_ = FindLiftWay(X_WB_, cloud, grasp_world.environment(),
                       -grasp_world.scene().gravity.normalized(), config.lift.way);
    Search();
  }

  SearchLabels Label() {
    Rng rng(seed_, RngStream::kItemLabel);
    if (state_.fixed.empty()) {
      for (int i = 0; i < config_.thumbs; ++i) LabelDrawn({Finger::kThumb}, rng);
      for (int i = 0; i < config_.indices; ++i) LabelDrawn({Finger::kIndex}, rng);
      for (int i = 0; i < config_.pairs; ++i) LabelDrawn({Finger::kThumb, Finger::kIndex}, rng);
    } else {
      LabelContacts(state_.fixed);
      for (int i = 0; i < config_.held_pairs && state_.fixed.size() == 1; ++i) {
        const bool thumb = state_.fixed.front().finger == Finger::kThumb;
        LabelDrawn({thumb ? Finger::kIndex : Finger::kThumb}, rng);
      }
    }
    return std::move(labels_);
  }

  std::vector<TruthRecord> LabelAgain(const std::vector<TruthRecord>& truths) {
    for (const TruthRecord& truth : truths) {
      Contacts contacts;
      for (int f = 0; f < kNumPlanningFingers; ++f) {
        const auto finger = static_cast<Finger>(f);
        if (const GraspContact* fixed = FindContact(state_.fixed, finger)) {
          contacts.push_back(*fixed);
        } else if (const auto& given = truth.contacts[f]) {
          contacts.push_back({finger, given->p_OC, given->nhat_O});
        }
      }
      LabelContacts(contacts);
    }
    return std::move(labels_.truths);
  }

 private:
  void Search() {
    ThreadPool alone(1);
    std::vector<Donor> all;
    for (int r = 0; r < kNumReliefs; ++r) {
      ThrowIfInterrupted();
      if (r > 0 && world_ == nullptr) break;  // nothing to move away
      const GraspSearchResult result =
          SearchGrasps(*places_[r], config_.search, state_.fixed,
                       Rng(seed_, RngStream::kItemLabel, 1, r).NextU64(), alone);
      labels_.stats.found[r] = static_cast<int>(result.found.size());
      for (const GraspResult& grasp : result.found) {
        all.push_back({grasp.contacts, grasp.kinematics->ik.configuration()});
        if (r == 0) KeepIfLifted(grasp.contacts);
      }
      donors_[r] = all;  // with more room, those of less are grasps too
    }
  }

  // A surface point for a finger of a label: near a found set's, anywhere, or where the tip can be.
  std::optional<GraspContact> DrawContact(Finger finger, const Donor* donor, Rng& rng) const {
    const double source = rng.Uniform();
    if (donor != nullptr) {
      const GraspContact* near = FindContact(donor->contacts, finger);
      if (near == nullptr) return std::nullopt;
      return grasp_world_.ContactNear(
          finger, near->p_OC + config_.moved * std::cbrt(rng.Uniform()) * rng.Direction());
    }
    if (source < config_.anywhere) {
      const MatrixX3& P = grasp_world_.surface().P;
      return grasp_world_.ContactNear(finger, P.row(rng.UniformInt(P.rows())));
    }
    const int place = places_[0]->DrawAny(finger, rng);
    if (place == ContactPlaces::kNone) return std::nullopt;
    return places_[0]->At(finger, place);
  }

  void LabelDrawn(const std::vector<Finger>& fingers, Rng& rng) {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const Donor* donor = nullptr;
      if (rng.Uniform() < config_.near_found) {
        // Of the least relief that has any, or of any.
        int r = 0;
        while (r + 1 < kNumReliefs && (donors_[r].empty() || rng.Uniform() < 0.3)) ++r;
        if (!donors_[r].empty()) donor = &donors_[r][rng.UniformInt(donors_[r].size())];
      }
      Contacts contacts = state_.fixed;
      for (const Finger finger : fingers) {
        const auto contact = DrawContact(finger, donor, rng);
        if (contact) contacts.push_back(*contact);
      }
      if (contacts.size() != state_.fixed.size() + fingers.size()) continue;
      std::sort(contacts.begin(), contacts.end(),
                [](const auto& a, const auto& b) { return a.finger < b.finger; });
      if (contacts.size() == 2) {
        const double span = (contacts[0].p_OC - contacts[1].p_OC).norm();
        if (span > kPairSpan || CalcTipGap(grasp_world_.tips(), contacts[0], contacts[1]) < 0.0)
          continue;
      }
      LabelContacts(contacts);
      return;
    }
  }

  void LabelContacts(const Contacts& contacts) {
    ThrowIfInterrupted();
    TruthRecord truth;
    for (const GraspContact& contact : contacts) {
      truth.contacts[static_cast<int>(contact.finger)] = PlanningContact{
          contact.p_OC, contact.nhat_O, CalcContactDistance(grasp_world_, contact.p_OC, X_WB_)};
    }
    const int least = FindLeastRelief(contacts);
    truth.relief = static_cast<double>(kNumReliefs - least) / kNumReliefs;
    truth.room = room_.CalcWith(X_WB_, contacts, state_.fixed);
    truth.lifted = least == 0 && way_.is_free() && FindLifted(contacts);
    labels_.truths.push_back(truth);
  }

  // The contacts of `given` that are new in the state.
  bool IsFixed(Finger finger) const { return FindContact(state_.fixed, finger) != nullptr; }

  // Found sets by the distance of their contacts from those of `given`, the nearest first.
  std::vector<const Donor*> FindDonors(const Contacts& given, int relief) const {
    std::vector<std::pair<double, int>> near;
    for (std::size_t i = 0; i < donors_[relief].size(); ++i) {
      double distance = 0.0;
      bool fits = true;
      for (const GraspContact& contact : given) {
        const GraspContact* own = FindContact(donors_[relief][i].contacts, contact.finger);
        fits = fits && own != nullptr && own->nhat_O.dot(contact.nhat_O) > kSameSide;
        if (fits) distance += (own->p_OC - contact.p_OC).norm();
      }
      if (fits) near.emplace_back(distance, static_cast<int>(i));
    }
    std::sort(near.begin(), near.end());
    std::vector<const Donor*> donors;
    for (int i = 0; i < std::min<int>(config_.donors, std::ssize(near)); ++i) {
      donors.push_back(&donors_[relief][near[i].second]);
    }
    return donors;
  }

  // The donor's set with `given` in place of its fingers' contacts, the others moved along.
  std::optional<Contacts> PutInto(const Donor& donor, const Contacts& given, int relief) const {
    Vector3 shift = Vector3::Zero();
    int moved = 0;
    for (const GraspContact& contact : given) {
      if (IsFixed(contact.finger)) continue;
      shift += contact.p_OC - FindContact(donor.contacts, contact.finger)->p_OC;
      ++moved;
    }
    if (moved > 0) shift /= moved;
    Contacts contacts;
    for (const GraspContact& own : donor.contacts) {
      if (const GraspContact* contact = FindContact(given, own.finger)) {
        contacts.push_back(*contact);
        continue;
      }
      const auto place = places_[relief]->Project(own.finger, own.p_OC + shift);
      if (!place) return std::nullopt;
      contacts.push_back(*place);
    }
    return contacts;
  }

  bool HasPlaces(const Contacts& given, int relief) const {
    return std::all_of(given.begin(), given.end(), [&](const GraspContact& contact) {
      return IsFixed(contact.finger) || places_[relief]->Allows(contact);
    });
  }

  // kNumReliefs where there is none.
  int FindLeastRelief(const Contacts& given) const {
    const Matrix3 R_WO = X_WB_.front().linear();
    for (int r = 0; r < kNumReliefs; ++r) {
      if (donors_[r].empty() || !HasPlaces(given, r)) continue;
      for (const Donor* donor : FindDonors(given, r)) {
        const auto contacts = PutInto(*donor, given, r);
        if (contacts && CalcForceStatus(grasp_world_, config_.test, *contacts, R_WO) ==
                            GraspStatus::kFeasible) {
          return r;
        }
      }
    }
    return kNumReliefs;
  }

  bool FindLifted(const Contacts& given) {
    for (const Donor* donor : FindDonors(given, 0)) {
      const auto contacts = PutInto(*donor, given, 0);
      if (!contacts) continue;
      ++labels_.stats.tests;
      const Rng rng(seed_, RngStream::kItemLabel, 2, labels_.stats.tests);
      const GraspAttempt attempt =
          TryContacts(grasp_world_, config_.test, *contacts, X_WB_, rng, &donor->hand);
      if (attempt.feasible() && KeepIfLifted(attempt.contacts)) return true;
    }
    return false;
  }

  // Whether the hand picks the object up; if so, a grasp to learn from.
  bool KeepIfLifted(const Contacts& grasp) {
    if (!way_.is_free()) return false;
    const Contacts contacts = world_ ? MoveToPressing(state_.state, grasp) : grasp;
    const WrenchConfig wrench =
        grasp_world_.MakeWrenchConfig(config_.test.f_min, X_WB_.front().linear());
    const double k = grasp_world_.scene().fingertips.grasp_stiffness;
    const auto forces =
        ChooseGraspForces(grasp_world_.ToWrenchContacts(contacts), wrench, k, config_.lift.forces);
    if (!forces || !forces->is_stiff) return false;
    if (world_) {  // with nothing to rest on it would fall before the fingers close
      ++labels_.stats.lifts;
      const LiftOutcome outcome =
          SimulateLift(*world_, grasp_world_.environment(), state_.state,
                       {contacts, forces->forces, k}, way_, config_.lift, Stepper::kKernel, false);
      if (!JudgeLift(outcome).empty()) return false;
      ++labels_.stats.lifted;
    }
    if (IsNewGrasp(grasp, lifted_)) {
      lifted_.push_back(grasp);
      labels_.grasps.push_back(ToRecord(grasp));
    }
    return true;
  }

  GraspRecord ToRecord(const Contacts& contacts) const {
    GraspRecord record;
    record.p_OC.fill(Vector3::Zero());
    record.nhat_O.fill(Vector3::Zero());
    for (const GraspContact& contact : contacts) {
      const int f = static_cast<int>(contact.finger);
      record.used[f] = true;
      record.p_OC[f] = contact.p_OC;
      record.nhat_O[f] = contact.nhat_O;
      record.phi[f] = CalcContactDistance(grasp_world_, contact.p_OC, X_WB_);
    }
    return record;
  }

  const World* world_;
  const GraspWorld& grasp_world_;
  const GraspRoom& room_;
  const ReachedState& state_;
  const SearchLabelConfig& config_;
  std::uint64_t seed_;
  std::vector<RigidTransform> X_WB_;
  // By relief.
  std::array<std::vector<RigidTransform>, kNumReliefs> X_WB_at_;
  std::array<std::unique_ptr<ContactPlaces>, kNumReliefs> places_;
  std::array<std::vector<Donor>, kNumReliefs> donors_;
  LiftWay way_;
  std::vector<Contacts> lifted_;
  SearchLabels labels_;
};

}  // namespace

SearchLabelConfig::SearchLabelConfig() {
  search.max_sets = 8192;
  search.max_solves = 64;
  search.max_found = 10;
  search.grasp.kinematics.ik.max_starts = 3;
  test.kinematics.ik.max_starts = 2;
  test.kinematics.ik.slsqp = false;
}

SearchLabels LabelState(const World* world, const GraspWorld& grasp_world, const GraspRoom& room,
                        const PointCloud& cloud, const ReachedState& state,
                        const SearchLabelConfig& config, std::uint64_t seed) {
  return StateLabeler(world, grasp_world, room, cloud, state, config, seed).Label();
}

std::vector<TruthRecord> LabelAgain(const World* world, const GraspWorld& grasp_world,
                                    const GraspRoom& room, const PointCloud& cloud,
                                    const ReachedState& state, const SearchLabelConfig& config,
                                    const std::vector<TruthRecord>& truths, std::uint64_t seed) {
  return StateLabeler(world, grasp_world, room, cloud, state, config, seed).LabelAgain(truths);
}

}  // namespace pregrasp
