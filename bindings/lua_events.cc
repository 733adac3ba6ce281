#include <algorithm>

#include "bindings/lua_session.h"
#include "bindings/machine.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

const Schema kEvent{"Event",
                    {"kind", "t", "num_steps", "speed", "a", "b", "p_W", "penetration", "force_N",
                     "slip_speed", "finger", "touching", "slipping", "slip_mm"}};

// The predicate of the session, pushed; false if it has none.
bool PushPredicate(lua_State* L, const std::shared_ptr<Session>& session) {
  const auto& predicates = ScriptContext::Of(L).predicates;
  const auto found = predicates.find(session.get());
  if (found == predicates.end() || found->second.session.lock() != session) return false;
  lua_rawgeti(L, LUA_REGISTRYINDEX, found->second.reference);
  return true;
}

// Asks the predicate on top about the event above it, which it takes off.
bool Ask(lua_State* L) {
  lua_pushvalue(L, -2);
  lua_insert(L, -2);
  {
    const Machine::Resume running(L);
    lua_call(L, 1, 1);
  }
  const bool stop = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return stop;
}

RecordWriter BeginEvent(lua_State* L, const char* kind, const WorldState& state, int index) {
  RecordWriter event(L, kEvent);
  event.Set("kind", kind).Set("t", state.t).Set("num_steps", index);
  return event;
}

// Whether the predicate on top stops at physics step `index` of the past.
bool StopsAtStep(lua_State* L, const std::vector<Body>& bodies, const Simulation& simulation,
                 int index) {
  const WorldState& state = simulation.state_at(index);
  BeginEvent(L, "step", state, index).Set("speed", state.bodies[0].v_WB.norm());
  if (Ask(L)) return true;
  for (const ContactPoint& contact : simulation.contacts_at(index)) {
    BeginEvent(L, "contact", state, index)
        .Set("a", bodies[contact.body_a.value].name)
        .Set("b", bodies[contact.body_b.value].name)
        .Set("p_W", contact.p_WC)
        .Set("penetration", std::max(0.0, -contact.phi))
        .Set("force_N", contact.f_W.norm())
        .Set("slip_speed", contact.v_slip_W.norm());
    if (Ask(L)) return true;
  }
  for (int f = 0; f < kNumFingers; ++f) {
    const FingertipState& tip = state.fingers[f];
    if (!tip.on) continue;
    BeginEvent(L, "finger", state, index)
        .Set("finger", static_cast<Finger>(f))
        .Set("touching", tip.touching)
        .Set("slipping", tip.slipping)
        .Set("slip_mm", 1e3 * tip.slip)
        .Set("force_N", tip.f_W.norm());
    if (Ask(L)) return true;
  }
  return false;
}

}  // namespace

Predicate LuaValue<Predicate>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_isnoneornil(L, index)) return {};
  if (!lua_isfunction(L, index)) {
    throw InputError("", path, "a function or nil", DescribeValue(L, index));
  }
  lua_pushvalue(L, index);
  return {luaL_ref(L, LUA_REGISTRYINDEX)};
}

void SessionBreakWhen(lua_State* L, const std::shared_ptr<Session>& session,
                      const Predicate& predicate) {
  auto& predicates = ScriptContext::Of(L).predicates;
  const auto known = predicates.find(session.get());
  if (known != predicates.end()) {
    luaL_unref(L, LUA_REGISTRYINDEX, known->second.reference);
    predicates.erase(known);
  }
  if (predicate.reference != LUA_NOREF) predicates[session.get()] = {session, predicate.reference};
}

bool HasPredicate(lua_State* L, const std::shared_ptr<Session>& session) {
  const bool has = PushPredicate(L, session);
  if (has) lua_pop(L, 1);
  return has;
}

void RequireNotAsking(lua_State* L, const Session* session) {
  if (session == nullptr) return;
  const auto& asking = ScriptContext::Of(L).asking;
  if (std::find(asking.begin(), asking.end(), session) != asking.end()) {
    throw InputError("", "", "a session to stand still while its break_when function is asked",
                     "a call that may change it");
  }
}

std::optional<int> FindStop(lua_State* L, const std::shared_ptr<Session>& session,
                            const Simulation& simulation, int first) {
  // The session is being asked about until this ends, however it does.
  struct Asking {
    std::vector<const Session*>& list;
    explicit Asking(std::vector<const Session*>& sessions, const Session* session)
        : list(sessions) {
      list.push_back(session);
    }
    ~Asking() { list.pop_back(); }
  };
  const Asking asking(ScriptContext::Of(L).asking, session.get());
  if (!PushPredicate(L, session)) return std::nullopt;
  const int count = simulation.num_states();
  int index = first;
  while (index < count && !StopsAtStep(L, session->scene().bodies, simulation, index)) ++index;
  lua_pop(L, 1);
  if (index == count) return std::nullopt;
  return index;
}

std::vector<const Schema*> EventSchemas() { return {&kEvent}; }

}  // namespace pregrasp
