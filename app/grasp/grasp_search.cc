#include "app/grasp/grasp_search.h"

#include <algorithm>
#include <optional>
#include <string>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/number_range.h"

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

bool HasEdge(const std::vector<GraspContact>& contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const GraspContact& contact) { return contact.on_edge; });
}

class Searcher {
 public:
  Searcher(const ContactPlaces& places, const GraspSearchConfig& config,
           const std::vector<GraspContact>& fixed, std::uint64_t seed)
      : world_(places.world()),
        config_(config),
        fixed_(fixed),
        X_WB_(places.X_WB()),
        seed_(seed),
        sampler_(places, config.sampler),
        wrench_(world_.MakeWrenchConfig(config.grasp.f_min, X_WB_.at(0).linear())) {}

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
    const GraspAttempt attempt = TryContacts(world_, config_.grasp, contacts, X_WB_, rng);
    SolvedSet set;
    set.reached = attempt.kinematics && attempt.kinematics->reached;
    if (attempt.feasible()) set.grasp = ReportGrasp(world_, config_.grasp, attempt, X_WB_);
    return set;
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
};

}  // namespace

void GraspSearchConfig::Validate() const {
  grasp.Validate();
  sampler.Validate();
  RequireAtLeast("grasp_search", "max_sets", 0, max_sets);
  RequireAtLeast("grasp_search", "max_plausible", 1, max_plausible);
  RequireAtLeast("grasp_search", "max_solves", 1, max_solves);
  RequireAtLeast("grasp_search", "max_found", 1, max_found);
}

GraspSearchConfig MakeSecondSourceConfig() {
  GraspSearchConfig config;
  config.max_sets = 20000;
  config.max_solves = 192;
  config.max_found = 8;
  return config;
}

GraspSearchResult SearchGrasps(const GraspWorld& world, const GraspSearchConfig& config,
                               const std::vector<GraspContact>& fixed,
                               const std::vector<RigidTransform>& X_WB, std::uint64_t seed,
                               ThreadPool& pool,
                               const std::function<void(const GraspSearchStats&)>& progress) {
  config.Validate();
  const ContactPlaces places(world, X_WB, config.sampler.slack);
  return SearchGrasps(places, config, fixed, seed, pool, progress);
}

GraspSearchResult SearchGrasps(const ContactPlaces& places, const GraspSearchConfig& config,
                               const std::vector<GraspContact>& fixed, std::uint64_t seed,
                               ThreadPool& pool,
                               const std::function<void(const GraspSearchStats&)>& progress) {
  config.Validate();
  const Searcher searcher(places, config, fixed, seed);
  GraspSearchResult result;
  GraspSearchStats& stats = result.stats;
  const auto done = [&] {
    return stats.feasible >= config.max_found || stats.solved >= config.max_solves;
  };
  // Where so many sets are wanted at the forces, these go on when no more may be solved.
  const bool all_forces = config.max_plausible < std::numeric_limits<int>::max();
  const auto enough = [&] {
    return stats.plausible >= config.max_plausible || stats.feasible >= config.max_found ||
           (!all_forces && done());
  };
  while (stats.drawn < config.max_sets && !enough()) {
    ThrowIfInterrupted();
    const int first = stats.drawn;
    const int batch = std::min(kBatch, config.max_sets - first);
    const std::vector<DrawnSet> sets = searcher.Draw(first, batch, pool);
    std::vector<int> held;
    for (int i = 0; i < batch; ++i) {
      stats.plausible += sets[i].outcome != Outcome::kNotDrawn;
      stats.on_edges += HasEdge(sets[i].contacts);
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
