#include "app/training/labels.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/core/interrupt.h"
#include "app/graph/learned_scorer.h"
#include "app/training/training_scene.h"

namespace pregrasp {
namespace {

constexpr double kMoved = 0.005;  // contacts taken from a grasp [m]

bool Wanted(int which, int finger) { return which == 2 || which == finger; }

PlanningContact ContactAt(const GraspWorld& world, const Vector3& p_OC, const Vector3& nhat_O,
                          const std::vector<RigidTransform>& X_WB) {
  return {p_OC, nhat_O, CalcContactDistance(world, p_OC, X_WB)};
}

std::optional<PlanningContacts> FromGrasp(const GraspWorld& world,
                                          const std::vector<const GraspRecord*>& grasps, int which,
                                          const std::vector<RigidTransform>& X_WB, Rng& rng) {
  const GraspRecord& grasp = *grasps[rng.UniformInt(static_cast<std::uint32_t>(grasps.size()))];
  PlanningContacts contacts;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (!Wanted(which, f)) continue;
    if (!grasp.used[f]) return std::nullopt;
    const Vector3 near = grasp.p_OC[f] + kMoved * std::cbrt(rng.Uniform()) * rng.Direction();
    const FacePoint face = world.object().ProjectToFace(near);
    contacts[f] = ContactAt(world, face.p_B, face.nhat_B, X_WB);
  }
  return contacts;
}

PlanningContacts FromAnywhere(const GraspWorld& world, int which,
                              const std::vector<RigidTransform>& X_WB, Rng& rng) {
  PlanningContacts contacts;
  const SurfacePoints& surface = world.surface();
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (!Wanted(which, f)) continue;
    const auto i = rng.UniformInt(static_cast<std::uint32_t>(surface.P.rows()));
    contacts[f] = ContactAt(world, surface.P.row(i), surface.N.row(i), X_WB);
  }
  return contacts;
}

std::optional<PlanningContacts> FromSampler(const GraspWorld& world, const ContactSampler& sampler,
                                            int which, const std::vector<RigidTransform>& X_WB,
                                            Rng& rng) {
  constexpr int kDraws = 50;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto set = sampler.Sample({}, rng);
    if (!set) continue;
    PlanningContacts contacts;
    for (const GraspContact& contact : *set) {
      const int f = static_cast<int>(contact.finger);
      if (f < kNumPlanningFingers && Wanted(which, f)) {
        contacts[f] = ContactAt(world, contact.p_OC, contact.nhat_O, X_WB);
      }
    }
    return contacts;
  }
  return std::nullopt;
}

}  // namespace

LabelConfig::LabelConfig() {
  completion.max_probes = 0;
  completion.max_stiffness_tests = 0;
  completion.max_solves = 2;
  completion.grasp.kinematics.ik.max_starts = 3;
  completion.grasp.kinematics.ik.slsqp = false;
}

double CalcContactDistance(const GraspWorld& world, const Vector3& p_OC,
                           const std::vector<RigidTransform>& X_WB) {
  return world.environment().Calc(X_WB.front() * p_OC, X_WB).phi;
}

PlanningContacts SampleLabelContacts(const GraspWorld& world, const ContactSampler& sampler,
                                     const std::vector<const GraspRecord*>& grasps, int which,
                                     const LabelConfig& config,
                                     const std::vector<RigidTransform>& X_WB, Rng& rng) {
  const double source = rng.Uniform();
  if (source < config.from_grasps && !grasps.empty()) {
    if (const auto contacts = FromGrasp(world, grasps, which, X_WB, rng)) return *contacts;
  }
  if (source < 1.0 - config.anywhere) {
    if (const auto contacts = FromSampler(world, sampler, which, X_WB, rng)) return *contacts;
  }
  return FromAnywhere(world, which, X_WB, rng);
}

LabelRecord CalcLabel(const GraspWorld& world, const GraspGenerator& generator,
                      const PointCloud& cloud, const CloudStructure& structure,
                      const PlanningContacts& contacts, const LabelConfig& config, const Rng& rng,
                      std::optional<LabelExample>* example) {
  LabelRecord label;
  label.contacts = contacts;
  label.tries = config.tries;
  std::vector<GraspContact> fixed;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (contacts[f]) {
      fixed.push_back({static_cast<Finger>(f), contacts[f]->p_OC, contacts[f]->nhat_O});
    }
  }
  const bool free = world.scene().bodies.size() == 1;
  Rng key = rng;
  for (int r = kNumReliefs - 1; r >= 0; --r) {
    ThrowIfInterrupted();
    const std::uint64_t seed = key.NextU64();
    if (!free && r + 2 < kNumReliefs && label.feasible[r + 1] == 0 && label.feasible[r + 2] == 0) {
      break;
    }
    const auto X_WB = MoveSurroundingsAway(world.scene(), cloud.P, kReliefs[r]);
    PlanningContacts seen = contacts;
    for (auto& contact : seen) {
      if (contact) contact->phi = CalcContactDistance(world, contact->p_OC, X_WB);
    }
    const EncodedState encoded = generator.Encode(
        structure, MakeObjectState(cloud, X_WB, world.environment(), world.scene().gravity,
                                   world.tips().radius(Finger::kIndex)));
    const auto grasps = generator.Sample(structure, encoded, seen, config.tries,
                                         Rng(seed, RngStream::kLabelLatent));
    const ContactPlaces places(world, X_WB);
    for (int i = 0; i < config.tries; ++i) {
      const Rng sample_rng(seed, RngStream::kLabelCompletion, i);
      const CompletedGrasp grasp =
          CompleteGrasp(places, config.completion, {grasps[i], sample_rng}, fixed);
      if (!grasp.feasible()) continue;
      ++label.feasible[r];
      if (example != nullptr) {
        *example = LabelExample{kReliefs[r], grasp.result.contacts,
                                grasp.result.kinematics->ik.configuration()};
      }
    }
  }
  return label;
}

}  // namespace pregrasp
