#include <fmt/format.h>

#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kLift{"Lift",
                   {"held", "reasons", "text", "height", "shift_mm", "turn_deg", "slip_mm",
                    "direction_W", "pushes", "soft", "stiff", "forearm_free", "not_converged",
                    "unresolved_mm", "neighbours", "step_id"}};

// All grasps of a trajectory.

Pushed GraspsAll(lua_State* L, LuaGrasps& grasps) {
  LuaValue<std::vector<std::shared_ptr<LuaGrasp>>>::Push(L, grasps.grasps);
  return PushIpairs(L);
}

// The most promising; nil where none is feasible.
Pushed GraspsBest(lua_State* L, LuaGrasps& grasps) {
  const std::vector<int> order = OrderGrasps(*grasps.state());
  if (order.empty()) {
    lua_pushnil(L);
  } else {
    PushObject(L, grasps.grasps[static_cast<std::size_t>(order.front()) - 1]);
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

GraspWithLift FactsOf(const LuaGrasp& grasp) {
  return {&grasp.facts(),
          grasp.lift == nullptr ? nullptr : &std::get<LiftFacts>(grasp.lift->facts.details)};
}

Pushed GraspsWhy(lua_State* L, LuaGrasps& grasps) {
  std::vector<GraspWithLift> all;
  for (const auto& grasp : grasps.grasps) all.push_back(FactsOf(*grasp));
  return PushExplanation(L, ExplainGrasps(all));
}

int GraspsCount(LuaGrasps& grasps) { return static_cast<int>(grasps.grasps.size()); }
int GraspsFeasible(LuaGrasps& grasps) { return grasps.node->progress.feasible; }
int GraspsLifting(LuaGrasps& grasps) { return grasps.node->progress.lifted; }
double GraspsSuccess(LuaGrasps& grasps) {
  const auto state = grasps.state();
  return state->grasps ? state->grasps->r_suc() : 0.0;
}
double GraspsRawSuccess(LuaGrasps& grasps) {
  const auto state = grasps.state();
  return state->grasps ? state->grasps->r_suc_raw() : 0.0;
}
// As r_suc: of the generator's samples alone.
double GraspsLiftSuccess(LuaGrasps& grasps) {
  int generated = 0, lifting = 0;
  for (const auto& grasp : grasps.grasps) {
    if (grasp->facts().source != GraspSourceName(GraspSource::kGenerator)) continue;
    ++generated;
    const bool lifted = grasp->lift != nullptr;
    lifting += lifted && std::get<LiftFacts>(grasp->lift->facts.details).held ? 1 : 0;
  }
  return generated == 0 ? 0.0 : static_cast<double>(lifting) / generated;
}

int GraspsToString(lua_State* L) {
  const auto grasps = FindObject<LuaGrasps>(L, 1);
  const std::string text = grasps ? fmt::format("Grasps({} of {} feasible)",
                                                GraspsFeasible(*grasps), GraspsCount(*grasps))
                                  : "Grasps";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

// One grasp.

Pushed GraspWhy(lua_State* L, LuaGrasp& grasp) {
  const GraspWithLift facts = FactsOf(grasp);
  return PushExplanation(L, ExplainGrasp(*facts.grasp, facts.lift));
}

// Without another: the one that best() gives of the same trajectory.
Pushed GraspWhyNot(lua_State* L, LuaGrasp& grasp,
                   const std::optional<std::shared_ptr<LuaGrasp>>& other) {
  if (other) return PushExplanation(L, ExplainGraspAgainst(FactsOf(grasp), FactsOf(**other)));
  const std::vector<int> order = OrderGrasps(*grasp.all.state());
  if (order.empty()) {
    throw InputError("", "other", "a grasp, as none is feasible", "nothing");
  }
  LuaGrasp best{grasp.all, nullptr, nullptr};
  for (const Timeline::Node* node : PathTo(*grasp.all.node)) {
    const auto* tested = std::get_if<GraspFacts>(&node->facts.details);
    const auto* lift = std::get_if<LiftFacts>(&node->facts.details);
    if (tested != nullptr && tested->entry == order.front()) best.step = node;
    if (lift != nullptr && lift->grasp == order.front()) best.lift = node;
  }
  return PushExplanation(L, ExplainGraspAgainst(FactsOf(grasp), FactsOf(best)));
}

void GraspShot(lua_State* L, LuaGrasp& grasp, const ShotOptions& options) {
  TakeShot(L, *grasp.all.session, *grasp.step, options);
}

bool GraspFeasible(LuaGrasp& grasp) { return grasp.facts().feasible; }
std::string GraspReason(LuaGrasp& grasp) { return grasp.facts().status; }
std::string GraspRawReason(LuaGrasp& grasp) { return grasp.facts().raw_status; }
std::string GraspText(LuaGrasp& grasp) { return grasp.facts().sentence; }
std::string SourceOfGrasp(LuaGrasp& grasp) { return grasp.facts().source; }
int GraspSample(LuaGrasp& grasp) { return grasp.facts().number; }
double GraspMoved(LuaGrasp& grasp) { return grasp.facts().moved_mm; }
int GraspRefinements(LuaGrasp& grasp) { return grasp.facts().refinements; }
std::string GraspStepId(LuaGrasp& grasp) { return grasp.step->id(); }
std::vector<std::string> GraspFingers(LuaGrasp& grasp) {
  std::vector<std::string> fingers;
  for (const GraspContactFacts& contact : grasp.facts().contacts) {
    fingers.emplace_back(FingerName(contact.finger));
  }
  return fingers;
}
Pushed GraspContacts(lua_State* L, LuaGrasp& grasp) {
  PushGraspContacts(L, grasp.grasp(*grasp.all.state()).result.contacts);
  return {1};
}
// nil where it was not tested
Pushed GraspWrench(lua_State* L, LuaGrasp& grasp) {
  const auto state = grasp.all.state();
  const auto& wrench = grasp.grasp(*state).result.wrench;
  wrench ? PushWrench(L, *wrench) : lua_pushnil(L);
  return {1};
}
Pushed GraspIk(lua_State* L, LuaGrasp& grasp) {
  const auto state = grasp.all.state();
  const auto& kinematics = grasp.grasp(*state).result.kinematics;
  kinematics ? PushIk(L, grasp.all.session->job().hand(), kinematics->ik) : lua_pushnil(L);
  return {1};
}
// nil where it is not feasible
Pushed GraspLift(lua_State* L, LuaGrasp& grasp) {
  if (grasp.lift == nullptr) {
    lua_pushnil(L);
    return {1};
  }
  const auto& lift = std::get<LiftFacts>(grasp.lift->facts.details);
  RecordWriter record(L, kLift);
  PushNeighbours(L, lift.neighbours);
  record.SetTop("neighbours")
      .Set("held", lift.held)
      .Set("reasons", lift.reasons)
      .Set("text", lift.sentence)
      .Set("height", lift.height_m)
      .Set("shift_mm", lift.shift_mm)
      .Set("turn_deg", lift.turn_deg)
      .Set("slip_mm", lift.slip_mm)
      .Set("direction_W", lift.direction_W)
      .Set("pushes", lift.pushes)
      .Set("soft", lift.soft)
      .Set("stiff", lift.stiff)
      .Set("forearm_free", lift.forearm_free)
      .Set("not_converged", lift.not_converged)
      .Set("unresolved_mm", lift.unresolved_mm)
      .Set("step_id", grasp.lift->id());
  return {1};
}

int GraspToString(lua_State* L) {
  const auto grasp = FindObject<LuaGrasp>(L, 1);
  const std::string text =
      grasp ? fmt::format("Grasp({}, {})", grasp->entry(), grasp->facts().status) : "Grasp";
  lua_pushlstring(L, text.data(), text.size());
  return 1;
}

}  // namespace

std::shared_ptr<LuaGrasps> FindGrasps(const std::shared_ptr<Session>& session,
                                      const Timeline::Node& certified, nlohmann::json options) {
  const Timeline::Node& end = CompleteGrasps(session->timeline(), certified, std::move(options));
  auto grasps = std::make_shared<LuaGrasps>(LuaGrasps{{session, &end}, {}});
  for (const Timeline::Node* node : PathTo(end)) {
    if (node->number <= certified.number) continue;
    if (std::holds_alternative<GraspFacts>(node->facts.details)) {
      grasps->grasps.push_back(
          std::make_shared<LuaGrasp>(LuaGrasp{{session, &end}, node, nullptr}));
    } else if (const auto* lift = std::get_if<LiftFacts>(&node->facts.details)) {
      grasps->grasps[static_cast<std::size_t>(lift->grasp) - 1]->lift = node;
    }
  }
  return grasps;
}

Pushed TrajectoryGrasps(lua_State* L, LuaTrajectory& trajectory, const GraspsOptions& options) {
  nlohmann::json command = nlohmann::json::object();
  if (!options.fields.empty()) command["settings"] = options.ToSettings();
  const std::shared_ptr<Session>& session = trajectory.session;
  if (trajectory.state()->release->conditions.empty()) {  // a fingertip can be nowhere on it
    PushObject(L, std::make_shared<LuaGrasps>(LuaGrasps{{session, trajectory.node}, {}}));
    return {1};
  }
  auto grasps = FindGrasps(session, *trajectory.node, std::move(command));
  for (const auto& grasp : grasps->grasps) {
    if (StopsAt(L, session, *grasp->step)) break;
    if (grasp->lift != nullptr && StopsAt(L, session, *grasp->lift)) break;
  }
  CountSteps(L, *session);
  PushObject(L, std::move(grasps));
  return {1};
}

const ClassInfo& GraspsClass() {
  static const FunctionInfo item = Method<&GraspsItem>("[]", "number");
  static const ClassInfo info{"Grasps",
                              {
                                  Method<&GraspsAll>("all"),
                                  Method<&GraspsBest>("best"),
                                  Query<&GraspsWhy>("why"),
                              },
                              {
                                  Property<&GraspsCount>("count"),
                                  Property<&GraspsFeasible>("num_feasible"),
                                  Property<&GraspsSuccess>("r_suc"),
                                  Property<&GraspsRawSuccess>("r_suc_raw"),
                                  Property<&GraspsLifting>("num_lifting"),
                                  Property<&GraspsLiftSuccess>("r_lift"),
                              },
                              GraspsToString,
                              &item};
  return info;
}

const ClassInfo& GraspClass() {
  static const ClassInfo info{"Grasp",
                              {
                                  Method<&GraspMotion>("motion", "options"),
                                  Query<&GraspWhy>("why"),
                                  Query<&GraspWhyNot>("why_not", "other"),
                                  Method<&GraspShot>("shot", "options"),
                              },
                              {
                                  Property<&GraspFeasible>("feasible"),
                                  Property<&GraspReason>("reason"),
                                  Property<&GraspRawReason>("raw_reason"),
                                  Property<&GraspText>("text"),
                                  Property<&GraspSample>("sample"),
                                  Property<&SourceOfGrasp>("source"),
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
