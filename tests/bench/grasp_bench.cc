// What the test of a grasp costs, beside peers that answer the same question.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "app/grasp/start_certificate.h"
#include "app/grasp/wrench.h"
#include "tests/bench/generated_grasps.h"
#include "tests/grasp/contact_sets.h"
#include "tests/grasp/grasp_scenes.h"
#include "tests/grasp/qhull_margin.h"
#include "tests/grasp/wrench_lp.h"

namespace pregrasp {
namespace {

struct Question {
  std::vector<WrenchContact> contacts;
  WrenchConfig config;
};

std::vector<Question> MakeQuestions(int count) {
  Rng rng(1, RngStream::kTest);
  std::vector<Question> questions(count);
  for (Question& question : questions) {
    question.contacts = SampleContactSet(rng);
    question.config = SampleWrenchConfig(rng);
  }
  return questions;
}

void CountSets(benchmark::State& state, std::size_t sets) {
  state.SetItemsProcessed(static_cast<std::int64_t>(sets) * state.iterations());
}

void WrenchVerdict(benchmark::State& state) {
  const std::vector<Question> questions = MakeQuestions(1000);
  int feasible = 0;
  for (auto _ : state) {
    feasible = 0;
    for (const Question& question : questions) {
      feasible += CalcWrenchStatus(question.contacts, question.config) == WrenchStatus::kFeasible;
    }
  }
  state.counters["feasible"] = feasible;
  CountSets(state, questions.size());
}
BENCHMARK(WrenchVerdict)->Unit(benchmark::kMillisecond);

// GLPK's simplex with inscribed pyramids, stopping at the first condition that
// fails, as ours does.
void WrenchVerdictByLp(benchmark::State& state) {
  const std::vector<Question> questions = MakeQuestions(1000);
  const int facets = static_cast<int>(state.range(0));
  int feasible = 0;
  for (auto _ : state) {
    feasible = 0;
    for (const Question& question : questions) {
      const auto balances = [&](bool with_weight) {
        return CalcImbalanceByLp(question.contacts, question.config, with_weight, facets,
                                 Pyramid::kInscribed) <= 1e-7;
      };
      feasible += balances(false) && balances(true);
    }
  }
  state.counters["feasible"] = feasible;
  CountSets(state, questions.size());
}
BENCHMARK(WrenchVerdictByLp)->ArgName("facets")->Arg(8)->Arg(64)->Unit(benchmark::kMillisecond);

void WrenchWithForcesAndMargin(benchmark::State& state) {
  const std::vector<Question> questions = MakeQuestions(300);
  for (auto _ : state) {
    for (const Question& question : questions) {
      benchmark::DoNotOptimize(CalcWrench(question.contacts, question.config));
    }
  }
  CountSets(state, questions.size());
}
BENCHMARK(WrenchWithForcesAndMargin)->Unit(benchmark::kMillisecond);

// Of sets that are force closure, where there is a hull to measure.
std::vector<Question> MakeClosedQuestions(std::size_t count) {
  std::vector<Question> closed;
  for (const Question& question : MakeQuestions(1000)) {
    if (closed.size() == count) break;
    if (CalcMargin(question.contacts, question.config.mu, question.config.torque_scale) > 0.0) {
      closed.push_back(question);
    }
  }
  return closed;
}

void Margin(benchmark::State& state) {
  const std::vector<Question> questions = MakeClosedQuestions(100);
  for (auto _ : state) {
    for (const auto& [contacts, config] : questions) {
      benchmark::DoNotOptimize(CalcMargin(contacts, config.mu, config.torque_scale));
    }
  }
  CountSets(state, questions.size());
}
BENCHMARK(Margin)->Unit(benchmark::kMillisecond);

void MarginByQhull(benchmark::State& state) {
  const std::vector<Question> questions = MakeClosedQuestions(20);
  for (auto _ : state) {
    for (const auto& [contacts, config] : questions) {
      benchmark::DoNotOptimize(
          CalcNearestFacetByQhull(CalcEdgeWrenches(contacts, config.mu, config.torque_scale)));
    }
  }
  CountSets(state, questions.size());
}
BENCHMARK(MarginByQhull)->Unit(benchmark::kMillisecond);

// Feasible grasps found by search, on one thread; items are grasps. The ruler
// overhangs 6 cm.
void GraspSearch(benchmark::State& state, const Scene& scene) {
  const GraspWorld world(scene, ShadowHand());
  ThreadPool pool(1);
  GraspSearchConfig config;
  config.max_found = 5;
  GraspSearchStats sum;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const GraspSearchStats stats =
        SearchGrasps(world, config, {}, world.StartPoses(), ++seed, pool).stats;
    sum.plausible += stats.plausible;
    sum.solved += stats.solved;
    sum.reached += stats.reached;
    sum.feasible += stats.feasible;
  }
  state.SetItemsProcessed(sum.feasible);
  const double grasps = std::max(1, sum.feasible);
  state.counters["sets_per_grasp"] = sum.plausible / grasps;
  state.counters["solved_per_grasp"] = sum.solved / grasps;
  state.counters["reached_per_grasp"] = sum.reached / grasps;
}
BENCHMARK_CAPTURE(GraspSearch, ruler, RulerScene(0.06))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(GraspSearch, carton, FreeCartonScene())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(GraspSearch, keyboard, KeyboardScene(0.16))->Unit(benchmark::kMillisecond);

void BuildGraspWorld(benchmark::State& state) {
  const Scene scene = FreeCartonScene();
  for (auto _ : state) benchmark::DoNotOptimize(GraspWorld(scene, ShadowHand()).object_radius());
}
BENCHMARK(BuildGraspWorld)->Unit(benchmark::kMillisecond);

// The verdict on a start that a proof decides, and on one that only a whole
// search can.
void StartCertificateOf(benchmark::State& state, const Scene& scene) {
  const GraspWorld world(scene, ShadowHand());
  ThreadPool pool(1);
  StartCertificate certificate;
  for (auto _ : state) certificate = CertifyStart(world, {}, {}, pool);
  state.SetLabel(StartVerdictName(certificate.verdict));
  state.counters["tried"] = certificate.search.tried;
}
BENCHMARK_CAPTURE(StartCertificateOf, book, BookScene())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(StartCertificateOf, keyboard_at_wall, KeyboardScene(0.01))
    ->Unit(benchmark::kMillisecond);

struct CompletionCounts {
  int samples = 0, feasible = 0, raw = 0, too_close = 0;

