#pragma once

#include <array>
#include <vector>

#include "app/trajectory/certify.h"

namespace pregrasp {

/// The worlds in which a certified plan is simulated again, one change each.
enum class RobustChange {
  kLessFriction,   ///< between bodies, x 0.75
  kMoreFriction,   ///< between bodies, x 1.25
  kLighter,        ///< the object's mass and inertia, x 0.7
  kHeavier,        ///< x 1.3
  kSpreadSupport,  ///< contacts resist turning like even pressure (StepConfig::spread_support)
};
inline constexpr int kNumRobustChanges = 5;
/// "friction x 0.75", ..: for logs, scripts and people.
const char* RobustChangeName(RobustChange change);

/// The scene with one change; the same scene where the change is one of the dynamics.
Scene ChangeScene(const Scene& scene, RobustChange change);

/// What a plan did in one of the worlds.
struct RobustOutcome {
  RobustChange change = RobustChange::kLessFriction;
  bool held = false;      ///< its end holds, and lies within 2 cm and 10 degrees of the nominal one
  double shift = 0.0;     ///< of the object's end from the nominal one [m]
  double turn_deg = 0.0;  ///< [degrees]
};

/// The design's "robust". Every number is finite.
struct RobustResult {
  std::vector<RobustOutcome> outcomes;  ///< one a world
  int held = 0;
  double worst_shift = 0.0;     ///< [m]
  double worst_turn_deg = 0.0;  ///< [degrees]
};

/// From the nominal end (design, section 4).
inline constexpr double kRobustShift = 0.02;  // [m]
inline constexpr double kRobustTurnDeg = 10.0;

/// The worlds, beside its own, in which a path's plans are tried while they are optimised (design,
/// section 5): light and slippery, heavy and sticky, each by both factors of RobustChange.
std::vector<World> MakeExtremeWorlds(const Scene& scene, const StepConfig& config);

/// The changed worlds of one scene, built once. Immutable, safe to share between threads.
class RobustWorlds {
 public:
  /// @param config  of the nominal world.
  RobustWorlds(const Scene& scene, const StepConfig& config);

  /// Simulates the world plan of a certificate in every world, through the kernel.
  /// @param start  of the plan, the nominal world's.
  RobustResult Test(const EnvironmentDistance& environment, const WorldState& start,
                    const WorldPlan& plan, PlanTiming timing, const CertifyConfig& config,
                    const WorldState& nominal_end) const;

 private:
  std::vector<World> worlds_;  // by RobustChange
};

}  // namespace pregrasp
