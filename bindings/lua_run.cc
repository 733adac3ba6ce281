#include "bindings/lua_run.h"

#include <fmt/format.h>

#include <fstream>
#include <map>

#include "app/core/json_text.h"
#include "app/core/text.h"
#include "app/page/pair.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"
#include "bindings/lua_session.h"
#include "bindings/machine.h"

namespace pregrasp {
namespace {

const Schema kRunStripOptions{
    "RunStripOptions",
    {"against", "file", "camera", "size", "quality", "overlay", "legend", "font_scale"}};

// A finished run. Of its steps the places of their lines are kept, not what they say.
struct LuaRun {
  std::filesystem::path directory;
  std::string name;  // as the script gave it
  nlohmann::json summary, manifest;
  std::vector<std::string> ids;
  std::map<std::string, std::streamoff> line_of;  // in steps.jsonl
};

}  // namespace

void PushJson(lua_State* L, const nlohmann::json& value) {
  luaL_checkstack(L, 4, "a document nested too deep");
  if (value.is_object()) {
    lua_createtable(L, 0, static_cast<int>(value.size()));
    for (const auto& [key, child] : value.items()) {
      PushJson(L, child);
      lua_setfield(L, -2, key.c_str());
    }
  } else if (value.is_array()) {
    lua_createtable(L, static_cast<int>(value.size()), 0);
    for (std::size_t i = 0; i < value.size(); ++i) {
      PushJson(L, value[i]);
      lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
    }
  } else if (value.is_string()) {
    LuaValue<std::string>::Push(L, value.get_ref<const std::string&>());
  } else if (value.is_boolean()) {
    lua_pushboolean(L, value.get<bool>());
  } else if (value.is_number_integer()) {
    lua_pushinteger(L, value.get<lua_Integer>());
  } else if (value.is_number()) {
    lua_pushnumber(L, value.get<double>());
  } else {
    lua_pushnil(L);
  }
}

template <>
struct LuaClass<LuaRun> {
  static const ClassInfo& info() { return RunClass(); }
  static const Session* session(const LuaRun& /*run*/) { return nullptr; }
};

namespace {

struct RunStripOptions {
  std::vector<std::string> ids;
  std::shared_ptr<LuaRun> against;
  Shot shot;
  std::string file;
};

}  // namespace

template <>
struct LuaValue<RunStripOptions> {
  static RunStripOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kRunStripOptions, "", "", kMostOfAStrip);
    RunStripOptions options;
    ReadStrip(L, fields, options.shot, options.file);
    options.against = fields.Find<std::shared_ptr<LuaRun>>("against").value_or(nullptr);
    for (int i = 1;; ++i) {
      const auto id =
          fields.Positional<std::optional<std::string>>(i, "[" + std::to_string(i) + "]");
      if (!id) return options;
      options.ids.push_back(*id);
    }
  }
};

namespace {

nlohmann::json ReadDocument(const std::filesystem::path& file) {
  return ParseJson(ReadFile(file), file.string());
}

std::shared_ptr<LuaRun> LoadFinishedRun(lua_State* L, const std::string& dir) {
  LuaRun run;
  run.name = dir;
  run.directory = Machine::Of(L).files().FindForReading(dir + "/manifest.json").parent_path();
  if (!IsFinishedRun(run.directory)) {
    throw InputError("", "dir", "a finished run", '"' + dir + '"');
  }
  run.manifest = ReadDocument(run.directory / "manifest.json");
  run.summary = ReadDocument(run.directory / "summary.json");
  const std::filesystem::path file = run.directory / "steps.jsonl";
  std::ifstream lines(file, std::ios::binary);
  std::streamoff at = 0;
  for (std::string line; std::getline(lines, line); at = lines.tellg()) {
    const std::string id = ParseJson(line, file.string()).value("id", "");
    run.line_of[id] = at;
    run.ids.push_back(id);
  }
  constexpr int kKibOfAStep = 1;
  CountMemory(L, kKibOfAStep * static_cast<int>(run.ids.size()));
  return std::make_shared<LuaRun>(std::move(run));
}

Pushed RunStep(lua_State* L, LuaRun& run, const std::string& id) {
  const auto found = run.line_of.find(id);
  if (found == run.line_of.end()) {
    const std::string nearest = FindNearest(id, run.ids);
    throw InputError("", "id",
                     nearest.empty() ? "the id of a step of the run" : '"' + nearest + '"',
                     '"' + OneLine(id) + '"');
  }
  const std::filesystem::path file = run.directory / "steps.jsonl";
  std::ifstream lines(file, std::ios::binary);
  lines.seekg(found->second);
  std::string line;
  std::getline(lines, line);
  PushJson(L, ParseJson(line, file.string()));
  return {1};
}

Pushed RunSummaryTable(lua_State* L, LuaRun& run) {
  PushJson(L, run.summary);
  return {1};
}
Pushed RunManifest(lua_State* L, LuaRun& run) {
  PushJson(L, run.manifest);
  return {1};
}
void RunShot(lua_State* L, LuaRun& run, const std::string& id, const ShotOptions& options) {
  if (!options.file) throw InputError("", "file", kWhereTo, "nothing");
  const LoadedRun loaded = LoadRun(run.directory);
  const StepFacts& step = loaded.Get(id);
  options.shot.config.Validate();
  PictureDrawer drawer(loaded.scene, LabelsOf(loaded));
  drawer.Draw(step, loaded, options.shot, PictureFile(L, *options.file));
}

// Steps side by side, the key ones where none are named; with `against` those of two runs.
void RunStrip(lua_State* L, LuaRun& run, const RunStripOptions& options) {
  const std::filesystem::path file = PictureFile(L, options.file);
  const LoadedRun loaded = LoadRun(run.directory);
  const std::optional<Vector3> view;
  if (options.against) {
    const LoadedRun other = LoadRun(options.against->directory);
    WritePng(DrawPairOfRuns(loaded, other, options.ids, options.shot, view), file);
  } else if (!options.ids.empty()) {
    WritePng(DrawStripOfRun(loaded, options.ids, options.shot, view), file);
  } else {
    WritePng(DrawContactSheet(loaded, options.shot, view), file);
  }
}

std::vector<std::string> RunIds(LuaRun& run) { return run.ids; }

int RunToString(lua_State* L) {
  const auto run = FindObject<LuaRun>(L, 1);
  LuaValue<std::string>::Push(
      L, run ? fmt::format("Run({}, {} steps)", run->name, run->ids.size()) : "Run");
  return 1;
}

}  // namespace

const std::vector<FunctionInfo>& RunFunctions() {
  static const std::vector<FunctionInfo> functions = {Function<&LoadFinishedRun>("load", "dir")};
  return functions;
}

std::vector<const Schema*> RunSchemas() { return {&kRunStripOptions}; }

const ClassInfo& RunClass() {
  static const ClassInfo info{"Run",
                              {
                                  Query<&RunShot>("shot", "id, options"),
                                  Query<&RunStep>("step", "id"),
                                  Query<&RunStrip>("strip", "options"),
                              },
                              {
                                  Property<&RunIds>("ids"),
                                  Property<&RunManifest>("manifest"),
                                  Property<&RunSummaryTable>("summary"),
                              },
                              RunToString};
  return info;
}

}  // namespace pregrasp
