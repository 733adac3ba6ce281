#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "app/grasp/start_certificate.h"
#include "app/job/path_list.h"
#include "app/job/planner.h"
#include "app/job/simulation.h"

namespace pregrasp {

/// Where a job is after a step: what its commands have come to on the way from the start to here,
/// as shared values that never change. A member is null, or empty, until the command that makes it.
struct JobState {
  PlannerConfig config;  ///< as the commands up to here have set it
  WorldState start;      ///< of every plan and simulation
  std::shared_ptr<const StartCertificate> verdict;

  std::shared_ptr<const Planner> planner;  ///< for `start`
  std::shared_ptr<const ContactGraph> graph;
  std::shared_ptr<PathList> paths;  ///< of the graph, once it is connected

  std::shared_ptr<const ContactPath> path;
  std::shared_ptr<const Mppi> mppi;  ///< refers to `graph`
  std::shared_ptr<const MppiState> optimization;
  int screen_rounds = 0;  ///< of the path

  std::shared_ptr<const Certificate> certificate;
  std::shared_ptr<const ReleaseResult> release;
  std::shared_ptr<const GraspSet> grasps;  ///< all samples, of which `num_grasps` have been a step
  int num_grasps = 0;
  /// Of all feasible samples, those that have been a step in `lifts`.
  std::shared_ptr<const std::vector<std::optional<LiftResult>>> prepared_lifts;
  std::map<int, std::shared_ptr<const LiftResult>> lifts;  ///< by number of the grasp, from 1

  int chosen_grasp = 0;                      ///< that `motion` ends in, from 1
  std::shared_ptr<const HandMotion> motion;  ///< refers to `planner`
  std::shared_ptr<const MotionState> motion_state;

  std::shared_ptr<const Simulation> simulation;
  int num_actions = 0;  ///< on the simulation

  // What is made from something goes when that is made anew.
  void ForgetGraph();
  void ForgetPath();
  void ForgetTrajectory();
  void ForgetGrasps();
  void ForgetMotion();
};

/// How far a state has come towards a grasp that is lifted and a hand that gets there.
struct Progress {
  enum class Reached {
    kNothing,
    kTrajectory,  ///< a plan was put to certification
    kCertified,
    kFeasible,  ///< a grasp is
    kLifted,    ///< and its lift is held
    kMoved,     ///< and the hand moves there without a failed frame
    kOk,        ///< and no neighbour is disturbed
  };
  Reached reached = Reached::kNothing;
  int feasible = 0, lifted = 0;  ///< grasps

  bool operator<(const Progress& other) const {
    return std::tie(reached, lifted, feasible) <
           std::tie(other.reached, other.lifted, other.feasible);
  }
};
Progress CalcProgress(const JobState& state);

}  // namespace pregrasp
