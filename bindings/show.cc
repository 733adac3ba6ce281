#include "bindings/show.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bindings/lua_array.h"
#include "bindings/sandbox.h"
#include "bindings/schema.h"
#include "bindings/value.h"

namespace pregrasp {
namespace {

constexpr int kMostRows = 20;          // of a table
constexpr int kMostInline = 8;         // entries of a list within a line
constexpr int kMostNested = 2;         // lists within lists
constexpr std::size_t kMostText = 60;  // bytes of a text within a line
constexpr int kMostColumn = 28;

using Row = std::vector<std::string>;

// At most `most` bytes, whole UTF-8 characters, ".." at the end if something is missing.
std::string Clip(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most > 2 ? most - 2 : 0;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "..";
}

void AddLine(std::string& text, const std::string& line) {
  if (!text.empty()) text += '\n';
  text += line;
}

std::string ShowText(lua_State* L, int index) {
  PushText(L, index);
  std::string text = lua_tostring(L, -1);
  lua_pop(L, 1);
  return text;
}

std::string ShowNumber(lua_State* L, int index, int digits) {
  if (lua_isinteger(L, index)) return std::to_string(lua_tointeger(L, index));
  const double number = lua_tonumber(L, index) + 0.0;  // without a zero's sign
  return std::isnan(number) ? "nan" : fmt::format("{:.{}g}", number, digits);
}

// A locked library or module stands for the table behind it: replaces the value on top.
void OpenProxy(lua_State* L) {
  if (lua_type(L, -1) != LUA_TTABLE || !lua_getmetatable(L, -1)) return;
  lua_pushliteral(L, "__index");
  lua_rawget(L, -2);
  lua_remove(L, -2);
  if (lua_type(L, -1) == LUA_TTABLE) {
    lua_replace(L, -2);
  } else {
    lua_pop(L, 1);
  }
}

// The fields to show of the value at `index`, in their order.
std::vector<std::string> FieldNames(lua_State* L, int index) {
  if (const ClassInfo* info = FindClass(L, index)) {
    std::vector<std::string> names;
    for (const FunctionInfo& property : info->properties) names.push_back(property.name);
    return names;
  }
  std::vector<std::string> names;
  if (lua_type(L, index) != LUA_TTABLE) return names;
  lua_pushnil(L);
  while (lua_next(L, index) != 0) {
    lua_pop(L, 1);
    if (lua_type(L, -1) == LUA_TSTRING) names.emplace_back(lua_tostring(L, -1));
  }
  if (const Schema* schema = FindSchema(L, index)) {
    const auto place = [&](const std::string& name) {
      return std::find(schema->keys.begin(), schema->keys.end(), name) - schema->keys.begin();
    };
    std::sort(names.begin(), names.end(),
              [&](const std::string& a, const std::string& b) { return place(a) < place(b); });
  } else {
    std::sort(names.begin(), names.end());
  }
  return names;
}

void PushField(lua_State* L, int index, const std::string& name) {
  lua_pushlstring(L, name.data(), name.size());
  if (lua_type(L, index) == LUA_TTABLE) {
    lua_rawget(L, index);
  } else {
    lua_gettable(L, index);
  }
}

std::string NameOf(lua_State* L, int index) {
  const Schema* schema = FindSchema(L, index);
  const ClassInfo* info = FindClass(L, index);
  return schema != nullptr ? schema->name : info != nullptr ? info->name : "";
}

std::string Inline(lua_State* L, int index, int depth);

// Below this share of the largest number of a list, one is rounding: a normal's -2e-09.
constexpr double kRounding = 1e-7;

// What is rounding in a list of `count` entries; 0 for one that is not of numbers.
double RoundingOf(lua_State* L, int index, int count) {
  double largest = 0.0;
  for (int i = 1; i <= count; ++i) {
    const bool number = lua_rawgeti(L, index, i) == LUA_TNUMBER;
    largest = number ? std::max(largest, std::abs(lua_tonumber(L, -1))) : 0.0;
    lua_pop(L, 1);
    if (!number) return 0.0;
  }
  return kRounding * largest;
}

std::string InlineList(lua_State* L, int index, int count, int depth) {
  lua_rawgeti(L, index, 1);
  const std::string kind = NameOf(L, lua_gettop(L));
  lua_pop(L, 1);
  if (!kind.empty()) return fmt::format("{} {}", count, kind);
  if (depth >= kMostNested) return fmt::format("{{{} entries}}", count);
  std::string text = "{";
  const int shown = std::min(count, kMostInline);
  const double rounding = RoundingOf(L, index, shown);
  for (int i = 1; i <= shown; ++i) {
    const bool number = lua_rawgeti(L, index, i) == LUA_TNUMBER;
    const bool nothing = number && std::abs(lua_tonumber(L, -1)) < rounding;
    text += (i > 1 ? ", " : "") + (nothing ? "0" : Inline(L, lua_gettop(L), depth + 1));
    lua_pop(L, 1);
  }
  return text + (count > kMostInline ? fmt::format(", .. {} in all}}", count) : "}");
}

// `Transform{p = {..}, q = {..}}` where that is short.
std::string InlineRecord(lua_State* L, int index, const std::string& kind, int depth) {
  std::string text;
  for (const std::string& name : FieldNames(L, index)) {
    PushField(L, index, name);
    if (!text.empty()) text += ", ";
    text += name + " = " + Inline(L, lua_gettop(L), depth + 1);
    lua_pop(L, 1);
    if (depth > 0 || text.size() > kMostText) return kind + "{..}";
  }
  return kind + '{' + text + '}';
}

std::string Inline(lua_State* L, int index, int depth) {
  switch (lua_type(L, index)) {
    case LUA_TNUMBER:
      return ShowNumber(L, index, depth == 0 ? 6 : 4);
    case LUA_TSTRING:
      return '"' + Clip(lua_tostring(L, index), kMostText) + '"';
    case LUA_TTABLE: {
      const std::string kind = NameOf(L, index);
      if (!kind.empty()) return InlineRecord(L, index, kind, depth);
      const auto count = static_cast<int>(lua_rawlen(L, index));
      if (count > 0) return InlineList(L, index, count, depth);
      return FieldNames(L, index).empty() ? "{}" : "{..}";
    }
    case LUA_TUSERDATA:
      if (const auto array = FindArray(L, index); array && array->count > 0) {
        PushArrayTable(L, *array, kMostInline);
        std::string text = InlineList(L, lua_gettop(L), array->count, depth);
        lua_pop(L, 1);
        return text;
      }
      return ShowText(L, index);
    default:
      return ShowText(L, index);
  }
}

// Rows with aligned columns, none wider than `width`.
std::string Align(const std::vector<Row>& rows, int width, std::size_t most_column) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths[c] = std::max(widths[c], std::min(row[c].size(), most_column));
    }
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += fmt::format("{:<{}}  ", Clip(row[c], most_column), widths[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    AddLine(text, Clip(line, static_cast<std::size_t>(width)));
  }
  return text;
}

// A list of records: their fields are columns.
std::string ShowRecords(lua_State* L, int index, int count, int width) {
  lua_rawgeti(L, index, 1);
  const std::vector<std::string> names = FieldNames(L, lua_gettop(L));
  lua_pop(L, 1);
  std::vector<Row> rows(1, Row(1));
  rows[0].insert(rows[0].end(), names.begin(), names.end());
  for (int i = 1; i <= std::min(count, kMostRows); ++i) {
    lua_rawgeti(L, index, i);
    const int item = lua_gettop(L);
    Row row = {std::to_string(i)};
    for (const std::string& name : names) {
      PushField(L, item, name);
      row.push_back(lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1)
                                                   : Inline(L, lua_gettop(L), 1));
      lua_pop(L, 1);
    }
    lua_pop(L, 1);
    rows.push_back(std::move(row));
  }
  return Align(rows, width, kMostColumn);
}

