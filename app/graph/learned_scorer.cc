#include "app/graph/learned_scorer.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>

#include "app/core/check.h"

namespace pregrasp {

ObjectState MakeObjectState(const PointCloud& cloud, const std::vector<RigidTransform>& X_WB,
                            const EnvironmentDistance& environment, const Vector3& gravity_W,
                            double radius) {
  const RigidTransform& X_WO = X_WB.front();
  ObjectState state;
  state.phi.resize(cloud.P.rows());
  state.occluded.resize(cloud.P.rows());
  for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
    const Vector3 p_WP = X_WO * Vector3(cloud.P.row(i));
    const double phi = environment.Calc(p_WP, X_WB).phi;
    state.phi[i] = phi;
    // A distance changes by at most the way gone, so that only a band needs a second look.
    bool occluded = phi < 0.0;
    if (!occluded && phi < 2.0 * radius) {
      const Vector3 nhat_W = X_WO.linear() * Vector3(cloud.N.row(i));
      occluded = environment.Calc(p_WP + radius * nhat_W, X_WB).phi < radius;
    }
    state.occluded[i] = occluded;
  }
  state.up_O = -(X_WO.linear().transpose() * gravity_W).normalized();
  return state;
}

PlanningContacts MakePlanningContacts(const Placement& placement,
                                      const std::vector<RigidTransform>* X_WB,
                                      const EnvironmentDistance& environment) {
  PlanningContacts contacts;
  for (int j = 0; j < kNumPlanningFingers; ++j) {
    const Placement::Contact& finger = placement.fingers[j];
    if (!finger.on) continue;
    contacts[j] = PlanningContact{finger.p_OC, finger.nhat_O};
    if (X_WB) contacts[j]->phi = environment.Calc(X_WB->front() * finger.p_OC, *X_WB).phi;
  }
  return contacts;
}

// Placements on the object in one state.
class LearnedScorer::FixedState : public PlacementScorer {
 public:
  // Without poses there are no surroundings.
  FixedState(const LearnedScorer& owner, ObjectState state,
             std::optional<std::vector<RigidTransform>> X_WB, ScoreOutput output)
      : owner_(owner), state_(std::move(state)), X_WB_(std::move(X_WB)), output_(output) {}

  std::vector<double> Score(std::span<const Placement> placements) const override {
    std::vector<PlanningContacts> contacts;
    contacts.reserve(placements.size());
    for (const Placement& placement : placements) {
      contacts.push_back(
          MakePlanningContacts(placement, X_WB_ ? &*X_WB_ : nullptr, owner_.environment_));
    }
    const VectorX scores =
        owner_.score_.ScoreContacts(owner_.structure_, state_, contacts, output_, owner_.pool_);
    return {scores.data(), scores.data() + scores.size()};
  }

  TipSpheres tips() const override { return owner_.tips_; }

  bool IsOccluded(Finger finger, const Placement::Contact& contact) const override {
    return X_WB_ && owner_.IsOccluded(finger, contact, *X_WB_);
  }

 private:
  const LearnedScorer& owner_;
  ObjectState state_;
  std::optional<std::vector<RigidTransform>> X_WB_;
  ScoreOutput output_;
};

LearnedScorer::LearnedScorer(const ScoreFunction& score, const Scene& scene, PointCloud cloud,
                             const EnvironmentDistance& environment, ThreadPool& pool)
    : score_(score),
      environment_(environment),
      pool_(pool),
      cloud_(std::move(cloud)),
      gravity_W_(scene.gravity),
      tips_(scene.tips),
      structure_(score.BuildStructure(cloud_.P, scene.object().X_WB.linear())) {
  for (const Body& body : scene.bodies) X_WB_start_.push_back(body.X_WB);
}

std::vector<double> LearnedScorer::Score(std::span<const ScoredState> states) const {
  const int count = static_cast<int>(states.size());
  std::vector<ObjectState> seen(count);
  std::vector<PlanningContacts> contacts(count);
  pool_.ParallelFor(count, [&](int i, int) {
    seen[i] = MakeObjectState(cloud_, states[i].X_WB, environment_, gravity_W_,
                              tips_.radius(Finger::kIndex));
    contacts[i] = MakePlanningContacts(states[i].placement, &states[i].X_WB, environment_);
  });
  const VectorX scores = score_.ScoreStates(structure_, seen, contacts, pool_);
  return {scores.data(), scores.data() + scores.size()};
}

bool LearnedScorer::IsOccluded(Finger finger, const Placement::Contact& contact,
                               const std::vector<RigidTransform>& X_WB) const {
  const double radius = tips_.radius(finger);
  const Vector3 p_WTip = X_WB.front() * Vector3(contact.p_OC + radius * contact.nhat_O);
  return environment_.Calc(p_WTip, X_WB).phi < radius;
}

std::vector<double> LearnedScorer::ScoreGraspable(std::span<const ScoredState> states) const {
  PREGRASP_CHECK(!probes_.empty());
  std::vector<double> scores(states.size());
  pool_.ParallelFor(static_cast<int>(states.size()),
                    [&](int i, int) { scores[i] = ScoreBestProbes(states[i]); });
  return scores;
}

double LearnedScorer::ScoreBestProbes(const ScoredState& state) const {
  std::vector<PlanningContacts> contacts;
  for (Placement probe : probes_) {
    bool free = true;
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const Placement::Contact& own = state.placement.fingers[f];
      if (own.on) probe.fingers[f] = own;
      free = free && (own.on || !probe.fingers[f].on ||
                      !IsOccluded(static_cast<Finger>(f), probe.fingers[f], state.X_WB));
    }
    if (free) contacts.push_back(MakePlanningContacts(probe, &state.X_WB, environment_));
  }
  if (contacts.empty()) return 0.0;
  const VectorX all = score_.ScoreContacts(
      structure_,
      MakeObjectState(cloud_, state.X_WB, environment_, gravity_W_, tips_.radius(Finger::kIndex)),
      contacts, ScoreOutput::kProgress);
  std::vector<double> best(all.data(), all.data() + all.size());
  const auto count = std::min<std::ptrdiff_t>(kBestProbes, std::ssize(best));
  std::partial_sort(best.begin(), best.begin() + count, best.end(), std::greater<>());
  return std::accumulate(best.begin(), best.begin() + count, 0.0) / kBestProbes;
}

std::unique_ptr<PlacementScorer> LearnedScorer::At(const std::vector<RigidTransform>& X_WB,
                                                   ScoreOutput output) const {
  return std::make_unique<FixedState>(
      *this, MakeObjectState(cloud_, X_WB, environment_, gravity_W_, tips_.radius(Finger::kIndex)),
      X_WB, output);
}

std::unique_ptr<PlacementScorer> LearnedScorer::Free() const {
  ObjectState state;
  state.up_O = -(X_WB_start_.front().linear().transpose() * gravity_W_).normalized();
  return std::make_unique<FixedState>(*this, std::move(state), std::nullopt,
                                      ScoreOutput::kProgress);
}

}  // namespace pregrasp
