#include "bindings/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

#include "app/core/data_folder.h"
#include "bindings/planner_options.h"

namespace pregrasp {
namespace {

// The word or type that `text` starts with, taken off it: types may hold blanks within brackets and
// quotes.
std::string TakeWord(std::string& text) {
  int depth = 0;
  bool quoted = false;
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (c == '"') quoted = !quoted;
    if (!quoted && (c == '<' || c == '(')) ++depth;
    if (!quoted && (c == '>' || c == ')')) --depth;
    if (c == ' ' && depth == 0 && !quoted) break;
  }
  std::string word = text.substr(0, end);
  text.erase(0, std::min(text.find_first_not_of(' ', end), text.size()));
  return word;
}

}  // namespace

std::vector<std::string> WordsOf(const std::string& type) {
  std::vector<std::string> words;
  for (std::size_t at = type.find('"'); at != std::string::npos;) {
    const std::size_t end = type.find('"', at + 1);
    if (end == std::string::npos) break;
    words.push_back(type.substr(at + 1, end - at - 1));
    at = type.find('"', end + 1);
  }
  return words;
}

namespace {

ManualEntry::Part TakePart(std::string text) {
  ManualEntry::Part part;
  part.name = TakeWord(text);
  if (part.name.back() == '?') {
    part.name.pop_back();
    part.optional = true;
  }
  part.type = TakeWord(text);
  part.text = text;
  return part;
}

std::string ToLower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool StartsWith(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

// The name of a class within a type: "Scene" of "Scene[]".
std::string ClassName(const std::string& type) {
  return type.substr(0, type.find_first_of("[|<("));
}

void AddPart(std::string& text, const ManualEntry::Part& part, std::size_t width,
             const std::string& indent) {
  text += fmt::format("{}{:<{}}  {}{}{}\n", indent, part.name + (part.optional ? "?" : ""), width,
                      part.type, part.text.empty() ? "" : "  ", part.text);
}

void AddLine(std::string& text, const std::string& line) {
  if (!text.empty()) text += '\n';
  text += line;
}

std::size_t WidthOf(const std::vector<ManualEntry::Part>& parts) {
  std::size_t width = 0;
  for (const auto& part : parts) width = std::max(width, part.name.size() + part.optional);
  return width;
}

}  // namespace

const Manual& Manual::Get() {
  static const Manual manual = [] {
    std::ifstream in(DataFolder() / "lua/meta/pregrasp.lua");
    std::stringstream text;
    text << in.rdbuf();
    return Manual(text.str() + '\n' + OptionAnnotations());
  }();
  return manual;
}

Manual::Manual(const std::string& text) {
  std::istringstream in(text);
  ManualEntry entry;
  std::string result;
  const auto finish = [&](const std::string& name) {
    if (!name.empty()) {
      entry.name = name;
      if (entries_.emplace(name, entry).second) order_.push_back(name);
    }
    entry = {};
  };
  for (std::string line; std::getline(in, line);) {
    if (StartsWith(line, "---@class ")) {
      std::string rest = line.substr(10);
      entry.name = TakeWord(rest);
      if (!rest.empty()) AddLine(entry.text, rest);
    } else if (StartsWith(line, "---@field ")) {
      entry.parts.push_back(TakePart(line.substr(10)));
    } else if (StartsWith(line, "---@param ")) {
      entry.parts.push_back(TakePart(line.substr(10)));
    } else if (StartsWith(line, "---@return ")) {
      entry.result = line.substr(11);
    } else if (StartsWith(line, "---@alias ")) {
      std::string rest = line.substr(10);
      const std::string name = TakeWord(rest);
      if (!rest.empty() && rest.front() != '"') continue;  // a name for a type
      entry.name = name;
      for (const std::string& word : WordsOf(rest)) entry.parts.push_back({word, "", "", false});
    } else if (StartsWith(line, "---| ")) {
      std::string rest = line.substr(5);
      std::string word = TakeWord(rest);
      word.erase(std::remove(word.begin(), word.end(), '"'), word.end());
      entry.parts.push_back({word, "", rest.substr(std::min<std::size_t>(rest.size(), 2)), false});
    } else if (StartsWith(line, "---@")) {
      continue;
    } else if (StartsWith(line, "---")) {
      AddLine(entry.text, line.substr(3));
    } else if (StartsWith(line, "function ")) {
      entry.signature = line.substr(9, line.find(')') - 8);
      finish(entry.signature.substr(0, entry.signature.find('(')));
    } else {
      finish(entry.name);
    }
  }
  finish(entry.name);
}

const ManualEntry* Manual::Find(const std::string& name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? nullptr : &found->second;
}

std::vector<const ManualEntry*> Manual::FunctionsOf(const std::string& owner) const {
  std::vector<const ManualEntry*> functions;
  for (const std::string& name : order_) {
    const ManualEntry& entry = entries_.at(name);
    if (!entry.is_function() || !StartsWith(name, owner)) continue;
    if (name[owner.size()] == ':' || name[owner.size()] == '.') functions.push_back(&entry);
  }
  return functions;
}

const ManualEntry* Manual::OptionsOf(const ManualEntry& function) const {
  for (const auto& part : function.parts) {
    const ManualEntry* options = Find(ClassName(part.type));
    if (options != nullptr && !options->parts.empty()) return options;
  }
  return nullptr;
}

std::vector<std::string> Manual::ValuesOf(const std::string& type) const {
  std::vector<std::string> words = WordsOf(type);
  const ManualEntry* alias = Find(ClassName(type));
  if (alias == nullptr || alias->is_function() || alias->parts.empty()) return words;
  for (const auto& part : alias->parts) {
    if (part.type.empty()) words.push_back(part.name);
  }
  return words;
}

std::string Manual::Explain(const std::string& name) const {
  const ManualEntry* entry = Find(name);
  if (entry == nullptr) return FindPart(name) == nullptr ? "" : Summarize(name) + '\n';
  std::string text = entry->is_function() ? entry->signature : entry->name;
  if (!entry->result.empty()) text += " -> " + entry->result;
  text += '\n';
  std::istringstream lines(entry->text);
  for (std::string line; std::getline(lines, line);) text += "  " + line + '\n';
  const std::size_t width = WidthOf(entry->parts);
  for (const auto& part : entry->parts) {
    AddPart(text, part, width, "  ");
    const ManualEntry* options = entry->is_function() ? Find(ClassName(part.type)) : nullptr;
    if (options == nullptr) continue;
    for (const auto& option : options->parts) {
      AddPart(text, option, WidthOf(options->parts), "    ");
    }
  }
  for (const ManualEntry* function : FunctionsOf(name)) {
    const std::string& first = function->text;
    text += fmt::format("  {}  {}\n", function->signature.substr(name.size()),
                        first.substr(0, first.find('\n')));
  }
  return text;
}

const ManualEntry::Part* Manual::FindPart(const std::string& name) const {
  const std::size_t dot = name.find('.');
  const ManualEntry* entry = dot == std::string::npos ? nullptr : Find(name.substr(0, dot));
  if (entry == nullptr || entry->is_function()) return nullptr;
  for (const auto& part : entry->parts) {
    if (part.name == name.substr(dot + 1)) return &part;
  }
  return nullptr;
}

std::string Manual::Summarize(const std::string& name) const {
  if (const auto* part = FindPart(name)) {
    return fmt::format("{}{}{}  {}", name, part->type.empty() ? "" : "  ", part->type, part->text);
  }
  const ManualEntry* entry = Find(name);
  if (entry == nullptr) return name;
  return fmt::format("{}  {}", entry->is_function() ? entry->signature : name,
                     entry->text.substr(0, entry->text.find('\n')));
}

std::vector<std::string> Manual::Match(const std::string& word) const {
  if (Find(word) != nullptr || FindPart(word) != nullptr) return {word};
  const std::string lower = ToLower(word);
  std::vector<std::string> names;
  for (const std::string& name : order_) {
    const std::size_t separator = name.find_first_of(".:");
    const bool member =
        separator != std::string::npos && ToLower(name.substr(separator + 1)) == lower;
    if (member || ToLower(name) == lower) names.push_back(name);
  }
  for (const std::string& name : order_) {
    const ManualEntry& entry = entries_.at(name);
    if (entry.is_function()) continue;
    for (const auto& part : entry.parts) {
      const std::string full = name + '.' + part.name;
      if (ToLower(part.name) == lower && Find(full) == nullptr) names.push_back(full);
    }
  }
  return names;
}

std::vector<std::string> Manual::Search(const std::string& text) const {
  std::vector<std::string> words;
  std::istringstream in(ToLower(text));
  for (std::string word; in >> word;) words.push_back(word);
  const auto mentions = [&](const std::string& where) {
    const std::string lower = ToLower(where);
    return !words.empty() && std::all_of(words.begin(), words.end(), [&](const std::string& word) {
      return lower.find(word) != std::string::npos;
    });
  };
  std::vector<std::string> names;
  for (const std::string& name : order_) {
    const ManualEntry& entry = entries_.at(name);
    std::string all = name + ' ' + entry.text + ' ' + entry.result;
    if (entry.is_function()) {
      for (const auto& part : entry.parts) all += ' ' + part.name + ' ' + part.text;
    }
    if (mentions(all)) names.push_back(name);
    if (entry.is_function()) continue;
    for (const auto& part : entry.parts) {
      const std::string full = name + '.' + part.name;
      if (Find(full) == nullptr && mentions(full + ' ' + part.text)) names.push_back(full);
    }
  }
  return names;
}

}  // namespace pregrasp