// A list of lists, or one that is too long for a line: a row each.
std::string ShowRows(lua_State* L, int index, int count, int width) {
  std::vector<Row> rows;
  for (int i = 1; i <= std::min(count, kMostRows); ++i) {
    lua_rawgeti(L, index, i);
    rows.push_back({std::to_string(i), Inline(L, lua_gettop(L), 1)});
    lua_pop(L, 1);
  }
  return Align(rows, width, static_cast<std::size_t>(width));
}

std::string ShowList(lua_State* L, int index, int count, int width) {
  lua_rawgeti(L, index, 1);
  const int first = lua_type(L, -1);
  const bool records = !NameOf(L, lua_gettop(L)).empty();
  lua_pop(L, 1);
  if (first != LUA_TTABLE && !records) {
    const std::string line = InlineList(L, index, count, 0);
    if (count <= kMostInline && line.size() <= static_cast<std::size_t>(width)) return line;
  }
  std::string text =
      records ? ShowRecords(L, index, count, width) : ShowRows(L, index, count, width);
  if (count > kMostRows) text += fmt::format("\n.. {} more", count - kMostRows);
  return text;
}

// A record's or an object's sentence, if it has one: the field `text`, or `sentence`.
std::optional<std::string> FindSentence(lua_State* L, int index) {
  if (NameOf(L, index).empty()) return std::nullopt;
  const std::vector<std::string> names = FieldNames(L, index);
  for (const char* name : {"text", "sentence"}) {
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    PushField(L, index, name);
    std::optional<std::string> sentence;
    if (lua_type(L, -1) == LUA_TSTRING) sentence = lua_tostring(L, -1);
    lua_pop(L, 1);
    return sentence;
  }
  return std::nullopt;
}

