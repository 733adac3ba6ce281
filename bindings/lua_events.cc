#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/core/text.h"
#include "app/pictures/words.h"
#include "bindings/lua_session.h"
#include "bindings/machine.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

const Schema kEvent{
    "Event",
    {"kind", "t", "num_steps", "speed", "a", "b", "p_W", "penetration", "force_N", "slip_speed",
     "finger", "touching", "slipping", "slip_mm", "step_id", "path", "cost", "text"}};
const Schema kStop{"Stop", {"by", "step_id", "t", "num_steps", "text"}};

using BreakPoint = ScriptContext::BreakPoint;
using Stop = ScriptContext::Stop;

const BreakPoint* FindBreakPoint(lua_State* L, const std::shared_ptr<Session>& session) {
  const auto& predicates = ScriptContext::Of(L).predicates;
  const auto found = predicates.find(session.get());
  if (found == predicates.end() || found->second.session.lock() != session) return nullptr;
  return &found->second;
}

RecordWriter BeginEvent(lua_State* L, const char* kind, double t) {
  RecordWriter event(L, kEvent);
  event.Set("kind", kind).Set("t", t);
  return event;
}

// One physics step, and what there was before it (null before the first).
struct PhysicsStep {
  int index = 0;
  const WorldState* state = nullptr;
  const std::vector<ContactPoint>* contacts = nullptr;
  const WorldState* state_before = nullptr;
  const std::vector<ContactPoint>* contacts_before = nullptr;
};

// Whether the function on top stops at a physics step.
bool FunctionStops(lua_State* L, const std::vector<Body>& bodies, const PhysicsStep& step) {
  const WorldState& state = *step.state;
  const auto ask = [L] {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    return AskFunction(L);
  };
  BeginEvent(L, "step", state.t)
      .Set("num_steps", step.index)
      .Set("speed", state.bodies[0].v_WB.norm());
  if (ask()) return true;
  for (const ContactPoint& contact : *step.contacts) {
    BeginEvent(L, "contact", state.t)
        .Set("num_steps", step.index)
        .Set("a", bodies[contact.body_a.value].name)
        .Set("b", bodies[contact.body_b.value].name)
        .Set("p_W", contact.p_WC)
        .Set("penetration", std::max(0.0, -contact.phi))
        .Set("force_N", contact.f_W.norm())
        .Set("slip_speed", contact.v_slip_W.norm());
    if (ask()) return true;
  }
  for (int f = 0; f < kNumFingers; ++f) {
    const FingertipState& tip = state.fingers[f];
    if (!tip.on) continue;
    BeginEvent(L, "finger", state.t)
        .Set("num_steps", step.index)
        .Set("finger", static_cast<Finger>(f))
        .Set("touching", tip.touching)
        .Set("slipping", tip.slipping)
        .Set("slip_mm", 1e3 * tip.slip)
        .Set("force_N", tip.f_W.norm());
    if (ask()) return true;
  }
  return false;
}

// Ready-made conditions. Each says in words where it holds, and nothing where it does not.
using Words = std::string;

