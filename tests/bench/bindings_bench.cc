// What a call from Lua into a bound function costs beside Lua's own loop: under 2 microseconds.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

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
      "local g = s:graph{{ triangles = 12, samples = 1, points = 128 }}\n"
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
BENCHMARK(BM_EmptyLoop);
BENCHMARK(BM_Property);
BENCHMARK(BM_Method);
BENCHMARK(BM_RecordOfARow);

}  // namespace
}  // namespace pregrasp

BENCHMARK_MAIN();
