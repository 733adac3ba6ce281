#include "app/commands/subcommand.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "app/core/error.h"
#include "app/core/text.h"

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
template <>
struct IsText<std::vector<std::string>> : std::true_type {};
template <>
struct IsText<std::vector<std::filesystem::path>> : std::true_type {};

CLI::Validator NoFlag() {
  return {[](const std::string& text) {
            if (text.empty()) return std::string("expected a value, got an empty one");
            if (text.rfind("--", 0) != 0) return std::string();
            return "expected a value, got the option " + text;
          },
          ""};
}

std::string Quote(const std::string& text) { return '"' + text + '"'; }

// The commands and the options of a command, as they are typed.
std::vector<std::string> CommandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// "a command (merge, report)"
std::string ListCommands(const CLI::App& app) {
  const std::vector<std::string> commands = CommandsOf(app);
  std::string list;
  for (const std::string& each : commands) list += (list.empty() ? "" : ", ") + each;
  return commands.size() == 1 ? "the command " + list : "a command (" + list + ")";
}

std::vector<std::string> OptionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// What the command was given and does not have.
InputError RefuseWord(const CLI::App& app, const std::string& name, const std::string& note,
                      const std::string& word) {
  const std::vector<std::string> commands = CommandsOf(app);
  std::string expected, nearest;
  if (word.rfind('-', 0) == 0) {
    expected = "an option that it has";
    nearest = FindNearest(word, OptionsOf(app));
  } else if (!commands.empty()) {
    expected = ListCommands(app);
    nearest = FindNearest(word, commands);
  } else {
    expected = "no more arguments";
  }
  if (!note.empty()) return {name, "", expected, Quote(word) + ": " + note};
  return {name, "", expected, Quote(word) + FormatHint(nearest)};
}

// What is wrong with an option's number of values.
InputError RefuseCount(const CLI::App& app, const std::string& name, const std::string& option) {
  const std::vector<const CLI::Option*> options = app.get_options();
  const auto found = std::find_if(options.begin(), options.end(), [&](const CLI::Option* each) {
    return each->get_name() == option;
  });
  const std::size_t count = found == options.end() ? 0 : (*found)->count();
  if (count < 2) return {name, option, "a value", "nothing"};
  return {name, option, "it once", std::to_string(count) + " times"};
}

}  // namespace

void RequireValues(int argc, char** argv) {
  int words = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("-", 0) != 0) ++words;
    if (words >= 2 && std::string(argv[1]) == "script") return;
    if (word.rfind("--", 0) == 0 && word.find('=') == word.size() - 1) {
      throw InputError("pregrasp", word.substr(0, word.size() - 1), "a value after =", "none");
    }
  }
}

std::string DescribeParseError(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += ' ' + command->get_name();
  }
  const std::string help = " (see " + name + " --help)";
  const std::vector<std::string> left = command->remaining();
  const auto option = std::find_if(left.begin(), left.end(), [](const std::string& word) {
    return word.size() > 1 && word[0] == '-' && word != "--";
  });
  // A command has the program's closing words unless it has its own.
  const std::string footer = command->get_footer();
  const std::string note = footer == app.get_footer() ? "" : footer;
  const std::string text = error.what(), is_required = " is required";
  if (option != left.end()) return RefuseWord(*command, name, note, *option).what() + help;
  if (!left.empty()) return RefuseWord(*command, name, note, left.front()).what() + help;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    return RefuseCount(*command, name, text.substr(0, text.find(": "))).what() + help;
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && text.ends_with(is_required)) {
    const std::string what = text.substr(0, text.size() - is_required.size());
    const bool one = what != "A subcommand";
    return InputError(name, "", one ? what : ListCommands(*command), "nothing").what() + help;
  }
  // A flag's, as all other values are checked before.
  const std::size_t begin = text.find(": "), equals = text.find(" = ");
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr && equals != text.npos) {
    const std::string flag = text.substr(begin + 2, equals - begin - 2);
    return InputError(name, flag, "no value", Quote(text.substr(equals + 3))).what() + help;
  }
  return name + ": " + text + help;
}

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

Subcommand Subcommand::AddCommand(const std::string& name, const std::string& text) const {
  return Subcommand(*app_->add_subcommand(name, text));
}

void Subcommand::AddNote(const std::string& text) const { app_->footer(text); }

void Subcommand::RequireCommand() const { app_->require_subcommand(1); }

template <typename Value>
Option Subcommand::Add(const std::string& name, Value& value, const std::string& text) const {
  CLI::Option& option = *app_->add_option(name, value, text);
  // A list of words without a name may hold another command's options.
  constexpr bool kList = requires {
    value.push_back({});
    value.front().size();
  };
  if constexpr (IsText<Value>::value) {
    if (!kList || name.rfind('-', 0) == 0) option.check(NoFlag());
  }
  return Option(option);
}

// Never gets a value, as the list before it takes all. But CLI11 ends a command at -- where none of
// its arguments is without a value.
void Subcommand::AddRest(const std::string& name, const std::string& text) const {
  app_->add_option_function<std::string>(
      name, [](const std::string&) {}, text);
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
