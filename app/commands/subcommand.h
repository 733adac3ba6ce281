#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "app/core/number_range.h"

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace pregrasp {

/// One option or argument, to be described further.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option Required() const;
  /// The help says the default.
  Option ShowDefault() const;
  /// A number of the range; else one line that names the option and the range.
  Option Within(const NumberRange& range) const;
  /// A list takes one element each time that the option is given, else all that follow it.
  Option OneAtATime() const;

 private:
  CLI::Option* option_;
};

/// The command line's description: the program or one of its subcommands. CLI11 stays behind it,
/// because its header takes the compiler three seconds for every file.
class Subcommand {
 public:
  explicit Subcommand(CLI::App& app) : app_(&app) {}

  Subcommand AddCommand(const std::string& name, const std::string& text) const;
  /// What the help ends with, and a message about an argument that the command does not have.
  void AddNote(const std::string& text) const;
  /// One of the subcommands must be given.
  void RequireCommand() const;

  /// An option, or an argument if `name` does not begin with a dash. `value` outlives the parsing.
  /// @tparam Value  one of those at the end of command.cc.
  template <typename Value>
  Option Add(const std::string& name, Value& value, const std::string& text) const;
  /// The help says what follows --, and the command takes it as more of its list of words. (CLI11
  /// alone would, only while that list is empty.)
  void AddRest(const std::string& name, const std::string& text) const;
  Option AddFlag(const std::string& name, bool& value, const std::string& text) const;
  /// --seed, or another name, a whole number from 0. (CLI11 alone would take -1 for the largest of
  /// them.)
  Option AddSeed(std::uint64_t& seed, const std::string& text) const;
  Option AddSeed(const std::string& name, std::uint64_t& seed, const std::string& text) const;

  /// What is done when the command line names this command, after its values are set.
  void OnChosen(const std::function<void()>& action) const;

 private:
  CLI::App* app_;
};

/// Throws InputError for "--out=", which would take the next word for its value. What a script is
/// given is the script's.
void RequireValues(int argc, char** argv);

/// One line about a command line that cannot be taken: the command, what was expected, what came.
/// @param app  the program, which has parsed up to there.
std::string DescribeParseError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace pregrasp
