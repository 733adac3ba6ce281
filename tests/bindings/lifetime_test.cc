// Objects that scripts hold, used when and where nothing should be left of them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "bindings/script.h"
#include "tests/bindings/lua_text.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStdout;

// One object of each kind, by name, from one session: small stages. And garbage, which makes Lua
// collect.
const char* const kPrelude = R"(local pg = require "pregrasp"
local function litter() for i = 1, 3e5 do local _ = {i} end end
local function session(seed)
  return pg.open(pg.scene{ name = "cube",
    object = { shape = pg.box{0.065, 0.065, 0.065}, mass = 0.05, friction = 0.6, p = {0, 0, 0.3325} },
    environment = { { name = "post", shape = pg.box{0.03, 0.03, 0.3}, p = {0, 0, 0.15}, friction = 0.6 } } },
    { seed = seed or 1 })
end
local stages = {
  function(o, seed) o.Session = session(seed) end,
  function(o) o.Simulation = o.Session:simulate() end,
  function(o)
    o.Graph = o.Session:graph{ triangles = 12, samples = 1, points = 128 }
    o.Graph:score() o.Graph:prune{ top_percent = 20 }
    o.Reason = o.Graph:why(0)
  end,
  function(o) o.Paths = o.Graph:paths{ stages = 1 } o.Path = o.Paths:next() end,
  function(o)
    o.Optimizer = o.Path:optimize{ samples = 6, iterations = 2 }
    while o.Optimizer:step() do end
  end,
  function(o) o.Trajectory = o.Optimizer:certify{ hold_seconds = 0.1 } end,
  function(o)
    o.Grasps = o.Trajectory:grasps{ samples = 4, points = 100, pairs = 300, max_refinement = 0.05,
      max_solves = 20, starts = 3, search_sets = 0 }
    o.Grasp = o.Grasps[1]
  end,
}
-- Up to the object of that name; all without one.
local function plan(seed, name)
  local o = {}
  for _, stage in ipairs(stages) do
    stage(o, seed)
    if name and o[name] then break end
  end
  return o
end
local function all()
  local o
  for seed = 1, 8 do
    o = plan(seed)
    if o.Grasps:best() then break end
  end
  o.Motion = o.Grasps:best():motion{ keyframe_starts = 3, frame_starts = 1, smoothing_iterations = 1, fps = 5 }
  for key in o.Motion:keyframes() do o.Frame = key break end
  o.Shape = pg.box{1, 1, 1}
  o.Scene = pg.scene{ name = "x", object = { shape = pg.sphere{0.02}, mass = 0.1, p = {0, 0, 0.02} },
    environment = { { shape = pg.box{1, 1, 0.1}, p = {0, 0, -0.05} } } }
  return o
end
-- What a script would do with each kind.
local use = {
  Session = function(x) return x.name, x:body("object").p end,
  Simulation = function(x) x:step(2) return x.t end,
  Graph = function(x) return x.stage, x:why(3).text end,
  Reason = function(x) return x.text end,
  Paths = function(x) return x:top(1)[1].score end,
  Path = function(x) return x.rank end,
  Optimizer = function(x) return x.best_cost, #x:rollouts() end,
  Trajectory = function(x) return x.certified, x:body("object").p end,
  Grasps = function(x) return x.count, x[1].reason end,
  Grasp = function(x) return x.reason end,
  Motion = function(x) return x.num_solved, x:step() end,
  Frame = function(x) return x.t end,
  Shape = function(x) return pg.union{x, x} end,
  Scene = function(x) return pg.open(x).name end,
}
)";

class LifetimeTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    weights_ = std::make_unique<TestFolder>();
    WriteRandomWeights(weights_->path());
  }
  static void TearDownTestSuite() { weights_.reset(); }

  std::string Script(const std::string& body, std::size_t megabytes = 512) {
    ScriptConfig config;
    config.output = folder_.path() / "out";
    if (!shipped_weights_) config.weights = weights_->path();
    config.machine.bytes = megabytes << 20U;
    const auto file = folder_.Write("test.lua", kPrelude + body);
    CaptureStdout();
    try {
      RunScript(file, {}, config);
    } catch (const std::exception& error) {
      return GetCapturedStdout() + error.what();
    }
    return GetCapturedStdout();
  }

  static std::unique_ptr<TestFolder> weights_;
  TestFolder folder_;
  bool shipped_weights_ = false;
};
std::unique_ptr<TestFolder> LifetimeTest::weights_;

