#include "app/hand/hand_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "app/core/file_kind.h"
#include "app/core/json_text.h"
#include "app/core/lua_api.h"
#include "app/core/number_range.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kMaxSource = 1U << 20U, kMaxLuaBytes = 16U << 20U;
constexpr int kMaxInstructions = 1000000, kMaxDepth = 8, kMaxValues = 10000;

constexpr NumberRange kPlace{-2.0, 2.0, 0, "m"};
constexpr NumberRange kDirection{-1e6, 1e6, 0, ""};
constexpr NumberRange kRadius{0.001, 0.1, 0, "m"};
constexpr NumberRange kAngle{-10.0, 10.0, 0, "rad"};
constexpr NumberRange kBehind{0.0, 1.0, 0, "m"};

// Lua's memory, which may grow to a cap while the file runs, and freely while it is read.
struct Allowance {
  std::size_t used = 0, cap = kMaxLuaBytes;

  static void* Allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
    auto& allowance = *static_cast<Allowance*>(self);
    if (block == nullptr) old_size = 0;
    if (allowance.cap != 0 && new_size > old_size &&
        allowance.used + (new_size - old_size) > allowance.cap) {
      return nullptr;
    }
    void* moved = nullptr;
    if (new_size == 0) {
      std::free(block);
    } else {
      moved = std::realloc(block, new_size);
      if (moved == nullptr) return nullptr;
    }
    allowance.used += new_size - old_size;
    return moved;
  }
};

void StopLua(lua_State* L, lua_Debug* /*unused*/) { luaL_error(L, "takes too long"); }

int ReturnTable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  return 1;
}

// A table of data as JSON: a list where it has an item 1.
class Converter {
 public:
  Converter(lua_State* L, const std::string& where) : L_(L), where_(where) {}

  Json Convert(const std::string& path, int depth = 0) {
    if (++count_ > kMaxValues || depth > kMaxDepth) {
      throw InputError(where_, path, "the table of a hand", "one too large");
    }
    switch (lua_type(L_, -1)) {
      case LUA_TBOOLEAN:
        return lua_toboolean(L_, -1) != 0;
      case LUA_TNUMBER:
        return lua_tonumber(L_, -1);
      case LUA_TSTRING: {
        std::size_t length = 0;
        const char* text = lua_tolstring(L_, -1, &length);
        return std::string(text, length);
      }
      case LUA_TTABLE:
        return ConvertTable(path, depth);
      default:
        throw InputError(where_, path, "data", luaL_typename(L_, -1));
    }
  }

 private:
  Json ConvertTable(const std::string& path, int depth) {
    Json list = Json::array(), object = Json::object();
    luaL_checkstack(L_, 4, nullptr);
    for (int i = 1;; ++i) {
      const bool is_item = lua_rawgeti(L_, -1, i) != LUA_TNIL;
      if (is_item) list.push_back(Convert(fmt::format("{}[{}]", path, i), depth + 1));
      lua_pop(L_, 1);
      if (!is_item) break;
    }
    for (lua_pushnil(L_); lua_next(L_, -2) != 0; lua_pop(L_, 1)) {
      if (lua_type(L_, -2) == LUA_TSTRING) {
        const std::string key = std::string(lua_tostring(L_, -2));
        object[key] = Convert(path.empty() ? key : fmt::format("{}.{}", path, key), depth + 1);
      } else if (!lua_isinteger(L_, -2) || lua_tointeger(L_, -2) < 1 ||
                 lua_tointeger(L_, -2) > static_cast<lua_Integer>(list.size())) {
        throw InputError(where_, path, "names, or items from 1 on", "another key");
      }
    }
    if (!list.empty() && !object.empty()) {
      throw InputError(where_, path, "a list or a table with names", "both in one");
    }
    return list.empty() ? object : list;
  }

  lua_State* L_;
  const std::string& where_;
  int count_ = 0;
};

std::string ReadSource(const fs::path& file) {
  const std::string other = DescribeNonFile(file);
  if (!other.empty()) throw InputError(file.string(), "", "a hand.lua", other);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), "", "a hand.lua", "one that cannot be read");
  std::string text(kMaxSource + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || text.size() > kMaxSource) {
    throw InputError(file.string(), "", "a readable file of at most 1 MB", "");
  }
  return text;
}

