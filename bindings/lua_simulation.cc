#include <fmt/format.h>

#include "app/core/interrupt.h"
#include "app/core/json_values.h"
#include "app/pictures/forces.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kTouchOptions{"TouchOptions", {"finger", "p_OC"}};
const Schema kMoveOptions{"MoveOptions", {"finger", "by", "to", "seconds"}};
const Schema kLiftOptions{"LiftOptions", {"finger"}};
const Schema kWaitOptions{"WaitOptions", {"seconds"}};
const Schema kFingers{"Fingers", {"thumb", "index", "middle", "ring", "little"}};
const Schema kFinger{"Finger",
                     {"on", "touching", "slipping", "force_N", "normal_N", "friction_N", "limit_N",
                      "slip_mm", "p_OC", "nhat_O", "p_WF", "p_WTarget", "f_W"}};
const Schema kContact{"Contact",
                      {"a", "b", "p_W", "nhat_W", "f_W", "force_N", "gap_mm", "slip_speed"}};

const Schema kStepTrace{"StepTrace", {"max_penetration_mm", "kinetic_J", "potential_J"}};

struct TouchOptions {
  Finger finger = Finger::kIndex;
  Vector3 p_OC = Vector3::Zero();
};
struct MoveOptions {
  Finger finger = Finger::kIndex;
  std::optional<Vector3> by, to;
  double seconds = 1.0;
};
struct LiftOptions {
  Finger finger = Finger::kIndex;
};
struct WaitOptions {
  double seconds = 1.0;
};

}  // namespace

template <>
struct LuaValue<TouchOptions> {
  static TouchOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kTouchOptions);
    return {fields.Required<Finger>("finger"), fields.Required<Vector3>("p_OC")};
  }
};

template <>
struct LuaValue<MoveOptions> {
  static MoveOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kMoveOptions);
    MoveOptions options;
    options.finger = fields.Required<Finger>("finger");
    options.by = fields.Find<Vector3>("by");
    options.to = fields.Find<Vector3>("to");
    options.seconds = fields.Optional<double>("seconds", options.seconds);
    if (options.by.has_value() == options.to.has_value()) {
      throw InputError("", "by", "either by = {..} or to = {..}", options.by ? "both" : "neither");
    }
    return options;
  }
};

template <>
struct LuaValue<LiftOptions> {
  static LiftOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kLiftOptions).Required<Finger>("finger")};
  }
};

template <>
struct LuaValue<WaitOptions> {
  static WaitOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kWaitOptions).Optional<double>("seconds", 1.0)};
  }
};

