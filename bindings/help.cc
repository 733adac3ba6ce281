#include "bindings/help.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "app/core/text.h"
#include "app/job/planner_settings.h"
#include "bindings/manual.h"
#include "bindings/protect.h"
#include "bindings/schema.h"
#include "bindings/script.h"
#include "bindings/show.h"

namespace pregrasp {
namespace {

const char* const kPromptHelp =
    R"(An expression shows its value; anything else is run. A local is kept for the next lines.
  pg                  require "pregrasp", the whole interface:  help(pg)
  s = pg.open "scenes/ruler.lua"                    help(s), help(s.settle), help "shot"
  help "sigma"        an option, a setting, an overlay, or whatever mentions the words
  Tab                 completes variables, fields, methods and options
  Ctrl-C              stops what runs; what it has done so far stays
  Ctrl-D              ends
)";

bool IsFunction(lua_State* L, int index, const FunctionInfo& function) {
  if (lua_tocfunction(L, index) != function.call) return false;
  if (lua_getupvalue(L, index, 1) == nullptr) return false;
  const bool same = lua_touserdata(L, -1) == &function;
  lua_pop(L, 1);
  return same;
}

std::string FindFunctionName(lua_State* L, int index) {
  const Api& api = GetApi();
  for (const FunctionInfo* function : api.functions) {
    if (IsFunction(L, index, *function)) return api.module->name + "." + function->name;
  }
  for (const ClassInfo* info : api.classes) {
    for (const FunctionInfo& method : info->methods) {
      if (IsFunction(L, index, method)) return info->name + ":" + method.name;
    }
  }
  return "";
}

// A planner's setting by its full name, "mppi.sigma".
std::string ExplainSetting(const std::string& name) {
  for (const PlannerSetting& setting : SettingsTable()) {
    if (setting.name != name) continue;
    const std::string rule = setting.rule.Text();
    return setting.name + "  " + setting.Values() + "  " + setting.meaning + "; " +
           FieldText(setting.Default()) + (rule.empty() ? "" : ", within the rules " + rule) + '\n';
  }
  return "";
}

std::string ExplainWord(const std::string& word) {
  const Manual& manual = Manual::Get();
  std::string text = ExplainSetting(word);
  for (const std::string& name : manual.Match(word)) {
    if (!text.empty()) text += '\n';
    text += manual.Explain(name);
  }
  if (!text.empty()) return text;
  constexpr std::size_t kMostFound = 30;
  const std::vector<std::string> found = manual.Search(word);
  for (std::size_t i = 0; i < std::min(found.size(), kMostFound); ++i) {
    text += manual.Summarize(found[i]) + '\n';
  }
  if (found.size() > kMostFound) {
    text += ".. and " + std::to_string(found.size() - kMostFound) + " more\n";
  }
  if (!text.empty()) return text;
  std::vector<std::string> names;
  for (const auto& [name, entry] : manual.entries()) {
    names.push_back(name);
    const std::size_t separator = name.find_first_of(".:");
    if (separator != std::string::npos) names.push_back(name.substr(separator + 1));
  }
  throw InputError("help: nothing is called \"" + word + "\"" +
                   FormatHint(FindNearest(word, names)));
}

}  // namespace

std::string FindManualName(lua_State* L, int index) {
  index = lua_absindex(L, index);
  if (lua_iscfunction(L, index)) return FindFunctionName(L, index);
  if (const ClassInfo* info = FindClass(L, index)) return info->name;
  if (const Schema* schema = FindSchema(L, index)) return schema->name;
  // The module is locked: its table is behind a proxy.
  if (lua_type(L, index) != LUA_TTABLE || luaL_getmetafield(L, index, "__index") == LUA_TNIL) {
    return "";
  }
  const Schema* schema = FindSchema(L, lua_gettop(L));
  lua_pop(L, 1);
  return schema == nullptr ? "" : schema->name;
}

int PrintHelp(lua_State* L) {
  return Protect(L, [L] {
    std::string text = kPromptHelp;
    if (lua_gettop(L) > 0) {
      const std::string name = FindManualName(L, 1);
      if (!name.empty()) {
        text = ExplainWord(name);
      } else if (lua_type(L, 1) == LUA_TSTRING) {
        text = ExplainWord(lua_tostring(L, 1));
      } else if (lua_iscfunction(L, 1)) {
        text = "a function of Lua's own: see https://www.lua.org/manual/5.4\n";
      } else {
        text = std::string("a ") + luaL_typename(L, 1) + ": " + ShowInline(L, 1) + "\n";
      }
    }
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
    return 0;
  });
}

}  // namespace pregrasp
