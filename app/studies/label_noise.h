#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/core/thread_pool.h"

namespace pregrasp {

/// How much is labelled more than once.
struct LabelNoiseConfig {
  int repeats = 8;
  int pushes = 32, states = 3;  ///< as TrialConfig's
};

/// Contacts in the states of one new object (MakeUnseenItems) labelled several times, each time by
/// searches and a room of their own, as a data set's are once: {"object", "family", "progress",
/// "lifted"}, of which the last two have a list of the repeats' values for each label.
/// @param by_room  whether progress is the label's room, else its relief.
nlohmann::ordered_json RepeatLabels(std::int64_t index, std::uint64_t seed, bool by_room,
                                    ThreadPool& pool, const LabelNoiseConfig& config = {});

/// What no function of state and contacts can go beyond on labels that differ so much from repeat
/// to repeat: `r2` by the labels' variance within and over all (one-way analysis of variance);
/// `rank` and `auc` of the mean of all other repeats, each repeat in turn being the truth, which
/// comes a little short of the true ceiling as that mean is noisy too. All also without labels.
/// @param objects  of RepeatLabels.
nlohmann::ordered_json CalcLabelCeiling(const std::vector<nlohmann::json>& objects);

}  // namespace pregrasp
