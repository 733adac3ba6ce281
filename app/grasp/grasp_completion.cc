#include "app/grasp/grasp_completion.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/number_range.h"
#include "app/core/text.h"
#include "app/grasp/grasp_refinement.h"
#include "app/grasp/spaced_projection.h"

namespace pregrasp {
namespace {

constexpr int kProbeChunk = 2048;  // sets drawn at a time, whatever the number of threads
constexpr int kProbeTask = 64;

double LargestMove(const std::vector<GraspContact>& projected,
                   const std::vector<GraspContact>& contacts) {
  double largest = 0.0;
  for (const GraspContact& contact : contacts) {
    const GraspContact* from = FindContact(projected, contact.finger);
    if (from != nullptr) largest = std::max(largest, (contact.p_OC - from->p_OC).norm());
  }
  return largest;
}

// The samples of one state of the world, refined together.
class Completion {
 public:
  Completion(const ContactPlaces& places, const CompletionConfig& config,
             std::span<const GeneratedGrasp> generated, const std::vector<GraspContact>& fixed,
             std::vector<HandConfiguration> known, ThreadPool* pool)
      : places_(places),
        config_(config),
        refinement_{config.grasp, config.max_refinement, config.forces, config.max_stiffness_tests},
        generated_(generated),
        fixed_(fixed),
        pool_(pool),
        raw_(generated.size()),
        refinements_(generated.size()),
        solved_(std::move(known)) {
    IkConfig& ik = refinement_.grasp.kinematics.ik;
    ik.max_starts = config.refinement_starts;
    ik.warm_starts = std::max(1, config.refinement_starts - 1);
  }

  CompletionResult Run() {
    ForEach([&](int i) { TestRaw(i); });
    for (const GraspAttempt& raw : raw_) {
      if (raw.feasible()) solved_.push_back(raw.kinematics->ik.configuration());
    }
    CompletionResult result;
    const bool any_held = std::any_of(raw_.begin(), raw_.end(),
                                      [](const GraspAttempt& raw) { return HasForces(raw); });
    if (!any_held && config_.max_probes > 0) result.hopeless = !AnyProbeHolds(&result.probes);
    if (!result.hopeless) Refine();
    result.grasps.resize(generated_.size());
    ForEach([&](int i) { result.grasps[i] = Finish(i); });
    return result;
  }

 private:
  template <typename Task>
  void ForEach(const Task& task) const {
    Run(static_cast<int>(generated_.size()), task);
  }
  template <typename Task>
  void Run(int count, const Task& task) const {
    const auto run = [&](int i, int) {
      ThrowIfInterrupted();
      task(i);
    };
    if (pool_ != nullptr) {
      pool_->ParallelFor(count, run);
    } else {
      for (int i = 0; i < count; ++i) run(i, 0);
    }
  }

  void TestRaw(int i) {
    const GeneratedGrasp& generated = generated_[i];
    std::vector<GraspContact> chosen = Project(generated.points);
    GraspAttempt raw = Test(i, chosen);
    int tests = HasForces(raw) ? 1 : 0;
    for (const GraspPoints& points : generated.further) {
      if (raw.feasible() || tests >= config_.max_raw_tests) break;
      const std::vector<GraspContact> contacts = Project(points);
      if (CalcForceStatus(places_.world(), config_.grasp, contacts,
                          places_.X_WB().at(0).linear()) != GraspStatus::kFeasible) {
        continue;
      }
      GraspAttempt attempt = Test(i, contacts);
      if (tests++ > 0 && !attempt.feasible()) continue;
      chosen = contacts;
      raw = std::move(attempt);
    }
    refinements_[i] =
        std::make_unique<GraspRefinement>(places_, refinement_, chosen, fixed_, generated.rng);
    raw_[i] = std::move(raw);
    refinements_[i]->Start(raw_[i]);
  }

  std::vector<GraspContact> Project(const GraspPoints& points) const {
    return ProjectSpaced(places_, points, fixed_, config_.grasp.may_drop);
  }
  GraspAttempt Test(int i, const std::vector<GraspContact>& contacts) const {
    return TryGrasp(places_.world(), config_.grasp, contacts, places_.X_WB(), generated_[i].rng);
  }
  static bool HasForces(const GraspAttempt& attempt) { return attempt.kinematics.has_value(); }

