#include <algorithm>
#include <numeric>

#include "app/job/plan_triangles.h"
#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"

namespace pregrasp {
namespace {

const Schema kRollout{"Rollout", {"number", "cost", "weight", "terms", "X_WO", "stages"}};
const Schema kRolloutStage{"RolloutStage", {"thumb", "index"}};
const Schema kRolloutFinger{"RolloutFinger", {"on", "kept", "triangle", "p_OC", "nhat_O", "knots"}};
const Schema kRolloutKnot{"RolloutKnot", {"depth", "tangent", "travel_W"}};
const Schema kTraceRow{"TraceRow", {"t", "X_WO", "fingers"}};
const Schema kTraceFinger{"TraceFinger",
                          {"finger", "touching", "slipping", "p_WF", "p_WTarget", "f_W"}};
const Schema kPlanChoice{"PlanChoice", {"number", "cost", "terms", "X_WO", "stages"}};

// The last iteration. @throws InputError before the first.
const IterationFacts& LastIteration(const LuaOptimizer& optimizer) {
  if (optimizer.facts() == nullptr) {
    throw InputError("", "", "an optimisation with an iteration", "one before its first step()");
  }
  return *optimizer.facts();
}

void RequireRollout(const IterationFacts& facts, int number, const char* field) {
  const auto count = std::ssize(facts.rollouts);
  if (number >= 1 && number <= count) return;
  throw InputError("", field, "a rollout from 1 to " + std::to_string(count),
                   std::to_string(number));
}

// What an action asks of the fingers, stage by stage.
void PushStages(lua_State* L, const Mppi& mppi, const std::vector<double>& action) {
  const RelativePlan plan = mppi.Decode(action);
  lua_createtable(L, static_cast<int>(plan.stages.size()), 0);
  const auto triangles = TrianglesOf(mppi, plan.stages);
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    RecordWriter stage(L, kRolloutStage);
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const FingerStage& finger = plan.stages[i][f];
      RecordWriter record(L, kRolloutFinger);
      record.Set("on", finger.on).Set("kept", finger.kept).Set("triangle", triangles[i][f]);
      if (finger.on && !finger.kept) {
        record.Set("p_OC", finger.contact.p_OC).Set("nhat_O", finger.contact.nhat_O);
      }
      lua_createtable(L, static_cast<int>(finger.knots.size()), 0);
      for (std::size_t k = 0; finger.on && k < finger.knots.size(); ++k) {
        const FingerStage::Knot& knot = finger.knots[k];
        RecordWriter(L, kRolloutKnot)
            .Set("depth", knot.depth)
            .Set("tangent", std::vector<double>{knot.tangent.x(), knot.tangent.y()})
            .Set("travel_W", knot.travel_W);
        lua_rawseti(L, -2, static_cast<lua_Integer>(k) + 1);
      }
      record.SetTop("knots");
      stage.SetTop(FingerName(static_cast<Finger>(f)));
    }
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
}

// A rollout of the last iteration, with its plan where `mppi` is given.
void PushRollout(lua_State* L, const IterationFacts& facts, int number, const Mppi* mppi,
                 const std::vector<double>* action) {
  const RolloutFacts& rollout = facts.rollouts[static_cast<std::size_t>(number) - 1];
  RecordWriter record(L, kRollout);
  record.Set("number", number).Set("cost", rollout.cost.total).Set("weight", rollout.weight);
  PushCost(L, rollout.cost);
  record.SetTop("terms");
  PushTransform(L, MakeTransform(rollout.q_WO_end, rollout.p_WO_end));
  record.SetTop("X_WO");
  if (mppi == nullptr) return;
  PushStages(L, *mppi, *action);
  record.SetTop("stages");
}

int RequireStride(const std::optional<int>& every) {
  const int stride = every.value_or(10);
  if (stride >= 1) return stride;
  throw InputError("", "every", "a whole number of physics steps from 1", std::to_string(stride));
}

// Every `stride`-th of `count` rows, and the last.
std::vector<int> RowsOfTrace(int count, int stride) {
  std::vector<int> rows;
  for (int i = 0; i < count; i += stride) rows.push_back(i);
  if (count > 0 && rows.back() != count - 1) rows.push_back(count - 1);
  return rows;
}

void PushTraceRow(lua_State* L, const WorldState& at) {
  RecordWriter record(L, kTraceRow);
  record.Set("t", at.t);
  PushTransform(L, at.bodies.front().X_WB());
  record.SetTop("X_WO");
  lua_createtable(L, 0, 0);
  lua_Integer count = 0;
  for (int f = 0; f < kNumFingers; ++f) {
    const FingertipState& tip = at.fingers[f];
    if (!tip.on) continue;
    RecordWriter(L, kTraceFinger)
        .Set("finger", static_cast<Finger>(f))
        .Set("touching", tip.touching)
        .Set("slipping", tip.slipping)
        .Set("p_WF", tip.p_WF)
        .Set("p_WTarget", tip.p_WTarget)
        .Set("f_W", tip.f_W);
    lua_rawseti(L, -2, ++count);
  }
  record.SetTop("fingers");
}

}  // namespace

