#include "bindings/planner_options.h"

#include <algorithm>

namespace pregrasp {
namespace {

// The options of one stage: a schema whose keys come from the planner's own list of fields.
struct StageKeys {
  Schema schema;
  std::vector<std::string> names;  // in full, by key
};

// All fields below `roots`, or those of them that are listed.
StageKeys MakeKeys(const std::string& name, const std::vector<std::string>& roots,
                   const std::vector<std::string>& only = {}) {
  StageKeys keys{{name, {}}, {}};
  const nlohmann::json all = PlannerConfigJson({});
  for (const std::string& root : roots) {
    for (const auto& [key, value] : all.at(root).items()) {
      if (!only.empty() && std::find(only.begin(), only.end(), key) == only.end()) continue;
      keys.schema.keys.push_back(key);
      keys.names.push_back(root + '.' + key);
    }
  }
  return keys;
}

FieldValue ReadFieldValue(lua_State* L, const Fields& fields, const std::string& key) {
  fields.Push(key);
  const int type = lua_type(L, -1);
  lua_pop(L, 1);
  if (type == LUA_TBOOLEAN) return fields.Required<bool>(key);
  if (type == LUA_TSTRING) return fields.Required<std::string>(key);
  return fields.Required<double>(key);
}

template <typename Options>
Options ReadOptions(lua_State* L, int index, const StageKeys& keys) {
  const Fields fields(L, index, keys.schema);
  Options options;
  for (std::size_t i = 0; i < keys.names.size(); ++i) {
    const std::string& key = keys.schema.keys[i];
    if (!fields.Has(key)) continue;
    options.fields.emplace_back(keys.names[i], ReadFieldValue(L, fields, key));
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
  static const StageKeys keys = MakeKeys("PathsOptions", {"paths"});
  return keys;
}
const StageKeys& OptimizeKeys() {
  static const StageKeys keys = MakeKeys("OptimizeOptions", {"mppi"});
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

}  // namespace

nlohmann::json StageOptions::ToSettings() const {
  PlannerConfig scratch;
  nlohmann::json settings = nlohmann::json::object();
  for (const auto& [name, value] : fields) {
    SetPlannerField(scratch, name, value);
    const std::size_t dot = name.find('.');
    // As the configuration has it, so that 48.0 is 48.
    settings[name] = PlannerConfigJson(scratch)[name.substr(0, dot)][name.substr(dot + 1)];
  }
  scratch.Validate();
  return settings;
}

GraphOptions LuaValue<GraphOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<GraphOptions>(L, index, GraphKeys());
}
PruneOptions LuaValue<PruneOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<PruneOptions>(L, index, PruneKeys());
}
PathsOptions LuaValue<PathsOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  return ReadOptions<PathsOptions>(L, index, PathsKeys());
}
OptimizeOptions LuaValue<OptimizeOptions>::Read(lua_State* L, int index,
                                                const std::string& /*path*/) {
  return ReadOptions<OptimizeOptions>(L, index, OptimizeKeys());
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
  return {&GraphKeys().schema,   &PruneKeys().schema,  &PathsKeys().schema, &OptimizeKeys().schema,
          &CertifyKeys().schema, &GraspsKeys().schema, &MotionKeys().schema};
}

}  // namespace pregrasp
