// The oracle is Lua's own string library, in a state without a sandbox.
#include "bindings/lua_pattern.h"

#include <gtest/gtest.h>

#include <string>

#include "app/core/rng.h"
#include "bindings/sandbox.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

// Both string libraries side by side in one state: Lua's as `theirs`, ours as `ours`.
class BothLibraries {
 public:
  BothLibraries() : machine_({}), L_(machine_.state()) {
    luaopen_string(L_);
    lua_setglobal(L_, "theirs");
    luaopen_string(L_);
    ReplaceStringFunctions(L_);
    lua_setglobal(L_, "ours");
  }

  // What library.function(arguments..) gives, as one text; an error's message is in last_error.
  std::string Run(const char* library, const char* function,
                  const std::vector<std::string>& arguments, int number = 0) {
    lua_settop(L_, 0);
    lua_getglobal(L_, library);
    lua_getfield(L_, -1, function);
    lua_remove(L_, 1);
    for (const std::string& a : arguments) lua_pushlstring(L_, a.data(), a.size());
    if (number != 0) lua_pushinteger(L_, number);
    if (!Call()) return "error";
    if (std::string(function) != "gmatch") return Results();
    std::string text;
    lua_setglobal(L_, "iterator");
    for (;;) {
      lua_getglobal(L_, "iterator");
      if (!Call()) return text + "error";
      if (lua_gettop(L_) == 0 || lua_isnil(L_, 1)) return text;
      text += Results() + ";";
      lua_settop(L_, 0);
    }
  }

  std::string last_error;

 private:
  bool Call() {
    if (lua_pcall(L_, lua_gettop(L_) - 1, LUA_MULTRET, 0) == LUA_OK) return true;
    last_error = lua_tostring(L_, -1);
    return false;
  }

  std::string Results() {
    std::string text;
    for (int i = 1; i <= lua_gettop(L_); ++i) {
      std::size_t size = 0;
      const char* data = luaL_tolstring(L_, i, &size);
      text += std::string(luaL_typename(L_, i)) + ":" + std::string(data, size) + "|";
      lua_pop(L_, 1);
    }
    return text;
  }

  Machine machine_;
  lua_State* L_;
};

std::string RandomText(Rng& rng, const std::vector<std::string>& pieces, int most) {
  std::string text;
  for (std::uint32_t i = rng.UniformInt(most + 1); i > 0; --i) {
    text += pieces[rng.UniformInt(static_cast<std::uint32_t>(pieces.size()))];
  }
  return text;
}

const std::vector<std::string> kPatternPieces = {
    "a",    "b",       "c",  ".",    "%a",   "%d",   "%s",     "%w",     "%W", "[ab]",
    "[^a]", "[a-c%d]", "*",  "+",    "-",    "?",    "(",      ")",      "()", "$",
    "^",    "%1",      "%2", "%bab", "[]]",  "[^]]", "%f[%w]", "%f[^a]", "[",  "%",
    "[a-]", "[%a-z]",  "%.", "%%",   "(a*)", "(.-)", "%x"};
const std::vector<std::string> kSubjectPieces = {"a", "b", "c", "ab", " ",
                                                 "1", ".", "%", "]",  "aa"};

TEST(LuaPatternTest, AgreesWithLuasOwnLibraryOnRandomPatterns) {
  BothLibraries both;
  Rng rng(20);
  int matched = 0, failed = 0;
  for (int i = 0; i < 40000; ++i) {
    const std::string pattern = RandomText(rng, kPatternPieces, 6);
    const std::string subject = RandomText(rng, kSubjectPieces, 10);
    const int init = static_cast<int>(rng.UniformInt(13)) - 6;
    for (const char* function : {"find", "match", "gmatch"}) {
      const std::string theirs = both.Run("theirs", function, {subject, pattern}, init);
      ASSERT_EQ(both.Run("ours", function, {subject, pattern}, init), theirs)
          << function << "(\"" << subject << "\", \"" << pattern << "\", " << init << ")";
      matched += theirs.find("string:") == 0 || theirs.find("number:") == 0;
      failed += theirs == "error";
    }
    const std::string theirs = both.Run("theirs", "gsub", {subject, pattern, "<%0%1>"});
    const std::string ours = both.Run("ours", "gsub", {subject, pattern, "<%0%1>"});
    // Lua's gsub lets an unfinished capture pass that its find does not; ours are of one mind.
    if (ours == "error" && both.last_error == "unfinished capture") continue;
    ASSERT_EQ(ours, theirs) << "gsub(\"" << subject << "\", \"" << pattern << "\")";
  }
  EXPECT_GT(matched, 5000);
  EXPECT_GT(failed, 5000);
}

TEST(LuaPatternTest, GivesEveryByteTheClassesThatLuaGivesIt) {
  BothLibraries both;
  for (int c = 0; c < 256; ++c) {
    const std::string subject(1, static_cast<char>(c));
    for (const char letter : std::string("acdglpsuwxzACDGLPSUWXZqb.-")) {
      if (letter == 'b') continue;
      const std::string pattern = std::string("%") + letter;
      ASSERT_EQ(both.Run("ours", "find", {subject, pattern}),
                both.Run("theirs", "find", {subject, pattern}))
          << c << " " << pattern;
    }
  }
}

TEST(LuaPatternTest, ReplacesByTableAndFunctionAsLuaDoes) {
  EXPECT_EQ(RunLua("return (('a b c'):gsub('%w', {a = 1, b = false}))"), "1 b c");
  EXPECT_EQ(RunLua("return (('k=v'):gsub('(%w)=(%w)', function(k, v) return v .. k end))"), "vk");
  EXPECT_EQ(LuaError("return ('a'):gsub('a', function() return {} end)"),
            "test.lua:1: invalid replacement value (a table)");
  EXPECT_EQ(LuaError("return ('a'):gsub('a', '%2')"),
            "test.lua:1: invalid capture index %2 in replacement string");
}

TEST(LuaPatternTest, APatternThatWouldRunForYearsIsOutOfTime) {
  MachineConfig config;
  config.seconds = 0.1;
  const std::string bomb =
      "local text, bomb = ('a'):rep(40), ('a?'):rep(40) .. ('a'):rep(40) .. 'b'\n";
  for (const char* call : {"text:find(bomb)", "text:match(bomb)", "text:gsub(bomb, '')",
                           "for _ in text:gmatch(bomb) do end"}) {
    EXPECT_EQ(LuaError(bomb + call, config),
              "test.lua:2: out of time after 0.1 s of Lua (--time gives it more)")
        << call;
  }
}

}  // namespace
}  // namespace pregrasp
