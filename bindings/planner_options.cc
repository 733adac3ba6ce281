#include "bindings/planner_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace pregrasp {
namespace {

// The options of one stage: a schema whose keys are those of the table of settings.
struct StageKeys {
  Schema schema;
  std::vector<const PlannerSetting*> settings;  // by key
  /// What it takes that is no setting, as the manual has it; the key first.
  std::vector<std::pair<std::string, std::string>> others = {};
};

// All settings below `roots`, or those of them that are listed.
StageKeys MakeKeys(const std::string& name, const std::vector<std::string>& roots,
                   const std::vector<std::string>& only = {}) {
  const auto is_in = [](const std::vector<std::string>& list, const std::string& word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  StageKeys keys{{name, {}}, {}};
  for (const PlannerSetting& setting : SettingsTable()) {
    if (!is_in(roots, setting.root()) || (!only.empty() && !is_in(only, setting.key()))) continue;
    keys.schema.keys.push_back(setting.key());
    keys.settings.push_back(&setting);
  }
  return keys;
}

// Any number, boolean or text: which of them, and within which range, the table says.
FieldValue ReadFieldValue(lua_State* L, const Fields& fields, const PlannerSetting& setting) {
  fields.Push(setting.key());
  const int type = lua_type(L, -1);
  const double number = lua_tonumber(L, -1);
  lua_pop(L, 1);
  if (type == LUA_TNUMBER) return number;
  if (type == LUA_TBOOLEAN) return fields.Required<bool>(setting.key());
  if (type == LUA_TSTRING) return fields.Required<std::string>(setting.key());
  fields.Refuse(setting.key(), setting.Expected());
}

template <typename Options>
Options ReadOptions(lua_State* L, int index, const StageKeys& keys) {
  const Fields fields(L, index, keys.schema);
  Options options;
  for (const PlannerSetting* setting : keys.settings) {
    if (!fields.Has(setting->key())) continue;
    options.fields.emplace_back(setting, ReadFieldValue(L, fields, *setting));
  }
  return options;
}

const StageKeys& GraphKeys() {
  static const StageKeys keys = MakeKeys("GraphOptions", {"cloud", "mesh", "graph"});
  return keys;
}
const StageKeys& PruneKeys() {
  static const StageKeys keys = MakeKeys("PruneOptions", {"graph"}, {"top_percent"});
  return keys;
}
const StageKeys& PathsKeys() {
  static const StageKeys keys = [] {
    StageKeys made = MakeKeys("PathsOptions", {"paths"});
    made.others = {{"filter",
                    "---@field filter? fun(path: Path): boolean? says yes to the paths that count, "
                    "the others being passed over with their ranks; all"}};
    for (const auto& [key, line] : made.others) made.schema.keys.push_back(key);
    return made;
  }();
  return keys;
}
const StageKeys& OptimizeKeys() {
  static const StageKeys keys = MakeKeys("OptimizeOptions", {"mppi"});
  return keys;
}
const StageKeys& ScreenKeys() {
  static const StageKeys keys = MakeKeys("ScreenOptions", {"screen"}, {"samples", "iterations"});
  return keys;
}
const StageKeys& CertifyKeys() {
  static const StageKeys keys = MakeKeys("CertifyOptions", {"certify"});
  return keys;
}
const StageKeys& GraspsKeys() {
  static const StageKeys keys = MakeKeys("GraspsOptions", {"grasps"});
  return keys;
}
const StageKeys& MotionKeys() {
  static const StageKeys keys = MakeKeys("MotionOptions", {"motion"});
  return keys;
}

std::vector<const StageKeys*> AllKeys() {
  return {&GraphKeys(),  &PruneKeys(),   &PathsKeys(),  &OptimizeKeys(),
          &ScreenKeys(), &CertifyKeys(), &GraspsKeys(), &MotionKeys()};
}

}  // namespace

FunctionReference::FunctionReference(lua_State* L, int index) {
  lua_pushvalue(L, index);
  reference_ = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_rawgeti(L, LUA_REGISTRYINDEX, LUA_RIDX_MAINTHREAD);
  main_ = lua_tothread(L, -1);
  lua_pop(L, 1);
}

FunctionReference::~FunctionReference() { luaL_unref(main_, LUA_REGISTRYINDEX, reference_); }

nlohmann::json StageOptions::ToSettings() const {
  PlannerConfig scratch;
  nlohmann::json settings = nlohmann::json::object();
  for (const auto& [setting, value] : fields) {
    try {
      setting->Set(scratch, value);
    } catch (const InputError& error) {
      throw InputError("", setting->key(), error.expected(), error.got());
    }
    settings[setting->name] = setting->GetJson(scratch);  // so that 48.0 is 48
  }
  scratch.Validate();
  return settings;
}

namespace {

// The type of a setting in LuaCATS: boolean, "reverse"|"forward", integer or number.
std::string TypeText(const PlannerSetting& setting) {
  if (setting.is_number()) return setting.range.step > 0 ? "integer" : "number";
  std::string words;
  for (const std::string& word : setting.choices()) {
    words += (words.empty() ? "\"" : "|\"") + word + '"';
  }
  return words.empty() ? "boolean" : words;
}

std::string OptionAnnotation(const PlannerSetting& setting) {
  std::string text =
      fmt::format("---@field {}? {} {}", setting.key(), TypeText(setting), setting.meaning);
  if (setting.is_number()) text += ", " + setting.range.Text();
  if (setting.range.step == 2) text += ", even";
  const std::string rule = setting.rule.Text();
  if (!rule.empty()) text += ", within the rules " + rule;
  return text + "; " + FieldText(setting.Default());
}

}  // namespace

std::string OptionAnnotations() {
  std::string text = "---@meta pregrasp\n";
  for (const StageKeys* keys : AllKeys()) {
    text += "\n---@class " + keys->schema.name + '\n';
    for (const PlannerSetting* setting : keys->settings) text += OptionAnnotation(*setting) + '\n';
    for (const auto& [key, line] : keys->others) text += line + '\n';
  }
  return text;
}

GraphOptions LuaValue<GraphOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<GraphOptions>(L, index, GraphKeys());
}
PruneOptions LuaValue<PruneOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<PruneOptions>(L, index, PruneKeys());
}
PathsOptions LuaValue<PathsOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  PathsOptions options = ReadOptions<PathsOptions>(L, index, PathsKeys());
  const Fields fields(L, index, PathsKeys().schema);
  fields.Push("filter");
  if (!lua_isnil(L, -1)) {
    if (!lua_isfunction(L, -1)) fields.Refuse("filter", "a function");
    options.filter = std::make_shared<const FunctionReference>(L, -1);
  }
  lua_pop(L, 1);
  return options;
}
OptimizeOptions LuaValue<OptimizeOptions>::Read(lua_State* L, int index,
                                                const std::string& /*path*/) {
  return ReadOptions<OptimizeOptions>(L, index, OptimizeKeys());
}
ScreenOptions LuaValue<ScreenOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<ScreenOptions>(L, index, ScreenKeys());
}
CertifyOptions LuaValue<CertifyOptions>::Read(lua_State* L, int index,
                                              const std::string& /*path*/) {
  return ReadOptions<CertifyOptions>(L, index, CertifyKeys());
}
GraspsOptions LuaValue<GraspsOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<GraspsOptions>(L, index, GraspsKeys());
}
MotionOptions LuaValue<MotionOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<MotionOptions>(L, index, MotionKeys());
}

std::vector<const Schema*> StageOptionSchemas() {
  std::vector<const Schema*> schemas;
  for (const StageKeys* keys : AllKeys()) schemas.push_back(&keys->schema);
  return schemas;
}

}  // namespace pregrasp
