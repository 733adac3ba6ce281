// What scoring and grasp generation cost, in the amounts in which planning asks for them. The time
// does not depend on the weights, so these are random ones.
#include <benchmark/benchmark.h>

#include <vector>

#include "app/networks/grasp_generator.h"
#include "app/networks/score_function.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

constexpr int kRollouts = 128, kStates = 3;
constexpr int kNodes = 1600, kSamples = 15;
constexpr int kPoints = 512;

std::vector<ObjectState> MakeStates(int count) {
  std::vector<ObjectState> states;
  for (int i = 0; i < count; ++i) {
    Rng rng(1, RngStream::kTest, i);
    states.push_back(MakeRandomState(rng, kPoints));
  }
  return states;
}

std::vector<PlanningContacts> MakeContacts(const MatrixX3& P, int count) {
  std::vector<PlanningContacts> contacts;
  for (int i = 0; i < count; ++i) {
    Rng rng(2, RngStream::kTest, i);
    contacts.push_back(MakeRandomContacts(rng, P));
  }
  return contacts;
}

// 128 rollouts of 3 states each, one choice of contacts per state; the argument is threads.
void ScoreRollouts(benchmark::State& state, const SetEncoderConfig& config) {
  const ScoreFunction score = ScoreFunction::FromTensors(MakeRandomScore(1, config));
  const MatrixX3 P = MakeBoxCloud(1, kPoints);
  const CloudStructure structure = score.BuildStructure(P, Matrix3::Identity());
  const auto states = MakeStates(kRollouts * kStates);
  const auto contacts = MakeContacts(P, kRollouts * kStates);
  ThreadPool pool(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(score.ScoreStates(structure, states, contacts, pool));
  }
}
BENCHMARK_CAPTURE(ScoreRollouts, default, SetEncoderConfig{})
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ScoreRollouts, paper, PaperSetEncoderConfig())
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

// A contact graph's nodes, 15 choices of contacts each, with the surroundings and without.
void ScoreGraph(benchmark::State& state) {
  const ScoreFunction score = ScoreFunction::FromTensors(MakeRandomScore(1));
  const MatrixX3 P = MakeBoxCloud(1, kPoints);
  const CloudStructure structure = score.BuildStructure(P, Matrix3::Identity());
  const auto contacts = MakeContacts(P, kNodes * kSamples);
  const ObjectState with = MakeStates(1)[0], without;
  ThreadPool pool(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        score.ScoreContacts(structure, with, contacts, ScoreOutput::kProgress, pool));
    benchmark::DoNotOptimize(
        score.ScoreContacts(structure, without, contacts, ScoreOutput::kProgress, pool));
  }
}
BENCHMARK(ScoreGraph)
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

// Once per object.
void BuildStructure(benchmark::State& state) {
  const ScoreFunction score = ScoreFunction::FromTensors(MakeRandomScore(1));
  const MatrixX3 P = MakeBoxCloud(1, kPoints);
  for (auto _ : state) {
    benchmark::DoNotOptimize(score.BuildStructure(P, Matrix3::Identity()));
  }
}
BENCHMARK(BuildStructure)->Unit(benchmark::kMillisecond);

// 20 grasps from both contacts, encoding included.
void GenerateGrasps(benchmark::State& state) {
  const GraspGenerator generator = GraspGenerator::FromTensors(MakeRandomGenerator(1));
  const MatrixX3 P = MakeBoxCloud(1, kPoints);
  const CloudStructure structure = generator.BuildStructure(P, Matrix3::Identity());
  const ObjectState object = MakeStates(1)[0];
  Rng rng(3);
  const PlanningContacts contacts{MakeRandomContact(rng, P), MakeRandomContact(rng, P)};
  for (auto _ : state) {
    const EncodedState encoded = generator.Encode(structure, object);
    benchmark::DoNotOptimize(generator.Sample(structure, encoded, contacts, 20, Rng(1)));
  }
}
BENCHMARK(GenerateGrasps)->Unit(benchmark::kMillisecond);

// The kernel on a layer of 256 x 256, by instruction set (0 baseline, 1 AVX2, 2 AVX-512).
void Multiply256(benchmark::State& state) {
  const auto isa = static_cast<KernelIsa>(state.range(0));
  if (!KernelIsaSupported(isa)) return state.SkipWithError("not supported by this processor");
  const int rows = 512, width = 256;
  std::vector<float> in(rows * width, 0.5F), weights(width * width, 0.1F), bias(width),
      out(rows * width);
  for (auto _ : state) {
    MultiplyRows(isa, in.data(), rows, width, width, weights.data(), bias.data(), width / kPanel,
                 out.data(), width);
    benchmark::ClobberMemory();
  }
  state.SetLabel(KernelIsaName(isa));
  state.counters["flops"] =
      benchmark::Counter(2.0 * rows * width * width * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}
BENCHMARK(Multiply256)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pregrasp

BENCHMARK_MAIN();
