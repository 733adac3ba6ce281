#include "app/grasp/grasp_search.h"

#include <algorithm>
#include <optional>
#include <string>

#include "app/core/error.h"
#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

// Sets are drawn in batches and solved in groups of fixed size, so that what is done before the
// search stops does not depend on the number of threads.
constexpr int kBatch = 4096;
constexpr int kChunk = 64;
constexpr int kGroup = 16;

enum class Outcome { kNotDrawn, kNotHeld, kHeld };

struct DrawnSet {
  Outcome outcome = Outcome::kNotDrawn;
  std::vector<GraspContact> contacts;
};

struct SolvedSet {
  bool reached = false;
  std::optional<GraspResult> grasp;
};

void RequireCount(const char* field, int value) {
  if (value < 1) throw InputError("grasp_search", field, "at least 1", std::to_string(value));
}

class Searcher {
 public:
  Searcher(const GraspWorld& world, const GraspSearchConfig& config,
           const std::vector<GraspContact>& fixed, const std::vector<RigidTransform>& X_WB,
           std::uint64_t seed)
      : world_(world),
        config_(config),
        fixed_(fixed),
        X_WB_(X_WB),
        seed_(seed),
        sampler_(world, X_WB, config.sampler),
        wrench_(world.MakeWrenchConfig(config.grasp.f_min, X_WB.at(0).linear())),
        reach_(config.grasp.kinematics) {
    reach_.ik.collision = false;
    reach_.ik.slsqp = false;
    reach_.ik.max_starts = std::min(config.reach_starts, reach_.ik.max_starts);
  }

  std::vector<DrawnSet> Draw(int first, int count, ThreadPool& pool) const {
    std::vector<DrawnSet> sets(count);
    pool.ParallelFor((count + kChunk - 1) / kChunk, [&](int chunk, int) {
      for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
        sets[i] = DrawOne(first + i);
      }
    });
    return sets;
  }

  SolvedSet Solve(int index, const std::vector<GraspContact>& contacts) const {
    const Rng rng(seed_, RngStream::kSearchedGraspIk, index);
    const KinematicResult plain = CalcKinematicFeasibility(world_, reach_, contacts, X_WB_, rng);
    if (!plain.feasible()) return {};
    const HandConfiguration start = plain.ik.configuration();
    return {true, TestContacts(world_, config_.grasp, contacts, X_WB_, rng, &start)};
  }

 private:
  DrawnSet DrawOne(int index) const {
    Rng rng(seed_, RngStream::kSearchedContacts, index);
    std::optional<std::vector<GraspContact>> contacts = sampler_.Sample(fixed_, rng);
    if (!contacts) return {};
    const WrenchStatus status = CalcWrenchStatus(world_.ToWrenchContacts(*contacts), wrench_);
    return {status == WrenchStatus::kFeasible ? Outcome::kHeld : Outcome::kNotHeld,
            std::move(*contacts)};
  }

  const GraspWorld& world_;
  const GraspSearchConfig& config_;
  const std::vector<GraspContact>& fixed_;
  const std::vector<RigidTransform>& X_WB_;
  std::uint64_t seed_;
  ContactSampler sampler_;
  WrenchConfig wrench_;
  KinematicConfig reach_;
};

}  // namespace

void GraspSearchConfig::Validate() const {
  grasp.Validate();
  sampler.Validate();
  RequireCount("max_sets", max_sets);
  RequireCount("max_solves", max_solves);
  RequireCount("max_found", max_found);
  RequireCount("reach_starts", reach_starts);
}

GraspSearchResult SearchGrasps(const GraspWorld& world, const GraspSearchConfig& config,
                               const std::vector<GraspContact>& fixed,
                               const std::vector<RigidTransform>& X_WB, std::uint64_t seed,
                               ThreadPool& pool,
                               const std::function<void(const GraspSearchStats&)>& progress) {
  config.Validate();
  const Searcher searcher(world, config, fixed, X_WB, seed);
  GraspSearchResult result;
  GraspSearchStats& stats = result.stats;
  const auto done = [&] {
    return stats.feasible >= config.max_found || stats.solved >= config.max_solves;
  };
  while (stats.drawn < config.max_sets && !done()) {
    ThrowIfInterrupted();
    const int first = stats.drawn;
    const int batch = std::min(kBatch, config.max_sets - first);
    const std::vector<DrawnSet> sets = searcher.Draw(first, batch, pool);
    std::vector<int> held;
    for (int i = 0; i < batch; ++i) {
      stats.plausible += sets[i].outcome != Outcome::kNotDrawn;
      stats.tried += sets[i].outcome == Outcome::kNotHeld;
      if (sets[i].outcome == Outcome::kHeld) held.push_back(i);
    }
    stats.drawn += batch;
    stats.held += static_cast<int>(held.size());
    if (progress) progress(stats);

    for (std::size_t begin = 0; begin < held.size() && !done(); begin += kGroup) {
      ThrowIfInterrupted();
      const int group = static_cast<int>(std::min<std::size_t>(kGroup, held.size() - begin));
      std::vector<SolvedSet> solved(group);
      pool.ParallelFor(group, [&](int k, int) {
        const int i = held[begin + k];
        solved[k] = searcher.Solve(first + i, sets[i].contacts);
      });
      stats.solved += group;
      stats.tried += group;
      for (SolvedSet& set : solved) {
        stats.reached += set.reached;
        if (!set.grasp || !set.grasp->feasible()) continue;
        ++stats.feasible;
        result.found.push_back(std::move(*set.grasp));
      }
      if (progress) progress(stats);
    }
  }
  return result;
}

}  // namespace pregrasp
