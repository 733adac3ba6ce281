#pragma once

#include <map>
#include <string>
#include <vector>

namespace pregrasp {

/// What the annotations say of a name, for help() and completion.
struct ManualEntry {
  struct Part {  ///< a field of a table or class, or a parameter of a function
    std::string name, type, text;
    bool optional = false;
  };
  std::string name;       ///< "pregrasp.open", "Session:settle", "Body"
  std::string signature;  ///< with parameters; a function's only
  std::string text;
  std::vector<Part> parts;
  std::string result;  ///< what a function returns, with its type first

  bool is_function() const { return !signature.empty(); }
};

/// The words in quotes that a type allows: none, key and all of `"none"|"key"|"all"`.
std::vector<std::string> WordsOf(const std::string& type);

/// The annotations as data. Their form is held by a test.
class Manual {
 public:
  /// That of the program: lua/meta/pregrasp.lua, read when first asked for, with the options of the
  /// planner's stages; these alone if the file is gone.
  static const Manual& Get();

  explicit Manual(const std::string& text);

  const std::map<std::string, ManualEntry>& entries() const { return entries_; }
  const ManualEntry* Find(const std::string& name) const;

  /// The functions of a class or module, in the file's order.
  std::vector<const ManualEntry*> FunctionsOf(const std::string& owner) const;

  /// The table of options that a function takes, or null.
  const ManualEntry* OptionsOf(const ManualEntry& function) const;

  /// The words that a value of a type may be, of the type itself or of the alias that it names.
  std::vector<std::string> ValuesOf(const std::string& type) const;

  /// Help on `name` as a person reads it: a class with fields and methods, or a function with its
  /// options. Empty if there is no such name.
  std::string Explain(const std::string& name) const;

  /// Full names that `word` may mean, whatever its capitals: itself, members called so, fields and
  /// options ("OptimizeOptions.sigma"), words that an argument may be ("Overlay.ghost").
  std::vector<std::string> Match(const std::string& word) const;

  /// Full names of what mentions all words of `text`, in the file's order.
  std::vector<std::string> Search(const std::string& text) const;

  /// One line on a name: `OptimizeOptions.sigma  number  standard deviation ..`.
  std::string Summarize(const std::string& name) const;

 private:
  // The field or option "Class.name"; null if there is none, with its class.
  const ManualEntry::Part* FindPart(const std::string& name) const;

  std::map<std::string, ManualEntry> entries_;
  std::vector<std::string> order_;
};

}  // namespace pregrasp
