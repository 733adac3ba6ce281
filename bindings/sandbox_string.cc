#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bindings/lua_pattern.h"
#include "bindings/protect.h"
#include "bindings/sandbox.h"

namespace pregrasp {
namespace {

constexpr std::size_t kMaxPattern = 1U << 14U;  // a compiled pattern takes 100 times its length

std::string_view ToView(lua_State* L, int index) {
  std::size_t size = 0;
  const char* data = luaL_checklstring(L, index, &size);
  return {data, size};
}

LuaPattern Compile(std::string_view pattern, bool anchors) {
  if (pattern.size() > kMaxPattern) {
    throw InputError("", "pattern", "at most 16384 characters", std::to_string(pattern.size()));
  }
  return LuaPattern(pattern, anchors);
}

MatchSteps StepsFor(lua_State* L) {
  return MatchSteps([L] { Machine::Of(L).CheckTime(L); });
}

// A malformed pattern is the script's mistake, not a bug of ours.
template <typename Body>
int ProtectPattern(lua_State* L, Body&& body) {
  return Protect(L, [&]() -> int {
    try {
      return body();
    } catch (const std::invalid_argument& error) {
      throw InputError(error.what());
    }
  });
}

void PushCapture(lua_State* L, std::string_view subject, const LuaPattern::Capture& capture) {
  if (capture.position) {
    lua_pushinteger(L, static_cast<lua_Integer>(capture.begin) + 1);
  } else {
    lua_pushlstring(L, subject.data() + capture.begin, capture.end - capture.begin);
  }
}

// All captures, or the whole match where there are none.
int PushCaptures(lua_State* L, std::string_view subject, const LuaPattern::Match& match,
                 bool whole_if_none) {
  luaL_checkstack(L, LuaPattern::kMaxCaptures + 2, "too many captures");
  if (match.captures.empty() && whole_if_none) {
    PushCapture(L, subject, {match.begin, match.end, false});
    return 1;
  }
  for (const LuaPattern::Capture& capture : match.captures) PushCapture(L, subject, capture);
  return static_cast<int>(match.captures.size());
}

// The 0-based start that argument `index` asks for, or nothing when it lies past the end.
std::optional<std::size_t> StartPosition(lua_State* L, int index, std::size_t size) {
  const lua_Integer position = luaL_optinteger(L, index, 1);
  if (position > static_cast<lua_Integer>(size) + 1) return std::nullopt;
  if (position > 0) return static_cast<std::size_t>(position) - 1;
  if (position == 0 || position < -static_cast<lua_Integer>(size)) return 0;
  return size + static_cast<std::size_t>(position);
}

bool HasSpecials(std::string_view pattern) {
  return pattern.find_first_of("^$*+?.([%-") != std::string_view::npos;
}

int FindOrMatch(lua_State* L, bool find) {
  Machine::Of(L).CheckTime(L);  // called by another function of C, no hook comes between
  const std::string_view subject = ToView(L, 1);
  const std::string_view pattern = ToView(L, 2);
  const std::optional<std::size_t> start = StartPosition(L, 3, subject.size());
  if (!start) {
    lua_pushnil(L);
    return 1;
  }
  if (find && (lua_toboolean(L, 4) || !HasSpecials(pattern))) {
    const void* found = memmem(subject.data() + *start, subject.size() - *start, pattern.data(),
                               pattern.size());  // linear in the worst case
    if (found == nullptr) {
      lua_pushnil(L);
      return 1;
    }
    const auto begin = static_cast<const char*>(found) - subject.data();
    lua_pushinteger(L, begin + 1);
    lua_pushinteger(L, begin + static_cast<lua_Integer>(pattern.size()));
    return 2;
  }
  MatchSteps steps = StepsFor(L);
  LuaPattern::Match match;
  if (!Compile(pattern, true).Find(subject, *start, steps, match)) {
    lua_pushnil(L);
    return 1;
  }
  if (!find) return PushCaptures(L, subject, match, true);
  lua_pushinteger(L, static_cast<lua_Integer>(match.begin) + 1);
  lua_pushinteger(L, static_cast<lua_Integer>(match.end));
  return 2 + PushCaptures(L, subject, match, false);
}

int Find(lua_State* L) {
  return ProtectPattern(L, [L] { return FindOrMatch(L, true); });
}

int Match(lua_State* L) {
  return ProtectPattern(L, [L] { return FindOrMatch(L, false); });
}

// Upvalues: subject, pattern, where to go on, end of the last match.
int NextMatch(lua_State* L) {
  return ProtectPattern(L, [L]() -> int {
    const std::string_view subject = ToView(L, lua_upvalueindex(1));
    const LuaPattern pattern = Compile(ToView(L, lua_upvalueindex(2)), false);
    const auto last = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(4)));
    MatchSteps steps = StepsFor(L);
    LuaPattern::Match match;
    for (auto begin = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(3)));
         begin <= subject.size(); ++begin) {
      if (!pattern.MatchAt(subject, begin, steps, match) || match.end + 1 == last) continue;
      lua_pushinteger(L, static_cast<lua_Integer>(match.end));
      lua_replace(L, lua_upvalueindex(3));
      lua_pushinteger(L, static_cast<lua_Integer>(match.end) + 1);
      lua_replace(L, lua_upvalueindex(4));
      return PushCaptures(L, subject, match, true);
    }
    return 0;
  });
}

