#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/timeline.h"

namespace pregrasp {

/// What a job has come to: the fields of summary.json (design, section 2.4) in their order. A field
/// that no step has filled in is none. Whoever drove the job, the same commands give the same
/// summary.
struct RunSummary {
  std::string scene;
  std::uint64_t seed = 1;
  std::optional<std::string> status;
  std::optional<bool> within_rules;
  std::optional<int> n_paths, n_screened;
  std::optional<double> r_suc, r_suc_raw, r_lift;

  struct Grasps {
    std::optional<int> tried, feasible, lifting;
    std::optional<std::vector<Finger>> fingers, kept;
    std::optional<std::string> source;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("tried", self.tried);
      visit("feasible", self.feasible);
      visit("lifting", self.lifting);
      visit("fingers", self.fingers);
      visit("kept", self.kept);
      visit("source", self.source);
    }
  } grasps;

  struct StartGrasps {
    std::optional<int> tried, feasible;
    std::optional<bool> certified;
    std::optional<double> mu_star;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("tried", self.tried);
      visit("feasible", self.feasible);
      visit("certified", self.certified);
      visit("mu_star", self.mu_star);
    }
  } start_grasps;

  struct ObjectMotion {
    double translation_m = 0.0, rotation_deg = 0.0, max_speed = 0.0;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("translation_m", self.translation_m);
      visit("rotation_deg", self.rotation_deg);
      visit("max_speed", self.max_speed);
    }
  } object_motion;

  struct Stage {
    std::vector<Finger> fingers;
    std::vector<int> triangles;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("fingers", self.fingers);
      visit("triangles", self.triangles);
    }
  };
  std::optional<std::vector<Stage>> contacts;
  std::optional<int> switches;  ///< contacts made, lost or moved between stages

  struct Force {
    Finger finger = Finger::kThumb;
    Vector3 p_WC = Vector3::Zero(), nhat_W = Vector3::UnitZ(), f_W = Vector3::Zero();
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("finger", self.finger);
      visit("p_WC", self.p_WC);
      visit("nhat_W", self.nhat_W);
      visit("f_W", self.f_W);
    }
  };
  struct Wrench {
    std::optional<double> mu, margin, min_normal_N;
    std::optional<std::vector<Force>> forces;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("mu", self.mu);
      visit("margin", self.margin);
      visit("min_normal_N", self.min_normal_N);
      visit("forces", self.forces);
    }
  } wrench;

  struct Lift {
    std::optional<bool> held;
    std::optional<double> height_m, slip_mm, turn_deg;
    std::optional<int> pushes;
    std::optional<bool> soft, stiff;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("held", self.held);
      visit("height_m", self.height_m);
      visit("slip_mm", self.slip_mm);
      visit("turn_deg", self.turn_deg);
      visit("pushes", self.pushes);
      visit("soft", self.soft);
      visit("stiff", self.stiff);
    }
  } lift;

  struct Robust {
    std::optional<int> worlds, held;
    std::optional<double> worst_shift_mm, worst_turn_deg;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("worlds", self.worlds);
      visit("held", self.held);
      visit("worst_shift_mm", self.worst_shift_mm);
      visit("worst_turn_deg", self.worst_turn_deg);
    }
  } robust;

  struct Neighbours {
    std::optional<double> moved_mm, turned_deg;
    std::optional<std::string> worst;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("moved_mm", self.moved_mm);
      visit("turned_deg", self.turned_deg);
      visit("worst", self.worst);
    }
  } neighbours;

  struct Motion {
    std::optional<int> frames, failed, loosened;
    std::optional<double> max_tip_error_mm, min_clearance_mm, max_joint_speed, max_wrist_speed;
    std::optional<bool> forearm_free;
    std::optional<std::string> order;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("frames", self.frames);
      visit("failed", self.failed);
      visit("loosened", self.loosened);
      visit("max_tip_error_mm", self.max_tip_error_mm);
      visit("min_clearance_mm", self.min_clearance_mm);
      visit("max_joint_speed", self.max_joint_speed);
      visit("max_wrist_speed", self.max_wrist_speed);
      visit("forearm_free", self.forearm_free);
      visit("order", self.order);
    }
  } motion;

  struct Physics {
    double mu_tip = 0.0, max_force_N = 0.0;
    std::optional<double> max_penetration_mm;
    double dt = 0.0;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("mu_tip", self.mu_tip);
      visit("max_force_N", self.max_force_N);
      visit("max_penetration_mm", self.max_penetration_mm);
      visit("dt", self.dt);
    }
  } physics;

  struct Counts {
    std::optional<int> nodes, kept, paths, rollouts, iterations;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("nodes", self.nodes);
      visit("kept", self.kept);
      visit("paths", self.paths);
      visit("rollouts", self.rollouts);
      visit("iterations", self.iterations);
    }
  } counts;

  struct Seconds {
    std::optional<double> total, geometry, graph, trajectory, grasp, motion, pictures;
    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("total", self.total);
      visit("geometry", self.geometry);
      visit("graph", self.graph);
      visit("trajectory", self.trajectory);
      visit("grasp", self.grasp);
      visit("motion", self.motion);
      visit("pictures", self.pictures);
    }
  } seconds;

  std::optional<double> peak_rss_mb;
  std::optional<std::string> hash;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("scene", self.scene);
    visit("seed", self.seed);
    visit("status", self.status);
    visit("within_rules", self.within_rules);
    visit("n_paths", self.n_paths);
    visit("n_screened", self.n_screened);
    visit("r_suc", self.r_suc);
    visit("r_suc_raw", self.r_suc_raw);
    visit("r_lift", self.r_lift);
    visit("grasps", self.grasps);
    visit("start_grasps", self.start_grasps);
    visit("object_motion", self.object_motion);
    visit("contacts", self.contacts);
    visit("switches", self.switches);
    visit("wrench", self.wrench);
    visit("lift", self.lift);
    visit("robust", self.robust);
    visit("neighbours", self.neighbours);
    visit("motion", self.motion);
    visit("physics", self.physics);
    visit("counts", self.counts);
    visit("seconds", self.seconds);
    visit("peak_rss_mb", self.peak_rss_mb);
    visit("hash", self.hash);
  }
};

/// What the job has come to at `node`: its trajectory, grasps and motion are those on the way
/// there; paths, rollouts and iterations are counted over all that was done until then. Seconds,
/// memory and the hash are left to who writes the files.
RunSummary Summarize(const Timeline& timeline, const Timeline::Node& node);

/// The status that `node` has reached: the furthest stage whose outcome is decided there. None
/// where nothing was planned, or where a stage is under way: a grasp may be among those not tried
/// yet.
std::optional<std::string> StatusAt(const Timeline& timeline, const Timeline::Node& node);

/// The node that has come furthest towards "ok"; of equals the one with more feasible grasps, then
/// the latest.
const Timeline::Node& FindFurthest(const Timeline& timeline);

/// The trajectory that rollout.csv shows of a node: the certified one, else that of a simulation by
/// hand, else the start alone. Every physics step, the start first.
std::vector<WorldState> GetRollout(const JobState& state);

}  // namespace pregrasp
