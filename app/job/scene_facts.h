#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/dynamics/neighbours.h"
#include "app/hand/hand_model.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// A movable body.
struct BodyFacts {
  std::string name;
  Vector3 p_WB = Vector3::Zero();
  Quaternion q_WB = Quaternion::Identity();
  Vector3 w_WB = Vector3::Zero(), v_WB = Vector3::Zero();

  RigidTransform X_WB() const { return MakeTransform(q_WB, p_WB); }

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("name", self.name);
    visit("p_WB", self.p_WB);
    visit("q_WB", self.q_WB);
    visit("w_WB", self.w_WB);
    visit("v_WB", self.v_WB);
  }
};

/// A finger, as FingertipState.
struct FingerFacts {
  Finger finger = Finger::kThumb;
  bool on = false, touching = false, slipping = false;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();
  Vector3 p_WF = Vector3::Zero(), p_WTarget = Vector3::Zero();
  Vector3 f_W = Vector3::Zero();  ///< on the object [N]
  double slip = 0.0;              ///< slid over the surface since it was put on [m]

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("on", self.on);
    visit("touching", self.touching);
    visit("slipping", self.slipping);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
    visit("p_WF", self.p_WF);
    visit("p_WTarget", self.p_WTarget);
    visit("f_W", self.f_W);
    visit("slip", self.slip);
  }
};

/// A point where two bodies touch, as ContactPoint.
struct ContactFacts {
  int a = 0, b = 0;  ///< scene indices, a < b
  Vector3 p_W = Vector3::Zero(), nhat_W = Vector3::UnitZ();
  Vector3 f_W = Vector3::Zero();  ///< on b [N]
  double gap = 0.0;               ///< before the step [m]
  Vector3 v_slip_W = Vector3::Zero();

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("a", self.a);
    visit("b", self.b);
    visit("p_W", self.p_W);
    visit("nhat_W", self.nhat_W);
    visit("f_W", self.f_W);
    visit("gap", self.gap);
    visit("v_slip_W", self.v_slip_W);
  }
};

/// A hand at one moment.
struct HandFacts {
  Vector3 p_WH = Vector3::Zero();
  Quaternion q_WH = Quaternion::Identity();
  std::vector<double> joints;  ///< in the order of HandModel::joints

  HandConfiguration configuration() const;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("p_WH", self.p_WH);
    visit("q_WH", self.q_WH);
    visit("joints", self.joints);
  }
};
HandFacts MakeHandFacts(const HandModel& model, const HandConfiguration& hand);

/// A fingertip's place on the object.
struct PlaceFacts {
  Finger finger = Finger::kThumb;
  Vector3 p_OC = Vector3::Zero(), nhat_O = Vector3::UnitZ();

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("finger", self.finger);
    visit("p_OC", self.p_OC);
    visit("nhat_O", self.nhat_O);
  }
};

/// How far movable bodies other than the object are from where the scene has them.
struct NeighbourFacts {
  std::string worst;  ///< the one that moved most, by name; empty if there are none
  double moved_mm = 0.0, turned_deg = 0.0;  ///< the most of all
  bool disturbed = false;                   ///< one turned over 30 degrees or fell over 5 cm

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("worst", self.worst);
    visit("moved_mm", self.moved_mm);
    visit("turned_deg", self.turned_deg);
    visit("disturbed", self.disturbed);
  }
};
NeighbourFacts MakeNeighbourFacts(const NeighbourMotion& motion, const Scene& scene);

// What single verbs say.

struct OpenFacts {
  std::vector<std::string> departures;  ///< from the physical rules, a sentence each

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("departures", self.departures);
  }
};

struct SettleFacts {
  double seconds = 0.0, moved_mm = 0.0, rotated_deg = 0.0;
  bool at_rest = false;
  std::string body;            ///< that moved furthest
  int not_converged = 0;       ///< physics steps that the contact solver left unfinished
  double unresolved_mm = 0.0;  ///< the overlap that these leave, summed

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("seconds", self.seconds);
    visit("moved_mm", self.moved_mm);
    visit("rotated_deg", self.rotated_deg);
    visit("at_rest", self.at_rest);
    visit("body", self.body);
    visit("not_converged", self.not_converged);
    visit("unresolved_mm", self.unresolved_mm);
  }
};

/// As StartCertificate.
struct VerdictFacts {
  std::string verdict;
  double mu = 0.0;
  std::optional<double> mu_star;  ///< none: the proof holds at the largest friction tried
  bool thin = false;
  int reachable_points = 0, reachable_edge_points = 0;
  int proposed = 0;  ///< grasps of the generator, tested; the rest is of the search
  int drawn = 0, plausible = 0, on_edges = 0, tried = 0, held = 0, reached = 0, feasible = 0;
  std::vector<PlaceFacts> example;  ///< a grasp, if graspable
  std::string sentence;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("verdict", self.verdict);
    visit("mu", self.mu);
    visit("mu_star", self.mu_star);
    visit("thin", self.thin);
    visit("reachable_points", self.reachable_points);
    visit("reachable_edge_points", self.reachable_edge_points);
    visit("proposed", self.proposed);
    visit("drawn", self.drawn);
    visit("plausible", self.plausible);
    visit("on_edges", self.on_edges);
    visit("tried", self.tried);
    visit("held", self.held);
    visit("reached", self.reached);
    visit("feasible", self.feasible);
    visit("example", self.example);
    visit("sentence", self.sentence);
  }
};

/// An action on a simulation by hand.
struct SimulationFacts {
  int physics_steps = 0;  ///< of this action
  bool stopped = false;   ///< ended before its time
  double moved_mm = 0.0, rotated_deg = 0.0;
  struct Trace {
    double max_penetration = 0.0, kinetic_energy = 0.0, potential_energy = 0.0;

    template <typename Self, typename Visit>
    static void VisitFields(Self& self, Visit&& visit) {
      visit("max_penetration", self.max_penetration);
      visit("kinetic_energy", self.kinetic_energy);
      visit("potential_energy", self.potential_energy);
    }
  };
  std::optional<Trace> trace;  ///< of the last physics step, where asked for

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("physics_steps", self.physics_steps);
    visit("stopped", self.stopped);
    visit("moved_mm", self.moved_mm);
    visit("rotated_deg", self.rotated_deg);
    visit("trace", self.trace);
  }
};

}  // namespace pregrasp
