#include "app/job/apply.h"

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/job/apply_stages.h"
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace internal {

void SetWorldFacts(StepFacts& facts, const World& world, const WorldState& state,
                   const std::vector<ContactPoint>& contacts) {
  facts.t = state.t;
  facts.bodies.clear();
  for (int i = 0; i < world.num_movables(); ++i) {
    const BodyState& body = state.bodies[i];
    facts.bodies.push_back({world.scene().bodies[world.body_index(MovableIndex{i}).value].name,
                            body.p_WB, body.q_WB, body.w_WB, body.v_WB});
  }
  facts.fingers.clear();
  for (int i = 0; i < world.scene().tips.count; ++i) {
    const FingertipState& tip = state.fingers[i];
    facts.fingers.push_back({static_cast<Finger>(i), tip.on, tip.touching, tip.slipping, tip.p_OC,
                             tip.nhat_O, tip.p_WF, tip.p_WTarget, tip.f_W, tip.slip});
  }
  facts.contacts.clear();
  for (const ContactPoint& contact : contacts) {
    facts.contacts.push_back({contact.body_a.value, contact.body_b.value, contact.p_WC,
                              contact.nhat_W, contact.f_W, contact.phi, contact.v_slip_W});
  }
}

void Require(bool condition, const char* expected, const char* got) {
  if (!condition) throw InputError("", "", expected, got);
}

}  // namespace internal

namespace {

void ApplyVerb(internal::Application& a) {
  switch (a.command.verb) {
    case Verb::kOpen:
    case Verb::kSettle:
    case Verb::kVerdict:
      return internal::ApplyScene(a);
    case Verb::kMesh:
    case Verb::kScore:
    case Verb::kPrune:
    case Verb::kPath:
      return internal::ApplyGraph(a);
    case Verb::kScreen:
    case Verb::kIterate:
    case Verb::kCertify:
      return internal::ApplyTrajectory(a);
    case Verb::kGrasp:
    case Verb::kLift:
      return internal::ApplyGrasp(a);
    case Verb::kKeyframe:
    case Verb::kFill:
    case Verb::kSmooth:
    case Verb::kFrame:
      return internal::ApplyMotion(a);
    case Verb::kTouch:
    case Verb::kLetGo:
    case Verb::kMove:
    case Verb::kWait:
      return internal::ApplySimulation(a);
  }
}

Applied ApplyWith(Job& job, const std::shared_ptr<const JobState>& state, const Command& command,
                  const Simulation* whole) {
  const bool opens = command.verb == Verb::kOpen;
  PREGRASP_CHECK(opens == (state == nullptr), VerbName(command.verb));
  JobState next;
  if (opens) {
    next.config = job.setup().config;
    next.start = job.world().InitialState();
  } else {
    next = *state;
  }
  if (command.options.contains("settings")) {
    ApplySettings(command.options["settings"], next.config);
  }
  Applied applied;
  applied.facts.command = command;
  applied.facts.details = MakeDetails(command.verb);
  internal::SetWorldFacts(applied.facts, job.world(), next.start, {});
  internal::Application application{job, command, next, applied.facts, false, whole};
  ApplyVerb(application);
  PREGRASP_CHECK(!applied.facts.id.empty(), VerbName(command.verb));
  applied.interrupted = application.interrupted;
  applied.state = std::make_shared<const JobState>(std::move(next));
  return applied;
}

}  // namespace

Applied Apply(Job& job, const std::shared_ptr<const JobState>& state, const Command& command) {
  return ApplyWith(job, state, command, nullptr);
}

Applied internal::ApplyPart(Job& job, const std::shared_ptr<const JobState>& state,
                            const Command& command, const Simulation& whole) {
  return ApplyWith(job, state, command, &whole);
}

const char* TimedStage(Verb verb) {
  switch (verb) {
    case Verb::kMesh:
      return "geometry";
    case Verb::kScore:
    case Verb::kPrune:
    case Verb::kPath:
      return "graph";
    case Verb::kScreen:
    case Verb::kIterate:
    case Verb::kCertify:
      return "trajectory";
    case Verb::kGrasp:
    case Verb::kLift:
      return "grasp";
    case Verb::kKeyframe:
    case Verb::kFill:
    case Verb::kSmooth:
    case Verb::kFrame:
      return "motion";
    default:
      return "";
  }
}

}  // namespace pregrasp
