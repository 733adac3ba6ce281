// What the planner asks the grasp generator to complete, and what that makes of it.
#include <algorithm>
#include <numeric>

#include "app/core/interrupt.h"
#include "app/grasp/grasp_room.h"
#include "app/job/planner.h"
#include "app/trajectory/cost.h"

namespace pregrasp {
namespace {

// Indices into `worth`, the largest first, ties in order.
template <typename T>
std::vector<int> OrderDescending(const std::vector<T>& worth) {
  std::vector<int> order(worth.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return worth[a] > worth[b]; });
  return order;
}

}  // namespace

std::vector<Placement> Planner::FindConditions(const TriangleMesh& mesh,
                                               const std::vector<RigidTransform>& X_WB,
                                               const Placement& fixed,
                                               const std::vector<GraspContact>& pressing) const {
  const auto scorer = scorer_->At(X_WB, ScoreOutput::kLifted);
  const std::vector<Placement> likely =
      FindPlacements(mesh, *shape_, *scorer, fixed, config_.grasp_samples * config_.placement_pool,
                     config_.placements, Rng(seed_, RngStream::kReleasePlacements));
  std::vector<double> worth = scorer->Score(likely);
  pool_.ParallelFor(static_cast<int>(likely.size()), [&](int i, int) {
    ThrowIfInterrupted();
    worth[i] *= room_->CalcWith(X_WB, KeptContacts({X_WB, likely[i]}), pressing);
  });
  std::vector<int> order = OrderDescending(worth);
  order.resize(std::min<std::size_t>(order.size(), config_.grasp_samples * config_.pilots));
  std::vector<Placement> conditions;
  for (const int i : order) conditions.push_back(likely[i]);
  return conditions;
}

GraspRequest Planner::MakeRequest(const Placement& condition, int path_rank, int number) const {
  return {condition, Rng(seed_, RngStream::kGraspLatent, path_rank, number),
          Rng(seed_, RngStream::kGraspCompletion, path_rank, number)};
}

std::vector<Placement> Planner::ChooseConditions(const ContactPlaces& places,
                                                 const std::vector<Placement>& conditions,
                                                 const std::vector<GraspContact>& fixed,
                                                 const std::vector<HandConfiguration>& known,
                                                 int path_rank) const {
  constexpr int kPilots = 2;          // grasps generated for each condition
  constexpr int kFirstNumber = 1000;  // of their random numbers: above those of all samples
  CompletionConfig as_projected = config_.completion;
  as_projected.max_solves = as_projected.max_probes = 0;
  std::vector<GraspRequest> requests;
  for (const Placement& condition : conditions) {
    for (int i = 0; i < kPilots; ++i) {
      const int number = kFirstNumber + static_cast<int>(requests.size());
      requests.push_back(MakeRequest(condition, path_rank, number));
    }
  }
  const std::vector<CompletedGrasp> pilots =
      pregrasp::CompleteGrasps(places, as_projected, GenerateGrasps(places.X_WB(), requests), fixed,
                               pool_, known)
          .grasps;
  // By condition: how many of its pilots are feasible, and of how many the forces hold.
  std::vector<std::pair<int, int>> worth(conditions.size());
  for (std::size_t i = 0; i < pilots.size(); ++i) {
    worth[i / kPilots].first += pilots[i].raw.feasible() ? 1 : 0;
    worth[i / kPilots].second += pilots[i].raw.kinematics.has_value() ? 1 : 0;
  }
  const std::vector<int> order = OrderDescending(worth);
  std::vector<Placement> chosen;
  for (const int i : order) {
    const bool enough = 2 * std::ssize(chosen) >= config_.grasp_samples;
    const bool hopeless = worth[i].first == 0 && worth[order.front()].first > 0;
    if (!enough && !hopeless) chosen.push_back(conditions[i]);
  }
  return chosen;
}

std::vector<GeneratedGrasp> Planner::GenerateGrasps(
    const std::vector<RigidTransform>& X_WB, const std::vector<GraspRequest>& requests) const {
  const ObjectState seen = MakeObjectState(scorer_->cloud(), X_WB, *environment_, scene().gravity,
                                           scene().tips.radius(Finger::kIndex));
  const EncodedState encoded = generator_->Encode(*generator_structure_, seen);
  std::vector<GeneratedGrasp> grasps;
  for (const GraspRequest& request : requests) {
    ThrowIfInterrupted();
    const PlanningContacts condition =
        MakePlanningContacts(request.condition, &X_WB, *environment_);
    const std::vector<GraspPoints> draws = generator_->Sample(
        *generator_structure_, encoded, condition, config_.grasp_draws, request.latent);
    grasps.push_back({draws.front(), request.completion, {draws.begin() + 1, draws.end()}});
  }
  return grasps;
}

}  // namespace pregrasp
