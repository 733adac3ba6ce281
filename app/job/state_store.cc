#include "app/job/state_store.h"

#include <algorithm>
#include <utility>

namespace pregrasp {
namespace {

// What a planner builds and loads, measured with the shipped weights: 7.8 MB.
constexpr std::size_t kPlannerBytes = 8'000'000;
// A grasp beside its contacts: two tests with hand poses, forces and reasons.
constexpr std::size_t kGraspBytes = 4000;

template <typename T>
std::size_t BytesOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

std::size_t PartBytes(const std::vector<TraceRow>& trace) {
  std::size_t bytes = BytesOf(trace);
  for (const TraceRow& row : trace) {
    bytes += BytesOf(row.state.bodies) + BytesOf(row.state.cache) + BytesOf(row.contacts);
  }
  return bytes;
}
std::size_t PartBytes(const Planner& /*planner*/) { return kPlannerBytes; }
std::size_t PartBytes(const ContactGraph& graph) {
  const TriangleMesh& mesh = graph.mesh();
  constexpr std::size_t kOfANode = sizeof(ContactNode) + sizeof(std::vector<int>) + 3 * sizeof(int);
  return kOfANode * graph.nodes().size() + 2 * sizeof(int) * graph.num_edges() +
         sizeof(double) * mesh.V.size() + sizeof(int) * mesh.F.size();
}
std::size_t PartBytes(const MppiState& state) {
  std::size_t bytes = BytesOf(state.samples) + BytesOf(state.plans);
  for (const MppiSample& sample : state.samples) bytes += BytesOf(sample.action);
  for (const MppiPlan& plan : state.plans) bytes += BytesOf(plan.action);
  return bytes;
}
std::size_t PartBytes(const Certificate& certificate) { return PartBytes(certificate.trace); }
std::size_t PartBytes(const ReleaseResult& release) { return BytesOf(release.conditions); }
std::size_t PartBytes(const GraspSet& grasps) { return kGraspBytes * grasps.grasps.size(); }
std::size_t PartBytes(const LiftResult& lift) { return sizeof(lift) + PartBytes(lift.trace); }
std::size_t PartBytes(const std::vector<std::optional<LiftResult>>& lifts) {
  std::size_t bytes = BytesOf(lifts);
  for (const auto& lift : lifts) bytes += lift ? PartBytes(lift->trace) : 0;
  return bytes;
}
std::size_t PartBytes(const MotionState& state) {
  return BytesOf(state.keys) + BytesOf(state.frames);
}
std::size_t PartBytes(const Simulation& simulation) {
  return sizeof(std::shared_ptr<void>) * simulation.num_states();
}

template <typename Visit>
void VisitParts(const JobState& state, Visit&& visit) {
  visit(state.planner.get());
  visit(state.graph.get());
  visit(state.optimization.get());
  visit(state.certificate.get());
  visit(state.release.get());
  visit(state.grasps.get());
  visit(state.prepared_lifts.get());
  for (const auto& [grasp, lift] : state.lifts) visit(lift.get());
  visit(state.motion_state.get());
  visit(state.simulation.get());
}

}  // namespace

std::shared_ptr<const JobState> StateStore::Find(int number) {
  const auto kept = kept_.find(number);
  if (kept == kept_.end()) return nullptr;
  kept->second.used = ++uses_;
  return kept->second.state;
}

void StateStore::Keep(int number, std::shared_ptr<const JobState> state) {
  bytes_ += sizeof(JobState);
  VisitParts(*state, [&](const auto* part) {
    if (part == nullptr) return;
    Part& known = parts_[part];
    if (known.states++ > 0) return;
    known.bytes = PartBytes(*part);
    bytes_ += known.bytes;
  });
  kept_[number] = {std::move(state), ++uses_};
  while (kept_.size() > 2 && (kept_.size() > most_states_ || bytes_ > most_bytes_)) {
    Drop(std::min_element(std::next(kept_.begin()), kept_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    }));
  }
}

void StateStore::Drop(std::map<int, Kept>::iterator kept) {
  bytes_ -= sizeof(JobState);
  VisitParts(*kept->second.state, [&](const void* part) {
    if (part == nullptr) return;
    const auto known = parts_.find(part);
    if (--known->second.states > 0) return;
    bytes_ -= known->second.bytes;
    parts_.erase(known);
  });
  kept_.erase(kept);
}

}  // namespace pregrasp
