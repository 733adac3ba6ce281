#include "app/commands/subcommand.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace pregrasp {
namespace {

// Values that are words: CLI11 takes whatever follows an option for its value.
template <typename Value>
struct IsText : std::false_type {};
template <>
struct IsText<std::string> : std::true_type {};
template <>
struct IsText<std::optional<std::string>> : std::true_type {};
template <>
struct IsText<std::filesystem::path> : std::true_type {};

CLI::Validator NoFlag() {
  return {[](const std::string& text) {
            if (text.empty()) return std::string("expected a value, got an empty one");
            if (text.rfind("--", 0) != 0) return std::string();
            return "expected a value, got the option " + text;
          },
          ""};
}

}  // namespace

Option Option::Required() const { return Option(*option_->required()); }

Option Option::ShowDefault() const { return Option(*option_->capture_default_str()); }

Option Option::Within(const NumberRange& range) const {
  const CLI::Validator within(
      [range](const std::string& text) {
        double value = 0.0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        const bool fits = error == std::errc() && rest == end && range.Contains(value);
        return fits ? std::string() : "expected " + range.Expected() + ", got \"" + text + '"';
      },
      range.Text());
  return Option(*option_->check(within));
}

Option Option::OneAtATime() const { return Option(*option_->allow_extra_args(false)); }

Option Option::CommaSeparated(int elements) const {
  return Option(*option_->delimiter(',')->expected(elements));
}

Option Option::CommaSeparated() const {
  return Option(*option_->delimiter(',')->allow_extra_args(false));
}

Subcommand Subcommand::AddCommand(const std::string& name, const std::string& text) const {
  return Subcommand(*app_->add_subcommand(name, text));
}

void Subcommand::RequireCommand() const { app_->require_subcommand(1); }

template <typename Value>
Option Subcommand::Add(const std::string& name, Value& value, const std::string& text) const {
  CLI::Option& option = *app_->add_option(name, value, text);
  if constexpr (IsText<Value>::value) option.check(NoFlag());
  return Option(option);
}

Option Subcommand::AddFlag(const std::string& name, bool& value, const std::string& text) const {
  return Option(*app_->add_flag(name, value, text));
}

Option Subcommand::AddSeed(std::uint64_t& seed, const std::string& text) const {
  return AddSeed("--seed", seed, text);
}

Option Subcommand::AddSeed(const std::string& name, std::uint64_t& seed,
                           const std::string& text) const {
  const CLI::Validator digits(
      [](const std::string& given) {
        std::uint64_t value = 0;
        const char* end = given.data() + given.size();
        const auto [rest, error] = std::from_chars(given.data(), end, value);
        const bool fits = error == std::errc() && rest == end;
        return fits ? std::string()
                    : "expected a whole number from 0 to 2^64 - 1, got \"" + given + '"';
      },
      "N", "seed");
  return Option(*app_->add_option(name, seed, text)->capture_default_str()->check(digits));
}

void Subcommand::OnChosen(const std::function<void()>& action) const { app_->callback(action); }

// What an option can be.
#define PREGRASP_OPTION_VALUE(...) \
  template Option Subcommand::Add(const std::string&, __VA_ARGS__&, const std::string&) const
PREGRASP_OPTION_VALUE(int);
PREGRASP_OPTION_VALUE(std::int64_t);
PREGRASP_OPTION_VALUE(double);
PREGRASP_OPTION_VALUE(std::string);
PREGRASP_OPTION_VALUE(std::optional<std::string>);
PREGRASP_OPTION_VALUE(std::filesystem::path);
PREGRASP_OPTION_VALUE(std::vector<double>);
PREGRASP_OPTION_VALUE(std::vector<std::string>);
PREGRASP_OPTION_VALUE(std::vector<std::filesystem::path>);
#undef PREGRASP_OPTION_VALUE

}  // namespace pregrasp