  // Whether any of many plausible sets holds: where none does, no completion will.
  bool AnyProbeHolds(int* drawn) const {
    const ContactSampler sampler(places_, config_.probes);
    const Matrix3 R_WO = places_.X_WB().at(0).linear();
    while (*drawn < config_.max_probes) {
      const int count = std::min(kProbeChunk, config_.max_probes - *drawn);
      std::vector<char> holds((count + kProbeTask - 1) / kProbeTask, 0);
      Run(static_cast<int>(holds.size()), [&](int task) {
        for (int i = task * kProbeTask; i < std::min(count, (task + 1) * kProbeTask); ++i) {
          Rng rng = generated_.front().rng.Split(RngStream::kCompletionProbes, *drawn + i);
          const auto contacts = sampler.Sample(fixed_, rng);
          if (!contacts) continue;
          if (CalcForceStatus(places_.world(), config_.grasp, *contacts, R_WO) ==
              GraspStatus::kFeasible) {
            holds[task] = 1;
            return;
          }
        }
      });
      *drawn += count;
      if (std::find(holds.begin(), holds.end(), 1) != holds.end()) return true;
    }
    return false;
  }

  void Refine() {
    for (int round = 0; round < config_.max_solves; ++round) {
      if (round == config_.patience && solved_.empty()) return;
      std::vector<int> open;
      for (int i = 0; i < static_cast<int>(raw_.size()); ++i) {
        if (raw_[i].status != GraspStatus::kNoPlace && refinements_[i]->open()) open.push_back(i);
      }
      if (open.empty()) return;
      std::vector<char> found(open.size());
      Run(static_cast<int>(open.size()),
          [&](int k) { found[k] = refinements_[open[k]]->Step(solved_) ? 1 : 0; });
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (found[k] == 0) continue;
        solved_.push_back(refinements_[open[k]]->found()->kinematics->ik.configuration());
      }
    }
  }

  CompletedGrasp Finish(int i) const {
    CompletedGrasp grasp;
    grasp.number = i + 1;
    grasp.projected = refinements_[i]->projected();
    grasp.raw = ReportGrasp(places_.world(), config_.grasp, raw_[i], places_.X_WB());
    grasp.refinements = refinements_[i]->solves();
    grasp.result = grasp.raw;
    const auto& found = refinements_[i]->found();
    if (found) {
      grasp.result = ReportGrasp(places_.world(), config_.grasp, *found, places_.X_WB());
      grasp.moved = LargestMove(grasp.projected, found->contacts);
    }
    return grasp;
  }

  const ContactPlaces& places_;
  const CompletionConfig& config_;
  RefinementConfig refinement_;
  std::span<const GeneratedGrasp> generated_;
  const std::vector<GraspContact>& fixed_;
  ThreadPool* pool_;
  std::vector<GraspAttempt> raw_;
  std::vector<std::unique_ptr<GraspRefinement>> refinements_;
  std::vector<HandConfiguration> solved_;
};

}  // namespace

void CompletionConfig::Validate() const {
  grasp.Validate();
  probes.Validate();
  if (!(max_refinement >= 0.0 && max_refinement <= 0.1)) {
    throw InputError("", "max_refinement", "a length from 0 to 0.1 m",
                     FormatDouble(max_refinement));
  }
  RequireAtLeast("", "max_raw_tests", 1, max_raw_tests);
  RequireAtLeast("", "max_solves", 0, max_solves);
  RequireAtLeast("", "refinement_starts", 1, refinement_starts);
  RequireAtLeast("", "patience", 1, patience);
  RequireAtLeast("", "max_probes", 0, max_probes);
  RequireAtLeast("", "max_stiffness_tests", 0, max_stiffness_tests);
  forces.Validate();
}

const char* GraspSourceName(GraspSource source) {
  return source == GraspSource::kGenerator ? "generator" : "search";
}

CompletedGrasp MakeSearchedGrasp(const GraspResult& found, int number) {
  CompletedGrasp grasp;
  grasp.source = GraspSource::kSearch;
  grasp.number = number;
  grasp.projected = found.contacts;
  grasp.raw = found;
  grasp.result = found;
  return grasp;
}

CompletionResult CompleteGrasps(const ContactPlaces& places, const CompletionConfig& config,
                                std::span<const GeneratedGrasp> generated,
                                const std::vector<GraspContact>& fixed, ThreadPool& pool,
                                std::vector<HandConfiguration> known) {
  config.Validate();
  if (generated.empty()) return {};
  return Completion(places, config, generated, fixed, std::move(known), &pool).Run();
}

CompletedGrasp CompleteGrasp(const ContactPlaces& places, const CompletionConfig& config,
                             const GeneratedGrasp& generated,
                             const std::vector<GraspContact>& fixed) {
  config.Validate();
  return Completion(places, config, {&generated, 1}, fixed, {}, nullptr).Run().grasps.front();
}

}  // namespace pregrasp