// In lines of at most `width` bytes, broken at blanks.
std::string Wrap(const std::string& text, std::size_t width) {
  std::string wrapped;
  std::size_t begin = 0;
  while (text.size() - begin > width) {
    std::size_t end = text.rfind(' ', begin + width);
    if (end == std::string::npos || end <= begin) break;
    AddLine(wrapped, text.substr(begin, end - begin));
    begin = end + 1;
  }
  AddLine(wrapped, text.substr(begin));
  return wrapped;
}

// The fields of a table or object, a row each; its sentence, which is shown before them, left out.
std::string ShowFields(lua_State* L, int index, int width) {
  std::vector<Row> rows;
  const bool told = FindSentence(L, index).has_value();
  for (const std::string& name : FieldNames(L, index)) {
    if (told && (name == "text" || name == "sentence")) continue;
    PushField(L, index, name);
    rows.push_back({"  " + name, Inline(L, lua_gettop(L), 0)});
    lua_pop(L, 1);
    if (rows.size() == 10U * kMostRows) {
      rows.push_back({"  .."});
      break;
    }
  }
  return Align(rows, width, static_cast<std::size_t>(width));
}

// The list `items` of a record with a sentence: the numbers that the sentence is made of.
void AddItems(lua_State* L, int index, int width, std::string& text) {
  const std::vector<std::string> names = FieldNames(L, index);
  if (std::find(names.begin(), names.end(), "items") == names.end()) return;
  PushField(L, index, "items");
  const auto count = lua_istable(L, -1) ? static_cast<int>(lua_rawlen(L, -1)) : 0;
  if (count > 0) AddLine(text, ShowRecords(L, lua_gettop(L), count, width));
  lua_pop(L, 1);
}

std::string ShowObject(lua_State* L, int index, const ClassInfo& info, int width) {
  std::string text = Wrap(ShowText(L, index), static_cast<std::size_t>(width));
  const std::string fields = ShowFields(L, index, width);
  if (!fields.empty()) AddLine(text, fields);
  std::string methods = " ";
  for (const FunctionInfo& method : info.methods) methods += " :" + method.name;
  if (!info.methods.empty()) AddLine(text, Clip(methods, static_cast<std::size_t>(width)));
  return text;
}

}  // namespace

std::string ShowInline(lua_State* L, int index) { return Inline(L, lua_absindex(L, index), 0); }

std::string ShowValue(lua_State* L, int index, int width) {
  luaL_checkstack(L, 20, "a value to show");
  lua_pushvalue(L, index);
  OpenProxy(L);
  const int value = lua_gettop(L);
  std::string text;
  if (lua_type(L, value) == LUA_TSTRING || lua_type(L, value) == LUA_TNUMBER) {
    text = ShowText(L, value);  // a number alone with all its digits, as print gives it
  } else if (const auto array = FindArray(L, value); array && array->count > 0) {
    PushArrayTable(L, *array, kMostRows);
    text = ShowList(L, lua_gettop(L), array->count, width);
  } else if (const ClassInfo* info = FindClass(L, value)) {
    text = ShowObject(L, value, *info, width);
  } else if (lua_type(L, value) == LUA_TTABLE) {
    const auto count = static_cast<int>(lua_rawlen(L, value));
    const std::string fields = ShowFields(L, value, width);
    text = NameOf(L, value);
    if (const auto sentence = FindSentence(L, value)) {
      AddLine(text, Wrap(*sentence, static_cast<std::size_t>(width)));
    }
    if (count > 0) AddLine(text, ShowList(L, value, count, width));
    if (!fields.empty()) AddLine(text, fields);
    if (FindSentence(L, value)) AddItems(L, value, width, text);
    if (text.empty()) text = "{}";
  } else {
    text = Inline(L, value, 0);
  }
  lua_settop(L, value - 1);
  return text;
}

}  // namespace pregrasp