TEST_F(LifetimeTest, AnObjectThatAWeakTableGivesBackIsWholeOrClosed) {
  // Weak keys are kept for one more round after their objects were let go.
  EXPECT_EQ(Script(R"(
    local kinds, weak, seen, wrong = 0, setmetatable({}, {__mode = "k"}), {}, nil
    do
      local o = all()
      for name, x in pairs(o) do kinds = kinds + 1 weak[x] = name end
    end
    for round = 1, 6 do
      for x, name in next, weak do
        local ok, message = pcall(use[name], x)
        if not ok then
          seen[name] = true
          if not tostring(message):find("closed object", 1, true) then wrong = name .. ": " .. tostring(message) end
          assert(not pcall(function() x.field = 1 end) and not pcall(x) and tostring(x):find("closed object"))
          assert(getmetatable(x) == false)
        end
      end
      litter()
    end
    print(kinds, next(weak), wrong))"),
            "14\tnil\tnil\n");
}

TEST_F(LifetimeTest, AnObjectLivesOnWithoutTheSessionThatMadeIt) {
  EXPECT_EQ(Script(R"(
    local o = all()
    local order = {}
    for name in pairs(o) do order[#order + 1] = name end
    o.Session = nil
    litter()
    local count = 0
    for _, name in ipairs(order) do
      if o[name] then assert(pcall(use[name], o[name]), name) count = count + 1 end
    end
    -- And each alone, when all others are gone.
    for name in pairs(plan(1)) do
      if name ~= "Session" then
        local x = plan(1, name)[name]
        litter()
        use[name](x)
      end
    end
    print(count))"),
            "13\n");
}

TEST_F(LifetimeTest, WhileAPredicateIsAskedNothingOfItsSessionMoves) {
  EXPECT_EQ(Script(R"lua(
    local o = all()
    local other = session(2)
    local acts = {
      Session = { "settle", "verdict", "simulate", "save", "graph", "shot", "record" },
      Simulation = { "step", "back", "wait", "touch", "lift", "move", "shot" },
      Graph = { "score", "prune", "prune_step", "paths", "back", "shot" },
      Paths = { "next", "top" }, Path = { "optimize", "shot" },
      Optimizer = { "step", "back", "certify", "shot" },
      Trajectory = { "grasps", "shot" }, Grasps = { "all", "best" }, Grasp = { "motion", "shot" },
      Motion = { "step", "finish", "back", "keyframes", "frames", "shot" }, Frame = { "shot" },
    }
    local frames = o.Motion:keyframes()
    local refused, went = 0, {}
    o.Session:break_when(function()
      for kind, names in pairs(acts) do
        for _, name in ipairs(names) do
          local ok, message = pcall(o[kind][name], o[kind])
          if not ok and message:find("stand still", 1, true) then refused = refused + 1
          else went[#went + 1] = kind .. ":" .. name .. " " .. tostring(message) end
        end
      end
      if pcall(frames) then went[#went + 1] = "keyframes()" end
      assert(o.Simulation.t and o.Session:body("object") and o.Graph:why(1).text and o.Optimizer.best_cost)
      local x = other:simulate() x:step(2)
      assert(x.num_steps == 2)
      o.Session:break_when(nil)
      litter()
      return true
    end)
    print(o.Simulation:step(3), o.Simulation.num_steps, refused, table.concat(went, "; ")))lua"),
            "true\t1\t41\t\n");
}

TEST_F(LifetimeTest, APredicateThatFailsYieldsOrNestsLeavesTheSessionUsable) {
  EXPECT_EQ(Script(R"(
    local s, other = session(1), session(2)
    local x, y = s:simulate(), other:simulate()
    s:break_when(function() error("no") end)
    print((select(2, pcall(x.step, x, 2)):gsub("^.-: ", "")))
    s:break_when(function() coroutine.yield(1) end)
    print(coroutine.resume(coroutine.create(function() x:step(2) end)))
    -- Each asks the other: the inner one may not come back to the outer.
    local inner
    other:break_when(function() inner = not pcall(x.step, x) return true end)
    s:break_when(function() y:step(2) return true end)
    print(x:step(3), inner, x.num_steps, y.num_steps)
    s:break_when(nil)
    print(x:step(3), x.num_steps))"),
            "no\n"
            "false\tattempt to yield across a C-call boundary\n"
            "true\ttrue\t1\t1\nfalse\t4\n");
}

TEST_F(LifetimeTest, CoroutinesThatAreRunningRefuseToBeResumedByTheirWrappers) {
  const char* const kText = R"(
    local refused = {}
    local function try(f, ...)
      local ok, message = pcall(f, ...)
      refused[#refused + 1] = not ok and tostring(message):match("cannot resume.*")
    end
    local itself itself = coroutine.wrap(function() try(itself) return "went on" end)
    print(itself())
    local a, b
    a = coroutine.wrap(function()
      local closed <close> = setmetatable({}, { __close = function() print "closed" end })
      local kept = {}
      for i = 1, 50 do kept[i] = {i} end
      coroutine.resume(b)
      for i = 1, 50 do assert(kept[i][1] == i) end
      return "whole"
    end)
    b = coroutine.create(function() try(a) litter() end)
    print(a())
    try(a)
    local failing = coroutine.wrap(function() error { code = 7 } end)
    local ok, value = pcall(failing)
    print(ok, value.code, pcall(failing))
    print(table.concat(refused, "; ")))";
  EXPECT_EQ(Script(kText),
            "went on\nclosed\nwhole\nfalse\t7\tfalse\tcannot resume dead coroutine\n"
            "cannot resume non-suspended coroutine; cannot resume non-suspended coroutine; cannot "
            "resume dead coroutine\n");
}

TEST_F(LifetimeTest, WhatObjectsHoldCountsTowardTheMemoryOfTheScript) {
  for (const char* text : {
           "local t, x = {}, session():simulate() x:step(20) while true do t[#t + 1] = x:fork() "
           "end",
           "local t = {} while true do t[#t + 1] = session() end",
           "local x = session():simulate() for i = 1, 1e6 do x:step(500) end",
           "local t = {} while true do t[#t + 1] = pg.box{1, 1, 1} end",
           "local t = {} while true do t[#t + 1] = session():graph{ triangles = 12, samples = 1 } "
           "end",
           "local t, g = {}, session():graph{ triangles = 12, samples = 1 } while true do t[#t + "
           "1] = "
           "g:what_if{ set = { [\"object.mass\"] = 0.04 + #t * 1e-4 } } end",
           "local s, t = session(), {} local x = s:simulate() x:step(20) s:save_state('out/state', "
           "x) "
           "while true do t[#t + 1] = { pg.load_state 'out/state' } end",
           "local g = session():graph{ triangles = 40, samples = 1 } g:score() for i = 1, 1e6 do "
           "g:fork():prune{ top_percent = 1 + i * 0.01 } end",
       }) {
    EXPECT_NE(Script(text, 40).find("not enough memory: a script has 40 MB"), std::string::npos)
        << text;
  }
  // Let go of, it counts no more.
  EXPECT_EQ(Script("for i = 1, 60 do session():simulate():step(20) end print 'done'", 60),
            "done\n");
}

// In MB, of this process now.
double ResidentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST_F(LifetimeTest, LoopsThatHoldNothingStayWithinTheMemoryOfTheScript) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps what was let go of";
#endif
  constexpr double kCap = 512.0;
  shipped_weights_ = true;  // 8 MB a planner
  for (const char* text : {
           // Each a planner of its own, which the session keeps while there is room.
           "local s = session() for i = 1, 90 do s:graph{ triangles = 12, samples = 1, points = 64 "
           "+ i } end",
           "local s = session() local x = s:simulate() x:step(100) for i = 1, 60 do "
           "s:save_state('out/state', x) local _, y = pg.load_state 'out/state' y:step(1) end",
           "local x = session():simulate() x:step(500) for i = 1, 20000 do x:fork() end",
       }) {
    const double before = ResidentMegabytes();
    EXPECT_EQ(Script(std::string(text) + " print 'done'"), "done\n") << text;
    EXPECT_LT(ResidentMegabytes() - before, kCap) << text;
  }
}

}  // namespace
}  // namespace pregrasp
