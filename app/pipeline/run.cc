#include "app/pipeline/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "app/core/error.h"
#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

// One path, as far as it came.
struct PathAttempt {
  int rank = 0;
  std::unique_ptr<Mppi> mppi;
  MppiState state;
  Certificate certificate;
  ReleaseResult release;
  GraspSet grasps;
  bool moves = false;  // a hand motion without a failed frame was found
  int frames_failed = 0;
};

class Runner {
 public:
  Runner(const Planner& planner, PlanRecord& record, const RunConfig& config,
         const std::function<void(const RunProgress&)>& progress)
      : planner_(planner), record_(record), config_(config), progress_(progress) {}

  RunResult Run() {
    BuildGraph();
    PathSearch search(*graph_, planner_.config().stages);
    RunResult result;
    std::optional<PathAttempt> best;
    ContactPath path;
    for (int i = 0; i < config_.paths && search.Next(&path); ++i) {
      PathAttempt attempt = Try(path, i);
      result.reasons.push_back(Explain(attempt));
      const bool success = attempt.moves && result.status != RunStatus::kOk;
      if (success) result.status = RunStatus::kOk;
      if (!attempt.grasps.feasible.empty() && result.status == RunStatus::kNoFeasibleGrasp) {
        result.status = RunStatus::kMotionFailed;
      }
      if (success) record_.SetNumPaths(i + 1);
      if (result.status == RunStatus::kOk && !config_.all) break;
    }
    if (result.status != RunStatus::kOk) {
      record_.SetNumPaths(static_cast<int>(result.reasons.size()));
    }
    return result;
  }

 private:
  void Report(const std::string& stage, int done, int total) const {
    if (progress_) progress_({stage, done, total});
    ThrowIfInterrupted();
  }

  void BuildGraph() {
    Report("contact graph", 0, 1);
    const PlannerConfig& config = planner_.config();
    record_.Time("geometry", [&] {
      graph_ = std::make_unique<ContactGraph>(planner_.BuildGraph(config.mesh, config.graph));
    });
    record_.AddMesh(*graph_);
    record_.Time("graph", [&] { planner_.ScoreGraph(*graph_); });
    record_.AddScores(*graph_);
    while (graph_->PruneStep()) record_.AddPruning(*graph_);
    Report("contact graph", 1, 1);
  }

  PathAttempt Try(const ContactPath& path, int index) {
    PathAttempt attempt;
    attempt.rank = path.rank;
    record_.AddPath(*graph_, path);
    Optimize(path, index, attempt);
    record_.Time("trajectory", [&] {
      attempt.certificate = planner_.Certify(*attempt.mppi, attempt.state);
      attempt.release = planner_.Release(*graph_, attempt.certificate);
    });
    record_.AddCertificate(*attempt.mppi, attempt.certificate, attempt.release);
    if (!attempt.certificate.certified) return attempt;
    CompleteGrasps(index, attempt);
    if (!succeeded_ && attempt.grasps.feasible.size() >= best_feasible_) {
      best_feasible_ = attempt.grasps.feasible.size();
      record_.ChoosePath(*attempt.mppi, attempt.certificate, attempt.release, attempt.grasps);
    }
    MoveHand(index, attempt);
    return attempt;
  }

  void Optimize(const ContactPath& path, int index, PathAttempt& attempt) {
    const MppiConfig& config = planner_.config().mppi;
    attempt.mppi = std::make_unique<Mppi>(planner_.MakeMppi(*graph_, path, config));
    attempt.state = attempt.mppi->Start();
    const std::string stage = fmt::format("path {} of {}, trajectory", index + 1, config_.paths);
    while (!attempt.state.ended()) {
      Report(stage, attempt.state.iteration, config.iterations);
      record_.Time("trajectory", [&] { attempt.mppi->Step(attempt.state, planner_.pool()); });
      record_.AddIteration(*attempt.mppi, attempt.state);
    }
  }

  void CompleteGrasps(int index, PathAttempt& attempt) {
    const int count = planner_.config().grasp_samples;
    Report(fmt::format("path {} of {}, grasps", index + 1, config_.paths), 0, count);
    record_.Time("grasp", [&] {
      attempt.grasps = planner_.CompleteGrasps(attempt.certificate, attempt.release, attempt.rank);
    });
    for (std::size_t sample = 0; sample < attempt.grasps.grasps.size(); ++sample) {
      record_.AddGrasp(attempt.certificate, attempt.rank, static_cast<int>(sample),
                       attempt.grasps.grasps[sample]);
    }
  }