// What touches: "table and ruler", "index".
std::vector<std::string> Touching(const std::vector<Body>& bodies, const WorldState& state,
                                  const std::vector<ContactPoint>& contacts) {
  std::vector<std::string> names;
  for (const ContactPoint& contact : contacts) {
    if (contact.f_W.norm() == 0.0) continue;
    names.push_back(bodies[contact.body_a.value].name + " and " +
                    bodies[contact.body_b.value].name);
  }
  for (int f = 0; f < kNumFingers; ++f) {
    if (state.fingers[f].touching) {
      names.push_back(std::string(FingerName(static_cast<Finger>(f))) + " and " + bodies[0].name);
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Words FirstMissing(const std::vector<std::string>& names, const std::vector<std::string>& from) {
  for (const std::string& name : names) {
    if (!std::binary_search(from.begin(), from.end(), name)) return name;
  }
  return "";
}

Words ContactMade(const std::vector<Body>& bodies, const PhysicsStep& step) {
  if (step.state_before == nullptr) return "";
  return FirstMissing(Touching(bodies, *step.state, *step.contacts),
                      Touching(bodies, *step.state_before, *step.contacts_before));
}

Words ContactLost(const std::vector<Body>& bodies, const PhysicsStep& step) {
  if (step.state_before == nullptr) return "";
  return FirstMissing(Touching(bodies, *step.state_before, *step.contacts_before),
                      Touching(bodies, *step.state, *step.contacts));
}

// A fingertip that stuck slips: its force is at the friction cone's limit.
Words Slip(const std::vector<Body>& bodies, const PhysicsStep& step) {
  if (step.state_before == nullptr) return "";
  for (int f = 0; f < kNumFingers; ++f) {
    const FingertipState &now = step.state->fingers[f], &before = step.state_before->fingers[f];
    if (now.on && now.slipping && !before.slipping) {
      return fmt::format("the {} slips on the {}", FingerName(static_cast<Finger>(f)),
                         bodies[0].name);
    }
  }
  return "";
}

Words Penetration(const std::vector<Body>& bodies, const PhysicsStep& step) {
  constexpr double kOverlap = 1e-4;  // [m]
  for (const ContactPoint& contact : *step.contacts) {
    if (-contact.phi <= kOverlap) continue;
    return fmt::format("{} and {} overlap by {:.2f} mm", bodies[contact.body_a.value].name,
                       bodies[contact.body_b.value].name, -1e3 * contact.phi);
  }
  return "";
}

template <typename T>
const T* DetailsOf(const Timeline::Node& node) {
  return std::get_if<T>(&node.facts.details);
}

// The last step before `node` with such details; null.
template <typename T>
const T* DetailsBefore(const Timeline::Node& node) {
  for (const Timeline::Node* at = node.parent; at != nullptr; at = at->parent) {
    if (const T* found = DetailsOf<T>(*at)) return found;
  }
  return nullptr;
}

Words NewBest(Session& /*session*/, const Timeline::Node& node) {
  const auto* now = DetailsOf<IterationFacts>(node);
  if (now == nullptr) return "";
  const auto* before = std::get_if<IterationFacts>(&node.parent->facts.details);
  if (before == nullptr) return fmt::format("the first best cost is {:.3f}", now->best_cost);
  if (!(now->best_cost < before->best_cost)) return "";
  return fmt::format("the best cost falls from {:.3f} to {:.3f}", before->best_cost,
                     now->best_cost);
}

Words ScoreDrop(Session& /*session*/, const Timeline::Node& node) {
  const auto* now = DetailsOf<IterationFacts>(node);
  const auto* before =
      now == nullptr ? nullptr : std::get_if<IterationFacts>(&node.parent->facts.details);
  if (before == nullptr || !(now->best.final_score < before->best.final_score)) return "";
  return fmt::format("the best plan's end scores {:.3f} after {:.3f}", now->best.final_score,
                     before->best.final_score);
}

// The path that was last begun before `node` in the order of doing is another.
Words PathSwitched(Session& session, const Timeline::Node& node) {
  const auto* now = DetailsOf<PathFacts>(node);
  if (now == nullptr) return "";
  const auto& nodes = session.timeline().nodes();
  for (int number = node.number - 1; number >= 1; --number) {
    const auto* before = DetailsOf<PathFacts>(*nodes[static_cast<std::size_t>(number) - 1]);
    if (before == nullptr) continue;
    return before->rank == now->rank
               ? ""
               : fmt::format("path {} after path {}", now->rank, before->rank);
  }
  return "";
}

Words Certified(Session& /*session*/, const Timeline::Node& node) {
  const auto* facts = DetailsOf<CertifyFacts>(node);
  return facts != nullptr && facts->certified ? "the plan is certified" : "";
}

Words CertifyFailed(Session& /*session*/, const Timeline::Node& node) {
  const auto* facts = DetailsOf<CertifyFacts>(node);
  if (facts == nullptr || facts->certified) return "";
  std::string reasons;
  for (const std::string& reason : facts->reasons)
    reasons += (reasons.empty() ? "" : "; ") + reason;
  return "not certified: " + reasons;
}

// Inverse kinematics found no pose: of a grasp whose forces are fine, of a frame.
Words IkFailed(Session& /*session*/, const Timeline::Node& node) {
  if (const auto* grasp = DetailsOf<GraspFacts>(node)) {
    constexpr std::array<const char*, 4> kKinematic = {"tip_error", "cone", "collision",
                                                       "not_certified"};
    const bool failed =
        std::find(kKinematic.begin(), kKinematic.end(), grasp->status) != kKinematic.end();
    return failed ? grasp->sentence : "";
  }
  const auto* frame = DetailsOf<FrameFacts>(node);
  if (frame == nullptr || !frame->failed) return "";
  return fmt::format("no hand pose in phase {}", frame->phase);
}

Words GraspFound(Session& /*session*/, const Timeline::Node& node) {
  const auto* grasp = DetailsOf<GraspFacts>(node);
  return grasp != nullptr && grasp->feasible ? grasp->sentence : "";
}

Words Lifted(Session& /*session*/, const Timeline::Node& node) {
  const auto* lift = DetailsOf<LiftFacts>(node);
  return lift != nullptr && lift->held ? lift->sentence : "";
}

Words LiftFailed(Session& /*session*/, const Timeline::Node& node) {
  const auto* lift = DetailsOf<LiftFacts>(node);
  return lift != nullptr && !lift->held ? lift->sentence : "";
}

Words Loosened(Session& /*session*/, const Timeline::Node& node) {
  const auto* frame = DetailsOf<FrameFacts>(node);
  if (frame == nullptr || frame->loosened == "none" || frame->failed) return "";
  return fmt::format("{} is loosened in phase {}", frame->loosened, frame->phase);
}

Words SearchEnded(Session& /*session*/, const Timeline::Node& node) {
  const auto* facts = DetailsOf<IterationFacts>(node);
  if (facts == nullptr || facts->end.empty()) return "";
  return facts->end == "limit" ? "the limit of iterations ends it"
                               : "the best cost hardly falls any more";
}

struct Condition {
  const char* name;
  Words (*of_physics)(const std::vector<Body>& bodies, const PhysicsStep& step);
  Words (*of_planner)(Session& session, const Timeline::Node& node);
};
constexpr std::array<Condition, 15> kConditions{{{"contact_made", ContactMade, nullptr},
                                                 {"contact_lost", ContactLost, nullptr},
                                                 {"slip", Slip, nullptr},
                                                 {"penetration", Penetration, nullptr},
                                                 {"new_best", nullptr, NewBest},
                                                 {"score_drop", nullptr, ScoreDrop},
                                                 {"path_switched", nullptr, PathSwitched},
                                                 {"search_ended", nullptr, SearchEnded},
                                                 {"certified", nullptr, Certified},
                                                 {"certify_failed", nullptr, CertifyFailed},
                                                 {"ik_failed", nullptr, IkFailed},
                                                 {"grasp_found", nullptr, GraspFound},
                                                 {"lifted", nullptr, Lifted},
                                                 {"lift_failed", nullptr, LiftFailed},
                                                 {"loosened", nullptr, Loosened}}};

const Condition& FindCondition(const std::string& name) {
  std::vector<std::string> names;
  for (const Condition& condition : kConditions) {
    if (name == condition.name) return condition;
    names.emplace_back(condition.name);
  }
  const std::string nearest = FindNearest(name, names);
  std::string all;
  for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
  throw InputError("", "predicate", nearest.empty() ? "one of " + all : '"' + nearest + '"',
                   '"' + OneLine(name) + '"');
}

// Whether a session's break point says yes to a physics step; `stop` then says why. The function,
// or nil, is on top.
bool StopsAtPhysics(lua_State* L, const BreakPoint& point, const std::vector<Body>& bodies,
                    const PhysicsStep& step, Stop& stop) {
  for (const std::string& name : point.conditions) {
    const Condition& condition = FindCondition(name);
    if (condition.of_physics == nullptr) continue;
    stop.text = condition.of_physics(bodies, step);
    if (!stop.text.empty()) stop.by = name;
    if (!stop.text.empty()) break;
  }
  if (stop.by.empty() && lua_isfunction(L, -1) && FunctionStops(L, bodies, step)) {
    stop.by = "function";
  }
  if (stop.by.empty()) return false;
  stop.t = step.state->t;
  stop.num_steps = step.index;
  return true;
}

void PushFunctionOf(lua_State* L, const BreakPoint& point) {
  if (point.reference == LUA_NOREF) {
    lua_pushnil(L);
  } else {
    lua_rawgeti(L, LUA_REGISTRYINDEX, point.reference);
  }
}

// The event of a planner's step, pushed: its kind is the verb.
void PushPlannerEvent(lua_State* L, Session& session, const Timeline::Node& node) {
  RecordWriter event = BeginEvent(L, VerbName(node.command.verb), node.facts.t);
  event.Set("step_id", node.id());
  const std::vector<std::string> lines =
      DescribeStep(session.scene(), node.facts, session.timeline());
  event.Set("text", lines.empty() ? std::string() : lines.front());
  std::visit(
      [&](const auto& facts) {
        if constexpr (requires { facts.path; }) event.Set("path", facts.path);
        if constexpr (requires { facts.best_cost; }) event.Set("cost", facts.best_cost);
      },
      node.facts.details);
}

}  // namespace

StandStill::StandStill(lua_State* L, const Session* session) : L_(L) {
  ScriptContext::Of(L).asking.push_back(session);
}
StandStill::~StandStill() { ScriptContext::Of(L_).asking.pop_back(); }

bool AskFunction(lua_State* L) {
  {
    const Machine::Resume running(L);
    lua_call(L, 1, 1);
  }
  const bool yes = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return yes;
}

Predicate LuaValue<Predicate>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_isnoneornil(L, index)) return {};
  Predicate predicate;
  if (lua_type(L, index) == LUA_TSTRING) {
    predicate.conditions = {LuaValue<std::string>::Read(L, index, path)};
  } else if (lua_istable(L, index)) {
    predicate.conditions = LuaValue<std::vector<std::string>>::Read(L, index, path);
  } else if (!lua_isfunction(L, index)) {
    throw InputError("", path, "a function, the name of a condition, a list of names, or nil",
                     DescribeValue(L, index));
  }
  for (const std::string& name : predicate.conditions) FindCondition(name);
  if (lua_isfunction(L, index)) {
    lua_pushvalue(L, index);
    predicate.reference = luaL_ref(L, LUA_REGISTRYINDEX);
  }
  return predicate;
}