Json RunHandFile(const fs::path& file) {
  const std::string source = ReadSource(file), where = file.string();
  Allowance allowance;
  const std::unique_ptr<lua_State, void (*)(lua_State*)> state(
      lua_newstate(Allowance::Allocate, &allowance), lua_close);
  lua_State* L = state.get();
  if (L == nullptr) throw InputError(where, "", "memory for Lua", "none");
  lua_sethook(L, StopLua, LUA_MASKCOUNT, kMaxInstructions);
  // A function that is given no upvalue and its name allocates a little: far below the cap.
  lua_pushcfunction(L, ReturnTable);
  lua_setglobal(L, "hand");
  const std::string chunk = '@' + where;
  int status = luaL_loadbufferx(L, source.data(), source.size(), chunk.c_str(), "t");
  if (status == LUA_OK) status = lua_pcall(L, 0, 1, 0);
  allowance.cap = 0;
  lua_sethook(L, nullptr, 0, 0);
  if (status != LUA_OK) {
    const char* message = lua_tostring(L, -1);
    throw InputError(OneLine(message != nullptr ? message : where + ": an error"));
  }
  if (!lua_istable(L, -1)) {
    throw InputError(where, "", "\"return hand{ .. }\" at its end", luaL_typename(L, -1));
  }
  return Converter(L, where).Convert("");
}

// A value of the table that knows its place.
class Value {
 public:
  Value(const Json& json, const std::string& where, std::string path = {})
      : json_(json), where_(where), path_(std::move(path)) {}

  [[noreturn]] void Fail(const std::string& expected) const {
    std::string got = FormatJson(json_);
    if (got.size() > 60) got = got.substr(0, 60) + "..";
    throw InputError(where_, path_, expected, got);
  }

  void ExpectKeys(const std::vector<std::string>& known) const {
    if (!json_.is_object()) Fail("a table with names");
    for (const auto& [key, value] : json_.items()) {
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      throw InputError(where_, Path(key), "a key of this table",
                       '"' + key + '"' + FormatHint(FindNearest(key, known)));
    }
  }

  bool Has(const std::string& key) const { return json_.contains(key); }
  Value operator[](const std::string& key) const {
    if (!json_.is_object()) Fail("a table with names");
    const auto found = json_.find(key);
    if (found == json_.end()) throw InputError(where_, Path(key), "a value", "nothing");
    return {*found, where_, Path(key)};
  }
  std::vector<Value> Items() const {
    std::vector<Value> items;
    if (!json_.is_array()) {
      if (json_.is_object() && json_.empty()) return items;
      Fail("a list");
    }
    for (std::size_t i = 0; i < json_.size(); ++i) {
      items.push_back({json_[i], where_, fmt::format("{}[{}]", path_, i + 1)});
    }
    return items;
  }
  std::vector<std::pair<std::string, Value>> Named() const {
    if (!json_.is_object()) Fail("a table with names");
    std::vector<std::pair<std::string, Value>> named;
    for (const auto& [key, value] : json_.items()) {
      named.emplace_back(key, Value(value, where_, Path(key)));
    }
    return named;
  }

