#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/studies/ladder.h"
#include "app/studies/study.h"

namespace pregrasp {

/// The weights' own word on which families they never saw. @throws InputError if there is none.
std::vector<std::string> ReadHeldOutFamilies(const std::filesystem::path& weights);

/// What the score says of the labels that are kept with the sources, on the families held out: each
/// label's family, whether a finger has to press, its truths and the score's two outputs.
/// @param labels  a file of PackStates.
nlohmann::ordered_json JudgeScore(const std::filesystem::path& labels,
                                  const std::filesystem::path& weights);

/// What the generators make of conditions taken from feasible grasps of one new object in free
/// space: for thumb, index and both the samples, those feasible as projected and after refinement,
/// and those whose fingertips overlap; beside them the same of single draws, and of as many sets of
/// random points, projected and refined likewise.
nlohmann::ordered_json TryGenerator(const std::string& family, std::int64_t number,
                                    std::uint64_t seed, const std::filesystem::path& weights,
                                    ThreadPool& pool);

/// At each pose of a ladder the placements that the score likes best, of thumb, index and both, and
/// what searches say of them.
nlohmann::ordered_json ProbeLadder(const Ladder& ladder, std::uint64_t seed,
                                   const StudySetup& setup);

/// Seconds of one thread for 128 rollouts of three states each to be scored.
double TimeScore(const std::filesystem::path& weights);

}  // namespace pregrasp
