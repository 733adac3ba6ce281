#include <fmt/format.h>

#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kLift{"Lift", {"held", "height", "shift", "turn_deg", "slip_mm", "direction_W"}};

constexpr int kGraspKib = 20;

// All grasps of a trajectory.

Pushed GraspsAll(lua_State* L, LuaGrasps& grasps) {
  LuaValue<std::vector<std::shared_ptr<LuaGrasp>>>::Push(L, grasps.grasps);
  return PushIpairs(L);
}

Pushed GraspsBest(lua_State* L, LuaGrasps& grasps) {
  if (grasps.all->feasible.empty()) {
    lua_pushnil(L);
  } else {
    PushObject(L, grasps.grasps[static_cast<std::size_t>(grasps.all->feasible.front())]);
  }
  return {1};
}

Pushed GraspsItem(lua_State* L, LuaGrasps& grasps, int number) {
  if (number < 1 || number > static_cast<int>(grasps.grasps.size())) {
    lua_pushnil(L);
  } else {
    PushObject(L, grasps.grasps[static_cast<std::size_t>(number) - 1]);
  }
  return {1};
}

int GraspsCount(LuaGrasps& grasps) { return static_cast<int>(grasps.grasps.size()); }
int GraspsFeasible(LuaGrasps& grasps) { return static_cast<int>(grasps.all->feasible.size()); }
double GraspsSuccess(LuaGrasps& grasps) { return grasps.all->r_suc(); }
double GraspsRawSuccess(LuaGrasps& grasps) { return grasps.all->r_suc_raw(); }

