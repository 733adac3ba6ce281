// Inverse kinematics of the hand on problems that have a solution by construction, a quarter each
// on boxes, cylinders, plates and meshes; its distances and kinematics beside FCL's and Simbody's.
#include <benchmark/benchmark.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/hand/certificate.h"
#include "app/hand/hand_simbody.h"
#include "app/hand/ik_terms.h"
#include "app/hand/solvable_problem.h"
#include "tests/hand/hand_test_data.h"
#include "tests/hand/simbody_assembler.h"

namespace pregrasp {
namespace {

constexpr int kProblemsPerObject = 25;

double ThreadCpuMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Instance {
  SolvableProblem solvable;
  std::unique_ptr<IkSolver> solver;
};

const std::vector<Instance>& Instances(int fingers, bool clutter) {
  static std::map<std::pair<int, bool>, std::vector<Instance>> made;
  std::vector<Instance>& instances = made[{fingers, clutter}];
  if (!instances.empty()) return instances;
  for (int object = 0; object < kNumIkObjects; ++object) {
    for (int i = 0; i < kProblemsPerObject; ++i) {
      Rng rng(21, RngStream::kTest, 100 * fingers + 10 * object + (clutter ? 1 : 0), i);
      instances.push_back(
          {MakeSolvableProblem(static_cast<IkObject>(object), fingers, clutter, rng), nullptr});
    }
  }
  for (Instance& instance : instances) {
    instance.solver = std::make_unique<IkSolver>(ShadowHand(), instance.solvable.pointers());
  }
  return instances;
}

// Quantiles of single solves' thread CPU time, and what became of them.
class Tally {
 public:
  void Add(double milliseconds, bool solved) {
    times_.push_back(milliseconds);
    solved_ += solved;
  }
  void Report(benchmark::State& state) {
    std::sort(times_.begin(), times_.end());
    const auto count = static_cast<double>(times_.size());
    state.counters["solved"] = solved_ / count;
    state.counters["median_ms"] = times_[times_.size() / 2];
    state.counters["p95_ms"] = times_[times_.size() * 95 / 100];
    state.SetItemsProcessed(static_cast<std::int64_t>(times_.size()));
  }

 private:
  std::vector<double> times_;
  int solved_ = 0;
};

void Ik(benchmark::State& state, int fingers, bool clutter, const IkConfig& config) {
  const std::vector<Instance>& instances = Instances(fingers, clutter);
  Tally tally;
  int by_slsqp = 0;
  int exact = 0;
  int denied = 0;
  double starts = 0.0;
  std::uint32_t repeat = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const double start = ThreadCpuMilliseconds();
      const IkResult result = instances[i].solver->Solve(
          config, instances[i].solvable.problem,
          Rng(1, RngStream::kTest, repeat, static_cast<std::uint32_t>(i)));
      tally.Add(ThreadCpuMilliseconds() - start, result.solved());
      by_slsqp += result.solved() && result.method == IkMethod::kSlsqp;
      exact += result.solved() && result.tip_error <= config.tip_target;
      denied += result.denied;
      starts += result.starts;
    }
    ++repeat;
  }
  const double count = static_cast<double>(instances.size()) * repeat;
  state.counters["by_slsqp"] = by_slsqp / count;
  state.counters["exact"] = exact / count;
  state.counters["denied"] = denied / count;
  state.counters["starts"] = starts / count;
  tally.Report(state);
}

// Contacts of one problem on the world of the next: most have no solution. What a rejected label
// costs; `solved` is the share that has one after all.
void IkForeign(benchmark::State& state, int fingers, const IkConfig& config) {
  const std::vector<Instance>& instances = Instances(fingers, true);
  Tally tally;
  for (auto _ : state) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const std::size_t other = (i + 1) % instances.size();
      IkProblem problem = instances[i].solvable.problem;
      problem.contacts = instances[other].solvable.problem.contacts;
      const double start = ThreadCpuMilliseconds();
      const IkResult result = instances[i].solver->Solve(
          config, problem, Rng(1, RngStream::kTest, 0, static_cast<std::uint32_t>(i)));
      tally.Add(ThreadCpuMilliseconds() - start, result.solved());
    }
  }
  tally.Report(state);
}

