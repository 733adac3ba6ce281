#include "bindings/lua_planner.h"

#include "bindings/scene_file.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

bool SameStart(const WorldState& a, const WorldState& b) {
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    if (a.bodies[i].p_WB != b.bodies[i].p_WB ||
        a.bodies[i].q_WB.coeffs() != b.bodies[i].q_WB.coeffs()) {
      return false;
    }
  }
  return true;
}

}  // namespace

Planning::Planning(std::shared_ptr<Session> owner, const PlannerConfig& config,
                   const std::filesystem::path& weights)
    : session(std::move(owner)),
      start(session->start()),
      planner(session->shared_world(), start, config, session->config().seed, session->pool(),
              weights),
      record(*session, planner) {}

std::shared_ptr<Planning> Planning::Of(lua_State* L, const std::shared_ptr<Session>& session,
                                       const PlannerConfig& config) {
  ScriptContext& context = ScriptContext::Of(L);
  std::weak_ptr<Planning>& known = context.planning[session.get()];
  std::shared_ptr<Planning> planning = known.lock();
  if (planning && SameStart(planning->start, session->start())) return planning;
  const std::filesystem::path& weights = context.config.weights;
  constexpr int kPlanningKib = 20000;
  CountMemory(L, kPlanningKib);
  planning = std::make_shared<Planning>(
      session, config, weights.empty() ? DataFolder() / "assets/weights" : weights);
  known = planning;
  return planning;
}

void ShootStep(lua_State* L, const Planning& planning,
               const std::shared_ptr<const JournalStep>& step, const ShotOptions& options) {
  if (!step) throw InputError("", "", "something that was done", "nothing yet");
  TakeShot(L, *planning.session, *step, options);
}

std::string StepId(const std::shared_ptr<const JournalStep>& step) {
  return step ? step->record.id : "";
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