int GMatch(lua_State* L) {
  return Protect(L, [L] {
    const std::string_view subject = ToView(L, 1);
    ToView(L, 2);
    const std::size_t start = StartPosition(L, 3, subject.size()).value_or(subject.size() + 1);
    lua_settop(L, 2);
    lua_pushinteger(L, static_cast<lua_Integer>(start));
    lua_pushinteger(L, 0);  // no match yet
    lua_pushcclosure(L, NextMatch, 4);
    return 1;
  });
}

// Appends what the replacement string makes of a match.
void ExpandString(lua_State* L, std::string_view subject, const LuaPattern::Match& match,
                  std::string_view replacement, std::string& result) {
  for (std::size_t i = 0; i < replacement.size(); ++i) {
    if (replacement[i] != '%') {
      result += replacement[i];
      continue;
    }
    const char c = ++i < replacement.size() ? replacement[i] : '\0';
    if (c == '%') {
      result += '%';
    } else if (c == '0' || (c == '1' && match.captures.empty())) {
      result += subject.substr(match.begin, match.end - match.begin);
    } else if (c >= '1' && c <= '9') {
      const auto index = static_cast<std::size_t>(c - '1');
      if (index >= match.captures.size()) {
        throw InputError(std::string("invalid capture index %") + c + " in replacement string");
      }
      PushCapture(L, subject, match.captures[index]);
      result += ToView(L, -1);
      lua_pop(L, 1);
    } else {
      throw InputError("invalid use of '%' in replacement string");
    }
  }
}

// Appends the replacement (argument 3) of one match; a false or nil value keeps the text.
void AppendReplacement(lua_State* L, std::string_view subject, const LuaPattern::Match& match,
                       std::string& result) {
  const int kind = lua_type(L, 3);
  if (kind == LUA_TSTRING || kind == LUA_TNUMBER) {
    ExpandString(L, subject, match, ToView(L, 3), result);
    return;
  }
  if (kind == LUA_TFUNCTION) {
    lua_pushvalue(L, 3);
    lua_call(L, PushCaptures(L, subject, match, true), 1);
  } else {
    lua_settop(L, 4);
    PushCaptures(L, subject, match, true);
    lua_settop(L, 5);  // the first one is the key
    lua_gettable(L, 3);
  }
  if (!lua_toboolean(L, -1)) {
    result += subject.substr(match.begin, match.end - match.begin);
  } else if (lua_isstring(L, -1)) {
    result += ToView(L, -1);
  } else {
    throw InputError(std::string("invalid replacement value (a ") + luaL_typename(L, -1) + ")");
  }
  lua_pop(L, 1);
}