LuaArray OptimizerRollouts(LuaOptimizer& optimizer) {
  LuaArray rollouts{"Rollout", 0, {}};
  const IterationFacts* facts = optimizer.facts();
  if (facts == nullptr) return rollouts;
  rollouts.count = static_cast<int>(facts->rollouts.size());
  rollouts.push = [session = optimizer.session, facts](lua_State* L, int rollout) {
    PushRollout(L, *facts, rollout + 1, nullptr, nullptr);  // the session keeps its steps
  };
  return rollouts;
}

Pushed OptimizerElite(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& count) {
  const IterationFacts& facts = LastIteration(optimizer);
  std::vector<int> order(facts.rollouts.size());
  std::iota(order.begin(), order.end(), 1);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return facts.rollouts[static_cast<std::size_t>(a) - 1].weight >
           facts.rollouts[static_cast<std::size_t>(b) - 1].weight;
  });
  const auto shown = std::clamp<std::ptrdiff_t>(count.value_or(5), 0, std::ssize(order));
  lua_createtable(L, static_cast<int>(shown), 0);
  for (std::ptrdiff_t i = 0; i < shown; ++i) {
    PushRollout(L, facts, order[static_cast<std::size_t>(i)], nullptr, nullptr);
    lua_rawseti(L, -2, i + 1);
  }
  return {1};
}

Pushed OptimizerRollout(lua_State* L, LuaOptimizer& optimizer, int number) {
  const IterationFacts& facts = LastIteration(optimizer);
  RequireRollout(facts, number, "number");
  const auto state = optimizer.state();
  PushRollout(L, facts, number, state->mppi.get(),
              &state->optimization->samples[static_cast<std::size_t>(number) - 1].action);
  return {1};
}

LuaArray OptimizerTrace(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& number,
                        const std::optional<int>& every) {
  const IterationFacts& facts = LastIteration(optimizer);
  if (number) RequireRollout(facts, *number, "number");
  const int stride = RequireStride(every);
  const auto state = optimizer.state();
  const std::vector<double>& action =
      number ? state->optimization->samples[static_cast<std::size_t>(*number) - 1].action
             : state->optimization->best_action;
  std::vector<TraceRow> trace;
  state->mppi->Simulate(action, &trace);
  std::vector<WorldState> rows;
  for (const int row : RowsOfTrace(static_cast<int>(trace.size()), stride)) {
    rows.push_back(std::move(trace[static_cast<std::size_t>(row)].state));
    rows.back().cache = {};
  }
  std::size_t bytes = 0;
  for (const WorldState& row : rows) bytes += sizeof(row) + row.bodies.size() * sizeof(BodyState);
  const auto shared = ShareArrayData(L, std::move(rows), bytes);
  const auto push = [shared](lua_State* machine, int row) {
    PushTraceRow(machine, (*shared)[static_cast<std::size_t>(row)]);
  };
  return {"TraceRow", static_cast<int>(shared->size()), push};
}

LuaArray TrajectoryTrace(lua_State* L, LuaTrajectory& trajectory, const std::optional<int>& every) {
  const auto certificate = trajectory.state()->certificate;
  const std::vector<TraceRow>& trace = certificate->trace;
  std::vector<int> rows = RowsOfTrace(static_cast<int>(trace.size()), RequireStride(every));
  std::size_t bytes = rows.size() * sizeof(int);
  for (const TraceRow& row : trace) {
    bytes += sizeof(row) + row.state.bodies.size() * sizeof(BodyState) +
             row.state.cache.size() * sizeof(WorldState::CachedImpulse) +
             row.contacts.size() * sizeof(ContactPoint);
  }
  const auto count = static_cast<int>(rows.size());
  const auto push = [held = ShareArrayData(L, certificate, bytes), &trace, rows = std::move(rows)](
                        lua_State* state, int row) {
    const int step = rows[static_cast<std::size_t>(row)];
    PushTraceRow(state, trace[static_cast<std::size_t>(step)].state);
  };
  return {"TraceRow", count, push};
}

