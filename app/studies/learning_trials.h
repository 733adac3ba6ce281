#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/studies/free_object.h"
#include "app/studies/grasp_library.h"
#include "app/studies/ladder.h"
#include "app/studies/study.h"
#include "app/training/object_families.h"

namespace pregrasp {

/// Labels beside the score's answers.
struct JudgedLabels {
  std::vector<double> truth, score, lifted, probability;

  void Add(double progress, double s, double is_lifted, double p);
  /// Their number, R2, rank correlation, AUC and calibration.
  nlohmann::ordered_json ToJson() const;
};

/// How much is tried of one object.
struct TrialConfig {
  int grasps = 6;               ///< whose contacts are given to the generators
  int samples = 4;              ///< of each condition
  int pushes = 32, states = 3;  ///< that labels are made of: few, as meshes are slow to simulate
};

/// The weights' own word on which families they never saw. @throws InputError if there is none.
std::vector<std::string> ReadHeldOutFamilies(const std::filesystem::path& weights);

/// Whether the weights' progress is a state's room (GraspRoom), not its relief.
bool IsProgressRoom(const std::filesystem::path& weights);

/// What the score says of the labels that are kept with the sources, on the families held out:
/// JudgedLabels::ToJson of all, by family, held by a finger or not; and of both outputs, in ten
/// bins, the means of prediction and truth.
/// @param labels  a file of PackStates.
nlohmann::ordered_json JudgeScore(const std::filesystem::path& labels,
                                  const std::filesystem::path& weights);

/// What the generators make of conditions taken from feasible grasps of one new object in free
/// space: for thumb, index and both the samples, those feasible as projected and after refinement,
/// and those whose fingertips overlap; beside them the same of single draws, of the grasps of
/// `library` that are nearest, and of as many sets of random points, projected and refined
/// likewise.
/// @param index  of an item that no data set has: of `objects`, or of ObjectFamilies() if null.
nlohmann::ordered_json TryGenerator(const LearningObjects& objects, std::int64_t index,
                                    std::uint64_t seed, const std::filesystem::path& weights,
                                    const GraspLibrary& library, ThreadPool& pool,
                                    const TrialConfig& config = {});

/// The same of objects `begin` to `end` of `objects` and, beside it, labels that searches give them
/// in a scene of each (as MakeStateItem's) with the score's answers: lists "truth", "score",
/// "lifted", "probability".
nlohmann::ordered_json JudgeObjects(const LearningObjects& objects, std::int64_t begin,
                                    std::int64_t end, std::uint64_t seed,
                                    const std::filesystem::path& weights,
                                    const GraspLibrary& library, ThreadPool& pool,
                                    const TrialConfig& config = {});

/// At each pose of a ladder the placements that the score likes best, of thumb, index and both, and
/// what searches say of them.
nlohmann::ordered_json ProbeLadder(const Ladder& ladder, std::uint64_t seed,
                                   const StudySetup& setup);

/// Seconds of one thread for 128 rollouts of three states each to be scored.
double TimeScore(const std::filesystem::path& weights);

}  // namespace pregrasp