void SessionBreakWhen(lua_State* L, const std::shared_ptr<Session>& session,
                      const Predicate& predicate) {
  auto& predicates = ScriptContext::Of(L).predicates;
  const auto known = predicates.find(session.get());
  if (known != predicates.end()) {
    luaL_unref(L, LUA_REGISTRYINDEX, known->second.reference);
    predicates.erase(known);
  }
  if (predicate.reference != LUA_NOREF || !predicate.conditions.empty()) {
    predicates[session.get()] = {session, predicate.reference, predicate.conditions};
  }
}

bool HasPredicate(lua_State* L, const std::shared_ptr<Session>& session) {
  return FindBreakPoint(L, session) != nullptr;
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
  const BreakPoint* found = FindBreakPoint(L, session);
  if (found == nullptr) return std::nullopt;
  const BreakPoint point = *found;  // the function may set another
  const StandStill still(L, session.get());
  PushFunctionOf(L, point);
  Stop stop{session, {}, {}, {}};
  std::optional<int> index;
  for (int i = first; i < simulation.num_states() && !index; ++i) {
    PhysicsStep step{i, &simulation.state_at(i), &simulation.contacts_at(i)};
    if (i > 0) {
      step.state_before = &simulation.state_at(i - 1);
      step.contacts_before = &simulation.contacts_at(i - 1);
    }
    if (StopsAtPhysics(L, point, session->scene().bodies, step, stop)) index = i;
  }
  lua_pop(L, 1);
  if (index) ScriptContext::Of(L).stops[session.get()] = stop;
  return index;
}