int GraspsToString(lua_State* L) {
  const auto grasps = FindObject<LuaGrasps>(L, 1);
  const std::string text = grasps ? fmt::format("Grasps({} of {} feasible)",
                                                GraspsFeasible(*grasps), GraspsCount(*grasps))
                                  : "Grasps";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// One grasp.

void GraspShot(lua_State* L, LuaGrasp& grasp, const ShotOptions& options) {
  ShootStep(L, *grasp.trajectory->planning, grasp.step, options);
}

bool GraspFeasible(LuaGrasp& grasp) { return grasp.grasp().feasible(); }
std::string GraspReason(LuaGrasp& grasp) { return GraspStatusName(grasp.grasp().result.status); }
std::string GraspRawReason(LuaGrasp& grasp) { return GraspStatusName(grasp.grasp().raw.status); }
std::string GraspText(LuaGrasp& grasp) {
  return Explain(grasp.grasp().result, grasp.trajectory->planning->planner.grasp_world());
}
int GraspSample(LuaGrasp& grasp) { return grasp.sample + 1; }
double GraspMoved(LuaGrasp& grasp) { return 1e3 * grasp.grasp().moved; }
int GraspRefinements(LuaGrasp& grasp) { return grasp.grasp().refinements; }
std::string GraspStepId(LuaGrasp& grasp) { return StepId(grasp.step); }
std::vector<std::string> GraspFingers(LuaGrasp& grasp) {
  std::vector<std::string> fingers;
  for (const GraspContact& contact : grasp.grasp().result.contacts) {
    fingers.emplace_back(FingerName(contact.finger));
  }
  return fingers;
}
Pushed GraspContacts(lua_State* L, LuaGrasp& grasp) {
  PushGraspContacts(L, grasp.grasp().result.contacts);
  return {1};
}
// nil where it was not tested
Pushed GraspWrench(lua_State* L, LuaGrasp& grasp) {
  const auto& wrench = grasp.grasp().result.wrench;
  wrench ? PushWrench(L, *wrench) : lua_pushnil(L);
  return {1};
}
Pushed GraspIk(lua_State* L, LuaGrasp& grasp) {
  const auto& kinematics = grasp.grasp().result.kinematics;
  kinematics ? PushIk(L, kinematics->ik) : lua_pushnil(L);
  return {1};
}
Pushed GraspLift(lua_State* L, LuaGrasp& grasp) {
  if (!grasp.lift()) {
    lua_pushnil(L);
    return {1};
  }
  RecordWriter(L, kLift)
      .Set("held", grasp.lift()->held)
      .Set("height", grasp.lift()->height)
      .Set("shift", grasp.lift()->shift)
      .Set("turn_deg", grasp.lift()->turn_deg)
      .Set("slip_mm", 1e3 * grasp.lift()->slip)
      .Set("direction_W", grasp.lift()->direction_W);
  return {1};
}

int GraspToString(lua_State* L) {
  const auto grasp = FindObject<LuaGrasp>(L, 1);
  const std::string text = grasp ? fmt::format("Grasp({}, {})", grasp->sample + 1,
                                               GraspStatusName(grasp->grasp().result.status))
                                 : "Grasp";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

Pushed TrajectoryGrasps(lua_State* L, const std::shared_ptr<LuaTrajectory>& trajectory,
                        const GraspsOptions& options) {
  PlannerConfig config = trajectory->config;
  options.ApplyTo(config);
  Planning& planning = *trajectory->planning;
  const Planner planner = planning.planner.WithConfig(config);
  // What the generator is asked to complete depends on the settings.
  const ReleaseResult release = planning.record.Time(
      "grasp", [&] { return planner.Release(trajectory->graph->state, trajectory->certificate); });
  const auto all = planning.record.Time("grasp", [&] {
    return std::make_shared<const GraspSet>(
        planner.CompleteGrasps(trajectory->certificate, release, trajectory->path_rank()));
  });
  auto grasps = std::make_shared<LuaGrasps>(LuaGrasps{all, {}});
  const int count = static_cast<int>(all->grasps.size());
  for (int sample = 0; sample < count; ++sample) {
    auto step = planning.Record(config, [&](PlanRecord& record) {
      record.AddGrasp(trajectory->certificate, trajectory->path_rank(), sample,
                      all->grasps[static_cast<std::size_t>(sample)]);
    });
    grasps->grasps.push_back(
        std::make_shared<LuaGrasp>(LuaGrasp{trajectory, config, all, sample, std::move(step)}));
  }
  planning.record.ChoosePath(*trajectory->mppi, trajectory->certificate, release, *all);
  planning.record.Publish();
  PushObject(L, std::move(grasps));
  CountMemory(L, kGraspKib * count);
  return {1};
}

const ClassInfo& GraspsClass() {
  static const FunctionInfo item = Method<&GraspsItem>("[]", "number");
  static const ClassInfo info{"Grasps",
                              {
                                  Method<&GraspsAll>("all"),
                                  Method<&GraspsBest>("best"),
                              },
                              {
                                  Property<&GraspsCount>("count"),
                                  Property<&GraspsFeasible>("num_feasible"),
                                  Property<&GraspsSuccess>("r_suc"),
                                  Property<&GraspsRawSuccess>("r_suc_raw"),
                              },
                              GraspsToString,
                              &item};
  return info;
}

const ClassInfo& GraspClass() {
  static const ClassInfo info{"Grasp",
                              {
                                  Method<&GraspMotion>("motion", "options"),
                                  Method<&GraspShot>("shot", "options"),
                              },
                              {
                                  Property<&GraspFeasible>("feasible"),
                                  Property<&GraspReason>("reason"),
                                  Property<&GraspRawReason>("raw_reason"),
                                  Property<&GraspText>("text"),
                                  Property<&GraspSample>("sample"),
                                  Property<&GraspFingers>("fingers"),
                                  Property<&GraspContacts>("contacts"),
                                  Property<&GraspMoved>("moved_mm"),
                                  Property<&GraspRefinements>("refinements"),
                                  Property<&GraspWrench>("wrench"),
                                  Property<&GraspIk>("ik"),
                                  Property<&GraspLift>("lift"),
                                  Property<&GraspStepId>("step_id"),
                              },
                              GraspToString};
  return info;
}

std::vector<const Schema*> GraspStageSchemas() { return {&kLift}; }

}  // namespace pregrasp
