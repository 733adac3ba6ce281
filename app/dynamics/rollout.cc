#include "app/dynamics/rollout.h"

#include <algorithm>
#include <string>

#include "app/core/error.h"

namespace pregrasp {
namespace {

using Status = RolloutResult::Status;

// A turning speed counts like the speed of a point this far away [m].
constexpr double kSettledArm = 0.1;

// The target after `step` steps.
Vector3 CalcTarget(const Vector3& start, const std::vector<Vector3>& knots, int steps_per_knot,
                   int step) {
  const int segment = (step - 1) / steps_per_knot;
  if (segment >= static_cast<int>(knots.size())) return knots.back();
  const Vector3& from = segment == 0 ? start : knots[segment - 1];
  const double share = static_cast<double>(step - segment * steps_per_knot) / steps_per_knot;
  return share == 1.0 ? knots[segment] : Vector3(from + share * (knots[segment] - from));
}

Status CheckStop(const StopRules& stop, const Vector3& p_start, const BodyState& object) {
  if (!object.p_WB.allFinite() || !object.q_WB.coeffs().allFinite() || !object.v_WB.allFinite() ||
      !object.w_WB.allFinite()) {
    return Status::kNotFinite;
  }
  if (object.p_WB.z() < stop.min_height) return Status::kFell;
  if (object.v_WB.norm() > stop.max_speed) return Status::kTooFast;
  if ((object.p_WB - p_start).norm() > stop.max_travel) return Status::kTooFar;
  return Status::kFinished;
}

bool IsSlow(const BodyState& object, double speed) {
  return object.v_WB.norm() < speed && kSettledArm * object.w_WB.norm() < speed;
}

void RequireAtLeast(const char* field, int value, int low) {
  if (value < low) {
    throw InputError("rollout", field, "an integer of at least " + std::to_string(low),
                     std::to_string(value));
  }
}

}  // namespace

void RolloutConfig::Validate() const {
  RequireAtLeast("steps", steps, 0);
  RequireAtLeast("steps_per_knot", steps_per_knot, 1);
  RequireAtLeast("record_every", record_every, 0);
  RequireAtLeast("stop.settled_steps", stop.settled_steps, 0);
}

RolloutResult SimulateRollout(const World& world, const RolloutConfig& config,
                              const RolloutInput& input) {
  config.Validate();
  RolloutResult result;
  WorldState& state = result.end;
  state = input.start;
  const Vector3 p_start = state.bodies[0].p_WB;
  int slow_steps = 0;
  while (result.steps < config.steps) {
    ++result.steps;
    for (int f = 0; f < kNumFingers; ++f) {
      const std::vector<Vector3>& knots = input.p_WTargets[f];
      if (!state.fingers[f].on || knots.empty()) continue;
      state.fingers[f].p_WTarget =
          CalcTarget(input.start.fingers[f].p_WTarget, knots, config.steps_per_knot, result.steps);
    }
    world.Step(state);
    const BodyState& object = state.bodies[0];
    bool slipping = false;
    for (const FingertipState& finger : state.fingers) {
      result.max_force = std::max(result.max_force, finger.f_W.norm());
      slipping = slipping || finger.slipping;
    }
    result.max_speed = std::max(result.max_speed, object.v_WB.norm());
    result.slipping_steps += slipping ? 1 : 0;
    if (config.record_every > 0 && result.steps % config.record_every == 0) {
      result.record.push_back(state);
    }
    result.status = CheckStop(config.stop, p_start, object);
    if (result.status != Status::kFinished) break;
    slow_steps = IsSlow(object, config.stop.settled_speed) ? slow_steps + 1 : 0;
    if (config.stop.settled_steps > 0 && slow_steps >= config.stop.settled_steps) {
      result.status = Status::kSettled;
      break;
    }
  }
  return result;
}

std::vector<RolloutResult> SimulateRollouts(const World& world, const RolloutConfig& config,
                                            const std::vector<RolloutInput>& inputs,
                                            ThreadPool* pool) {
  config.Validate();
  std::vector<RolloutResult> results(inputs.size());
  pool->ParallelFor(static_cast<int>(inputs.size()),
                    [&](int i, int) { results[i] = SimulateRollout(world, config, inputs[i]); });
  return results;
}

}  // namespace pregrasp