  bool is_text() const { return json_.is_string(); }
  std::string Text() const {
    if (!json_.is_string()) Fail("a string");
    return json_.get<std::string>();
  }
  // A word that can stand in a table of numbers.
  std::string Name() const {
    std::string name = Text();
    const bool legal = !name.empty() && name.size() <= 64 &&
                       name.find_first_not_of(
                           "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                           "0123456789_.-") == std::string::npos;
    if (!legal) Fail("a name of letters, digits, _, - and .");
    return name;
  }
  bool Bool() const {
    if (!json_.is_boolean()) Fail("true or false");
    return json_.get<bool>();
  }
  double Number(const NumberRange& range) const {
    if (!json_.is_number()) Fail(range.Expected());
    const double value = json_.get<double>();
    RequireWithin(where_, path_, range, value);
    return value;
  }
  Vector3 Vec3(const NumberRange& range) const {
    const std::vector<Value> items = Items();
    if (items.size() != 3) Fail("three numbers {x, y, z}");
    Vector3 v;
    for (int i = 0; i < 3; ++i) v[i] = items[static_cast<std::size_t>(i)].Number(range);
    return v;
  }

 private:
  std::string Path(const std::string& key) const { return path_.empty() ? key : path_ + '.' + key; }

  const Json& json_;
  const std::string& where_;
  std::string path_;
};

HandDescription::Frame ReadFrame(const Value& value) {
  HandDescription::Frame frame;
  if (value.Has("p")) frame.p = value["p"].Vec3(kPlace);
  const auto direction = [&](const char* key, const Vector3& otherwise) {
    if (!value.Has(key)) return otherwise;
    const Vector3 v = value[key].Vec3(kDirection);
    if (!(v.norm() > 1e-9)) value[key].Fail("a direction");
    return Vector3(v.normalized());
  };
  frame.along = direction("along", frame.along);
  frame.palmar = direction("palmar", frame.palmar);
  if (std::abs(frame.along.dot(frame.palmar)) > 1e-3) {
    value.Fail("\"along\" and \"palmar\" at right angles");
  }
  return frame;
}

HandDescription::Finger ReadFinger(const Value& value) {
  value.ExpectKeys({"joints", "tip"});
  HandDescription::Finger finger;
  for (const Value& item : value["joints"].Items()) {
    if (item.is_text()) {
      finger.joints.push_back({item.Text(), item.Name()});
    } else {
      item.ExpectKeys({"urdf", "name"});
      finger.joints.push_back({item["urdf"].Text(), item["name"].Name()});
    }
  }
  if (finger.joints.empty()) value["joints"].Fail("at least one joint");
  const Value tip = value["tip"];
  tip.ExpectKeys({"p", "r", "along", "palmar"});
  finger.tip = ReadFrame(tip);
  if (!tip.Has("p")) tip.Fail("the centre p of its sphere");
  finger.tip_radius = tip["r"].Number(kRadius);
  return finger;
}

HandCapsule ReadCapsule(const Value& value) {
  value.ExpectKeys({"from", "to", "r"});
  HandCapsule capsule;
  capsule.p_LA = value["from"].Vec3(kPlace);
  capsule.p_LB = value.Has("to") ? value["to"].Vec3(kPlace) : capsule.p_LA;
  capsule.radius = value["r"].Number(kRadius);
  return capsule;
}

HandForearm ReadForearm(const Value& value) {
  value.ExpectKeys({"r", "from", "to"});
  HandForearm forearm;
  forearm.radius = value["r"].Number(kRadius);
  forearm.begin = value["from"].Number(kBehind);
  forearm.end = value["to"].Number(kBehind);
  if (!(forearm.begin < forearm.end)) value.Fail("\"from\" below \"to\"");
  return forearm;
}

}  // namespace

HandDescription ReadHandFile(const fs::path& file) {
  const Json json = RunHandFile(file);
  const std::string where = file.string();
  const Value table(json, where);
  table.ExpectKeys(
      {"name", "urdf", "mirror", "palm", "fingers", "posture", "may_touch", "capsules", "forearm"});
  HandDescription hand;
  hand.file = file;
  hand.name = table["name"].Name();
  hand.urdf = file.parent_path() / table["urdf"].Text();
  if (table.Has("mirror")) hand.mirror = table["mirror"].Bool();
  const Value palm = table["palm"];
  palm.ExpectKeys({"link", "p", "along", "palmar"});
  hand.palm = palm["link"].Text();
  hand.palm_frame = ReadFrame(palm);
  const Value fingers = table["fingers"];
  for (const Value& finger : fingers.Items()) hand.fingers.push_back(ReadFinger(finger));
  if (hand.fingers.size() < kLeastFingers || hand.fingers.size() > kNumFingers) {
    throw InputError(where, "fingers", "2 to 5 fingers, the thumb first",
                     std::to_string(hand.fingers.size()));
  }
  std::set<std::string> names;
  std::size_t num_joints = 0;
  for (const HandDescription::Finger& finger : hand.fingers) {
    for (const HandDescription::Joint& joint : finger.joints) {
      ++num_joints;
      if (names.insert(joint.name).second) continue;
      throw InputError(where, "fingers", "each joint once", '"' + joint.name + "\" twice");
    }
  }
  if (num_joints > kMaxHandJoints) {
    throw InputError(where, "fingers", fmt::format("at most {} joints", kMaxHandJoints),
                     std::to_string(num_joints));
  }
  if (table.Has("posture")) {
    for (const auto& [joint, angle] : table["posture"].Named()) {
      hand.posture[joint] = angle.Number(kAngle);
    }
  }
  if (table.Has("may_touch")) {
    for (const Value& pair : table["may_touch"].Items()) {
      const std::vector<Value> links = pair.Items();
      if (links.size() != 2) pair.Fail("two links");
      hand.may_touch.emplace_back(links[0].Text(), links[1].Text());
    }
  }
  if (table.Has("capsules")) {
    for (const auto& [link, capsules] : table["capsules"].Named()) {
      for (const Value& capsule : capsules.Items()) {
        hand.capsules[link].push_back(ReadCapsule(capsule));
      }
    }
  }
  if (table.Has("forearm")) hand.forearm = ReadForearm(table["forearm"]);
  return hand;
}

}  // namespace pregrasp