namespace {

// Does an action, ended where break_when says, and moves on.
// @returns whether break_when stopped it.
bool Act(lua_State* L, LuaSimulation& sim, Verb verb, nlohmann::json options) {
  Timeline& timeline = sim.session->timeline();
  if (sim.traced && !timeline.GetState(*sim.node)->simulation) options["trace"] = true;
  const int before = sim.simulation()->num_states();
  bool stopped = false;
  sim.ahead = nullptr;
  if (HasPredicate(L, sim.session)) {
    Applied applied = timeline.Try(*sim.node, verb, options);
    const std::optional<int> stop = FindStop(L, sim.session, *applied.state->simulation, before);
    stopped = stop.has_value();
    if (stopped) {
      options["stopped_after"] = *stop + 1 - before;
      sim.node = &timeline.Do(*sim.node, verb, std::move(options));
    } else {
      sim.node = &timeline.Commit(*sim.node, std::move(applied));
    }
  } else {
    try {
      sim.node = &timeline.Do(*sim.node, verb, std::move(options));
    } catch (const Interrupted&) {
      sim.node = &timeline.last();  // what was done until then
      throw;
    }
  }
  CountSteps(L, *sim.session);
  return stopped;
}

// Methods.

void SimTouch(lua_State* L, LuaSimulation& sim, const TouchOptions& options) {
  Act(L, sim, Verb::kTouch,
      {{"finger", FingerName(options.finger)}, {"p_OC", ToJson(options.p_OC)}});
}

bool SimMove(lua_State* L, LuaSimulation& sim, const MoveOptions& options) {
  const Vector3 from =
      sim.simulation()->state().fingers[static_cast<int>(options.finger)].p_WTarget;
  const Vector3 to = options.to ? *options.to : Vector3(from + *options.by);
  return Act(L, sim, Verb::kMove,
             {{"finger", FingerName(options.finger)},
              {"p_WTarget", ToJson(to)},
              {"seconds", options.seconds}});
}

void SimLift(lua_State* L, LuaSimulation& sim, const LiftOptions& options) {
  Act(L, sim, Verb::kLetGo, {{"finger", FingerName(options.finger)}});
}

bool SimWait(lua_State* L, LuaSimulation& sim, const WaitOptions& options) {
  return Act(L, sim, Verb::kWait, {{"seconds", options.seconds}});
}

bool SimStep(lua_State* L, LuaSimulation& sim, const std::optional<int>& steps) {
  return Act(L, sim, Verb::kWait, {{"steps", steps.value_or(1)}});
}

int NumStates(const Timeline& timeline, const Timeline::Node& node) {
  const auto state = timeline.GetState(node);
  return state->simulation ? state->simulation->num_states() : 1;
}

// Goes to the state after `count` physics steps, the start's being 1, of those on the way to
// `sim.ahead`: to the action that ended there, else to one that is stopped there.
void GoTo(lua_State* L, LuaSimulation& sim, int count) {
  Timeline& timeline = sim.session->timeline();
  const Timeline::Node* at = sim.ahead;
  while (at->parent != nullptr && std::holds_alternative<SimulationFacts>(at->facts.details) &&
         NumStates(timeline, *at->parent) > count) {
    at = at->parent;
  }
  if (NumStates(timeline, *at) == count) {
    sim.node = at;
    return;
  }
  const int begins = NumStates(timeline, *at->parent);
  if (begins == count) {
    sim.node = at->parent;
    return;
  }
  nlohmann::json options = at->command.options;
  options["stopped_after"] = count - begins;
  sim.node = &timeline.Do(*at->parent, at->command.verb, std::move(options));
  CountSteps(L, *sim.session);
}

// Takes physics steps back, exactly.
void SimBack(lua_State* L, LuaSimulation& sim, const std::optional<int>& steps) {
  const int count = NumStates(sim.session->timeline(), *sim.node), back = steps.value_or(1);
  if (back < 0 || back >= count) {
    throw InputError("", "steps", fmt::format("0 to {} steps", count - 1), std::to_string(back));
  }
  if (sim.ahead == nullptr) sim.ahead = sim.node;
  GoTo(L, sim, count - back);
}

// Takes steps that it went back.
void SimForward(lua_State* L, LuaSimulation& sim, const std::optional<int>& steps) {
  Timeline& timeline = sim.session->timeline();
  const int count = NumStates(timeline, *sim.node), forward = steps.value_or(1);
  const int most = sim.ahead == nullptr ? 0 : NumStates(timeline, *sim.ahead) - count;
  if (forward < 0 || forward > most) {
    throw InputError("", "steps", fmt::format("0 to {} steps, as it went back", most),
                     std::to_string(forward));
  }
  if (forward > 0) GoTo(L, sim, count + forward);
}

Pushed SimFork(lua_State* L, LuaSimulation& sim) {
  PushObject(L, std::make_shared<LuaSimulation>(sim));
  CountMemory(L, 1);  // the past is the session's: a fork copies none of it
  return {1};
}

void SimShot(lua_State* L, LuaSimulation& sim, const ShotOptions& options) {
  TakeShot(L, *sim.session, *sim.node, options);
}

Pushed SimBody(lua_State* L, LuaSimulation& sim, const std::string& name) {
  PushBody(L, sim.session->world(), sim.simulation()->state(),
           FindBody(sim.session->scene(), name));
  return {1};
}

// Properties.

double SimTime(LuaSimulation& sim) { return sim.node->facts.t; }
int SimSteps(LuaSimulation& sim) { return sim.simulation()->num_states() - 1; }
std::string SimStepId(LuaSimulation& sim) { return sim.node->id(); }

Pushed SimObject(lua_State* L, LuaSimulation& sim) {
  PushBody(L, sim.session->world(), sim.simulation()->state(), 0);
  return {1};
}

Pushed SimFingers(lua_State* L, LuaSimulation& sim) {
  const StepFacts& step = sim.node->facts;
  RecordWriter fingers(L, kFingers);
  for (const FingerFacts& tip : step.fingers) {
    const ForceSplit split = SplitFingerForce(sim.session->scene(), step.object().q_WB, tip);
    RecordWriter(L, kFinger)
        .Set("on", tip.on)
        .Set("touching", tip.touching)
        .Set("slipping", tip.slipping)
        .Set("force_N", tip.f_W.norm())
        .Set("normal_N", split.normal)
        .Set("friction_N", split.tangential)
        .Set("limit_N", split.limit)
        .Set("slip_mm", 1e3 * tip.slip)
        .Set("p_OC", tip.p_OC)
        .Set("nhat_O", tip.nhat_O)
        .Set("p_WF", tip.p_WF)
        .Set("p_WTarget", tip.p_WTarget)
        .Set("f_W", tip.f_W);
    fingers.SetTop(FingerName(tip.finger));
  }
  return {1};
}

Pushed SimContacts(lua_State* L, LuaSimulation& sim) {
  const std::vector<ContactFacts>& contacts = sim.node->facts.contacts;
  const std::vector<Body>& bodies = sim.session->scene().bodies;
  lua_createtable(L, static_cast<int>(contacts.size()), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactFacts& contact = contacts[i];
    RecordWriter(L, kContact)
        .Set("a", bodies[contact.a].name)
        .Set("b", bodies[contact.b].name)
        .Set("p_W", contact.p_W)
        .Set("nhat_W", contact.nhat_W)
        .Set("f_W", contact.f_W)
        .Set("force_N", contact.f_W.norm())
        .Set("gap_mm", 1e3 * contact.gap)
        .Set("slip_speed", contact.v_slip_W.norm());
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

// nil where it is not traced
Pushed SimTrace(lua_State* L, LuaSimulation& sim) {
  const auto* facts = std::get_if<SimulationFacts>(&sim.node->facts.details);
  if (facts == nullptr || !facts->trace) {
    lua_pushnil(L);
    return {1};
  }
  RecordWriter(L, kStepTrace)
      .Set("max_penetration_mm", 1e3 * facts->trace->max_penetration)
      .Set("kinetic_J", facts->trace->kinetic_energy)
      .Set("potential_J", facts->trace->potential_energy);
  return {1};
}

int SimToString(lua_State* L) {
  const auto sim = FindObject<LuaSimulation>(L, 1);
  const std::string text =
      sim ? fmt::format("Simulation({}, t = {:.3f} s)", sim->node->id(), SimTime(*sim))
          : "Simulation";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

std::shared_ptr<const Simulation> LuaSimulation::simulation() const {
  const auto state = session->timeline().GetState(*node);
  if (state->simulation) return state->simulation;
  return std::make_shared<const Simulation>(session->job().shared_world(), state->start, traced);
}

const ClassInfo& SimulationClass() {
  static const ClassInfo info{"Simulation",
                              {
                                  Method<&SimTouch>("touch", "options"),
                                  Method<&SimMove>("move", "options"),
                                  Method<&SimLift>("lift", "options"),
                                  Method<&SimWait>("wait", "options"),
                                  Method<&SimStep>("step", "steps"),
                                  Method<&SimBack>("back", "steps"),
                                  Method<&SimForward>("forward", "steps"),
                                  Method<&SimulationWhatIf>("what_if", "options"),
                                  Query<&SimFork>("fork"),
                                  Method<&SimShot>("shot", "options"),
                                  Query<&SimBody>("body", "name"),
                              },
                              {
                                  Property<&SimTime>("t"),
                                  Property<&SimSteps>("num_steps"),
                                  Property<&SimStepId>("step_id"),
                                  Property<&SimObject>("object"),
                                  Property<&SimFingers>("fingers"),
                                  Property<&SimContacts>("contacts"),
                                  Property<&SimTrace>("trace"),
                              },
                              SimToString};
  return info;
}

std::vector<const Schema*> SimulationSchemas() {
  return {&kTouchOptions, &kMoveOptions, &kLiftOptions, &kWaitOptions,
          &kFingers,      &kFinger,      &kContact,     &kStepTrace};
}

}  // namespace pregrasp
