#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/grasp/start_certificate.h"
#include "app/job/planner.h"
#include "app/pipeline/session.h"

namespace pregrasp {

/// Tells a session what the planner's stages did: each call is one step of its journal, with the
/// step's id, numbers, sentences and picture, and fills in what the run's summary says of it.
/// Decides nothing and computes nothing that a stage did not report.
class PlanRecord {
 public:
  /// Both outlive this.
  PlanRecord(Session& session, const Planner& planner);

  void SetStart(const StartCertificate& start);
  /// What the manifest says of the settings; the planner's until then.
  void SetConfig(const PlannerConfig& config);

  void AddMesh(const ContactGraph& graph);
  void AddScores(const ContactGraph& graph);
  /// After each of the graph's pruning steps: graph.prune.1 to .3, or more of fewer nodes.
  void AddPruning(const ContactGraph& graph);
  void AddPath(const ContactGraph& graph, const ContactPath& path);
  void AddIteration(const Mppi& mppi, const MppiState& state);
  void AddCertificate(const Mppi& mppi, const Certificate& certificate,
                      const ReleaseResult& release);
  /// @param sample  from 0.
  void AddGrasp(const Certificate& certificate, int path_rank, int sample,
                const CompletedGrasp& grasp);
  /// @param number  of the keyframe, from 1, in time.
  void AddKeyframe(const HandMotion& motion, const MotionState& state, int number);
  /// @param frame  from 0.
  void AddFrame(const HandMotion& motion, const MotionState& state, int frame);

  /// What the summary says of the chosen path: its trajectory, and its grasps in all.
  void ChoosePath(const Mppi& mppi, const Certificate& certificate, const ReleaseResult& release,
                  const GraspSet& grasps);
  void ChooseGrasp(const Certificate& certificate, const CompletedGrasp& grasp,
                   const LiftResult& lift);
  void ChooseMotion(const HandMotion& motion, const MotionState& state);
  /// @param n  paths optimised in full until the first success, or in all.
  void SetNumPaths(int n);
  void SetStatus(const std::string& status) { outcome_.summary["status"] = status; }

  /// Runs `work` and counts its time as the summary's seconds of `stage`.
  template <typename Work>
  auto Time(const char* stage, Work&& work) {
    const Stopwatch watch(seconds_[stage]);
    return work();
  }

  /// Hands all of it to the session, whose run directory it becomes. To be called again whenever
  /// something was added.
  void Publish();

 private:
  class Stopwatch {
   public:
    explicit Stopwatch(double& total) : total_(total) {}
    ~Stopwatch() {
      total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

   private:
    double& total_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  JournalStep MakeFrameStep(const std::string& id, const HandMotion& motion,
                            const MotionState& state, int frame);

  Session& session_;
  const Planner& planner_;
  RunOutcome outcome_;
  std::map<std::string, double> seconds_;
  int num_paths_ = 0, num_iterations_ = 0;
  long num_rollouts_ = 0;
  std::set<std::pair<int, bool>> grasps_shown_;  // (path, feasible) with a key picture
};

}  // namespace pregrasp
