#include "bindings/completion.h"

#include <algorithm>
#include <array>
#include <set>

#include "app/job/planner_settings.h"
#include "bindings/help.h"
#include "bindings/manual.h"
#include "bindings/protect.h"
#include "bindings/schema.h"
#include "bindings/typed_text.h"
#include "bindings/value.h"

namespace pregrasp {
namespace {

constexpr std::array<const char*, 22> kKeywords = {
    "and",      "break",  "do",   "else", "elseif", "end",  "false", "for",
    "function", "goto",   "if",   "in",   "local",  "nil",  "not",   "or",
    "repeat",   "return", "then", "true", "until",  "while"};

using Kind = LuaToken::Kind;
using Tokens = std::vector<LuaToken>;

// A line cut into what comes before the word at its end, and the word. The tokens are views of the
// line.
struct Typed {
  Tokens before;
  std::string word;
  std::size_t begin = 0;
  bool quoted = false;  // the word is a string that is still open
};

Typed Cut(const std::string& line) {
  Typed typed{SplitLua(line), "", line.size()};
  if (!typed.before.empty()) {
    const LuaToken last = typed.before.back();
    if (last.kind == Kind::kName && last.begin + last.text.size() == line.size()) {
      typed.word = last.text;
      typed.begin = last.begin;
      typed.before.pop_back();
    } else if (last.kind == Kind::kString && last.text.front() != '[' &&
               (last.text.size() == 1 || last.text.back() != last.text.front())) {
      typed.quoted = true;
      typed.word = last.text.substr(1);
      typed.begin = last.begin + 1;
      typed.before.pop_back();
    }
  }
  return typed;
}

// Replaces the value on top by its field, without calling anything but properties.
bool Enter(lua_State* L) {  // value, key -> field
  const int value = lua_gettop(L) - 1;
  if (const ClassInfo* info = FindClass(L, value)) {
    if (lua_type(L, -1) != LUA_TSTRING) return false;
    const std::string key = lua_tostring(L, -1);
    const auto named = [&](const FunctionInfo& function) { return function.name == key; };
    if (std::none_of(info->properties.begin(), info->properties.end(), named) &&
        std::none_of(info->methods.begin(), info->methods.end(), named)) {
      return false;
    }
    lua_gettable(L, value);
  } else if (lua_type(L, value) == LUA_TTABLE) {
    lua_pushvalue(L, -1);
    if (lua_rawget(L, value) == LUA_TNIL && luaL_getmetafield(L, value, "__index") == LUA_TTABLE) {
      lua_pushvalue(L, value + 1);
      lua_rawget(L, -2);
    }
  } else {
    return false;
  }
  lua_replace(L, value);
  lua_settop(L, value);
  return true;
}

// Pushes the value of the chain `a.b[1]:c` that ends before token `end`; false if there is none.
bool PushChain(lua_State* L, const Tokens& tokens, std::size_t end) {
  std::size_t begin = end;
  for (;;) {
    if (begin >= 3 && tokens[begin - 1].text == "]" && tokens[begin - 2].kind == Kind::kNumber &&
        tokens[begin - 3].text == "[") {
      begin -= 3;
      continue;
    }
    if (begin == 0 || tokens[begin - 1].kind != Kind::kName) return false;
    --begin;
    if (begin == 0 || (tokens[begin - 1].text != "." && tokens[begin - 1].text != ":")) break;
    --begin;
  }
  Machine::Of(L).PushTypedEnvironment(L);
  for (std::size_t i = begin; i < end; ++i) {
    const LuaToken& token = tokens[i];
    if (token.kind == Kind::kSign) continue;
    const std::string text(token.text);
    if (token.kind == Kind::kNumber) {
      lua_stringtonumber(L, text.c_str());
    } else {
      lua_pushlstring(L, text.data(), text.size());
    }
    if (!Enter(L)) return false;
  }
  return true;
}

void AddKeys(lua_State* L, int table, std::set<std::string>& words) {
  lua_pushnil(L);
  while (lua_next(L, table) != 0) {
    lua_pop(L, 1);
    if (lua_type(L, -1) == LUA_TSTRING) words.insert(lua_tostring(L, -1));
  }
}

// The members of the value on top.
std::set<std::string> Members(lua_State* L, bool methods) {
  const int value = lua_gettop(L);
  std::set<std::string> words;
  if (const ClassInfo* info = FindClass(L, value)) {
    for (const auto& member : methods ? info->methods : info->properties) words.insert(member.name);
  } else if (lua_type(L, value) == LUA_TTABLE) {
    AddKeys(L, value, words);
    if (luaL_getmetafield(L, value, "__index") == LUA_TTABLE) AddKeys(L, lua_gettop(L), words);
  }
  return words;
}

// Where the innermost brace that is open at the end stands; the number of tokens if none is.
std::size_t FindOpenBrace(const Tokens& tokens) {
  int depth = 0;
  for (std::size_t i = tokens.size(); i-- > 0;) {
    if (tokens[i].text == "}") ++depth;
    if (tokens[i].text == "{" && depth-- == 0) return i;
  }
  return tokens.size();
}

// The options of the call whose table is open at the end; null if none is.
const ManualEntry* FindOptions(lua_State* L, const Tokens& tokens) {
  const std::size_t brace = FindOpenBrace(tokens);
  if (brace == tokens.size() || brace == 0) return nullptr;
  const std::size_t end = tokens[brace - 1].text == "(" ? brace - 1 : brace;
  if (end == 0 || !PushChain(L, tokens, end)) return nullptr;
  const Manual& manual = Manual::Get();
  const ManualEntry* function = manual.Find(FindManualName(L, lua_gettop(L)));
  return function == nullptr ? nullptr : manual.OptionsOf(*function);
}

// The options that the call around the end takes, if a new key can begin there.
std::set<std::string> Options(lua_State* L, const Tokens& tokens) {
  std::set<std::string> words;
  if (tokens.empty()) return words;
  const std::string_view last = tokens.back().text;
  if (last != "{" && last != "," && last != ";") return words;
  const ManualEntry* options = FindOptions(L, tokens);
  if (options == nullptr) return words;
  for (const auto& part : options->parts) words.insert(part.name);
  return words;
}

// What the first argument of the call that begins at the end may be, `f"`, `x:f("` or `f{ "`: a
// word of its type, or the id of a step.
std::set<std::string> Arguments(lua_State* L, const Tokens& tokens) {
  std::size_t end = FindOpenBrace(tokens);
  if (end > 0 && tokens[end - 1].text == "(") --end;
  if (end == 0 || !PushChain(L, tokens, end)) return {};
  const ManualEntry* function = Manual::Get().Find(FindManualName(L, lua_gettop(L)));
  if (function == nullptr || function->parts.empty()) return {};
  const ManualEntry::Part& first = function->parts.front();
  const std::vector<std::string> values = Manual::Get().ValuesOf(first.type);
  std::set<std::string> words(values.begin(), values.end());
  if (first.name == "id" && first.type == "string" && end >= 3 && tokens[end - 2].text == ":" &&
      PushChain(L, tokens, end - 2)) {
    lua_pushliteral(L, "ids");
    if (!Enter(L) || !lua_istable(L, -1)) return words;
    for (const std::string& id : LuaValue<std::vector<std::string>>::Read(L, lua_gettop(L), "")) {
      words.insert(id);
    }
  }
  return words;
}

// Whether a key of a table `set = {` begins at the end, as `["`.
bool IsSettingsKey(Tokens tokens) {
  if (tokens.empty() || tokens.back().text != "[") return false;
  tokens.pop_back();
  const std::size_t brace = FindOpenBrace(tokens);
  return brace < tokens.size() && brace >= 2 && tokens[brace - 1].text == "=" &&
         tokens[brace - 2].text == "set";
}

// What may be in the quotes that open at the end: the values of `key =`, or of its list; a
// setting's full name; an argument.
std::set<std::string> Values(lua_State* L, Tokens tokens) {
  if (IsSettingsKey(tokens)) {
    std::set<std::string> names;
    for (const PlannerSetting& setting : SettingsTable()) names.insert(setting.name);
    return names;
  }
  if (std::set<std::string> words = Arguments(L, tokens); !words.empty()) return words;
  if (!tokens.empty() && tokens.back().text != "=") {
    const std::size_t brace = FindOpenBrace(tokens);
    tokens.resize(std::min(brace, tokens.size()));
  }
  if (tokens.size() < 2 || tokens.back().text != "=") return {};
  const std::string key(tokens[tokens.size() - 2].text);
  tokens.resize(tokens.size() - 2);
  const ManualEntry* options = FindOptions(L, tokens);
  if (options == nullptr) return {};
  std::set<std::string> words;
  for (const auto& part : options->parts) {
    if (part.name != key) continue;
    for (const std::string& word : Manual::Get().ValuesOf(part.type)) words.insert(word);
  }
  return words;
}

std::set<std::string> Candidates(lua_State* L, const Typed& typed) {
  const Tokens& before = typed.before;
  if (typed.quoted) return Values(L, before);
  if (!before.empty() && (before.back().text == "." || before.back().text == ":")) {
    if (!PushChain(L, before, before.size() - 1)) return {};
    return Members(L, before.back().text == ":");
  }
  if (!before.empty() && before.back().kind == Kind::kString) return {};
  std::set<std::string> words = Options(L, before);
  if (!words.empty()) return words;
  words.insert(kKeywords.begin(), kKeywords.end());
  Machine::Of(L).PushTypedEnvironment(L);
  AddKeys(L, lua_gettop(L), words);
  return words;
}

int Complete(lua_State* L) {
  return Protect(L, [L] {
    const std::string line = lua_tostring(L, 1);
    const Typed typed = Cut(line);
    std::vector<std::string> words;
    for (const std::string& word : Candidates(L, typed)) {
      if (word.rfind(typed.word, 0) == 0) words.push_back(word);
    }
    lua_pushinteger(L, static_cast<lua_Integer>(typed.begin));
    LuaValue<std::vector<std::string>>::Push(L, words);
    return 2;
  });
}

}  // namespace

Completion CompleteLine(Machine& machine, const std::string& line) {
  lua_State* L = machine.state();
  Completion completion;
  try {
    lua_pushcfunction(L, Complete);
    lua_pushlstring(L, line.data(), line.size());
    machine.Call(1, 2);
    completion.begin = static_cast<std::size_t>(lua_tointeger(L, -2));
    completion.words = LuaValue<std::vector<std::string>>::Read(L, -1, "");
    lua_pop(L, 2);
  } catch (const InputError&) {
    completion = {line.size(), {}};  // a value that cannot be read has nothing to offer
  }
  return completion;
}

}  // namespace pregrasp
