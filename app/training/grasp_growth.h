#pragma once

#include <cstdint>
#include <vector>

#include "app/grasp/grasp_search.h"

namespace pregrasp {

/// How feasible grasps are gathered in one scene: seeds by search, then a tree of small changes,
/// each tested (the paper's perturbation and retest, its seeds by hand).
struct GrowthConfig {
  GraspSearchConfig search;  ///< for seeds; max_found of them
  int max_tests = 100;       ///< perturbed grasps put to the test
  int max_grasps = 30;       ///< stop when so many are gathered
  double step = 0.012;       ///< a contact moves along the surface by up to this [m]
  double spacing = 0.005;  ///< two grasps with the same fingers differ by this in some contact [m]

  /// Fewer restarts of inverse kinematics than for verdicts: missing a grasp costs little here.
  GrowthConfig();
};

struct GrownGrasp {
  std::vector<GraspContact> contacts;
  HandConfiguration hand;
  bool seed = false;  ///< found by search
};

struct GrowthResult {
  std::vector<GrownGrasp> grasps;
  int tests = 0;  ///< perturbed grasps that were tested
  GraspSearchStats search;
};

/// Feasible grasps of the object with every body at X_WB. The same for any number of threads.
GrowthResult GrowGrasps(const GraspWorld& world, const GrowthConfig& config,
                        const std::vector<RigidTransform>& X_WB, std::uint64_t seed,
                        ThreadPool& pool);

}  // namespace pregrasp
