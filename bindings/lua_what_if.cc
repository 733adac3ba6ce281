#include "bindings/lua_planner.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

const Schema kWhatIfOptions{"WhatIfOptions", {"set"}};

// The session's scene and planner with some values changed, as a session of its own, at its start.
std::shared_ptr<Session> OpenChanged(lua_State* L, Session& session, const WhatIfOptions& options) {
  std::vector<Setting> settings = options.settings;
  Scene scene = session.scene();
  std::vector<bool> movable;
  for (const Body& body : scene.bodies) movable.push_back(body.movable());
  SessionConfig config = session.config();
  const std::string hand = scene.hand, hand_where = WhereHandIsNamed(scene, settings);
  ApplySceneSettings(scene, settings);
  ApplyPlannerSettings(config.planner, settings);
  RequireNoSettingsLeft(settings, PlannerRoots());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].movable() == movable[i]) continue;
    throw InputError("", "set", "a mass for bodies that move", "one for " + scene.bodies[i].name);
  }
  ValidateScene(scene);
  if (scene.hand != hand) FindHandOf(scene, Machine::Of(L).script_folder(), hand_where);
  constexpr int kSessionKib = 2000;
  CountMemory(L, kSessionKib);
  MemoryClaim claim = ClaimMemory(L, std::size_t{kSessionKib} << 10U);
  auto changed = std::make_shared<Session>(std::move(scene), config);
  changed->claim() = std::move(claim);
  const Timeline::Node& start = session.start();
  if (start.command.verb == Verb::kSettle) {
    changed->Settle(CommandOptions(start.command).Number("seconds"));
  }
  return changed;
}

// Does in `changed` what led from the session's start to `node`. @param first  gets the first step.
const Timeline::Node& Repeat(Session& changed, const Session& session, const Timeline::Node& node,
                             const Timeline::Node** first) {
  const Timeline::Node* at = &changed.start();
  for (const Timeline::Node* step : PathTo(node)) {
    if (step->number <= session.start().number) continue;
    at = &changed.timeline().Do(*at, step->command.verb, step->command.options);
    if (*first == nullptr) *first = at;
  }
  return *at;
}

}  // namespace

WhatIfOptions LuaValue<WhatIfOptions>::Read(lua_State* L, int index, const std::string& path) {
  if (lua_isnoneornil(L, index)) {
    throw InputError("", path, "{set = {[\"object.p\"] = {x, y, z}, ..}}", "nothing");
  }
  const Fields fields(L, index, kWhatIfOptions);
  return {ReadSettings(L, fields)};
}

Pushed SessionWhatIf(lua_State* L, const std::shared_ptr<Session>& session,
                     const WhatIfOptions& options) {
  PushObject(L, OpenChanged(L, *session, options));
  return {1};
}

Pushed GraphWhatIf(lua_State* L, LuaGraph& graph, const WhatIfOptions& options) {
  const std::shared_ptr<Session> changed = OpenChanged(L, *graph.session, options);
  const Timeline::Node* first = nullptr;
  const Timeline::Node& end = Repeat(*changed, *graph.session, *graph.node, &first);
  CountSteps(L, *changed);
  PushObject(L, std::make_shared<LuaGraph>(LuaGraph{{changed, &end}, first}));
  return {1};
}

Pushed SimulationWhatIf(lua_State* L, LuaSimulation& simulation, const WhatIfOptions& options) {
  const std::shared_ptr<Session> changed = OpenChanged(L, *simulation.session, options);
  const Timeline::Node* first = nullptr;
  const Timeline::Node& end = Repeat(*changed, *simulation.session, *simulation.node, &first);
  CountSteps(L, *changed);
  PushObject(L, std::make_shared<LuaSimulation>(LuaSimulation{changed, &end, simulation.traced}));
  return {1};
}

std::vector<const Schema*> WhatIfSchemas() { return {&kWhatIfOptions}; }

}  // namespace pregrasp