bool StopsAt(lua_State* L, const std::shared_ptr<Session>& session, const Timeline::Node& node) {
  const BreakPoint* found = FindBreakPoint(L, session);
  if (found == nullptr) return false;
  const BreakPoint point = *found;
  const StandStill still(L, session.get());
  PushFunctionOf(L, point);
  Stop stop{session, {}, node.id(), {}, node.facts.t};
  if (node.command.verb == Verb::kCertify) {
    const auto state = session->timeline().GetState(node);
    const std::vector<TraceRow>& trace = state->certificate->trace;
    for (std::size_t i = 1; i < trace.size() && stop.by.empty(); ++i) {
      const PhysicsStep step{static_cast<int>(i), &trace[i].state, &trace[i].contacts,
                             &trace[i - 1].state, &trace[i - 1].contacts};
      StopsAtPhysics(L, point, session->scene().bodies, step, stop);
    }
  }
  for (const std::string& name : point.conditions) {
    if (!stop.by.empty()) break;
    const Condition& condition = FindCondition(name);
    if (condition.of_planner == nullptr) continue;
    stop.text = condition.of_planner(*session, node);
    if (!stop.text.empty()) stop.by = name;
  }
  if (stop.by.empty() && lua_isfunction(L, -1)) {
    lua_pushvalue(L, -1);
    PushPlannerEvent(L, *session, node);
    if (AskFunction(L)) stop.by = "function";
  }
  lua_pop(L, 1);
  if (stop.by.empty()) return false;
  ScriptContext::Of(L).stops[session.get()] = stop;
  return true;
}

Pushed SessionStopped(lua_State* L, const std::shared_ptr<Session>& session) {
  const auto& stops = ScriptContext::Of(L).stops;
  const auto found = stops.find(session.get());
  if (found == stops.end() || found->second.session.lock() != session) {
    lua_pushnil(L);
    return {1};
  }
  const Stop& stop = found->second;
  RecordWriter(L, kStop)
      .Set("by", stop.by)
      .Set("step_id", stop.step_id)
      .Set("t", stop.t)
      .Set("num_steps", stop.num_steps)
      .Set("text", stop.text);
  return {1};
}

std::vector<const Schema*> EventSchemas() { return {&kEvent, &kStop}; }

}  // namespace pregrasp
