// Each test here tries to leave the sandbox or to break one of its limits.
#include "bindings/machine.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "app/core/interrupt.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStdout;

MachineConfig Small(double seconds = 0.05) {
  MachineConfig config;
  config.seconds = seconds;
  config.bytes = 32U << 20U;
  return config;
}

double SecondsOf(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(MachineTest, HasNoFunctionThatReachesOutside) {
  for (const char* name : {"os", "io", "debug", "package", "dofile", "loadfile", "collectgarbage",
                           "warn", "loadstring", "module"}) {
    EXPECT_EQ(RunLua(std::string("return tostring(rawget(_G, '") + name + "'))"), "nil") << name;
    EXPECT_NE(LuaError(std::string("return ") + name), "") << name;
  }
  EXPECT_EQ(RunLua("return string.dump"), "nil");
  EXPECT_EQ(RunLua("local ok, message = load('\\27Lua'); return tostring(ok)"), "nil");
  EXPECT_EQ(RunLua("return getmetatable('')"), "false");
}

TEST(MachineTest, LibrariesCanOnlyBeRead) {
  for (const char* text :
       {"string.format = 1", "math.pi = 3", "rawset(table, 'insert', 1)", "table.insert(utf8, 1)",
        "setmetatable(string, {})", "rawset(_G.string, 'x', 1)", "coroutine.wrap = nil"}) {
    EXPECT_NE(LuaError(text), "") << text;
  }
  EXPECT_EQ(RunLua("for k, v in pairs(math) do if k == 'pi' then return v == math.pi end end"),
            "true");
  EXPECT_EQ(RunLua("return tostring((next(string)))"), "nil");
}

TEST(MachineTest, AnUnknownVariableIsAnErrorThatNamesTheNearest) {
  EXPECT_EQ(LuaError("local a = 1\nreturn tostrin(a)"),
            "test.lua:2: unknown variable \"tostrin\" (did you mean \"tostring\"?)");
  EXPECT_EQ(RunLua("x = 3; return x"), "3");
}

TEST(MachineTest, EachChunkHasAFreshEnvironment) {
  const TestFolder folder;
  folder.Write("lib/m.lua", "leak = 1; print = nil; return { n = 5 }");
  Machine machine({});
  machine.LoadFile(machine.state(), folder.Write("main.lua", R"(
    local m = require 'lib.m'
    assert(rawget(_G, 'leak') == nil and print and require 'lib.m' == m)
    assert(not pcall(require, 'lib.missing'))
    assert(not pcall(require, '..lib.m'))
    return m.n)"));
  machine.Call(0, 1);
  EXPECT_EQ(lua_tointeger(machine.state(), -1), 5);
}

TEST(MachineTest, AModuleThatFailsOrRequiresItselfSaysWhere) {
  const TestFolder folder;
  folder.Write("a.lua", "return require 'b'");
  folder.Write("b.lua", "return require 'a'");
  folder.Write("c.lua", "local x = 1 +");
  Machine machine({});
  lua_State* L = machine.state();
  for (const auto& [name, message] : {std::pair("a", "module \"a\" requires itself"),
                                      std::pair("c", "c.lua:1: unexpected symbol")}) {
    machine.LoadFile(L, folder.Write("main.lua", std::string("require '") + name + "'"));
    try {
      machine.Call(0, 0);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(MachineTest, NoProtectedCallSwallowsTheTimeLimit) {
  for (const char* text : {
           "while true do end",
           "while true do pcall(function() while true do end end) end",
           "while true do xpcall(function() while true do end end, function() while true do end "
           "end) end",
           "while true do local co = coroutine.wrap(function() while true do end end); pcall(co) "
           "end",
           "local function f() local co = coroutine.create(f); coroutine.resume(co); return f() "
           "end f()",
           "local t <close> = setmetatable({}, {__close = function() while true do end end}) while "
           "true do end",
           "setmetatable({}, {__index = function(t, k) return t[k + 1] end})[1] = nil; while true "
           "do end",
           "goto a; ::a:: goto a",
           "coroutine.wrap(function() local t <close> = setmetatable({}, {__close = function() "
           "while true do end end}) while true do end end)()",
           "local co = coroutine.create(function() local t <close> = setmetatable({}, {__close = "
           "function() while true do end end}) while true do end end) coroutine.resume(co) "
           "coroutine.close(co)",
           "xpcall(xpcall, function() while true do end end, function() while true do end end, "
           "function() while true do end end)",
           "while true do local ok = pcall(string.rep, 'x', 1e9) end",
           "local s = ('x'):rep(1e6); while true do local a = s .. s end",
           "while true do load('return 1')() end",
           "table.sort({3, 1, 2}, function() while true do end end)",
           "local a, b = ('\\0'):rep(8e6) .. 'a', ('\\0'):rep(8e6) .. 'b' local t = {} for i = 1, "
           "1000 "
           "do t[i] = i % 2 == 0 and a or b end table.sort(t)",
           "local s = ('x'):rep(7e6) local a, b = s .. 'a', s .. 'b' while a < b do end",
           "local s = ('x'):rep(7e6) local a, b = s .. 'a', s .. 'b' "
           "coroutine.wrap(function() while a < b do end end)()",
           "local a, b = ('x'):rep(7e6), 'y' local t = {} for i = 1, 1e5 do t[i] = i % 2 == 0 and "
           "a or "
           "b end while true do pcall(table.sort, t, string.find) end",
           "local t = {} for i = 1, 200 do t[('k'):rep(2e5) .. i] = i end while true do for _ in "
           "pairs(t) "
           "do end end",
           "while true do tostring(setmetatable({}, {__tostring = function() return 'x' end})) end",
       }) {
    std::string message;
    SCOPED_TRACE(text);
    const double seconds = SecondsOf([&] { message = LuaError(text, Small()); });
    EXPECT_NE(message.find("out of time after 0.05 s of Lua"), std::string::npos)
        << text << ": " << message;
    EXPECT_LT(seconds, 5.0) << text;
  }
}

TEST(MachineTest, LibraryLoopsThatNoHookReachesAreRefused) {
  for (const char* text : {
           "return (''):rep(1e18)",
           "table.move({}, 1, 1e15, 2)",
           "table.move({}, math.mininteger, math.maxinteger, 2)",
           "table.insert(setmetatable({}, {__len = function() return 1e15 // 1 | 0 end}), 1, 1)",
           "table.remove(setmetatable({}, {__len = function() return 1 << 60 end}), 1)",
           "table.concat(setmetatable({}, {__index = rawlen}), '', 1, 1 << 60)",
           "table.sort(setmetatable({}, {__len = function() return 1 << 30 end}))",
           "return table.unpack({}, 1, 1e8)",
           "setmetatable({}, {__gc = function() while true do end end})",
       }) {
    std::string message;
    SCOPED_TRACE(text);
    const double seconds = SecondsOf([&] { message = LuaError(text, Small()); });
    EXPECT_EQ(message.empty(), std::string(text) == "return (''):rep(1e18)") << text << message;
    EXPECT_LT(seconds, 2.0) << text;
  }
}

TEST(MachineTest, MemoryIsCapped) {
  const std::string line = "test.lua:1: not enough memory: a script has 32 MB, a string 16 MB";
  EXPECT_EQ(LuaError("return ('x'):rep(1e9)", Small(20)).substr(0, 29),
            "test.lua:1: not enough memory");
  EXPECT_EQ(LuaError("local t = {} for i = 1, 1e9 do t[i] = i end", Small(20)), line);
  EXPECT_EQ(LuaError("local s = 'x' while true do s = s .. s end", Small(20)), line);
  EXPECT_EQ(LuaError("local t = {} while true do t = {t} end", Small(20)), line);
  EXPECT_EQ(RunLua("return pcall(string.rep, 'x', 1e9)", Small(20)), "false");
}

TEST(MachineTest, DeepRecursionIsAnErrorWithALine) {
  EXPECT_NE(LuaError("local function f() return 1 + f() end\nreturn f()")
                .find("test.lua:1: stack overflow"),
            std::string::npos);
  EXPECT_NE(LuaError("local s = ('a'):gsub('a', function() return f() end)"), "");
  EXPECT_NE(
      LuaError("local function f() return pcall(f) end while true do assert(f()) end", Small()),
      "");
  EXPECT_NE(LuaError("return " + std::string(100000, '(')), "");
  EXPECT_NE(LuaError("return " + std::string(100000, '{')), "");
}

TEST(MachineTest, EveryErrorIsOneLineWithFileAndLine) {
  EXPECT_EQ(LuaError("local t\nt.x = 1"), "test.lua:2: attempt to index a nil value (local 't')");
  EXPECT_EQ(LuaError("\nerror('two\\nlines')"), "test.lua:2: two lines");
  EXPECT_EQ(LuaError("\nerror({code = 3})"), "test.lua:2: an error whose value is a table");
  EXPECT_EQ(LuaError("error(setmetatable({}, {__tostring = function() return 'mine' end}))"),
            "test.lua:1: mine");
  EXPECT_EQ(LuaError("error()"), "test.lua:1: an error whose value is a nil");
  EXPECT_EQ(LuaError("error('no position', 0)"), "test.lua:1: no position");
  EXPECT_EQ(LuaError("\n\nx = = 1").substr(0, 12), "test.lua:3: ");
  EXPECT_EQ(LuaError("error(setmetatable({}, {__tostring = function() error({}) end}))"),
            "test.lua:1: an error whose value is a table");
}

TEST(MachineTest, ALongNameIsWrittenInFull) {
  const TestFolder folder;
  const std::string name = std::string(70, 'n') + ".lua";
  Machine machine({});
  for (const char* text : {"\nerror 'x'", "\nlocal = 1", "\nlocal t = nil; t.x = 1"}) {
    try {
      machine.LoadFile(machine.state(), folder.Write(name, text));
      machine.Call(0, 0);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find((folder.path() / name).string() + ":2: "), 0U)
          << error.what();
    }
  }
}

TEST(MachineTest, FilesThatAreNotTextAreRefused) {
  const TestFolder folder;
  Machine machine({});
  lua_State* L = machine.state();
  EXPECT_THROW(machine.LoadFile(L, folder.Write("byte.lua", "\x1bLua")), InputError);
  EXPECT_THROW(machine.LoadFile(L, folder.path()), InputError);
  EXPECT_THROW(machine.LoadFile(L, folder.path() / "missing.lua"), InputError);
  EXPECT_THROW(machine.LoadFile(L, "/dev/zero"), InputError);
  EXPECT_NO_THROW(
      machine.LoadFile(L, folder.Write("shebang.lua", "#!/usr/bin/pregrasp\nreturn 1")));
  EXPECT_NO_THROW(machine.LoadFile(L, folder.Write("empty.lua", "")));
}

TEST(MachineTest, RunsOfOneSeedAreEqualAndOfAnotherDiffer) {
  const std::string text = R"(
    local t, order = {}, {}
    for i = 1, 50 do t['k' .. i] = i; t[-i] = i; t[i / 3] = i end
    for k in pairs(t) do order[#order + 1] = tostring(k) end
    return table.concat(order, ' ') .. math.random() .. tostring({}) .. string.format('%s', print))";
  MachineConfig other;
  other.seed = 2;
  EXPECT_EQ(RunLua(text), RunLua(text));
  EXPECT_NE(RunLua(text), RunLua(text, other));
  EXPECT_EQ(LuaError("math.randomseed()").substr(0, 38), "test.lua:1: math.randomseed: expected ");
  EXPECT_EQ(RunLua("math.randomseed(4) local a = math.random() math.randomseed(4) return a == "
                   "math.random()"),
            "true");
  EXPECT_NE(LuaError("return ('%p'):format({})"), "");
}

TEST(MachineTest, PairsGivesEveryPairOnceInOrder) {
  EXPECT_EQ(RunLua(R"(
    local t, keys = {10, 20, nil, 40, b = 1, a = 2, [2.5] = 3, [true] = 4, [-1] = 5}, {}
    for k, v in pairs(t) do assert(t[k] == v); keys[#keys + 1] = tostring(k) end
    return table.concat(keys, ' '))"),
            "1 2 4 -1 2.5 a b true");
  EXPECT_EQ(RunLua(R"(
    local t, n = {1, 2, 3, x = 1, y = 2}, 0
    for k in pairs(t) do t[k] = nil; t.y = nil; n = n + 1 end
    return n)"),
            "4");
  EXPECT_EQ(RunLua("for a, b in pairs(setmetatable({}, {__pairs = function() return function(_, k) "
                   "if not k then return 1, 2 end end end})) do return a + b end"),
            "3");
}

TEST(MachineTest, SortingIsStableAndTakesAnyOrder) {
  EXPECT_EQ(RunLua(R"(
    local t = {} for i = 1, 1000 do t[i] = (i * 7919) % 1000 end
    table.sort(t) for i = 1, 1000 do assert(t[i] == i - 1) end
    table.sort(t, function(a, b) return a > b end) for i = 1, 1000 do assert(t[i] == 1000 - i) end
    local pairs_ = {} for i = 1, 300 do pairs_[i] = { key = i % 3, place = i } end
    table.sort(pairs_, function(a, b) return a.key < b.key end)
    for i = 2, 300 do
      local a, b = pairs_[i - 1], pairs_[i]
      assert(a.key < b.key or (a.key == b.key and a.place < b.place))
    end
    local words = { "b", "a\0c", "", "a", "a\0b", "ab", "\255", "B" }
    table.sort(words)
    for i = 2, #words do assert(words[i - 1] < words[i]) end
    table.sort(t, function() return true end)  -- no order at all
    local mixed = setmetatable({}, { __lt = function(a, b) return false end })
    table.sort({ mixed, mixed, mixed })
    table.sort({}) table.sort({ 1 }, nil)
    return tostring(pcall(table.sort, { 1, "x" })) .. tostring(pcall(table.sort, { 1 }, 3)))"),
            "falsefalse");
}

TEST(MachineTest, ATextWithAZeroByteIsWholeInComparisonsAndRefusedAsAName) {
  EXPECT_NE(LuaError("require('a\\0b')").find("a text without a zero byte"), std::string::npos);
}

TEST(MachineTest, PrintGoesToStandardOutputThroughTostring) {
  CaptureStdout();
  RunLua(
      "print('a', 1, 2.5, nil, true, {}, setmetatable({}, {__tostring = function() return 'T' "
      "end}))");
  EXPECT_EQ(GetCapturedStdout(), "a\t1\t2.5\tnil\ttrue\ttable\tT\n");
}

TEST(MachineTest, AnInterruptEndsTheScriptWhateverCatchesIt) {
  RequestInterrupt();
  EXPECT_THROW(RunLua("while true do pcall(function() while true do end end) end"), Interrupted);
  ClearInterrupt();
  EXPECT_EQ(RunLua("return 1"), "1");
}

}  // namespace
}  // namespace pregrasp