Pushed OptimizerWhy(lua_State* L, LuaOptimizer& optimizer, const std::optional<int>& number) {
  const IterationFacts& facts = LastIteration(optimizer);
  return PushExplanation(L, ExplainRollout(facts, number.value_or(FindBestRollout(facts))));
}

Pushed OptimizerWhyNot(lua_State* L, LuaOptimizer& optimizer, int number,
                       const std::optional<int>& other) {
  const IterationFacts& facts = LastIteration(optimizer);
  return PushExplanation(
      L, ExplainRolloutAgainst(facts, number, other.value_or(FindBestRollout(facts))));
}

// nil before the first iteration
Pushed OptimizerNominal(lua_State* L, LuaOptimizer& optimizer) {
  const auto state = optimizer.state();
  if (!state->mppi) {
    lua_pushnil(L);
    return {1};
  }
  const bool picked = optimizer.nominal > 0 && optimizer.facts() != nullptr;
  PushStages(
      L, *state->mppi,
      picked ? state->optimization->samples[static_cast<std::size_t>(optimizer.nominal) - 1].action
             : state->optimization->mean);
  return {1};
}

Pushed OptimizerPlans(lua_State* L, LuaOptimizer& optimizer) {
  lua_createtable(L, 0, 0);
  const auto state = optimizer.state();
  if (!state->mppi) return {1};
  const std::vector<MppiPlan>& plans = state->optimization->plans;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    RecordWriter record(L, kPlanChoice);
    record.Set("number", static_cast<int>(i) + 1).Set("cost", plans[i].cost.total);
    CostFacts cost{plans[i].cost.total, plans[i].cost.stage_scores, plans[i].cost.final_score,
                   plans[i].cost.room,  plans[i].cost.reward,       {}};
    for (const CostTerm& term : CostTerms()) {
      cost.terms.push_back({term.name, plans[i].cost.*term.value});
    }
    PushCost(L, cost);
    record.SetTop("terms");
    PushTransform(L, plans[i].X_WO_end);
    record.SetTop("X_WO");
    PushStages(L, *state->mppi, plans[i].action);
    record.SetTop("stages");
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  return {1};
}

namespace {

// The settings that the next iteration has.
PlannerConfig NextConfig(const LuaOptimizer& optimizer) {
  PlannerConfig config = optimizer.state()->config;
  ApplySettings(optimizer.settings, config);
  return config;
}

}  // namespace

Pushed OptimizerSettings(lua_State* L, LuaOptimizer& optimizer) {
  const PlannerConfig config = NextConfig(optimizer);
  lua_createtable(L, 0, 0);
  for (const PlannerSetting& setting : SettingsTable()) {
    if (setting.root() != "mppi") continue;
    const FieldValue value = setting.Get(config);
    if (const double* number = std::get_if<double>(&value)) {
      lua_pushnumber(L, *number);
    } else if (const bool* flag = std::get_if<bool>(&value)) {
      lua_pushboolean(L, *flag);
    } else {
      LuaValue<std::string>::Push(L, std::get<std::string>(value));
    }
    lua_setfield(L, -2, setting.key().c_str());
  }
  return {1};
}

double OptimizerSigma(LuaOptimizer& optimizer) {
  const auto state = optimizer.state();
  const int done = optimizer.facts() == nullptr ? 0 : optimizer.facts()->iteration;
  if (state->mppi && optimizer.settings.empty()) return state->mppi->CalcSigma(done);
  const PlannerConfig config = NextConfig(optimizer);
  return state->planner->WithConfig(config)
      .MakeMppi(*state->graph, *state->path, config.mppi)
      .CalcSigma(done);
}

std::vector<const Schema*> RolloutSchemas() {
  return {&kRollout,  &kRolloutStage, &kRolloutFinger, &kRolloutKnot,
          &kTraceRow, &kTraceFinger,  &kPlanChoice};
}

}  // namespace pregrasp
