#include "bindings/lua_planner.h"

namespace pregrasp {

namespace {

// Whether `later` is `node` or comes after it.
bool Follows(const Timeline::Node* later, const Timeline::Node& node) {
  while (later != nullptr && later != &node) later = later->parent;
  return later != nullptr;
}

}  // namespace

nlohmann::json Cursor::TakeOptions(nlohmann::json options) {
  if (!settings.empty()) options["settings"] = std::exchange(settings, nlohmann::json::object());
  return options;
}

void Cursor::Do(Verb verb, nlohmann::json options) {
  const nlohmann::json pending = settings;
  try {
    node = &session->timeline().Do(*node, verb, TakeOptions(std::move(options)));
    if (!Follows(ahead, *node)) ahead = node;
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
  if (!Follows(ahead, *node)) ahead = node;
  for (int i = 0; i < steps; ++i) node = node->parent;
}

void Cursor::Forward(int steps) {
  std::vector<const Timeline::Node*> coming;  // the last first
  if (Follows(ahead, *node)) {
    for (const Timeline::Node* at = ahead; at != node; at = at->parent) coming.push_back(at);
  }
  const auto most = static_cast<int>(coming.size());
  if (steps < 0 || steps > most) {
    throw InputError("", "steps", "0 to " + std::to_string(most) + " steps, as it went back",
                     std::to_string(steps));
  }
  if (steps > 0) node = coming[coming.size() - static_cast<std::size_t>(steps)];
}

Pushed PushIpairs(lua_State* L) {
  lua_getglobal(L, "ipairs");
  lua_insert(L, -2);
  lua_call(L, 1, 3);
  return {3};
}

std::vector<const ClassInfo*> PlannerClasses() {
  return {&GraphClass(),     &ReasonClass(),     &PathsClass(),  &PathClass(),
          &OptimizerClass(), &TrajectoryClass(), &GraspsClass(), &GraspClass(),
          &MotionClass(),    &FrameClass(),      &PlanClass(),   &ArrayClass()};
}

}  // namespace pregrasp
