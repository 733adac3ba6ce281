#pragma once

#include <array>
#include <limits>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/dynamics/world.h"

namespace pregrasp {

/// When a rollout ends before its time. Every rule is a number, so that a batch needs no callbacks.
struct StopRules {
  double min_height = -std::numeric_limits<double>::infinity();  ///< the object's p_WB.z [m]
  double max_speed = std::numeric_limits<double>::infinity();    ///< of p_WB [m/s]
  double max_travel = std::numeric_limits<double>::infinity();   ///< of p_WB from the start [m]
  /// Ends once the object has been slower than this [m/s, and rad/s times 0.1 m] for
  /// `settled_steps` steps in a row; 0 steps: never.
  double settled_speed = 1e-3;
  int settled_steps = 0;
};

struct RolloutConfig {
  int steps = 240;         ///< of the world's dt, at least 0
  int steps_per_knot = 1;  ///< at least 1
  int record_every = 0;    ///< keeps the state after each so many steps; 0 keeps none
  StopRules stop;

  /// @throws InputError naming the field.
  void Validate() const;
};

/// What one rollout starts from and does.
struct RolloutInput {
  WorldState start;
  /// Targets by finger: knot i is reached at the end of step (i + 1) * steps_per_knot, on a
  /// straight line from the knot before, the first from the target in `start`; the last one stays.
  /// A finger without knots keeps its target, and one that is off in `start` stays off.
  std::array<std::vector<Vector3>, kNumFingers> p_WTargets;
};

struct RolloutResult {
  enum class Status {
    kFinished,   ///< all steps done
    kFell,       ///< below min_height
    kTooFast,    ///< above max_speed
    kTooFar,     ///< beyond max_travel
    kSettled,    ///< at rest
    kNotFinite,  ///< the state is no longer finite numbers
  };

  Status status = Status::kFinished;
  int steps = 0;  ///< done
  WorldState end;
  std::vector<WorldState> record;  ///< as asked for by record_every
  double max_speed = 0.0;          ///< of the object's p_WB [m/s]
  double max_force = 0.0;          ///< of any finger [N]
  int slipping_steps = 0;          ///< steps in which a finger was at its cone's limit
};

/// Simulates one rollout.
RolloutResult SimulateRollout(const World& world, const RolloutConfig& config,
                              const RolloutInput& input);

/// Simulates many, on all workers of the pool. Results are in the order of the inputs, and the same
/// bytes for any number of threads.
std::vector<RolloutResult> SimulateRollouts(const World& world, const RolloutConfig& config,
                                            const std::vector<RolloutInput>& inputs,
                                            ThreadPool* pool);

}  // namespace pregrasp
