#pragma once

#include <sstream>
#include <string>

namespace pregrasp::internal {

[[noreturn]] void CheckFailed(const char* file, int line, const char* condition,
                              const std::string& values);

template <typename... Values>
std::string JoinValues(const Values&... values) {
  std::ostringstream out;
  [[maybe_unused]] const char* separator = "";
  ((out << separator << values, separator = ", "), ...);
  return out.str();
}

}  // namespace pregrasp::internal

/// Holds in every build, or throws InternalError with the condition and the values given after it.
#define PREGRASP_CHECK(condition, ...)                                                  \
  do {                                                                                  \
    if (!(condition)) {                                                                 \
      ::pregrasp::internal::CheckFailed(__FILE__, __LINE__, #condition,                 \
                                        ::pregrasp::internal::JoinValues(__VA_ARGS__)); \
    }                                                                                   \
  } while (false)
