#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "app/grasp/balance_proof.h"
#include "app/grasp/grasp_search.h"

namespace pregrasp {

/// How it is known whether the object can be grasped where it stands.
enum class StartVerdict {
  kCertified,  ///< ungraspable: a proof that no fingertips at all can balance the weight
  kSearched,   ///< ungraspable as far as a search over contact sets can tell
  kGraspable,  ///< a feasible grasp was found
};
/// "certified", "searched", "graspable".
const char* StartVerdictName(StartVerdict verdict);

struct StartCertificateConfig {
  /// Of the search: kLeastWithinReach sets are put to the forces, and those that hold to inverse
  /// kinematics with IkConfig's 20 restarts, 5,000 at most. A set counts as reached unless all of
  /// them fail without collision too.
  GraspSearchConfig search;
  std::uint64_t seed = 1;

  StartCertificateConfig();
  void Validate() const;
};

/// The searched verdict means little below so many sets within reach that were put to the forces
/// (the project's definition).
inline constexpr int kLeastWithinReach = 100000;

/// The grasps that a generator proposes for a start, completed and tested.
struct ProposedGrasps {
  int nodes = 0;                        ///< contact states that it was asked to complete
  int samples = 0;                      ///< grasps that it proposed for them, all tested
  std::optional<GraspResult> feasible;  ///< the first that is a grasp
};

/// Who proposes grasps for a start: is asked only where there is no proof.
struct GraspProposer {
  /// All that the answer depends on, beyond the scene, the configuration's seed and the program.
  std::string key;
  std::function<ProposedGrasps()> propose;  ///< empty: nothing is proposed
};

/// A start whose mu* is no farther than this from the scene's friction is judged thinly.
inline constexpr double kThinMargin = 0.05;

struct StartCertificate {
  StartVerdict verdict = StartVerdict::kSearched;

  double mu = 0.0;  ///< the scene's fingertip friction, at which the proof was looked for
  /// mu*: the friction up to which the start is certified (FindProofLimit); infinity if it is at
  /// the largest that is tried.
  double mu_star = 0.0;
  bool thin() const { return std::abs(mu_star - mu) <= kThinMargin; }
  BalanceProof proof;             ///< valid if certified
  double proof_slack = 0.0;       ///< CalcProofSlack of it: checked again, by other means
  int surface_points = 0;         ///< points of the object's surface that were looked at
  int reachable_points = 0;       ///< of those, where a fingertip can be
  int edge_points = 0;            ///< points of edges and corners that were looked at
  int reachable_edge_points = 0;  ///< of those, where a fingertip can be at some normal of the fan
  double spacing = 0.0;  ///< no point of a flat face is farther than this from one of them [m]

  int proposed_nodes = 0;    ///< contact states that the generator completed; 0 if certified
  int proposed_samples = 0;  ///< grasps that it proposed for them
  GraspSearchStats search;   ///< zero if certified, or if a proposed grasp is feasible
  std::optional<GraspResult> example;  ///< a grasp, if graspable
};

/// Whether the object is ungraspable at the scene's start: the design's two ways.
/// First a proof, at all that a fingertip sphere can touch, with circular cones and no limit on
/// forces: points of the faces (the smallest sphere, let into surroundings and object as far as
/// kinematic feasibility would), of the edges and of the corners (the whole fan of normals that
/// leaves the sphere free of the surroundings). Without a proof, the proposed grasps, if any, and
/// then a search of contact sets, edges among them, are put to the full test.
StartCertificate CertifyStart(const GraspWorld& world, const StartCertificateConfig& config,
                              const GraspProposer& proposer, ThreadPool& pool,
                              const std::function<void(const GraspSearchStats&)>& progress = {});

/// The contacts that the proof is about: those on faces, then those on edges and corners.
std::vector<GraspContact> FindReachableContacts(const GraspWorld& world, const IkConfig& kinematics,
                                                const std::vector<EdgePoint>& edges,
                                                const std::vector<RigidTransform>& X_WB,
                                                ThreadPool& pool);

}  // namespace pregrasp
