#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/grasp/contact_sampler.h"
#include "app/grasp/feasible_grasp.h"
#include "app/grasp/grasp_stiffness.h"
#include "app/networks/grasp_generator.h"

namespace pregrasp {

struct CompletionConfig {
  GraspConfig grasp;
  /// Of a sample's draws, those with forces that are put to inverse kinematics at most.
  int max_raw_tests = 3;
  /// How far a contact may be moved from where its generated point was projected [m], in a straight
  /// line: the far side of a thin plate is near.
  double max_refinement = 0.010;
  /// Moved sets put to inverse kinematics, for each sample that is not feasible as it is.
  int max_solves = 24;
  int refinement_starts = 3;  ///< of inverse kinematics, on each of these
  /// Refinement of all samples ends after so many sets of each without any feasible grasp, raw or
  /// refined.
  int patience = 8;
  /// Contact sets drawn, about 5 us each, where no sample holds as it is; if none of them holds
  /// either, nothing is refined.
  int max_probes = 40000;  ///< 0 to refine whatever there is
  /// Sets of each sample tested for whether they are stiff enough to lift, as `forces` has it.
  int max_stiffness_tests = 40;  ///< 0: refinement ends with what is feasible
  GraspForcesConfig forces;
  SamplerConfig probes;

  CompletionConfig() { grasp.kinematics.ik.max_starts = 6; }
  void Validate() const;
};

enum class GraspSource { kGenerator, kSearch };
/// "generator", "search".
const char* GraspSourceName(GraspSource source);

/// One grasp to choose from, tested.
struct CompletedGrasp {
  GraspSource source = GraspSource::kGenerator;
  int number = 1;  ///< among those of its source, from 1
  /// The generated points projected to the object (ProjectSpaced); what `raw` is the test of.
  std::vector<GraspContact> projected;
  GraspResult raw;      ///< without refinement
  GraspResult result;   ///< the refined grasp if one is feasible and not less stiff, else `raw`
  double moved = 0.0;   ///< the farthest a contact was moved by refinement [m]
  int refinements = 0;  ///< moved sets put to inverse kinematics

  bool feasible() const { return result.feasible(); }
};

/// A grasp that the search found, as an entry beside generated ones.
CompletedGrasp MakeSearchedGrasp(const GraspResult& found, int number);

/// What the generator made, and the numbers that refine it: a stream of their own, keyed by the
/// sample.
struct GeneratedGrasp {
  GraspPoints points;
  Rng rng;
  /// Further draws of the same condition. Where the forces of one do not hold once it is projected,
  /// which is soon seen, the next takes its place: the exact test scores what the network draws.
  std::vector<GraspPoints> further = {};
};

struct CompletionResult {
  std::vector<CompletedGrasp> grasps;  ///< by sample
  int probes = 0;                      ///< contact sets drawn because no sample held
  bool hopeless = false;               ///< neither a sample nor any of these sets held
};

/// Projects generated grasps to the object and tests them: of a sample's draws the first that is
/// feasible, of at most `max_raw_tests` with forces; else the first with forces, else the first.
/// Where one is not feasible, or would give way when it lifts, refines it (GraspRefinement).
/// Samples are refined in rounds, one set of each, and begin with the hand poses that solved
/// others: the same result for any number of threads (design, section 4: r_suc with refinement,
/// r_suc_raw without). Contacts of `fixed` are kept as they are.
/// @param known  hand poses of other grasps in this state, from which inverse kinematics begins
/// too:
///               among neighbours a pose without collision is hard to find from nothing.
/// @throws Interrupted.
CompletionResult CompleteGrasps(const ContactPlaces& places, const CompletionConfig& config,
                                std::span<const GeneratedGrasp> generated,
                                const std::vector<GraspContact>& fixed, ThreadPool& pool,
                                std::vector<HandConfiguration> known = {});

/// One alone, on this thread.
CompletedGrasp CompleteGrasp(const ContactPlaces& places, const CompletionConfig& config,
                             const GeneratedGrasp& generated,
                             const std::vector<GraspContact>& fixed);

}  // namespace pregrasp