  CompletionCounts& operator+=(const CompletedGrasp& grasp) {
    ++samples;
    feasible += grasp.feasible();
    raw += grasp.raw.feasible();
    too_close += grasp.raw.status == GraspStatus::kTipsTooClose;
    return *this;
  }
};

// Twenty generated grasps, projected, refined and tested on one thread, and how
// many of them are feasible. A start where nothing can hold, then poses in
// which search finds grasps.
void Completion(benchmark::State& state, const Scene& scene,
                const std::vector<GraspContact>& pressing) {
  GeneratedGrasps generated(scene, pressing);
  constexpr int kSeeds = 5;
  std::vector<std::vector<GeneratedGrasp>> draws;
  ThreadPool pool(1);
  for (int seed = 1; seed <= kSeeds; ++seed) draws.push_back(generated.Draw(seed));
  CompletionCounts counts;
  std::size_t next = 0;
  for (auto _ : state) {
    const std::vector<GeneratedGrasp>& draw = draws[next++ % kSeeds];
    const ContactPlaces places(generated.world(), generated.world().StartPoses());
    for (const CompletedGrasp& grasp :
         CompleteGrasps(places, {}, draw, generated.pressing(), pool).grasps) {
      counts += grasp;
    }
  }
  const auto samples = static_cast<double>(counts.samples);
  state.counters["r_suc"] = counts.feasible / samples;
  state.counters["r_suc_raw"] = counts.raw / samples;
  state.counters["too_close"] = counts.too_close / samples;
}

// The search that follows, at the same poses.
void SecondSource(benchmark::State& state, const Scene& scene,
                  const std::vector<GraspContact>& pressing) {
  const GraspWorld world(scene, ShadowHand());
  ThreadPool pool(1);
  std::uint64_t seed = 0;
  double found = 0.0;
  for (auto _ : state) {
    const ContactPlaces places(world, world.StartPoses());
    found += SearchGrasps(places, MakeSecondSourceConfig(), pressing, ++seed, pool).stats.feasible;
  }
  state.counters["found"] = found / static_cast<double>(state.iterations());
}

void CompletionBenchmark(const std::string& name, const Scene& scene,
                         const std::vector<GraspContact>& pressing = {}) {
  benchmark::RegisterBenchmark(("SecondSource/" + name).c_str(), SecondSource, scene, pressing)
      ->Iterations(5)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("Completion/" + name).c_str(), Completion, scene, pressing)
      ->Iterations(5)
      ->Unit(benchmark::kMillisecond);
}

void RegisterCompletions() {
  const Vector3 card(0.200, 0.250, 0.003);
  CompletionBenchmark("card_flat", FlatScene(card, 0.03, -0.01));
  CompletionBenchmark("card_40mm_over_edge", FlatScene(card, 0.03, 0.04));
  CompletionBenchmark("card_80mm_over_edge", FlatScene(card, 0.03, 0.08));
  CompletionBenchmark("card_free", Moved(FlatScene(card, 0.03, 0.0), {0, 0, 0.5}));
  CompletionBenchmark("ruler_60mm_over_edge", RulerScene(0.06));
  CompletionBenchmark("board_50mm_over_shelf", BoardScene(0.05));
  CompletionBenchmark("keyboard_at_wall", KeyboardScene(0.01));
  CompletionBenchmark("keyboard_36mm_out", Moved(KeyboardScene(0.01), {0.046, 0, 0}));
  CompletionBenchmark("keyboard_72mm_out", Moved(KeyboardScene(0.01), {0.082, 0, 0}));
  CompletionBenchmark("keyboard_free", Moved(KeyboardScene(0.01), {0, 0, 0.5}));
  CompletionBenchmark("carton_in_row", CartonScene());
  CompletionBenchmark("carton_35mm_out", Moved(CartonScene(), {0.035, 0, 0}));
  CompletionBenchmark("book_in_row", BookScene());
  const GraspContact on_top{Finger::kIndex, {-0.03, 0, 0.115}, Vector3::UnitZ()};
  for (const int tilt : {8, 16, 24}) {
    CompletionBenchmark("book_pressed_" + std::to_string(tilt) + "_degrees",
                        Tilted(BookScene(), tilt, {0.0775, 0, 0}), {on_top});
  }
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  pregrasp::RegisterCompletions();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
