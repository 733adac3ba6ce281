// Random calls on random objects, some from coroutines, from predicates and through weak tables:
// each gives a result or one line. 2,000 calls; PREGRASP_FUZZ_CALLS asks for more (test.sh
// --sanitize: 20,000).
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>

#include "bindings/script.h"
#include "tests/bindings/lua_text.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStdout;

const char* const kFuzz = R"(local count = tonumber((...))
local pg = require "pregrasp"
local random = math.random
local pool, weak = {}, setmetatable({}, { __mode = "k" })
local function keep(x)
  if type(x) ~= "userdata" then return x end
  local kind = tostring(x):match("^%a+")
  local of = pool[kind] or {}
  pool[kind] = of
  of[#of < 6 and #of + 1 or random(6)] = x
  weak[x] = kind
  return x
end
local function pick(list) return list[random(#list)] end
local function any()  -- an object, now and then one that only a weak table still has
  if random(16) == 1 then for x, kind in next, weak do return x, kind end end
  local kinds = {} for kind in pairs(pool) do kinds[#kinds + 1] = kind end
  local kind = pick(kinds)
  return pick(pool[kind]), kind
end
local fingers = { "thumb", "index", "middle", "ring", "little" }
local function point() return { random() * 0.1 - 0.05, random() * 0.1 - 0.05, random() * 0.1 } end
local step  -- one random call, defined below
local function open()
  return pg.open(pg.scene{ name = "cube",
    object = { shape = pg.box{0.065, 0.065, 0.065}, mass = 0.05, friction = 0.6, p = {0, 0, 0.3325} },
    environment = { { name = "post", shape = pg.box{0.03, 0.03, 0.3}, p = {0, 0, 0.15}, friction = 0.6 } } },
    { seed = random(100) })
end
local function predicate()
  local left = random(6)
  return function(ev)
    step(true)
    left = left - 1
    if left == -1 and random(4) == 1 then error(ev.kind) end
    return left < 0
  end
end
local small = { quality = "draft", size = {64, 48} }
local good = {
  Session = {
    simulate = function() return { trace = random(2) == 1 } end, body = function() return "object" end,
    distance = point, cloud = function() return { points = 64 } end, mesh = function() return { triangles = 12 } end,
    graph = function() return { triangles = 12, samples = 1, points = 128 } end,
    break_when = function() if random(2) == 1 then return predicate() end end,
    settle = function() return { seconds = 0.02 } end,
    shot = function() return { file = "out/x.png", quality = small.quality, size = small.size } end,
    save = function() return "out/run" .. random(3) end, save_state = function() return "out/state" .. random(2) end,
    go = function() return pick{ "scene.start", "graph.score", "graph.prune.3", "paths.rank.1", "path.1.mppi.1", "sim.1", "sim.3" } end,
    step = function() return pick{ "scene.start", "graph.mesh", "sim.2" } end, why = function() end, check = function() end,
    what_if = function() return { set = { ["object.mass"] = 0.04 + 0.02 * random() } } end, plan = function() return { paths = 1 } end, record = function() return { dir = "out/rec" .. random(2), pictures = "none" } end,
  },
  Simulation = {
    touch = function() return { finger = pick(fingers), p_OC = point() } end,
    move = function() return { finger = pick(fingers), by = point(), seconds = 0.02 } end,
    lift = function() return { finger = pick(fingers) } end, wait = function() return { seconds = 0.02 } end,
    step = function() return random(6) end, back = function() return random(0, 3) end, fork = function() end,
    forward = function() return random(0, 3) end, what_if = function() return { set = { ["fingertips.friction"] = random() } } end,
    body = function() return "post" end,
  },
  Graph = {
    score = function() end, prune = function() return { top_percent = 20 } end, prune_step = function() end,
    why = function() return random(0, 143) end, node = function() return random(0, 143) end, top = function() return random(5) end,
    triangles = function() return { finger = pick(fingers), count = random(3) } end, forward = function() return random(0, 1) end,
    path = function() return { random(0, 143), { thumb = random(0, 11), index = random(0, 12) } } end,
    what_if = function() return { set = { ["environment.post.p"] = { 0, 0, 0.15 } } } end,
    neighbors = function() return random(0, 143) end,
    paths = function() return { stages = random(2), filter = random(2) == 1 and predicate() or nil } end,
    back = function() return random(0, 1) end, fork = function() end,
  },
  Paths = { next = function() end, top = function() return random(3) end, why = function() return random(3) end },
  Path = { why = function() end, why_not = function() return (any()) end, optimize = function() return { samples = 4, iterations = 1 } end },
  Optimizer = { step = function() end, back = function() return random(0, 1) end, fork = function() return {} end,
    rollouts = function() end, elite = function() return random(5) end, rollout = function() return random(5) end,
    trace = function() return random(5) end, why = function() return random(5) end, why_not = function() return random(5) end,
    run = function() return 1 end, set = function() return { sigma = random() } end, set_nominal = function() return random(0, 5) end,
    forward = function() return random(0, 1) end, certify = function() return { hold_seconds = 0.05 } end },
  Trajectory = { why = function() end, why_not = function() return (any()) end, trace = function() return random(0, 50) end, body = function() return "object" end,
    grasps = function() return { samples = 1, points = 100, pairs = 100, max_solves = 1, starts = 1, search_sets = 0 } end },
  Grasps = { all = function() end, best = function() end, why = function() end },
  Grasp = { motion = function() return {} end, why = function() end, why_not = function() return (any()) end },
  Motion = { back = function() return 0 end, forward = function() return 0 end, why = function() end, why_not = function() return (any()) end },
  Plan = { why = function() end, why_not = function() return random(3) end, back = function() return 0 end, forward = function() return random(0, 1) end },
  Frame = { why = function() end, why_not = function() return (any()) end }, Array = { table = function() end }, Reason = {}, Shape = {}, Scene = {},
}
local fields = { "t", "num_steps", "object", "fingers", "contacts", "trace", "step_id", "name", "bodies", "stage", "kept",
  "best_cost", "certified", "reasons", "count", "reason", "text", "node", "rank", "score", "terms", 1, 2, -1, "nothing", "iteration" }
local function junk(depth)
  local n = random(12)
  if n == 1 then return nil elseif n == 2 then return random(-3, 300) elseif n == 3 then return 0 / 0
  elseif n == 4 then return 1e308 * pick{1, -1} elseif n == 5 then return "index\0x" elseif n == 6 then return ("x"):rep(random(2000))
  elseif n == 7 then return (any()) elseif n == 8 then return function() return step(true) end elseif n == 9 then return true
  elseif n == 10 and depth < 3 then return { junk(depth + 1), junk(depth + 1) }
  elseif n == 11 and depth < 3 then return { [pick(fingers)] = junk(depth + 1), seconds = junk(depth + 1) } end
  return random()
end
local costly = { what_if = 0.1, save_state = 0.05, trace = 0.2, check = 0.2, plan = 0.1, graph = 0.1, certify = 0.1, grasps = 0.1, optimize = 0.3, save = 0.05, record = 0.05, shot = 0.05, motion = 0.1 }
local calls, passed, depth = 0, 0, 0
local function call()
  local x, kind = any()
  if random(40) == 1 then return pcall(function() return x[pick(fields)] end) end
  local methods = good[kind]
  local names = {} for name in pairs(methods or {}) do names[#names + 1] = name end
  if #names == 0 or random(40) == 1 then return pcall(pg[pick{ "box", "union", "wrench", "ik", "scene", "open", "compare", "check", "load_state" }], junk(1), junk(1)) end
  local name = pick(names)
  if random() > (costly[name] or 1) then calls = calls - 1 return nil end
  local argument
  if random(20) > 1 then argument = methods[name]() else argument = junk(1) end
  if type(argument) == "table" and random(12) == 1 then argument[next(argument) or 1] = junk(1) end
  if argument == nil then return pcall(function() return x[name](x) end) end
  return pcall(function() return x[name](x, argument) end)
end
function step(nested)
  if depth > 3 then return end
  depth = depth + 1
  calls = calls + 1
  local results
  if random(6) == 1 then
    local co = coroutine.create(call)
    results = table.pack(select(2, coroutine.resume(co)))
  else
    results = table.pack(call())
  end
  if results[1] then passed = passed + 1 end
  for i = 2, results.n do keep(results[i]) end
  if results[1] == false and type(results[2]) ~= "string" then print("no text", results[2]) end
  depth = depth - 1
  if not nested and random(100) == 1 then
    pool[pick{ "Session", "Simulation", "Graph", "Optimizer", "Trajectory" }] = nil
    for i = 1, 2e4 do local _ = {i} end
  end
end
while calls < count do
  if not pool.Session or random(400) == 1 then keep(open()) end
  if not pool.Shape then keep(pg.box{1, 1, 1}) end
  step(false)
end
print(calls, passed)
)";

TEST(FuzzCallsTest, RandomCallsGiveResultsOrOneLine) {
  const TestFolder folder, weights;
  WriteRandomWeights(weights.path());
  const char* asked = std::getenv("PREGRASP_FUZZ_CALLS");
  const std::string count = asked == nullptr ? "2000" : asked;
  ScriptConfig config;
  config.output = folder.path() / "out";
  config.weights = weights.path();
  config.threads = 1;
  config.machine.seconds = 600.0;
  CaptureStdout();
  const auto run = [&] { RunScript(folder.Write("fuzz.lua", kFuzz), {count}, config); };
  EXPECT_NO_THROW(run());
  std::istringstream out(GetCapturedStdout());
  long calls = 0, passed = 0;
  out >> calls >> passed;
  EXPECT_FALSE(out.fail()) << out.str();
  EXPECT_GE(calls, std::stol(count));
  EXPECT_GE(3 * passed, calls) << "most calls fail at their arguments";
}

}  // namespace
}  // namespace pregrasp
