#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/studies/study.h"

namespace pregrasp {

/// What is known of one pose of a ladder.
struct PoseFacts {
  int pose = 1;
  double moved_mm = 0.0, turned_deg = 0.0;  ///< from the ladder's first pose
  double overlap_mm = 0.0;                  ///< of the object with other bodies: 0 but for mistakes
  bool holds = false;                       ///< a press of the finger keeps the object there
  double hold_shift_mm = 0.0, hold_turn_deg = 0.0;
  bool stays_when_released = false;
  double final_score = 0.0;  ///< the learned part of what a plan's end is worth (ScoreGraspable)
  double room = 0.0;         ///< the other part (GraspRoom)
  /// Of the placements that are tried for completion: the mean score, and the mean probability.
  double score = 0.0, probability = 0.0;
  int generated = 0, generated_feasible = 0, generated_raw = 0;
  int sets = 0, sets_hold = 0;  ///< of a search: plausible ones drawn, and those that hold
  int solved = 0, sets_reach = 0, found = 0;  ///< put to inverse kinematics, within reach, feasible
  std::optional<int> lift_tried, lifted;      ///< of all feasible grasps, if the pose holds

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("pose", self.pose);
    visit("moved_mm", self.moved_mm);
    visit("turned_deg", self.turned_deg);
    visit("overlap_mm", self.overlap_mm);
    visit("holds", self.holds);
    visit("hold_shift_mm", self.hold_shift_mm);
    visit("hold_turn_deg", self.hold_turn_deg);
    visit("stays_when_released", self.stays_when_released);
    visit("final_score", self.final_score);
    visit("room", self.room);
    visit("score", self.score);
    visit("probability", self.probability);
    visit("generated", self.generated);
    visit("generated_feasible", self.generated_feasible);
    visit("generated_raw", self.generated_raw);
    visit("sets", self.sets);
    visit("sets_hold", self.sets_hold);
    visit("solved", self.solved);
    visit("sets_reach", self.sets_reach);
    visit("found", self.found);
    visit("lift_tried", self.lift_tried);
    visit("lifted", self.lifted);
  }
};

/// MPPI on one node, scored by progress.
struct OracleFacts {
  int thumb = 0, index = 0;  ///< triangles: the pressing finger's, and the best beside it
  int iterations = 0, rollouts = 0;
  double progress = 0.0;  ///< of the best plan's end
  bool certified = false;
  std::vector<std::string> reasons;
  int feasible = 0, lifted = 0;  ///< grasps of the certified end

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("thumb", self.thumb);
    visit("index", self.index);
    visit("iterations", self.iterations);
    visit("rollouts", self.rollouts);
    visit("progress", self.progress);
    visit("certified", self.certified);
    visit("reasons", self.reasons);
    visit("feasible", self.feasible);
    visit("lifted", self.lifted);
  }
};

/// One ladder with one seed: an item of the study.
struct LadderFacts {
  std::string ladder, scene;
  std::uint64_t seed = 1;
  std::vector<PoseFacts> poses;
  std::vector<OracleFacts> oracle;
  double seconds = 0.0;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("ladder", self.ladder);
    visit("scene", self.scene);
    visit("seed", self.seed);
    visit("poses", self.poses);
    visit("oracle", self.oracle);
    visit("seconds", self.seconds);
  }
};

/// Judges a ladder with one seed, pose by pose, then follows the oracle on the node of each contact
/// that it presses with. Leaves `seconds` to the caller. @throws Interrupted.
LadderFacts ClimbLadder(const Ladder& ladder, std::uint64_t seed, const StudySetup& setup);

}  // namespace pregrasp
