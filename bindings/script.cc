#include "bindings/script.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/data_folder.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/job/planner_settings.h"
#include "app/recording/build_info.h"
#include "bindings/lua_array.h"
#include "bindings/lua_grasp.h"
#include "bindings/lua_planner.h"
#include "bindings/lua_run.h"
#include "bindings/lua_scene.h"
#include "bindings/lua_session.h"
#include "bindings/lua_study.h"
#include "bindings/sandbox.h"
#include "bindings/scene_argument.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const char kContextKey = 0;  // registry key, by address

const Schema kOpenOptions{"OpenOptions", {"seed", "threads", "set"}};

struct OpenOptions {
  std::optional<std::int64_t> seed;
  std::optional<int> threads;
  std::vector<Setting> settings;
};

}  // namespace

fs::path WeightsFolder(const ScriptConfig& config) {
  return config.weights.empty() ? DataFolder() / "assets" / "weights" : config.weights;
}

// set = { ["fingertips.friction"] = 0.5, ["object.p"] = {0, 0, 0.1} }
std::vector<Setting> ReadSettings(lua_State* L, const Fields& fields) {
  std::vector<Setting> settings;
  fields.Push("set");
  if (lua_isnil(L, -1)) {
    lua_pop(L, 1);
    return settings;
  }
  if (!lua_istable(L, -1)) fields.Refuse("set", "a table {[\"object.mass\"] = 0.2, ..}");
  lua_pushnil(L);
  while (lua_next(L, -2) != 0) {
    const std::string key = KeyText(L, -2);
    std::string value;
    if (lua_istable(L, -1) || FindArray(L, -1)) {
      const Vector3 v = LuaValue<Vector3>::Read(L, -1, "set." + key);
      value = fmt::format("{},{},{}", v.x(), v.y(), v.z());
    } else if (lua_type(L, -1) == LUA_TSTRING) {
      value = LuaValue<std::string>::Read(L, -1, "set." + key);
    } else if (lua_type(L, -1) == LUA_TBOOLEAN) {
      value = lua_toboolean(L, -1) != 0 ? "true" : "false";
    } else {
      value = FormatDouble(LuaValue<double>::Read(L, -1, "set." + key));
    }
    settings.push_back({key, value, "set"});
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  std::sort(settings.begin(), settings.end(),
            [](const Setting& a, const Setting& b) { return a.key < b.key; });
  return settings;
}

template <>
struct LuaValue<OpenOptions> {
  static OpenOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kOpenOptions);
    return {fields.Find<std::int64_t>("seed"), fields.Find<int>("threads"),
            ReadSettings(L, fields)};
  }
};

namespace {

std::shared_ptr<Session> Open(lua_State* L, SceneArgument& argument, OpenOptions& options) {
  const ScriptContext& context = ScriptContext::Of(L);
  Scene scene = LoadScene(L, std::move(argument), options.settings);
  SessionConfig config;
  ApplyPlannerSettings(config.planner, options.settings);
  RequireNoSettingsLeft(options.settings, PlannerRoots());
  config.seed = static_cast<std::uint64_t>(
      options.seed.value_or(static_cast<std::int64_t>(context.config.machine.seed)));
  if (options.threads) RequireWithin("", "threads", ThreadPool::kThreads, *options.threads);
  config.threads = options.threads.value_or(context.config.threads);
  config.pictures = context.config.pictures;
  config.command = context.config.remake;
  config.weights = WeightsFolder(context.config);
  constexpr int kSessionKib = 2000;
  CountMemory(L, kSessionKib);
  MemoryClaim claim = ClaimMemory(L, std::size_t{kSessionKib} << 10U);
  auto session = std::make_shared<Session>(std::move(scene), config);
  session->claim() = std::move(claim);
  return session;
}

// What there is to say of a scene, be it such that no session of it can be opened.
Pushed CheckArgument(lua_State* L, SceneArgument& argument) {
  std::vector<Setting> none;
  return PushCheck(L, LoadScene(L, std::move(argument), none));
}

const std::vector<FunctionInfo>& SceneFunctions() {
  static const std::vector<FunctionInfo> functions = {Function<&Open>("open", "scene, options"),
                                                      Function<&CheckArgument>("check", "scene")};
  return functions;
}

Api MakeApi() {
  Api api;
  static Schema module{"pregrasp", {"version", "seed"}};
  for (const FunctionInfo& function : SceneFunctions()) api.functions.push_back(&function);
  for (const FunctionInfo& constructor : SceneConstructors()) api.functions.push_back(&constructor);
  for (const FunctionInfo& function : GraspFunctions()) api.functions.push_back(&function);
  for (const FunctionInfo& function : RunFunctions()) api.functions.push_back(&function);
  for (const FunctionInfo& function : StudyFunctions()) api.functions.push_back(&function);
  for (const FunctionInfo& function : TimelineFunctions()) api.functions.push_back(&function);
  for (const FunctionInfo* function : api.functions) module.keys.push_back(function->name);
  api.module = &module;
  api.classes = {&SessionClass(), &SimulationClass(), &RunClass()};
  for (const ClassInfo* scene_class : SceneClasses()) api.classes.push_back(scene_class);
  for (const ClassInfo* stage : PlannerClasses()) api.classes.push_back(stage);
  api.schemas = {&kOpenOptions};
  for (const auto& schemas :
       {SceneSchemas(), SessionSchemas(), SimulationSchemas(), GeometrySchemas(), GraspSchemas(),
        StageOptionSchemas(), GraphSchemas(), PathSchemas(), TrajectorySchemas(),
        GraspStageSchemas(), MotionSchemas(), EventSchemas(), ReasonSchemas(), RolloutSchemas(),
        TimelineSchemas(), RunSchemas(), WhatIfSchemas(), PlanSchemas(), StudySchemas()}) {
    api.schemas.insert(api.schemas.end(), schemas.begin(), schemas.end());
  }
  return api;
}

}  // namespace

