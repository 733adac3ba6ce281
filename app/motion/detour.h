#pragma once

#include <array>
#include <vector>

#include "app/core/rng.h"
#include "app/hand/ik.h"

namespace pregrasp {

/// A finger has the same contact at two moments if its places are this near on the object [m].
inline constexpr double kSameContact = 2e-3;

/// How hard a way without collision is looked for.
struct DetourConfig {
  double retreat = 0.03;  ///< fingertips leave and reach contacts along their normals, by this [m]
  int max_tries = 4000;   ///< of the tree search, each a random configuration to grow to: about
                          ///< 0.2 ms; 400 leave a third of the hard ways unfound, 2000 none seen
  int shortcuts = 60;     ///< tries to leave out what lies between two points of the way
  double max_edge = 1.5;  ///< of the trees, in units of 5 cm and half a radian
  double spread = 0.15;   ///< how far about its ends the palm is looked for [m]
  double spread_angle = 0.8;  ///< and turned [rad]; twice as far in every other try
};

/// A way between two configurations, among bodies that stand.
struct DetourProblem {
  HandConfiguration from, to;
  std::vector<RigidTransform> X_WB;
  /// Contacts at the ends. A finger that has the same contact at both keeps it all along.
  std::vector<IkContact> from_contacts, to_contacts;
  Vector3 up_W = Vector3::UnitZ();  ///< against gravity, unit length
};

enum class DetourKind {
  kStraight,
  kRetreat,  ///< straight between places off the contacts
  kSearch,   ///< found by the tree search
  kBlocked,  ///< none was found: what is returned goes through something
};
/// "straight", "retreat", "search", "blocked".
const char* DetourKindName(DetourKind kind);

struct DetourResult {
  DetourKind kind = DetourKind::kBlocked;
  std::vector<HandConfiguration> points;  ///< from, .., to: straight ways between them
  int tries = 0;                          ///< of the tree search
};

/// Finds a way free of collision (IkSolver::CheckWay): the straight one; else one that leaves the
/// contacts along their normals, or the hand along the forearm, and comes to the others likewise;
/// else two trees of random configurations grown towards each other (RRT-Connect: Kuffner and
/// LaValle, "RRT-Connect: an efficient approach to single-query path planning", ICRA 2000), with
/// what can be left out left out. Own code and not OMPL's, whose random numbers come from one seed
/// a process: here a way must be a function of the arguments, wherever and how often it is asked
/// for.
DetourResult FindDetour(const IkSolver& solver, const IkConfig& ik, const DetourConfig& config,
                        const DetourProblem& problem, Rng rng);

}  // namespace pregrasp
