#include <fmt/format.h>

#include <limits>

#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/job/run_summary.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kPlanOptions{"RunOptions", {"paths", "all", "plans", "motions", "set"}};

}  // namespace

PlanOptions LuaValue<PlanOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  const Fields fields(L, index, kPlanOptions);
  PlanOptions options;
  RunConfig& run = options.config;
  run.paths = fields.Optional<int>("paths", run.paths);
  run.all = fields.Optional<bool>("all", run.all);
  run.plans = fields.Optional<int>("plans", run.plans);
  run.motions = fields.Optional<int>("motions", run.motions);
  run.Validate();
  std::vector<Setting> settings = ReadSettings(L, fields);
  PlannerConfig config;
  std::vector<std::string> names;
  for (const Setting& setting : settings) names.push_back(setting.key);
  ApplyPlannerSettings(config, settings);
  RequireNoSettingsLeft(settings, PlannerRoots());
  config.Validate();
  for (const std::string& name : names) {
    run.settings[name] = FindPlannerSetting(name).GetJson(config);
  }
  return options;
}

namespace {

// Takes the run to its first `steps` steps, one new one after another until break_when says yes or
// `until` does. @returns whether break_when stopped it.
bool TakeSteps(lua_State* L, LuaPlan& plan, int steps,
               const std::function<bool(const RunPlace&)>& until) {
  Timeline& timeline = plan.session->timeline();
  const int before = plan.place.steps;
  bool stopped = false;
  RunPlace reached = plan.place;
  const auto finish = [&] {
    plan.place = reached;
    plan.ahead = std::max(plan.ahead, plan.place.steps);
    CountSteps(L, *plan.session);
  };
  try {
    reached = TakeRunSteps(timeline, plan.config, steps, [&](const RunPlace& place) {
      reached = place;
      if (place.steps <= before) return true;
      stopped = StopsAt(L, plan.session, *place.node);
      return !stopped && !(until && until(place));
    });
  } catch (const Interrupted&) {
    finish();
    throw;
  }
  finish();
  return stopped;
}

// Methods.

bool PlanStep(lua_State* L, LuaPlan& plan, const std::optional<int>& steps) {
  const int count = steps.value_or(1);
  if (count < 1) throw InputError("", "steps", "a whole number from 1", std::to_string(count));
  const int before = plan.place.steps;
  if (plan.place.result) return false;
  TakeSteps(L, plan, before + count, {});
  return plan.place.steps > before;
}

// Refuses what is no step's id in any run, before a minute is spent on the way to it.
void RequireStepOfARun(const std::string& id) {
  const std::string first = id.substr(0, id.find('.'));
  for (const char* word : {"scene", "graph", "paths", "path", "motion"}) {
    if (first == word && first != id) return;
  }
  throw InputError("", "to", "the id of a step of a run, as \"path.1.mppi.3\"",
                   '"' + OneLine(id) + '"');
}

bool PlanRun(lua_State* L, LuaPlan& plan, const std::optional<std::string>& to) {
  if (to) {
    RequireStepOfARun(*to);
    // One that was taken is gone to.
    const auto before = [&](const RunPlace& place) { return place.node->id() != *to; };
    const RunPlace taken = TakeRunSteps(plan.session->timeline(), plan.config, plan.ahead, before);
    if (taken.node != nullptr && taken.node->id() == *to) {
      plan.place = taken;
      return false;
    }
  }
  if (plan.place.result) return false;
  return TakeSteps(L, plan, std::numeric_limits<int>::max(),
                   [&](const RunPlace& place) { return to && place.node->id() == *to; });
}

// The kind of step: several verbs are of one stage of the pipeline.
std::string StageOf(const Timeline::Node& node) {
  const std::string stage = TimedStage(node.command.verb);
  return stage.empty() ? VerbName(node.command.verb) : stage;
}

bool PlanNextStage(lua_State* L, LuaPlan& plan) {
  if (plan.place.result) return false;
  const std::string now = plan.place.node == nullptr ? "" : StageOf(*plan.place.node);
  return TakeSteps(L, plan, std::numeric_limits<int>::max(),
                   [&](const RunPlace& place) { return StageOf(*place.node) != now; });
}

void MoveTo(LuaPlan& plan, int steps) {
  plan.place = TakeRunSteps(plan.session->timeline(), plan.config, steps, {});
}

void PlanBack(LuaPlan& plan, const std::optional<int>& steps) {
  const int count = steps.value_or(1);
  if (count < 0 || count > plan.place.steps) {
    throw InputError("", "steps", fmt::format("0 to {} steps", plan.place.steps),
                     std::to_string(count));
  }
  MoveTo(plan, plan.place.steps - count);
}

void PlanForward(LuaPlan& plan, const std::optional<int>& steps) {
  const int count = steps.value_or(1), most = plan.ahead - plan.place.steps;
  if (count < 0 || count > most) {
    throw InputError("", "steps", fmt::format("0 to {} steps, as it went back", most),
                     std::to_string(count));
  }
  MoveTo(plan, plan.place.steps + count);
}

Pushed PlanObject(lua_State* L, LuaPlan& plan) {
  const Timeline::Node* node = plan.place.node;
  return SessionGo(L, plan.session,
                   node == nullptr ? plan.session->timeline().root().id() : node->id());
}

std::string PlanSave(lua_State* L, LuaPlan& plan, const std::optional<std::string>& dir) {
  std::optional<std::filesystem::path> directory;
  if (dir) directory = Machine::Of(L).files().ResolveForWriting(*dir);
  return plan.session->Save(directory, plan.place.result ? plan.place.result->end : plan.place.node)
      .string();
}

Pushed PlanWhy(lua_State* L, LuaPlan& plan) {
  Explanation why;
  if (!plan.place.result) {
    why.verdict = "open";
    why.text = plan.place.node == nullptr
                   ? "The run has not begun"
                   : fmt::format("The run is at {} and has not ended", plan.place.node->id());
    return PushExplanation(L, why);
  }
  const RunResult& result = *plan.place.result;
  why.verdict = result.status;
  why.text = fmt::format("The run ended {} at {}", result.status, result.end->id());
  if (result.status == "start_graspable") {
    why.text += ": the object can be grasped where it stands";
  }
  for (const std::string& reason : result.reasons) why.text += "; " + reason;
  why.items = ExplainPathOf(plan.session->timeline(), *result.end).items;
  return PushExplanation(L, why);
}

// Why its result is not of another path.
Pushed PlanWhyNot(lua_State* L, LuaPlan& plan, int path) {
  if (!plan.place.result) {
    throw InputError("", "", "a run that has ended", "one that has not");
  }
  RequireRank(path);
  return PushExplanation(
      L, ExplainPathAgainstEnd(plan.session->timeline(), *plan.place.result->end, path));
}

// Properties.

int PlanSteps(LuaPlan& plan) { return plan.place.steps; }
// "" before the first
std::string PlanStepId(LuaPlan& plan) {
  return plan.place.node == nullptr ? "" : plan.place.node->id();
}
bool PlanFinished(LuaPlan& plan) { return plan.place.result.has_value(); }
// nil before its end
std::optional<std::string> PlanStatus(LuaPlan& plan) {
  if (!plan.place.result) return std::nullopt;
  return plan.place.result->status;
}
// nil before its end
std::optional<std::string> PlanEnd(LuaPlan& plan) {
  if (!plan.place.result) return std::nullopt;
  return plan.place.result->end->id();
}
std::vector<std::string> PlanReasons(LuaPlan& plan) {
  return plan.place.result ? plan.place.result->reasons : std::vector<std::string>{};
}
std::string PlanStage(LuaPlan& plan) { return plan.place.progress.stage; }

int PlanToString(lua_State* L) {
  const auto plan = FindObject<LuaPlan>(L, 1);
  LuaValue<std::string>::Push(
      L,
      !plan ? "Plan"
            : fmt::format("Plan({} step{}{})", plan->place.steps, plan->place.steps == 1 ? "" : "s",
                          plan->place.result ? ", " + plan->place.result->status : ""));
  return 1;
}

}  // namespace