// The peer: one aligned start as ours, no restart, no collision.
void IkAssembler(benchmark::State& state, int fingers) {
  const std::vector<Instance>& instances = Instances(fingers, false);
  IkConfig config;
  config.collision = false;
  SimbodyAssembler assembler(ShadowHand());
  const IkSolver judge(ShadowHand());
  Tally tally;
  for (auto _ : state) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const IkProblem& problem = instances[i].solvable.problem;
      Rng rng(1, RngStream::kTest, 0, static_cast<std::uint32_t>(i));
      const internal::IkTerms terms(ShadowHand(), nullptr, config, problem);
      internal::IkPoint scratch;
      const double start = ThreadCpuMilliseconds();
      const HandConfiguration from = internal::SampleStart(terms, rng, &scratch);
      const HandConfiguration found = assembler.Solve(problem.contacts, from, 1e-4);
      const double time = ThreadCpuMilliseconds() - start;
      IkConfig without_cones = config;  // a Markers goal knows none
      without_cones.max_cone_deg = 180.0;
      tally.Add(time, judge.Evaluate(without_cones, problem, found).solved());
    }
  }
  tally.Report(state);
}

struct Posed {
  HandConfiguration configuration;
  std::vector<RigidTransform> X_WB;
};

// Six boxes and random hands near them, often in collision.
struct BoxWorld {
  std::vector<Shape> shapes;
  std::vector<Posed> poses;

  BoxWorld() {
    Rng rng(3);
    for (int i = 0; i < 6; ++i) {
      shapes.push_back(
          Box{{rng.Uniform(0.04, 0.2), rng.Uniform(0.04, 0.2), rng.Uniform(0.02, 0.1)}});
    }
    for (int i = 0; i < 200; ++i) {
      Posed posed;
      posed.configuration = RandomConfiguration(ShadowHand(), rng);
      for (int b = 0; b < 6; ++b) {
        const Quaternion q = rng.Rotation();
        posed.X_WB.push_back(MakeTransform(
            q, posed.configuration.X_WH.translation() + rng.Uniform(0.05, 0.25) * rng.Direction()));
      }
      poses.push_back(posed);
    }
  }
  std::vector<const Shape*> pointers() const {
    std::vector<const Shape*> out;
    for (const Shape& shape : shapes) out.push_back(&shape);
    return out;
  }
};

