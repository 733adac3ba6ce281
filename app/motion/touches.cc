#include "app/motion/touches.h"

#include <algorithm>

#include "app/core/interrupt.h"
#include "app/motion/hand_motion.h"

namespace pregrasp {
namespace {

constexpr double kBriefly = 0.1;  // a contact that is lost this long is kept [s]
constexpr double kEvery = 0.25;   // reach is looked at this often [s]
constexpr int kStarts = 50;       // of inverse kinematics, on each rung

Placement::Contact ContactOf(const FingertipState& tip) { return {tip.on, tip.p_OC, tip.nhat_O}; }

bool SameFingersOn(const Contacts& a, const Contacts& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const auto& x, const auto& y) { return x.on == y.on; });
}

// The rows at which reach is looked at.
std::vector<std::size_t> FindMoments(const std::vector<TraceRow>& trace,
                                     const std::vector<Contacts>& touches) {
  std::vector<std::size_t> moments;
  double last = 0.0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (!AnyOn(touches[i])) continue;
    const double t = trace[i].state.t;
    const bool begins = i == 0 || !SameFingersOn(touches[i - 1], touches[i]);
    const bool ends = i + 1 == trace.size() || !SameFingersOn(touches[i + 1], touches[i]);
    if (!begins && !ends && t - last < kEvery) continue;
    moments.push_back(i);
    last = t;
  }
  return moments;
}

// A pose by one of a few rungs of the ladder, the strictest first: without cones hardly a random
// start comes near a pose that would do with them.
std::optional<HandConfiguration> SolveLoosely(const IkSolver& solver, const IkConfig& ik,
                                              const IkProblem& problem, const Rng& rng) {
  for (const LooseningRung rung :
       {LooseningRung::kNone, LooseningRung::kTip5mm, LooseningRung::kClearance1mm}) {
    IkConfig config = LoosenIk(ik, rung);
    config.max_starts = kStarts;
    config.warm_starts = 1;
    config.reason_starts = 0;
    const IkResult result = solver.Solve(config, problem, rng);
    if (result.solved()) return result.configuration();
  }
  return std::nullopt;
}

}  // namespace

bool AnyOn(const Contacts& contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.on; });
}

Contacts ContactsOn(const WorldState& state) {
  Contacts contacts{};
  for (int j = 0; j < kNumFingers; ++j) contacts[j] = ContactOf(state.fingers[j]);
  return contacts;
}

std::vector<Contacts> FindTouches(const std::vector<TraceRow>& trace) {
  std::vector<Contacts> touches(trace.size());
  for (int j = 0; j < kNumFingers; ++j) {
    std::size_t touched = 0;  // when it last did
    for (std::size_t i = 1; i < trace.size(); ++i) {
      const FingertipState& tip = trace[i].state.fingers[j];
      if (!tip.on) continue;
      if (!trace[i - 1].state.fingers[j].on) touched = i - 1;
      if (!tip.touching) continue;
      const bool briefly = trace[i].state.t - trace[touched].state.t <= kBriefly;
      for (std::size_t k = briefly ? touched + 1 : i; k <= i; ++k) {
        touches[k][j] = ContactOf(trace[k].state.fingers[j]);
      }
      touched = i;
    }
  }
  return touches;
}

std::optional<double> FindOutOfReach(const IkSolver& solver, const IkConfig& ik, const World& world,
                                     const std::vector<TraceRow>& trace, const Rng& rng) {
  const std::vector<Contacts> touches = FindTouches(trace);
  std::optional<HandConfiguration> last;
  for (const std::size_t row : FindMoments(trace, touches)) {
    ThrowIfInterrupted();
    MotionFrameTask frame;
    frame.X_WB = world.GetPoses(trace[row].state);
    frame.contacts = touches[row];
    IkProblem problem = MakeIkProblem(frame);
    problem.warm_start = last;
    last = SolveLoosely(solver, ik, problem, rng.Split(RngStream::kMotionFrame, row));
    if (!last) return trace[row].state.t;
  }
  return std::nullopt;
}

}  // namespace pregrasp
