#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/job/branch_comparison.h"
#include "app/job/step_facts.h"
#include "app/motion/hand_motion.h"
#include "app/scene/scene.h"
#include "app/trajectory/certify.h"

namespace pregrasp {

/// Why something came out as it did: a sentence made from the decision's own numbers, and these.
struct Explanation {
  /// A number that counted.
  struct Item {
    std::string name;
    std::optional<double> value;
    std::optional<double> other;  ///< what it is compared with: text says what that is
    std::optional<double> limit;  ///< that it had to keep
    std::string unit = {};
    std::optional<bool> met = std::nullopt;  ///< whether it did
  };
  std::string verdict;  ///< a word
  std::string text;
  std::vector<Item> items;
};

/// Why a path has its rank, and which it beat.
Explanation ExplainPath(const PathFacts& path);
/// Why `path` is not before `other`.
Explanation ExplainOrder(const PathFacts& path, const PathFacts& other);

/// The cheapest rollout of an iteration, from 1.
int FindBestRollout(const IterationFacts& iteration);
/// What made a rollout, from 1, cost what it does: its terms beside the mean of all.
Explanation ExplainRollout(const IterationFacts& iteration, int rollout);
/// Why it is not `other`, the cheapest one where none is named.
Explanation ExplainRolloutAgainst(const IterationFacts& iteration, int rollout, int other);

/// A plan's verdict by the numbers of its certificate.
Explanation ExplainCertificate(const Scene& scene, const CertifyFacts& facts,
                               const CertifyConfig& config);

/// One grasp, and its lift where it was lifted (else null).
Explanation ExplainGrasp(const GraspFacts& grasp, const LiftFacts* lift);
/// A grasp with its lift, if it was lifted.
struct GraspWithLift {
  const GraspFacts* grasp = nullptr;
  const LiftFacts* lift = nullptr;
};
/// What all grasps of a trajectory came to: how many failed for which reason.
Explanation ExplainGrasps(const std::vector<GraspWithLift>& grasps);

/// What a frame of a hand motion gave up, beside what was demanded.
Explanation ExplainFrame(const FrameFacts& frame, const MotionConfig& config);

/// What a hand motion came to.
Explanation ExplainMotionEnd(const MotionFacts& facts);

// Why something is not another: `other` of each item is that one's number.

/// A plan's certificate beside another's. @param id, other_id  their steps.
Explanation ExplainCertificateAgainst(const Scene& scene, const std::string& id,
                                      const CertifyFacts& facts, const std::string& other_id,
                                      const CertifyFacts& other, const CertifyConfig& config);
/// Why a grasp comes before or after another in OrderGrasps, or is feasible where it is not.
Explanation ExplainGraspAgainst(const GraspWithLift& grasp, const GraspWithLift& other);
/// What a frame gave up beside what another did.
Explanation ExplainFrameAgainst(const FrameFacts& frame, const FrameFacts& other,
                                const MotionConfig& config);
Explanation ExplainMotionAgainst(const MotionFacts& motion, const MotionFacts& other);
/// How far the path came that `end` is of, by its numbers; no text for a step of no path.
Explanation ExplainPathOf(const Timeline& timeline, const Timeline::Node& end);
/// How far the path of a rank came in the timeline, beside that which `end` is of.
Explanation ExplainPathAgainstEnd(const Timeline& timeline, const Timeline::Node& end, int rank);

/// How two steps differ. @param left, right  the steps themselves, with the sources of their facts.
Explanation ExplainDifference(const BranchComparison& comparison, const Scene& left_scene,
                              const Scene& right_scene, const StepFacts& left,
                              const StepFacts& right, const FactsSource& left_steps,
                              const FactsSource& right_steps);

}  // namespace pregrasp
