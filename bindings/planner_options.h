#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/job/planner_settings.h"
#include "bindings/value.h"

namespace pregrasp {

/// A function of the script, held until this goes.
class FunctionReference {
 public:
  /// Of the function at `index`.
  FunctionReference(lua_State* L, int index);
  ~FunctionReference();
  FunctionReference(const FunctionReference&) = delete;
  FunctionReference& operator=(const FunctionReference&) = delete;

  void Push(lua_State* L) const { lua_rawgeti(L, LUA_REGISTRYINDEX, reference_); }

 private:
  lua_State* main_;  // the machine's first thread, which lives as long as it does
  int reference_;
};

/// Settings of a planner's stage as a script gives them: a key is the last part of the setting's
/// name ("samples" of "mppi.samples").
struct StageOptions {
  std::vector<std::pair<const PlannerSetting*, FieldValue>> fields;

  /// The same as a command's `settings`. @throws InputError that names the key, for a value that
  /// does not fit.
  nlohmann::json ToSettings() const;
};

struct GraphOptions : StageOptions {};
struct PruneOptions : StageOptions {};
struct PathsOptions : StageOptions {
  std::shared_ptr<const FunctionReference> filter;  ///< which paths count; null: all
};
struct OptimizeOptions : StageOptions {};
struct ScreenOptions : StageOptions {};
struct CertifyOptions : StageOptions {};
struct GraspsOptions : StageOptions {};
struct MotionOptions : StageOptions {};

template <>
struct LuaValue<GraphOptions> {
  static GraphOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<PruneOptions> {
  static PruneOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<PathsOptions> {
  static PathsOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<OptimizeOptions> {
  static OptimizeOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<ScreenOptions> {
  static ScreenOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<CertifyOptions> {
  static CertifyOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<GraspsOptions> {
  static GraspsOptions Read(lua_State* L, int index, const std::string& path);
};
template <>
struct LuaValue<MotionOptions> {
  static MotionOptions Read(lua_State* L, int index, const std::string& path);
};

std::vector<const Schema*> StageOptionSchemas();

/// Those options as LuaCATS annotations, a class for each schema, from the table of settings: the
/// rest of the manual (lua/meta/pregrasp.lua).
std::string OptionAnnotations();

}  // namespace pregrasp
