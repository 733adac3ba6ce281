// What a call from Lua into a bound function costs beside Lua's own loop: under 2 microseconds.
// What a jump to one of the last 1,000 steps costs in a session that has more: under 50 ms and 1
// GB.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/core/peak_memory.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

constexpr int kCalls = 100000;

// Runs a script whose loop does `body` kCalls times.
void RunLoop(benchmark::State& state, const std::string& body) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "pregrasp_bindings_bench.lua";
  std::ofstream(file) << fmt::format(
      "local pg = require 'pregrasp' local s = pg.open 'scenes/ruler.lua' local sim = "
      "s:simulate()\n"
      "local g = s:graph{{ triangles = 12, samples = 1, points = 128 }} local nodes = g.nodes\n"
      "return function() for _ = 1, {} do {} end end",
      kCalls, body);
  const ScriptConfig config;
  ScriptMachine machine(config);
  machine.machine().LoadFile(machine.machine().state(), file);
  machine.machine().Call(0, 1);
  lua_State* L = machine.machine().state();
  for (auto _ : state) {
    lua_pushvalue(L, -1);
    machine.machine().Call(0, 0);
  }
  state.SetItemsProcessed(state.iterations() * kCalls);  // its inverse is the time of a call
}

void BM_EmptyLoop(benchmark::State& state) { RunLoop(state, "local _ = 1"); }
void BM_Property(benchmark::State& state) { RunLoop(state, "local _ = s.dt"); }
void BM_Method(benchmark::State& state) { RunLoop(state, "sim:back(0)"); }
void BM_RecordOfARow(benchmark::State& state) { RunLoop(state, "local _ = g:node(3)"); }
void BM_ItemOfAnArray(benchmark::State& state) { RunLoop(state, "local _ = nodes[7]"); }

// Jumps to each of the last 1,000 steps in turn, far and near mixed, and reads what needs the state
// there. @param script  makes the steps and gives a function that jumps `k` steps back.
void RunJumps(benchmark::State& state, const std::string& script) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "pregrasp_jumps_bench.lua";
  std::ofstream(file) << "local pg = require 'pregrasp' local s = pg.open 'scenes/ruler.lua'\n"
                      << script;
  ScriptConfig config;
  config.machine.seconds = 1000.0;
  config.machine.bytes = 1U << 30U;
  ScriptMachine machine(config);
  machine.machine().LoadFile(machine.machine().state(), file);
  machine.machine().Call(0, 1);
  lua_State* L = machine.machine().state();
  double worst = 0.0;
  int k = 0;
  for (auto _ : state) {
    k = (k + 389) % 1000;
    const auto begin = std::chrono::steady_clock::now();
    lua_pushvalue(L, -1);
    lua_pushinteger(L, k);
    machine.machine().Call(1, 0);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    worst = std::max(worst, took.count());
  }
  state.counters["worst_ms"] = 1e3 * worst;
  state.counters["peak_MB"] = PeakMegabytes();
}

void BM_JumpAmongPlannerSteps(benchmark::State& state) {
  RunJumps(state,
           "local g = s:graph{ triangles = 24, samples = 2, points = 256 } g:score() g:prune()\n"
           "local paths = g:paths()\n"
           "for _ = 1, 22 do\n"
           "  local o = paths:next():optimize{ samples = 8, iterations = 50, patience = 50 }\n"
           "  for _ = 1, 50 do o:step() end\n"
           "end\n"
           "local ids = s.ids assert(#ids > 1100)\n"
           "return function(k)\n"
           "  local x = s:go(ids[#ids - k])\n"
           "  local _ = tostring(x):find '^Path' and x.nodes or x.nominal\n"
           "end");
}
void BM_JumpAmongPhysicsSteps(benchmark::State& state) {
  RunJumps(
      state,
      "local sim = s:simulate() sim:touch{ finger = 'index', p_OC = { 0.11, 0, 0.0015 } }\n"
      "sim:move{ finger = 'index', by = { 0, 0, -0.012 }, seconds = 1 } sim:wait{ seconds = 10 }\n"
      "return function(k) sim:back(k) local _ = sim.object.p sim:forward(k) end");
}
BENCHMARK(BM_EmptyLoop);
BENCHMARK(BM_Property);
BENCHMARK(BM_Method);
BENCHMARK(BM_RecordOfARow);
BENCHMARK(BM_ItemOfAnArray);
BENCHMARK(BM_JumpAmongPlannerSteps)->Iterations(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_JumpAmongPhysicsSteps)->Iterations(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pregrasp

BENCHMARK_MAIN();
