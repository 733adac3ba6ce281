// Random calls on random objects, some from coroutines, from predicates and through weak tables:
// each gives a result or one line. 2,000 calls of four seeds together; PREGRASP_FUZZ_CALLS asks for
// more (test.sh --sanitize: 20,000).
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
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
  if random(3) == 1 then return pg.open("scenes/ruler.lua", { seed = random(100) }) end
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
local saved, finished = {}, {}  -- directories that load_state and load can read
local function shot() return { file = "out/x.png", quality = "draft", size = {64, 48} } end
local function strip(of, other)
  local options = { of, file = "out/y.png", quality = "draft", size = {400, 600} }
  if random(2) == 1 then options.against = other else options[2] = other end
  return options
end
local cheap = { ["mesh.triangles"] = 12, ["graph.samples"] = 1, ["cloud.points"] = 128, ["graph.top_percent"] = 20, ["screen.samples"] = 4,
  ["screen.iterations"] = 1, ["screen.rounds"] = 1, ["mppi.samples"] = 4, ["mppi.iterations"] = 2, ["certify.hold_seconds"] = 0.05,
  ["grasps.samples"] = 1, ["grasps.draws"] = 1, ["grasps.points"] = 100, ["grasps.pairs"] = 100, ["grasps.max_solves"] = 1, ["grasps.max_probes"] = 100,
  ["grasps.search_sets"] = 0, ["grasps.starts"] = 1 }
local steps = { "scene.start", "scene.verdict", "graph.mesh", "graph.score", "graph.prune.3", "paths.rank.1", "path.1.screen.1", "path.1.mppi.1",
  "path.1.certify", "path.1.grasp.1", "sim.1", "sim.3" }
local function plan()
  local set = {} for key, value in pairs(cheap) do set[key] = value end
  set["screen.paths"] = random(2) set["mppi.iterations"] = random(3)
  return { paths = random(2), plans = 1, motions = 1, all = random(2) == 1, set = set }
end
local within_rules = {} for key, value in pairs(cheap) do within_rules[key] = value end
within_rules["certify.hold_seconds"], within_rules["screen.paths"], within_rules["mppi.iterations"] = nil, 1, 1
local wrong = { dir = { "/etc", "../x", 3 }, study = { "lader", 1, "ladder" }, scenes = { {}, { 3 }, "ruler", { "scenes/rulr.lua" } },
  seeds = { 0, 1.5, 1e9 }, first_seed = { -1, "x" }, paths = { 0, "2" }, threads = { -1, 1e9 }, keep_runs = { 1 }, nothing = { 1 },
  set = { { hand = "nonsense" }, { ["object.mass"] = -1 }, { ["certify.hold_seconds"] = 0.05 }, { ["mppi.sigm"] = 1 }, 3 } }
