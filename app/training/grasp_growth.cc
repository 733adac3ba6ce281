#include "app/training/grasp_growth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

bool SameFingers(const std::vector<GraspContact>& a, const std::vector<GraspContact>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& x, const auto& y) { return x.finger == y.finger; });
}

bool IsNew(const std::vector<GraspContact>& contacts, const std::vector<GrownGrasp>& known,
           double spacing) {
  return std::none_of(known.begin(), known.end(), [&](const GrownGrasp& grasp) {
    if (!SameFingers(grasp.contacts, contacts)) return false;
    double farthest = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      farthest = std::max(farthest, (contacts[i].p_OC - grasp.contacts[i].p_OC).norm());
    }
    return farthest < spacing;
  });
}

std::vector<GraspContact> Perturb(const GraspWorld& world, std::vector<GraspContact> contacts,
                                  double step, Rng& rng) {
  for (GraspContact& contact : contacts) {
    const Vector3 p_O = contact.p_OC + step * std::cbrt(rng.Uniform()) * rng.Direction();
    contact = world.ContactNear(contact.finger, p_O);
  }
  return contacts;
}

}  // namespace

GrowthConfig::GrowthConfig() {
  search.max_sets = 20'000;
  search.max_solves = 96;
  search.max_found = 6;
  search.grasp.kinematics.ik.max_starts = 3;
  search.grasp.kinematics.ik.warm_starts = 2;
}

GrowthResult GrowGrasps(const GraspWorld& world, const GrowthConfig& config,
                        const std::vector<RigidTransform>& X_WB, std::uint64_t seed,
                        ThreadPool& pool) {
  GrowthResult result;
  const GraspSearchResult seeds = SearchGrasps(world, config.search, {}, X_WB, seed, pool);
  result.search = seeds.stats;
  for (const GraspResult& grasp : seeds.found) {
    if (!IsNew(grasp.contacts, result.grasps, config.spacing)) continue;
    result.grasps.push_back({grasp.contacts, grasp.kinematics->ik.configuration(), true});
  }
  if (result.grasps.empty()) return result;
  Rng rng(seed, RngStream::kGrowthMoves);
  while (result.tests < config.max_tests &&
         static_cast<int>(result.grasps.size()) < config.max_grasps) {
    ThrowIfInterrupted();
    const GrownGrasp& parent =
        result.grasps[rng.UniformInt(static_cast<std::uint32_t>(result.grasps.size()))];
    const auto contacts = Perturb(world, parent.contacts, config.step, rng);
    ++result.tests;
    if (!IsNew(contacts, result.grasps, config.spacing)) continue;
    const Rng ik_rng(seed, RngStream::kGrownGraspIk, result.tests);
    const GraspResult test =
        TestContacts(world, config.search.grasp, contacts, X_WB, ik_rng, &parent.hand);
    if (!test.feasible()) continue;
    result.grasps.push_back({test.contacts, test.kinematics->ik.configuration(), false});
  }
  return result;
}

}  // namespace pregrasp
