#include "bindings/lua_planner.h"

namespace pregrasp {

nlohmann::json Cursor::TakeOptions(nlohmann::json options) {
  if (!settings.empty()) options["settings"] = std::exchange(settings, nlohmann::json::object());
  return options;
}

void Cursor::Do(Verb verb, nlohmann::json options) {
  const nlohmann::json pending = settings;
  try {
    node = &session->timeline().Do(*node, verb, TakeOptions(std::move(options)));
  } catch (const InputError&) {
    settings = pending;  // nothing was done with them
    throw;
  }
}

void Cursor::Back(int steps, const Timeline::Node* first) {
  int most = 0;
  for (const Timeline::Node* at = node; at != first; at = at->parent) ++most;
  if (steps < 0 || steps > most) {
    throw InputError("", "steps", "0 to " + std::to_string(most) + " steps", std::to_string(steps));
  }
  for (int i = 0; i < steps; ++i) node = node->parent;
}

Pushed PushIpairs(lua_State* L) {
  lua_getglobal(L, "ipairs");
  lua_insert(L, -2);
  lua_call(L, 1, 3);
  return {3};
}

std::vector<const ClassInfo*> PlannerClasses() {
  return {&GraphClass(),      &ReasonClass(), &PathsClass(), &PathClass(),   &OptimizerClass(),
          &TrajectoryClass(), &GraspsClass(), &GraspClass(), &MotionClass(), &FrameClass()};
}

}  // namespace pregrasp