void Distances(benchmark::State& state) {
  const BoxWorld world;
  const HandObstacles obstacles(world.pointers());
  std::vector<HandObstacles::Placed> placed;
  for (const Posed& posed : world.poses) placed.push_back(obstacles.Place(posed.X_WB));
  std::vector<HandDistance> near;
  HandPose pose;
  CapsuleEnds ends;
  for (auto _ : state) {
    for (std::size_t i = 0; i < world.poses.size(); ++i) {
      near.clear();
      CalcHandPose(ShadowHand(), world.poses[i].configuration.X_WH, world.poses[i].configuration.q,
                   &pose);
      CalcCapsuleEnds(ShadowHand(), pose, &ends);
      obstacles.FindNear(ShadowHand(), ends, placed[i], {}, 5e-3, &near);
      FindNearSelf(ShadowHand(), ends, 5e-3, &near);
      benchmark::DoNotOptimize(near.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.poses.size()));
}

void Certificate(benchmark::State& state) {
  const BoxWorld world;
  const HandCertificate certificate(ShadowHand(), world.pointers());
  for (auto _ : state) {
    for (const Posed& posed : world.poses) {
      benchmark::DoNotOptimize(certificate.FindCollisions(posed.configuration, posed.X_WB, {}));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.poses.size()));
}

// The peer of Distances: FCL's unsigned distance at the tolerance at which it is right, same pairs.
void DistancesByFcl(benchmark::State& state) {
  const BoxWorld world;
  const HandModel& hand = ShadowHand();
  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> capsules;
  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> boxes;
  for (const HandCapsule& c : hand.capsules) {
    capsules.push_back(std::make_shared<fcl::Capsuled>(c.radius, (c.p_LB - c.p_LA).norm()));
  }
  for (const Shape& shape : world.shapes) {
    boxes.push_back(std::make_shared<fcl::Boxd>(std::get<Box>(shape).size));
  }
  fcl::DistanceRequestd request(true);
  request.distance_tolerance = 1e-9;
  HandPose pose;
  for (auto _ : state) {
    for (const Posed& posed : world.poses) {
      CalcHandPose(hand, posed.configuration.X_WH, posed.configuration.q, &pose);
      std::vector<fcl::CollisionObjectd> parts;
      for (std::size_t i = 0; i < capsules.size(); ++i) {
        const HandCapsule& c = hand.capsules[i];
        const RigidTransform X_LC =
            MakeTransform(FrameFromNormal((c.p_LB - c.p_LA).normalized()), 0.5 * (c.p_LA + c.p_LB));
        parts.emplace_back(capsules[i], RigidTransform(pose.X_WL(c.link) * X_LC));
      }
      const auto measure = [&](const fcl::CollisionObjectd& a, const fcl::CollisionObjectd& b) {
        fcl::DistanceResultd result;
        benchmark::DoNotOptimize(fcl::distance(&a, &b, request, result));
      };
      for (const auto& [i, k] : hand.self_pairs) measure(parts[i], parts[k]);
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        const fcl::CollisionObjectd box(boxes[b], posed.X_WB[b]);
        for (const fcl::CollisionObjectd& part : parts) measure(part, box);
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.poses.size()));
}

void Kinematics(benchmark::State& state) {
  const BoxWorld world;
  HandPose pose;
  PointJacobian J;
  for (auto _ : state) {
    for (const Posed& posed : world.poses) {
      CalcHandPose(ShadowHand(), posed.configuration.X_WH, posed.configuration.q, &pose);
      for (const Fingertip& tip : ShadowHand().tips) {
        CalcPointJacobian(ShadowHand(), pose, tip.link, pose.CalcPoint(tip.link, tip.p_LT), &J);
        benchmark::DoNotOptimize(J.data());
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.poses.size()));
}

void KinematicsBySimbody(benchmark::State& state) {
  const BoxWorld world;
  HandSimbody simbody(ShadowHand());
  for (auto _ : state) {
    for (const Posed& posed : world.poses) {
      simbody.SetConfiguration(posed.configuration);
      for (const Fingertip& tip : ShadowHand().tips) {
        benchmark::DoNotOptimize(simbody.CalcPointJacobian(tip.link, tip.p_LT));
      }
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(world.poses.size()));
}

BENCHMARK(Kinematics)->Unit(benchmark::kMicrosecond);
BENCHMARK(KinematicsBySimbody)->Unit(benchmark::kMicrosecond);
BENCHMARK(Distances)->Unit(benchmark::kMicrosecond);
BENCHMARK(DistancesByFcl)->Unit(benchmark::kMicrosecond);
BENCHMARK(Certificate)->Unit(benchmark::kMicrosecond);

void Register(const std::string& name, auto function) {
  benchmark::RegisterBenchmark(name.c_str(), function)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(4);
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;
  for (const int fingers : {2, 3, 5}) {
    const std::string k = std::to_string(fingers);
    IkConfig config;
    for (const bool clutter : {false, true}) {
      Register("Ik/" + k + (clutter ? "/cluttered" : "/plain"),
               [=](benchmark::State& state) { Ik(state, fingers, clutter, config); });
    }
    Register("IkForeign/" + k, [=](benchmark::State& state) { IkForeign(state, fingers, config); });
    config.slsqp = false;
    Register("IkWithoutSlsqp/" + k + "/cluttered",
             [=](benchmark::State& state) { Ik(state, fingers, true, config); });
    config.collision = false;
    config.max_cone_deg = 180.0;
    Register("IkUnobstructed/" + k,
             [=](benchmark::State& state) { Ik(state, fingers, false, config); });
    Register("IkUnobstructedByAssembler/" + k,
             [=](benchmark::State& state) { IkAssembler(state, fingers); });
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