Pushed SessionPlan(lua_State* L, const std::shared_ptr<Session>& session,
                   const PlanOptions& options) {
  PushObject(L, std::make_shared<LuaPlan>(LuaPlan{session, options.config, {}, 0}));
  return {1};
}

const ClassInfo& PlanClass() {
  static const ClassInfo info{"Plan",
                              {
                                  Method<&PlanStep>("step", "steps"),
                                  Method<&PlanRun>("run", "to"),
                                  Method<&PlanNextStage>("next_stage"),
                                  Method<&PlanBack>("back", "steps"),
                                  Method<&PlanForward>("forward", "steps"),
                                  Method<&PlanObject>("object"),
                                  Query<&PlanWhy>("why"),
                                  Query<&PlanWhyNot>("why_not", "path"),
                                  Method<&PlanSave>("save", "dir"),
                              },
                              {
                                  Property<&PlanSteps>("num_steps"),
                                  Property<&PlanStepId>("step_id"),
                                  Property<&PlanStage>("stage"),
                                  Property<&PlanFinished>("finished"),
                                  Property<&PlanStatus>("status"),
                                  Property<&PlanEnd>("end_id"),
                                  Property<&PlanReasons>("reasons"),
                              },
                              PlanToString};
  return info;
}

std::vector<const Schema*> PlanSchemas() { return {&kPlanOptions}; }

}  // namespace pregrasp