  // Tries the first feasible grasps in turn; the first whose motion has no failed frame is it.
  void MoveHand(int index, PathAttempt& attempt) {
    const int count = std::min(config_.motions, static_cast<int>(attempt.grasps.feasible.size()));
    for (int i = 0; i < count && !attempt.moves; ++i) {
      Report(fmt::format("path {} of {}, hand motion", index + 1, config_.paths), i, count);
      const int sample = attempt.grasps.feasible[i];
      const CompletedGrasp& grasp = attempt.grasps.grasps[sample];
      const LiftResult& lift = *attempt.grasps.lifts[sample];
      const HandMotion motion = planner_.MakeMotion(attempt.certificate, grasp.result,
                                                    lift.direction_W, planner_.config().motion);
      MotionState state = motion.Start();
      record_.Time("motion", [&] {
        while (motion.SolveKeyframe(state)) ThrowIfInterrupted();
        motion.Finish(state);
      });
      const int failed = motion.Summarize(state).failed;
      attempt.moves = failed == 0;
      if (i == 0 || failed < attempt.frames_failed) attempt.frames_failed = failed;
      if (succeeded_ || (!attempt.moves && i > 0)) continue;
      record_.ChoosePath(*attempt.mppi, attempt.certificate, attempt.release, attempt.grasps);
      record_.ChooseGrasp(attempt.certificate, grasp, lift);
      record_.ChooseMotion(motion, state);
      if (!attempt.moves) continue;
      for (std::size_t key = 1; key <= motion.task().keyframes.size(); ++key) {
        record_.AddKeyframe(motion, state, static_cast<int>(key));
      }
      for (std::size_t frame = 0; frame < state.frames.size(); ++frame) {
        record_.AddFrame(motion, state, static_cast<int>(frame));
      }
    }
    succeeded_ = succeeded_ || attempt.moves;
  }

  // The verdict of most samples.
  static std::string CommonReason(const std::vector<CompletedGrasp>& grasps) {
    std::map<std::string, int> counts;
    for (const CompletedGrasp& grasp : grasps) ++counts[GraspStatusName(grasp.result.status)];
    const auto most =
        std::max_element(counts.begin(), counts.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return fmt::format("{} ({} of {})", most->first, most->second, grasps.size());
  }

  static std::string Explain(const PathAttempt& attempt) {
    const std::string head =
        fmt::format("path {}, cost {:.3f}: ", attempt.rank, attempt.state.best_cost);
    if (!attempt.certificate.certified) {
      std::string reasons;
      for (const CertifyReason reason : attempt.certificate.reasons) {
        reasons += (reasons.empty() ? "" : "; ") + std::string(CertifyReasonText(reason));
      }
      return head + "not certified: " + reasons;
    }
    if (attempt.grasps.grasps.empty()) {
      return head + "certified, but no fingertip can be anywhere on the object";
    }
    if (attempt.grasps.feasible.empty()) {
      return head + "certified, but no grasp is feasible, most often because of " +
             CommonReason(attempt.grasps.grasps);
    }
    const std::string share =
        fmt::format("{} of {} grasps are feasible", attempt.grasps.feasible.size(),
                    attempt.grasps.grasps.size());
    if (!attempt.moves) {
      return head + share +
             fmt::format(", but the hand motion fails in {} frames", attempt.frames_failed);
    }
    return head + share + ", and the hand gets there";
  }

  const Planner& planner_;
  PlanRecord& record_;
  const RunConfig& config_;
  const std::function<void(const RunProgress&)>& progress_;
  std::unique_ptr<ContactGraph> graph_;
  bool succeeded_ = false;
  std::size_t best_feasible_ = 0;
};

}  // namespace

void RunConfig::Validate() const {
  if (paths < 1 || paths > 1000) {
    throw InputError("", "paths", "a whole number from 1 to 1000", std::to_string(paths));
  }
  if (motions < 1 || motions > 1000) {
    throw InputError("", "motions", "a whole number from 1 to 1000", std::to_string(motions));
  }
}

const char* RunStatusName(RunStatus status) {
  switch (status) {
    case RunStatus::kOk:
      return "ok";
    case RunStatus::kNoFeasibleGrasp:
      return "no_feasible_grasp";
    case RunStatus::kMotionFailed:
      return "motion_failed";
    case RunStatus::kStartGraspable:
      return "start_graspable";
  }
  return "";
}

RunResult RunPlanner(const Planner& planner, PlanRecord& record, const StartCertificate& start,
                     const RunConfig& config,
                     const std::function<void(const RunProgress&)>& progress) {
  config.Validate();
  record.SetStart(start);
  RunResult result;
  if (start.verdict == StartVerdict::kGraspable) {
    result.status = RunStatus::kStartGraspable;
  } else {
    try {
      result = Runner(planner, record, config, progress).Run();
    } catch (const Interrupted&) {
      record.Publish();
      throw;
    }
  }
  record.SetStatus(RunStatusName(result.status));
  record.Publish();
  return result;
}

}  // namespace pregrasp
