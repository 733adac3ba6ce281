#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/grasp/contact_sampler.h"
#include "app/grasp/feasible_grasp.h"

namespace pregrasp {

struct GraspSearchConfig {
  /// With 4 restarts of inverse kinematics, not 20: where contact sets abound, the next set is
  /// worth more than another restart.
  GraspConfig grasp;
  SamplerConfig sampler;
  int max_sets = 100000;  ///< contact sets drawn, about 5 us each; 0 does not search
  /// Stop after the batch in which so many sets within reach were put to the forces.
  int max_plausible = std::numeric_limits<int>::max();
  int max_solves =
      1000;  ///< of those, sets that may go on to inverse kinematics: milliseconds each
  /// Stop when so many grasps are found; what is found in the same group of 16 sets comes along.
  int max_found = 1;

  GraspSearchConfig() { grasp.kinematics.ik.max_starts = 4; }
  void Validate() const;
};

/// Bounds for a second source beside generated grasps: a few grasps in about 0.3 s, or none.
GraspSearchConfig MakeSecondSourceConfig();

/// How far the drawn sets came.
struct GraspSearchStats {
  int drawn = 0;  ///< attempts to draw a set
  int plausible =
      0;  ///< sets drawn: where tips can be, no nearer and farther than a hand brings them
  int on_edges = 0;  ///< of those, sets with a contact on an edge or corner
  int held = 0;      ///< of the plausible ones, with forces as a grasp needs them
  int solved = 0;    ///< of those, put to inverse kinematics before the search stopped
  int reached = 0;   ///< of those, within the hand's reach, collisions aside
  int feasible = 0;  ///< of those, feasible grasps
  /// Sets put to the whole test: plausible ones that failed at the forces, and those solved.
  int tried = 0;
};

struct GraspSearchResult {
  std::vector<GraspResult> found;  ///< feasible ones, in the order drawn
  GraspSearchStats stats;
};

/// Looks for feasible grasps by drawing contact sets: reach of the tips, then forces, then
/// kinematics without collision, then the full test. The same result for any number of threads.
/// @param places    where fingertips can be with the bodies where they are.
/// @param fixed     contacts that every set must hold: fingers that already press.
/// @param seed      keys every draw.
/// @param progress  called between batches with what is done so far; may be empty.
GraspSearchResult SearchGrasps(const ContactPlaces& places, const GraspSearchConfig& config,
                               const std::vector<GraspContact>& fixed, std::uint64_t seed,
                               ThreadPool& pool,
                               const std::function<void(const GraspSearchStats&)>& progress = {});

/// The same with the bodies at X_WB, the object first.
GraspSearchResult SearchGrasps(const GraspWorld& world, const GraspSearchConfig& config,
                               const std::vector<GraspContact>& fixed,
                               const std::vector<RigidTransform>& X_WB, std::uint64_t seed,
                               ThreadPool& pool,
                               const std::function<void(const GraspSearchStats&)>& progress = {});

}  // namespace pregrasp
