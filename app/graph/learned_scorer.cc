#include "app/graph/learned_scorer.h"

#include <optional>

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
             std::optional<std::vector<RigidTransform>> X_WB)
      : owner_(owner), state_(std::move(state)), X_WB_(std::move(X_WB)) {}

  std::vector<double> Score(std::span<const Placement> placements) const override {
    std::vector<PlanningContacts> contacts;
    contacts.reserve(placements.size());
    for (const Placement& placement : placements) {
      contacts.push_back(
          MakePlanningContacts(placement, X_WB_ ? &*X_WB_ : nullptr, owner_.environment_));
    }
    const VectorX scores =
        owner_.score_.ScoreContacts(owner_.structure_, state_, contacts, owner_.pool_);
    return {scores.data(), scores.data() + scores.size()};
  }

  bool IsOccluded(Finger finger, const Placement::Contact& contact) const override {
    if (!X_WB_) return false;
    const double radius = FingertipRadius(finger);
    const Vector3 p_WTip = X_WB_->front() * Vector3(contact.p_OC + radius * contact.nhat_O);
    return owner_.environment_.Calc(p_WTip, *X_WB_).phi < radius;
  }

 private:
  const LearnedScorer& owner_;
  ObjectState state_;
  std::optional<std::vector<RigidTransform>> X_WB_;
};

LearnedScorer::LearnedScorer(const ScoreFunction& score, const Scene& scene, PointCloud cloud,
                             const EnvironmentDistance& environment, ThreadPool& pool)
    : score_(score),
      environment_(environment),
      pool_(pool),
      cloud_(std::move(cloud)),
      gravity_W_(scene.gravity),
      structure_(score.BuildStructure(cloud_.P, scene.object().X_WB.linear())) {
  for (const Body& body : scene.bodies) X_WB_start_.push_back(body.X_WB);
}

std::vector<double> LearnedScorer::Score(std::span<const ScoredState> states) const {
  const int count = static_cast<int>(states.size());
  std::vector<ObjectState> seen(count);
  std::vector<PlanningContacts> contacts(count);
  pool_.ParallelFor(count, [&](int i, int) {
    seen[i] = MakeObjectState(cloud_, states[i].X_WB, environment_, gravity_W_);
    contacts[i] = MakePlanningContacts(states[i].placement, &states[i].X_WB, environment_);
  });
  const VectorX scores = score_.ScoreStates(structure_, seen, contacts, pool_);
  return {scores.data(), scores.data() + scores.size()};
}

std::unique_ptr<PlacementScorer> LearnedScorer::At(const std::vector<RigidTransform>& X_WB) const {
  return std::make_unique<FixedState>(
      *this, MakeObjectState(cloud_, X_WB, environment_, gravity_W_), X_WB);
}

std::unique_ptr<PlacementScorer> LearnedScorer::Free() const {
  ObjectState state;
  state.up_O = -(X_WB_start_.front().linear().transpose() * gravity_W_).normalized();
  return std::make_unique<FixedState>(*this, std::move(state), std::nullopt);
}

}  // namespace pregrasp
