#include "bindings/lua_study.h"

#include "app/core/thread_pool.h"
#include "app/job/planner_settings.h"
#include "app/studies/eval.h"
#include "bindings/function.h"
#include "bindings/ladder_file.h"
#include "bindings/lua_planner.h"
#include "bindings/lua_run.h"
#include "bindings/scene_argument.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

const Schema kEvalOptions{
    "EvalOptions",
    {"dir", "study", "scenes", "seeds", "first_seed", "paths", "set", "threads", "keep_runs"}};

// eval{..}; the folders are yet to be found.
struct EvalArgument {
  std::string dir;
  const StudyInfo* study = nullptr;
  std::vector<SceneArgument> scenes;  // or ladders, by their files
  StudySetup setup;
  bool keep_runs = false;
  std::vector<Setting> settings;
};

const StudyInfo& ReadStudy(const Fields& fields) {
  const std::string name = fields.Optional<std::string>("study", Studies().front().name);
  std::string names;
  for (const StudyInfo& study : Studies()) {
    if (study.name == name) return study;
    names += (names.empty() ? "" : ", ") + study.name;
  }
  fields.Refuse("study", names);
}

}  // namespace

template <>
struct LuaValue<EvalArgument> {
  static EvalArgument Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kEvalOptions);
    EvalArgument argument;
    argument.dir = fields.Required<std::string>("dir");
    argument.study = &ReadStudy(fields);
    if (argument.study->subject == StudySubject::kMade) {
      if (fields.Has("scenes"))
        fields.Refuse("scenes", "none, as the study makes its own problems");
    } else {
      argument.scenes = fields.Required<std::vector<SceneArgument>>("scenes");
      if (argument.scenes.empty()) fields.Refuse("scenes", "a list of one or more");
    }
    StudySetup& setup = argument.setup;
    setup.seeds = fields.Optional<int>("seeds", setup.seeds);
    RequireWithin("", "seeds", StudySetup::kSeeds, setup.seeds);
    const auto first = fields.Optional<std::int64_t>("first_seed", 1);
    if (first < 0) fields.Refuse("first_seed", "a whole number, 0 or more");
    setup.first_seed = static_cast<std::uint64_t>(first);
    setup.run.paths = fields.Optional<int>("paths", setup.run.paths);
    setup.threads = fields.Optional<int>("threads", ScriptContext::Of(L).config.threads);
    RequireWithin("", "threads", ThreadPool::kThreads, setup.threads);
    argument.keep_runs = fields.Optional<bool>("keep_runs", false);
    argument.settings = ReadSettings(L, fields);
    return argument;
  }
};

namespace {

// Applies what the scene left of the settings to the planner, whose they are then.
void ApplyRest(std::vector<Setting> settings, StudySetup& setup) {
  setup.planner = {};
  ApplyPlannerSettings(setup.planner, settings);
  RequireNoSettingsLeft(settings, PlannerRoots());
}

Pushed EvalStudy(lua_State* L, EvalArgument& argument) {
  const FileAccess& files = Machine::Of(L).files();
  EvalConfig config;
  config.study = argument.study->name;
  config.out = files.ResolveForWriting(argument.dir);
  StudySetup& setup = config.setup;
  setup = std::move(argument.setup);
  setup.weights = WeightsFolder(ScriptContext::Of(L).config);
  // Links are followed here, so that none within leads elsewhere.
  files.ResolveForWriting(argument.dir + "/items");
  files.ResolveForWriting(argument.dir + "/records");
  const std::filesystem::path runs = files.ResolveForWriting(argument.dir + "/runs");
  if (argument.keep_runs) setup.runs = runs;
  if (argument.scenes.empty()) ApplyRest(argument.settings, setup);
  for (SceneArgument& scene : argument.scenes) {
    std::vector<Setting> settings = argument.settings;  // each takes those that fit it
    if (argument.study->subject == StudySubject::kScenes) {
      setup.scenes.push_back(LoadScene(L, std::move(scene), settings));
    } else if (scene.file) {
      setup.ladders.push_back(LoadLadderFile(files.FindForReading(*scene.file), settings));
    } else {
      throw InputError("", "scenes", "the names of ladders' files", "a scene");
    }
    ApplyRest(std::move(settings), setup);
  }
  RunEval(config, {});
  PushJson(L, ReadEval(config.out));
  return {1};
}

}  // namespace

const std::vector<FunctionInfo>& StudyFunctions() {
  static const std::vector<FunctionInfo> functions = {Function<&EvalStudy>("eval", "options")};
  return functions;
}

std::vector<const Schema*> StudySchemas() { return {&kEvalOptions}; }

}  // namespace pregrasp
