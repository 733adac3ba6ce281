// What the test of a grasp costs, beside peers that answer the same question.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "app/grasp/start_certificate.h"
#include "app/grasp/wrench.h"
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

// GLPK's simplex with inscribed pyramids, stopping at the first condition that fails, as ours does.
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

// Feasible grasps found by search, on one thread; items are grasps. The ruler overhangs 6 cm.
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

// The verdict on a start that a proof decides, and on one that only a whole search can.
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

}  // namespace
}  // namespace pregrasp

BENCHMARK_MAIN();
