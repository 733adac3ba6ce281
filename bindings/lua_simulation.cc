#include <fmt/format.h>

#include "app/pipeline/forces.h"
#include "bindings/lua_session.h"

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

constexpr int kBytesPerStepKib = 3;

// Methods. Each that advances tells Lua's collector what the past has grown by, and returns whether
// break_when stopped it.

template <typename Body>
bool Advance(lua_State* L, LuaSimulation& sim, Body&& body) {
  const int before = sim.simulation->num_states();
  body();
  CountMemory(L, kBytesPerStepKib * (sim.simulation->num_states() - before));
  return StopWhereAsked(L, sim, before);
}

void SimTouch(LuaSimulation& sim, const TouchOptions& options) {
  sim.session->Touch(sim.simulation, options.finger, options.p_OC);
}

bool SimMove(lua_State* L, LuaSimulation& sim, const MoveOptions& options) {
  const Vector3& from = sim.simulation->state().fingers[static_cast<int>(options.finger)].p_WTarget;
  const Vector3 to = options.to ? *options.to : Vector3(from + *options.by);
  return Advance(L, sim,
                 [&] { sim.session->Move(sim.simulation, options.finger, to, options.seconds); });
}

void SimLift(LuaSimulation& sim, const LiftOptions& options) {
  sim.session->Lift(sim.simulation, options.finger);
}

bool SimWait(lua_State* L, LuaSimulation& sim, const WaitOptions& options) {
  return Advance(L, sim, [&] { sim.session->Wait(sim.simulation, options.seconds); });
}

bool SimStep(lua_State* L, LuaSimulation& sim, const std::optional<int>& steps) {
  return Advance(L, sim, [&] { sim.session->Step(sim.simulation, steps.value_or(1)); });
}

void SimBack(LuaSimulation& sim, const std::optional<int>& steps) {
  sim.simulation->Back(steps.value_or(1));
}

Pushed SimFork(lua_State* L, LuaSimulation& sim) {
  PushObject(L, std::make_shared<LuaSimulation>(
                    LuaSimulation{sim.session, std::make_shared<Simulation>(*sim.simulation)}));
  CountMemory(L, 1 + sim.simulation->num_states() / 64);
  return {1};
}

void SimShot(lua_State* L, LuaSimulation& sim, const ShotOptions& options) {
  TakeShot(L, *sim.session, sim.session->StepOf(*sim.simulation), options);
}

Pushed SimBody(lua_State* L, LuaSimulation& sim, const std::string& name) {
  PushBody(L, sim.simulation->world(), sim.simulation->state(),
           FindBody(sim.session->scene(), name));
  return {1};
}

// Properties.

double SimTime(LuaSimulation& sim) { return sim.simulation->state().t; }
int SimSteps(LuaSimulation& sim) { return sim.simulation->num_states() - 1; }
std::string SimStepId(LuaSimulation& sim) { return sim.simulation->step_id(); }

Pushed SimObject(lua_State* L, LuaSimulation& sim) {
  PushBody(L, sim.simulation->world(), sim.simulation->state(), 0);
  return {1};
}

Pushed SimFingers(lua_State* L, LuaSimulation& sim) {
  const WorldState& state = sim.simulation->state();
  RecordWriter fingers(L, kFingers);
  for (int i = 0; i < kNumFingers; ++i) {
    const FingertipState& tip = state.fingers[i];
    const ForceSplit split =
        SplitFingerForce(sim.simulation->world(), state, static_cast<Finger>(i));
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
    fingers.SetTop(kFingerNames[i]);
  }
  return {1};
}

Pushed SimContacts(lua_State* L, LuaSimulation& sim) {
  const std::vector<ContactPoint>& contacts = sim.simulation->contacts();
  const std::vector<Body>& bodies = sim.session->scene().bodies;
  lua_createtable(L, static_cast<int>(contacts.size()), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& contact = contacts[i];
    RecordWriter(L, kContact)
        .Set("a", bodies[contact.body_a.value].name)
        .Set("b", bodies[contact.body_b.value].name)
        .Set("p_W", contact.p_WC)
        .Set("nhat_W", contact.nhat_W)
        .Set("f_W", contact.f_W)
        .Set("force_N", contact.f_W.norm())
        .Set("gap_mm", 1e3 * contact.phi)
        .Set("slip_speed", contact.v_slip_W.norm());
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

Pushed SimTrace(lua_State* L, LuaSimulation& sim) {
  const int last = sim.simulation->num_states() - 1;
  if (!sim.simulation->traced() || last == 0) {
    lua_pushnil(L);
    return {1};
  }
  const StepTrace& trace = sim.simulation->trace_at(last);
  RecordWriter(L, kStepTrace)
      .Set("max_penetration_mm", 1e3 * trace.max_penetration)
      .Set("kinetic_J", trace.kinetic_energy)
      .Set("potential_J", trace.potential_energy);
  return {1};
}

int SimToString(lua_State* L) {
  const auto sim = FindObject<LuaSimulation>(L, 1);
  const std::string text = sim ? fmt::format("Simulation({}, t = {:.3f} s)",
                                             sim->simulation->step_id(), sim->simulation->state().t)
                               : "Simulation";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

const ClassInfo& SimulationClass() {
  static const ClassInfo info{"Simulation",
                              {
                                  Method<&SimTouch>("touch", "options"),
                                  Method<&SimMove>("move", "options"),
                                  Method<&SimLift>("lift", "options"),
                                  Method<&SimWait>("wait", "options"),
                                  Method<&SimStep>("step", "steps"),
                                  Method<&SimBack>("back", "steps"),
                                  Method<&SimFork>("fork"),
                                  Method<&SimShot>("shot", "options"),
                                  Method<&SimBody>("body", "name"),
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