local evals = 0
local function eval()  -- each third one is good; the first of these makes an item, the others find it
  local options = { dir = "out/eval", scenes = { "scenes/ruler.lua" }, seeds = 1, paths = 1, threads = 1, set = within_rules }
  evals = evals + 1
  if evals % 3 == 1 then return options end
  local keys = {} for key in pairs(wrong) do keys[#keys + 1] = key end
  local key = pick(keys)
  options[key] = pick(wrong[key])
  return options
end
local module = {
  eval = eval,
  compare = function() return (any()), (any()) end,
  load_state = function() return pick(saved) end, load = function() return pick(finished) end,
  wrench = function() return { p = { point(), point() }, n = { {1, 0, 0}, {-1, 0, 0} }, mu = random(), mass = 0.1 * random() } end,
  ik = function() return { contacts = { thumb = { p = point(), n = {1, 0, 0} }, index = { p = point(), n = {-1, 0, 0} } }, seed = random(9) } end,
  check = function() return "scenes/ruler.lua" end, box = function() return point() end, sphere = function() return { r = random() } end,
}
local good = {
  Session = {
    simulate = function() return { trace = random(2) == 1 } end, body = function(s) return pick(s.bodies) end,
    distance = point, cloud = function() return { points = 64 } end, mesh = function() return { triangles = 12 } end,
    graph = function() return { triangles = 12, samples = 1, points = 128 } end,
    break_when = function() if random(2) == 1 then return predicate() end end,
    settle = function() return { seconds = 0.02 } end,
    shot = shot, strip = function(s) return strip(random(2) == 1 and s or pick(steps), (any())) end,
    save = function() return "out/run" .. random(3) end, verdict = function() end,
    save_state = function(s)
      local dir = "out/state" .. random(3)
      if random(2) == 1 then return dir end
      return dir, s
    end,
    go = function() return pick(steps) end, step = function() return pick(steps) end, why = function() end, check = function() end,
    what_if = function() return { set = { ["object.mass"] = 0.04 + 0.02 * random() } } end, plan = plan, record = function() return { dir = "out/rec" .. random(2), pictures = "none" } end,
  },
  Simulation = {
    touch = function() return { finger = pick(fingers), p_OC = point() } end,
    move = function() return { finger = pick(fingers), by = point(), seconds = 0.02 } end,
    lift = function() return { finger = pick(fingers) } end, wait = function() return { seconds = 0.02 } end,
    step = function() return random(6) end, back = function() return random(0, 3) end, fork = function() end,
    forward = function() return random(0, 3) end, what_if = function() return { set = { ["fingertips.friction"] = random() } } end,
    body = function() return pick{ "post", "ruler", "cube" } end, shot = shot,
  },
  Graph = {
    score = function() end, prune = function() return { top_percent = 20 } end, prune_step = function() end,
    why = function() return random(0, 143) end, node = function() return random(0, 143) end, top = function() return random(5) end,
    triangles = function() return { finger = pick(fingers), count = random(3) } end, forward = function() return random(0, 1) end,
    path = function() return { random(0, 143), { thumb = random(0, 11), index = random(0, 12) } } end,
    what_if = function() return { set = { ["object.friction"] = 0.3 + 0.2 * random() } } end,
    neighbors = function() return random(0, 143) end,
    paths = function() return { stages = random(2), filter = random(2) == 1 and predicate() or nil } end,
    back = function() return random(0, 1) end, fork = function() end, why_not = function() return random(0, 143) end, shot = shot,
  },
  Paths = { next = function() end, top = function() return random(3) end, why = function() return random(3) end },
  Path = { why = function() end, shot = shot, why_not = function() return pool.Path and pick(pool.Path) or any() end, optimize = function() return { samples = 4, iterations = 1 } end },
  Optimizer = { step = function() end, back = function() return random(0, 1) end, fork = function() return {} end,
    rollouts = function() end, elite = function() return random(5) end, rollout = function() return random(5) end,
    trace = function() return random(5) end, why = function() return random(5) end, why_not = function() return random(5) end,
    run = function() return 1 end, set = function() return { sigma = random() } end, set_nominal = function() return random(0, 5) end,
    forward = function() return random(0, 1) end, certify = function() return { hold_seconds = 0.05 } end,
    screen = function() return { samples = 4, iterations = 1 } end, shot = shot },
  Trajectory = { why = function() end, why_not = function() return (any()) end, trace = function() return random(0, 50) end,
    body = function() return pick{ "cube", "ruler", "object" } end, shot = shot,
    grasps = function() return { samples = 1, points = 100, pairs = 100, max_solves = 1, starts = 1, search_sets = 0 } end },
  Grasps = { all = function() end, best = function() end, why = function() end },
  Grasp = { motion = function() return {} end, why = function() end, why_not = function() return (any()) end, shot = shot },
  Motion = { back = function() return 0 end, forward = function() return 0 end, why = function() end, why_not = function() return (any()) end,
    step = function() end, shot = shot },
  Plan = { step = function() return random(4) end, run = function() return random(4) > 1 and pick(steps) or nil end, next_stage = function() end,
    why = function() end, why_not = function() return random(3) end, back = function() return random(0, 3) end,
    forward = function() return random(0, 3) end, object = function() end, save = function() return "out/run" .. random(3) end },
  Frame = { why = function() end, why_not = function() return (any()) end, shot = shot }, Array = { table = function() end },
  Run = { step = function() return pick(steps) end, shot = function() return pick(steps), shot() end,
    strip = function(run) return strip("scene.start", random(2) == 1 and run or "sim.1") end }, Reason = {}, Shape = {}, Scene = {},
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
local costly = { what_if = 0.4, save_state = 0.2, trace = 0.2, check = 0.2, plan = 0.3, graph = 0.4, certify = 0.3, grasps = 0.4, optimize = 0.5,
  save = 0.1, record = 0.05, shot = 0.05, strip = 0.05, motion = 0.1, verdict = 0.1, load_state = 0.5, load = 0.3, run = 0.4, eval = 0.5 }
local calls, passed, depth = 0, 0, 0
local tried, done = {}, {}  -- calls with good arguments, and those of them that gave a result, by Class:method
local function count_good(name, ok, ...)
  tried[name] = (tried[name] or 0) + 1
  if ok then done[name] = (done[name] or 0) + 1 end
  return ok, ...
end
local function call_module(name)
  if random() > (costly[name] or 1) then calls = calls - 1 return nil end
  if name:match("^load") and #(name == "load" and finished or saved) == 0 then calls = calls - 1 return nil end
  local arguments = table.pack(module[name]())
  return count_good(name, pcall(function() return pg[name](table.unpack(arguments, 1, arguments.n)) end))
end
local function call()
  local x, kind = any()
  if random(40) == 1 then return pcall(function() return x[pick(fields)] end) end
  local methods = good[kind]
  local names = {} for name in pairs(methods or {}) do names[#names + 1] = name end
  if random(12) == 1 then
    names = {} for name in pairs(module) do names[#names + 1] = name end
    return call_module(pick(names))
  end
  if #names == 0 or random(40) == 1 then return pcall(pg[pick{ "box", "union", "wrench", "ik", "scene", "open", "compare", "check", "load_state" }], junk(1), junk(1)) end
  local name = pick(names)
  if random() > (costly[name] or 1) then calls = calls - 1 return nil end
  local arguments, good_one = table.pack(methods[name](x)), true
  if random(20) == 1 then arguments, good_one = { junk(1), n = 1 }, false end
  local argument = arguments[1]
  if type(argument) == "table" and random(12) == 1 then good_one, argument[next(argument) or 1] = false, junk(1) end
  local results = table.pack(pcall(function() return x[name](x, table.unpack(arguments, 1, arguments.n)) end))
  if not good_one then return table.unpack(results, 1, results.n) end
  if results[1] and name == "save_state" then saved[#saved + 1] = argument end
  if results[1] and name == "save" then finished[#finished + 1] = argument end
  return count_good(kind .. ":" .. name, table.unpack(results, 1, results.n))
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
  if not pool.Plan then keep(pick(pool.Session):plan(plan())) end
  if random(80) == 1 then count_good("Plan:step", pcall(function() return pick(pool.Plan):step(random(3)) end)) end
  if random(80) == 1 then calls = calls + 1 call_module "eval" end
  step(false)
end
print(calls, passed)
local names = {} for name in pairs(tried) do names[#names + 1] = name end
for _, name in ipairs(names) do print(name, tried[name], done[name] or 0) end
)";

class FuzzCallsTest : public testing::TestWithParam<int> {};
constexpr int kFuzzSeeds = 4;

TEST_P(FuzzCallsTest, RandomCallsGiveResultsOrOneLine) {
  const TestFolder folder, weights;
  WriteRandomWeights(weights.path());
  const char* asked = std::getenv("PREGRASP_FUZZ_CALLS");
  const long count = (asked == nullptr ? 2000 : std::stol(asked)) / kFuzzSeeds;
  ScriptConfig config;
  config.output = folder.path() / "out";
  config.weights = weights.path();
  config.threads = 1;
  config.machine.seconds = 600.0;
  config.machine.seed = GetParam();
  CaptureStdout();
  const auto run = [&] {
    RunScript(folder.Write("fuzz.lua", kFuzz), {std::to_string(count)}, config);
  };
  EXPECT_NO_THROW(run());
  std::istringstream out(GetCapturedStdout());
  long calls = 0, passed = 0;
  out >> calls >> passed;
  EXPECT_FALSE(out.fail()) << out.str();
  EXPECT_GE(calls, count);
  EXPECT_GE(3 * passed, calls) << "most calls fail at their arguments";
  std::map<std::string, int> done;
  std::string name;
  for (int tried = 0, good = 0; out >> name >> tried >> good;) done[name] = good;
  for (const char* must : {"Plan:step", "eval"}) {
    EXPECT_GE(done[must], 1) << must << " never gave a result";
  }
  constexpr long kEnoughForAll = 5000;
  if (count < kEnoughForAll) return;
  for (const char* must :
       {"Plan:step", "Plan:run", "Plan:next_stage", "Plan:back", "Plan:forward", "Plan:object",
        "Session:plan", "Session:go", "Session:save_state", "Session:what_if", "Graph:what_if",
        "Simulation:what_if", "Simulation:forward", "compare", "load", "load_state"}) {
    EXPECT_GE(done[must], 1) << must << " never gave a result";
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FuzzCallsTest, testing::Range(1, 1 + kFuzzSeeds));

}  // namespace
}  // namespace pregrasp
