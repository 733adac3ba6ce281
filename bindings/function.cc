#include "bindings/function.h"

#include <sstream>

namespace pregrasp::internal {

std::string ParameterName(const FunctionInfo& function, int number) {
  std::istringstream names(function.parameters);
  std::string name;
  for (int i = 0; i < number; ++i) {
    if (!std::getline(names >> std::ws, name, ',')) return "argument " + std::to_string(number);
  }
  return name;
}

void ThrowTooMany(const FunctionInfo& function, int got) {
  throw InputError("", "",
                   function.parameters.empty() ? "no arguments" : "(" + function.parameters + ")",
                   std::to_string(got) + " arguments");
}

}  // namespace pregrasp::internal
