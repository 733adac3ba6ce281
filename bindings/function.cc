#include "bindings/function.h"

#include <optional>
#include <sstream>

#include "bindings/protect.h"

namespace pregrasp::internal {

std::string ParameterName(const FunctionInfo& function, int number) {
  std::istringstream names(function.parameters);
  std::string name;
  for (int i = 0; i < number; ++i) {
    if (!std::getline(names >> std::ws, name, ',')) return "argument " + std::to_string(number);
  }
  return name;
}

void ThrowNoSelf(lua_State* L, int index, const FunctionInfo& function,
                 const std::string& class_name) {
  throw InputError("", "", WithArticle(class_name) + " before a colon (x:" + function.name + ")",
                   DescribeValue(L, index));
}

void ThrowTooMany(const FunctionInfo& function, int got) {
  throw InputError("", "",
                   function.parameters.empty() ? "no arguments" : "(" + function.parameters + ")",
                   std::to_string(got) + " arguments");
}

int CallBound(lua_State* L, int (*body)(lua_State* L, const FunctionInfo& function), bool paused) {
  return Protect(L, [L, body, paused]() -> int {
    const auto& function =
        *static_cast<const FunctionInfo*>(lua_touserdata(L, lua_upvalueindex(1)));
    Machine::Of(L).RaiseIfInterrupted(L);
    std::optional<Machine::Pause> pause;
    if (paused) pause.emplace(L);
    try {
      const int results = body(L, function);
      Machine::Of(L).RaiseIfInterrupted(L);
      return results;
    } catch (const InputError& error) {
      // Say which call it was, unless the line of the script is said already.
      if (InSameFile(error.what(), WhereInLua(L))) throw;
      throw InputError(function.name + ": " + error.what());
    }
  });
}

}  // namespace pregrasp::internal