int GSub(lua_State* L) {
  return ProtectPattern(L, [L]() -> int {
    const std::string_view subject = ToView(L, 1);
    const LuaPattern pattern = Compile(ToView(L, 2), true);
    const int kind = lua_type(L, 3);
    if (kind != LUA_TSTRING && kind != LUA_TNUMBER && kind != LUA_TFUNCTION && kind != LUA_TTABLE) {
      luaL_typeerror(L, 3, "string/function/table");
    }
    const lua_Integer most = luaL_optinteger(L, 4, static_cast<lua_Integer>(subject.size()) + 1);
    lua_settop(L, 4);
    MatchSteps steps = StepsFor(L);
    LuaPattern::Match match;
    std::string result;
    lua_Integer count = 0;
    std::size_t at = 0;
    std::size_t last = static_cast<std::size_t>(-1);  // end of the last match
    while (count < most) {
      if (pattern.MatchAt(subject, at, steps, match) && match.end != last) {
        ++count;
        AppendReplacement(L, subject, match, result);
        at = last = match.end;
      } else if (at < subject.size()) {
        result += subject[at++];
      } else {
        break;
      }
      if (result.size() > Machine::kMaxString) throw std::bad_alloc();
      if (pattern.anchored()) break;
    }
    if (at < subject.size()) result += subject.substr(at);
    lua_pushlstring(L, result.data(), result.size());
    lua_pushinteger(L, count);
    return 2;
  });
}

int Repeat(lua_State* L) {
  return Protect(L, [L]() -> int {
    const std::string_view text = ToView(L, 1);
    const lua_Integer count = luaL_checkinteger(L, 2);
    const std::string_view separator = lua_isnoneornil(L, 3) ? std::string_view() : ToView(L, 3);
    std::string result;
    // Lua's own loops `count` times even over nothing.
    if (count > 0 && !(text.empty() && separator.empty())) {
      const std::size_t unit = text.size() + separator.size();
      if (static_cast<std::size_t>(count) > Machine::kMaxString / unit + 1) throw std::bad_alloc();
      result.reserve(unit * static_cast<std::size_t>(count));
      for (lua_Integer i = 0; i < count; ++i) {
        if (i > 0) result += separator;
        result += text;
      }
    }
    Machine::Of(L).CheckTime(L);
    lua_pushlstring(L, result.data(), result.size());
    return 1;
  });
}

// Lua's own format, after taking the addresses out of its arguments.
int Format(lua_State* L) {
  Machine::Of(L).CheckTime(L);
  const std::string_view format = ToView(L, 1);
  for (std::size_t i = 0; i + 1 < format.size(); ++i) {
    if (format[i] != '%') continue;
    i = format.find_first_not_of("-+ #0123456789.", i + 1);
    if (i == std::string_view::npos) break;
    if (format[i] == 'p') return luaL_error(L, "invalid conversion '%%p' to 'format'");
  }
  for (int i = 2; i <= lua_gettop(L); ++i) {
    const int kind = lua_type(L, i);
    if (kind == LUA_TTABLE || kind == LUA_TUSERDATA || kind == LUA_TFUNCTION ||
        kind == LUA_TTHREAD) {
      PushText(L, i);
      lua_replace(L, i);
    }
  }
  const lua_CFunction original = lua_tocfunction(L, lua_upvalueindex(1));
  return original(L);
}

}  // namespace

void ReplaceStringFunctions(lua_State* L) {
  lua_pushnil(L);
  lua_setfield(L, -2, "dump");
  lua_getfield(L, -1, "format");
  lua_pushcclosure(L, Format, 1);
  lua_setfield(L, -2, "format");
  const luaL_Reg replaced[] = {{"find", Find}, {"match", Match}, {"gmatch", GMatch},
                               {"gsub", GSub}, {"rep", Repeat},  {nullptr, nullptr}};
  luaL_setfuncs(L, replaced, 0);
}

}  // namespace pregrasp