const Api& GetApi() {
  static const Api api = MakeApi();
  return api;
}

ScriptContext& ScriptContext::Of(lua_State* L) {
  lua_rawgetp(L, LUA_REGISTRYINDEX, &kContextKey);
  auto* context = static_cast<ScriptContext*>(lua_touserdata(L, -1));
  lua_pop(L, 1);
  return *context;
}

ScriptMachine::ScriptMachine(const ScriptConfig& config)
    : context_{config, {}, {}, {}, {}}, machine_(config.machine) {
  machine_.files().AllowProgramFiles(DataFolder());
  machine_.files().SetOutput(config.output);
  lua_State* L = machine_.state();
  lua_pushlightuserdata(L, &context_);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kContextKey);
  const Api& api = GetApi();
  RecordWriter module(L, *api.module);
  module.Set("version", ProgramVersion());
  module.Set("seed", static_cast<std::int64_t>(config.machine.seed));
  for (const FunctionInfo* function : api.functions) {
    PushFunction(L, *function);
    module.SetTop(function->name);
  }
  MakeReadOnly(L);
  SetModule(L, "pregrasp");
}

void ScriptMachine::FinishRecordings(const std::optional<std::string>& status,
                                     const std::string& error) {
  for (const auto& session : context_.recording) {
    session->FinishRecording(status, nullptr, error);
  }
}

void ScriptMachine::FinishFailedRecordings(const std::string& error) {
  try {
    FinishRecordings("failed", OneLine(error));
  } catch (const InputError&) {
    // It cannot be kept; what it failed for is told all the same.
  }
}

void LeaveNothingOnFailure(const ScriptConfig& config, const std::function<void()>& body) {
  std::error_code ignored;
  const bool had_output = fs::exists(config.output, ignored);
  try {
    body();
  } catch (const std::exception&) {
    // Where nothing was recorded, the folder that was made for it is gone too.
    if (!had_output) fs::remove(config.output, ignored);
    throw;
  }
}

namespace {

void RunInMachine(const fs::path& file, const std::vector<std::string>& arguments,
                  const ScriptConfig& config) {
  ScriptMachine script(config);
  Machine& machine = script.machine();
  lua_State* L = machine.state();
  machine.LoadFile(L, file);
  const int count = static_cast<int>(arguments.size());
  if (lua_checkstack(L, count + 2) == 0) {
    throw InputError("ARGS", "", "fewer arguments", std::to_string(count));
  }
  for (const std::string& argument : arguments) {
    lua_pushlstring(L, argument.data(), argument.size());
  }
  try {
    machine.Call(count, 0);
    script.FinishRecordings(std::nullopt);
  } catch (const Interrupted&) {
    ClearInterrupt();
    script.FinishRecordings("interrupted");
    throw;
  } catch (const InputError& error) {
    script.FinishFailedRecordings(error.what());
    throw;
  }
}

}  // namespace

void RunScript(const fs::path& file, const std::vector<std::string>& arguments,
               const ScriptConfig& config) {
  LeaveNothingOnFailure(config, [&] { RunInMachine(file, arguments, config); });
}

}  // namespace pregrasp
