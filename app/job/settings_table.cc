// The one table of a planner's settings: name, range with unit, meaning, field, and the rule of
// those that decide what counts as a success. High ends keep what a run needs in memory and time
// finite: the largest values together give a certified trajectory of 2 minutes (a row for each
// physics step), 20,000 frames, and 8 MB for an iteration of MPPI (PlannerConfig::Validate).
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace {

using Field = PlannerSetting::Field;
using Settings = std::vector<PlannerSetting>;

NumberRange Whole(double low, double high) { return {low, high, 1}; }
NumberRange Real(double low, double high, const char* unit = "") { return {low, high, 0, unit}; }

SettingRule AtLeast(double value, const char* definition) { return {value, {}, definition}; }
SettingRule AtMost(double value, const char* definition) { return {{}, value, definition}; }

// The value of a row that is neither bounded nor free: flags and choices.
constexpr NumberRange kNoNumber;

#define FIELD(member) [](PlannerConfig& config) -> Field { return &config.member; }

Settings GraphSettings() {
  return {
      {"cloud.points",
       Whole(64, 4096),
       "of the object's cloud; the same for all graphs of a session",
       FIELD(cloud_points),
       {}},
      {"mesh.triangles", {12, 200, 2}, "of the contact mesh", FIELD(mesh.triangles), {}},
      {"mesh.convex_share",
       Real(0.01, 1.0),
       "from which share of its hull's volume on a shape is meshed by its hull",
       FIELD(mesh.convex_share),
       {}},
      {"graph.samples",
       Whole(1, 100),
       "placements a node for each of thumb, index and both",
       FIELD(graph.samples),
       {}},
      {"graph.top_percent",
       Real(0.01, 100.0),
       "percent of the nodes that each score keeps",
       FIELD(graph.top_percent),
       {}},
      {"paths.stages", Whole(1, 8), "contact states in a path", FIELD(stages), {}},
      {"paths.order",
       kNoNumber,
       "explore: best first among paths that differ; paper: by the sum of scores alone",
       FIELD(order),
       {}},
  };
}

Settings ScreenSettings() {
  return {
      {"screen.paths",
       Whole(1, 1000),
       "given a few rollouts before any is optimised; 1 does not screen",
       FIELD(screen.paths),
       {}},
      {"screen.samples", Whole(4, 4096), "rollouts an iteration", FIELD(screen.samples), {}},
      {"screen.iterations", Whole(1, 1000), "of a path in a round", FIELD(screen.iterations), {}},
      {"screen.rounds",
       Whole(1, 20),
       "after each of which the better half of the paths goes on",
       FIELD(screen.rounds),
       {}},
      {"screen.enough",
       Whole(1, 1000),
       "paths that are clearly worth it, after which screening ends",
       FIELD(screen.enough),
       {}},
      {"screen.clear",
       Real(0.0, 100.0),
       "clearly: above the worth of doing nothing by this",
       FIELD(screen.clear),
       {}},
  };
}

Settings MppiSettings() {
  return {
      {"mppi.samples", Whole(4, 4096), "rollouts an iteration", FIELD(mppi.samples), {}},
      {"mppi.iterations", Whole(1, 1000), "iterations at most", FIELD(mppi.iterations), {}},
      {"mppi.sigma",
       Real(1e-6, 100.0),
       "standard deviation of the noise in the first iteration",
       FIELD(mppi.sigma),
       {}},
      {"mppi.final_sigma",
       Real(1e-6, 100.0),
       "of the noise in the last iteration",
       FIELD(mppi.final_sigma),
       {}},
      {"mppi.temperature",
       Real(1e-6, 1e6),
       "lambda over the standard deviation of the better half's costs",
       FIELD(mppi.temperature),
       {}},
      {"mppi.patience",
       Whole(1, 1000),
       "iterations without progress after which it ends, from the first rise on",
       FIELD(mppi.patience),
       {}},
      {"mppi.rise",
       Real(0.0, 100.0),
       "the first rise: the best reward is above that of doing nothing by this",
       FIELD(mppi.rise),
       {}},
      {"mppi.proposals",
       Real(0.0, 1.0),
       "share of the samples that are steady pushes until the first rise, then a quarter of that",
       FIELD(mppi.proposals),
       {}},
      {"mppi.progress",
       Real(0.0, 100.0),
       "what counts as progress: the best cost falls by this share of the score's spread",
       FIELD(mppi.progress),
       {}},
      {"mppi.max_travel",
       Real(0.0, 1.0, "m"),
       "of a target in a knot, each axis",
       FIELD(mppi.max_travel),
       {}},
      {"mppi.stage_seconds",
       Real(0.05, 10.0, "s"),
       "of one contact stage",
       FIELD(mppi.timing.stage_seconds),
       {}},
      {"mppi.transfer_seconds",
       Real(0.0, 30.0, "s"),
       "before a finger is put on a new contact, and as long as its way there takes",
       FIELD(mppi.timing.transfer_seconds),
       {}},
      {"mppi.transfer_speed",
       Real(0.01, 10.0, "m/s"),
       "of a fingertip on its way to a new contact",
       FIELD(mppi.timing.transfer_speed),
       {}},
      {"mppi.knots",
       Whole(1, 100),
       "force targets a stage; a fork keeps it",
       FIELD(mppi.timing.knots),
       {}},
      {"mppi.hold_seconds",
       Real(0.0, 30.0, "s"),
       "the last targets are held before the last score",
       FIELD(mppi.timing.hold_seconds),
       {}},
      {"mppi.room",
       Real(0.0, 1000.0),
       "weight: share of contact sets that hold and that the surroundings leave free at the end",
       FIELD(mppi.weights.room),
       {}},
      {"mppi.no_contact",
       Real(0.0, 1000.0),
       "weight: no finger ever touches",
       FIELD(mppi.weights.no_contact),
       {}},
      {"mppi.slip",
       Real(0.0, 1000.0),
       "tie-breaker, over the score's spread: share of the contact time at the cone's limit",
       FIELD(mppi.weights.slip),
       {}},
      {"mppi.effort",
       Real(0.0, 1000.0),
       "tie-breaker: mean force over the largest one allowed",
       FIELD(mppi.weights.effort),
       {}},
      {"mppi.unrest",
       Real(0.0, 1000.0),
       "tie-breaker: speed when the hold ends",
       FIELD(mppi.weights.unrest),
       {}},
      {"mppi.speed",
       Real(0.0, 1000.0),
       "tie-breaker: peak speed above 0.35 m/s",
       FIELD(mppi.weights.speed),
       {}},
      {"mppi.tip_overlap",
       Real(0.0, 1000.0),
       "weight: a fingertip in the surroundings, by the share of a fingertip's radius",
       FIELD(mppi.weights.tip_overlap),
       {}},
      {"mppi.tip_spacing",
       Real(0.0, 1000.0),
       "weight: the two tips overlap, by the share of a fingertip's radius",
       FIELD(mppi.weights.tip_spacing),
       {}},
      {"mppi.hold",
       Real(0.0, 1000.0),
       "weight: the object's way in the hold over what a certificate allows, from half of it on",
       FIELD(mppi.weights.hold),
       {}},
      {"mppi.haste",
       Real(0.0, 1000.0),
       "weight: a tip that touches is over 0.8 m/s or 8 m/s^2, by the excess, at most 1",
       FIELD(mppi.weights.haste),
       {}},
      {"mppi.fall",
       Real(0.0, 1000.0),
       "weight: the object fell out of the scene",
       FIELD(mppi.weights.fall),
       {}},
  };
}

Settings CertifySettings() {
  const char* holds = "a final pose that holds stays within 0.01 m and 5 deg for 1.5 s";
  return {
      {"certify.hold_seconds", Real(0.0, 30.0, "s"), "the last targets are kept this long",
       FIELD(certify.hold_seconds), AtLeast(1.5, holds)},
      {"certify.max_hold_shift", Real(0.0, 1.0, "m"), "the object may move this far in the hold",
       FIELD(certify.max_hold_shift), AtMost(0.01, holds)},
      {"certify.max_hold_turn_deg", Real(0.0, 180.0, "deg"),
       "the object may turn this far in the hold", FIELD(certify.max_hold_turn_deg),
       AtMost(5.0, holds)},
      {"certify.max_unresolved", Real(0.0, 1.0, "m"),
       "overlap that the contact solver may leave unfinished, over all steps",
       FIELD(certify.max_unresolved), AtMost(0.001, "a certified simulation has converged")},
  };
}

Settings GraspsSettings() {
  const char* reached = "a contact is reached within 0.0005 m, 60 deg and 0.001 m of overlap";
  return {
      {"grasps.samples", Whole(1, 500), "latent samples of the generator", FIELD(grasp_samples),
       AtMost(20, "r_suc and success are of 20 samples")},
      {"grasps.points",
       Whole(1, 10000),
       "places a finger that are scored, for what the generator is to complete",
       FIELD(placements.points),
       {}},
      {"grasps.pairs",
       Whole(0, 50000),
       "placements of both fingers that are scored",
       FIELD(placements.pairs),
       {}},
      {"grasps.spacing",
       Real(0.0, 1.0, "m"),
       "by which the placements of two samples differ somewhere",
       FIELD(placements.spacing),
       {}},
      {"grasps.f_min", Real(0.0, 100.0, "N"), "smallest normal force of every finger",
       FIELD(completion.grasp.f_min), AtLeast(0.5, "every finger of a feasible grasp presses")},
      {"grasps.may_drop",
       kNoNumber,
       "ring and little may be left out",
       FIELD(completion.grasp.may_drop),
       {}},
      {"grasps.max_refinement", Real(0.0, 0.1, "m"), "how far a contact may be moved",
       FIELD(completion.max_refinement), AtMost(0.010, "r_suc is after 10 mm of refinement")},
      {"grasps.max_solves",
       Whole(0, 1000),
       "moved sets of a sample that are put to inverse kinematics",
       FIELD(completion.max_solves),
       {}},
      {"grasps.patience",
       Whole(1, 1000),
       "rounds after which refinement ends where none is feasible yet",
       FIELD(completion.patience),
       {}},
      {"grasps.max_stiffness_tests",
       Whole(0, 10000),
       "sets of each sample tested for whether they are stiff enough to lift; 0: what is feasible "
       "will do",
       FIELD(completion.max_stiffness_tests),
       {}},
      {"grasps.max_probes",
       Whole(0, 1e6),
       "contact sets drawn where no sample holds: if none does, nothing is refined",
       FIELD(completion.max_probes),
       {}},
      {"grasps.search_sets",
       Whole(0, 1e6),
       "contact sets that the search draws beside the samples; 0 does not search",
       FIELD(search.max_sets),
       {}},
      {"grasps.search_solves",
       Whole(1, 10000),
       "of those, put to inverse kinematics",
       FIELD(search.max_solves),
       {}},
      {"grasps.search_found",
       Whole(1, 1000),
       "grasps after which it ends",
       FIELD(search.max_found),
       {}},
      {"grasps.starts",
       Whole(1, 1000),
       "restarts of inverse kinematics",
       FIELD(completion.grasp.kinematics.ik.max_starts),
       {}},
      {"grasps.tip_tolerance", Real(1e-4, 0.01, "m"), "a fingertip may miss its contact by this",
       FIELD(completion.grasp.kinematics.ik.tip_tolerance), AtMost(5e-4, reached)},
      {"grasps.max_cone_deg", Real(1.0, 180.0, "deg"),
       "between a distal axis and the inward normal",
       FIELD(completion.grasp.kinematics.ik.max_cone_deg), AtMost(60.0, reached)},
      {"grasps.contact_depth", Real(0.0, 0.01, "m"),
       "a contacting distal link may enter the object by this",
       FIELD(completion.grasp.kinematics.ik.contact_depth), AtMost(1e-3, reached)},
  };
}

Settings LiftSettings() {
  const char* held = "a lifted object follows for 0.1 m within 0.01 m and 15 deg, and stays";
  return {
      {"lift.height", Real(0.01, 1.0, "m"), "along the lift's direction", FIELD(lift.way.height),
       AtLeast(0.10, held)},
      {"lift.handover_seconds",
       Real(0.01, 10.0, "s"),
       "in which fingers that leave their contacts let go",
       FIELD(lift.handover_seconds),
       {}},
      {"lift.closing_seconds",
       Real(0.01, 10.0, "s"),
       "in which the grasp's forces rise",
       FIELD(lift.closing_seconds),
       {}},
      {"lift.lift_seconds",
       Real(0.05, 10.0, "s"),
       "for lift.height; a longer way takes longer",
       FIELD(lift.lift_seconds),
       {}},
      {"lift.hold_seconds",
       Real(0.3, 10.0, "s"),
       "it is held after that; only fingers touch it in the last 0.3 s",
       FIELD(lift.hold_seconds),
       {}},
      {"lift.friction_reserve",
       Real(0.01, 1.0),
       "share of the friction cone that forces are chosen in",
       FIELD(lift.forces.friction_reserve),
       {}},
  };
}

Settings MotionSettings() {
  const char* clean = "a frame is clean within 0.0005 m, 60 deg and 0.001 m of overlap";
  const char* whole = "the hand comes from 0.2 m off";
  const char* limits =
      "a hand within its limits keeps to 1 m/s, 3 rad/s, 5 m/s^2, 20 and 40 rad/s^2";
  return {
      {"motion.order",
       kNoNumber,
       "of keyframes: reverse solves the last first",
       FIELD(motion.order),
       {}},
      {"motion.fps", Real(1.0, 120.0, "Hz"), "frames a second", FIELD(motion_timing.fps),
       AtLeast(30.0, "30 frames a second are checked")},
      {"motion.approach_distance", Real(0.0, 1.0, "m"), "how far off the palm starts",
       FIELD(motion.approach_distance), AtLeast(0.20, whole)},
      {"motion.keyframe_starts",
       Whole(1, 1000),
       "restarts of inverse kinematics at a keyframe",
       FIELD(motion.keyframe_starts),
       {}},
      {"motion.frame_starts",
       Whole(1, 1000),
       "restarts of inverse kinematics in between",
       FIELD(motion.frame_starts),
       {}},
      {"motion.smoothing_iterations",
       Whole(1, 1000),
       "of smoothing the whole motion, at most",
       FIELD(motion.smoothing.iterations),
       {}},
      {"motion.pace",
       Real(0.1, 1.0),
       "share of the limits at which free parts are gone through",
       FIELD(motion.pace),
       {}},
      {"motion.wrist_speed", Real(0.01, 10.0, "m/s"), "limit", FIELD(motion.limits.wrist_speed),
       AtMost(1.0, limits)},
      {"motion.wrist_turn_speed", Real(0.01, 30.0, "rad/s"), "limit",
       FIELD(motion.limits.wrist_turn_speed), AtMost(3.0, limits)},
      {"motion.wrist_acceleration", Real(0.1, 100.0, "m/s^2"), "limit",
       FIELD(motion.limits.wrist_acceleration), AtMost(5.0, limits)},
      {"motion.wrist_turn_acceleration", Real(0.1, 1000.0, "rad/s^2"), "limit",
       FIELD(motion.limits.wrist_turn_acceleration), AtMost(20.0, limits)},
      {"motion.joint_acceleration", Real(0.1, 1000.0, "rad/s^2"),
       "limit; the joints' speeds are limited by the hand's own",
       FIELD(motion.limits.joint_acceleration), AtMost(40.0, limits)},
      {"motion.tip_tolerance", Real(1e-4, 0.01, "m"),
       "a fingertip may miss its contact by this before a frame counts as loosened",
       FIELD(motion.ik.tip_tolerance), AtMost(5e-4, clean)},
      {"motion.max_cone_deg", Real(1.0, 180.0, "deg"),
       "between a distal axis and the inward normal, likewise", FIELD(motion.ik.max_cone_deg),
       AtMost(60.0, clean)},
      {"motion.contact_depth", Real(0.0, 0.01, "m"),
       "a contacting distal link may enter the object by this, likewise",
       FIELD(motion.ik.contact_depth), AtMost(1e-3, clean)},
  };
}

#undef FIELD

}  // namespace

const std::vector<PlannerSetting>& SettingsTable() {
  static const Settings all = [] {
    Settings rows;
    for (const Settings& stage :
         {GraphSettings(), ScreenSettings(), MppiSettings(), CertifySettings(), GraspsSettings(),
          LiftSettings(), MotionSettings()}) {
      rows.insert(rows.end(), stage.begin(), stage.end());
    }
    return rows;
  }();
  return all;
}

}  // namespace pregrasp
