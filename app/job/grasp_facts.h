#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/scene_facts.h"

namespace pregrasp {

// As in step_facts.h: grasps and their lifts.

/// A contact of a grasp with the force on the object there.
struct GraspContactFacts {
  Finger finger = Finger::kThumb;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
  Vector3 f_O = Vector3::Zero();  ///< [N], in O; zero where no forces were found

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
    visit("f_O", self.f_O);
  }
};

struct GraspFacts {
  int path = 0;
  int entry = 0;       ///< among all grasps of the trajectory, from 1: what lifts and motions name
  int number = 0;      ///< among those of its source, from 1
  std::string source;  ///< "generator" or "search"
  bool feasible = false;
  std::string status, raw_status;
  std::string sentence;  ///< why
  double moved_mm = 0.0;
  int refinements = 0;
  std::vector<GraspContactFacts> contacts;
  std::vector<PlaceFacts> kept;  ///< contacts that press on
  std::optional<double> margin, min_normal_N;
  std::optional<HandFacts> hand;
  std::optional<double> tip_error_mm, clearance_mm;
  std::vector<std::string> colliding;  ///< the closest pair, by name

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("entry", self.entry);
    visit("number", self.number);
    visit("source", self.source);
    visit("feasible", self.feasible);
    visit("status", self.status);
    visit("raw_status", self.raw_status);
    visit("sentence", self.sentence);
    visit("moved_mm", self.moved_mm);
    visit("refinements", self.refinements);
    visit("contacts", self.contacts);
    visit("kept", self.kept);
    visit("margin", self.margin);
    visit("min_normal_N", self.min_normal_N);
    visit("hand", self.hand);
    visit("tip_error_mm", self.tip_error_mm);
    visit("clearance_mm", self.clearance_mm);
    visit("colliding", self.colliding);
  }
};

/// As LiftResult.
struct LiftFacts {
  int path = 0, grasp = 0;
  bool held = false;
  std::vector<std::string> reasons;  ///< why not, by name
  std::string sentence;
  double height_m = 0.0, shift_mm = 0.0, turn_deg = 0.0, slip_mm = 0.0;
  Vector3 direction_W = Vector3::UnitZ();
  int pushes = 0;  ///< of six, withstood
  bool soft = false, stiff = false;
  bool forearm_free = false;            ///< at the grasp and at the end
  int not_converged = 0;                ///< physics steps that the contact solver left unfinished
  double unresolved_mm = 0.0;           ///< the overlap that these may have left, summed
  std::vector<GraspContactFacts> grip;  ///< with the forces it holds by
  NeighbourFacts neighbours;            ///< at the end
  double neighbour_moved_mm = 0.0, neighbour_turned_deg = 0.0;  ///< the most, at any step
  HandFacts hand;                                               ///< at the grasp

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("path", self.path);
    visit("grasp", self.grasp);
    visit("held", self.held);
    visit("reasons", self.reasons);
    visit("sentence", self.sentence);
    visit("height_m", self.height_m);
    visit("shift_mm", self.shift_mm);
    visit("turn_deg", self.turn_deg);
    visit("slip_mm", self.slip_mm);
    visit("direction_W", self.direction_W);
    visit("pushes", self.pushes);
    visit("soft", self.soft);
    visit("stiff", self.stiff);
    visit("forearm_free", self.forearm_free);
    visit("not_converged", self.not_converged);
    visit("unresolved_mm", self.unresolved_mm);
    visit("grip", self.grip);
    visit("neighbours", self.neighbours);
    visit("neighbour_moved_mm", self.neighbour_moved_mm);
    visit("neighbour_turned_deg", self.neighbour_turned_deg);
    visit("hand", self.hand);
  }
};

}  // namespace pregrasp
