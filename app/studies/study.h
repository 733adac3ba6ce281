#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/core/number_range.h"
#include "app/job/planner.h"
#include "app/job/run_policy.h"
#include "app/studies/ladder.h"
#include "app/training/object_families.h"

namespace pregrasp {

/// What a study is of: everything that decides its items, and how they are made.
struct StudySetup {
  static constexpr NumberRange kSeeds{1, 10'000, 1};

  std::vector<Scene> scenes;    ///< loaded, in the order of the tables; of a study of scenes
  std::vector<Ladder> ladders;  ///< of a study of ladders
  int seeds = 3;                ///< of each scene or ladder, or in all, from first_seed on
  std::uint64_t first_seed = 1;
  PlannerConfig planner;
  RunConfig run;
  std::filesystem::path weights;
  /// Of a study of networks: more to judge them by; may be null.
  std::shared_ptr<const std::vector<TrainingObject>> objects;

  int threads = 0;             ///< of one item; cannot change a result
  std::filesystem::path runs;  ///< where the items' run directories are kept; empty for nowhere
};

/// One study under work. Items are independent of one another.
class Study {
 public:
  virtual ~Study() = default;
  virtual std::int64_t num_items() const = 0;

  /// Item `index`: what its record in the study's files is. A pure function of the setup, but for
  /// keys named "seconds". @throws Interrupted.
  virtual nlohmann::ordered_json MakeItem(std::int64_t index) const = 0;
};

/// Names and contents of files.
using StudyFiles = std::vector<std::pair<std::string, std::string>>;

/// What a study's items are made of.
enum class StudySubject {
  kScenes,
  kLadders,
  kMade,  ///< its own problems, one a seed
};

template <typename T>
std::unique_ptr<Study> MakeStudy(const StudySetup& setup) {
  return std::make_unique<T>(setup);
}

/// A study that `pregrasp eval` knows.
struct StudyInfo {
  std::string name;  ///< of --study
  std::string text;  ///< one line
  StudySubject subject = StudySubject::kScenes;
  bool takes_objects = false;
  std::unique_ptr<Study> (*make)(const StudySetup& setup) = nullptr;
  /// One line about an item that was made, for the terminal.
  std::string (*describe)(const nlohmann::json& item) = nullptr;
  /// The study's tables, of all its items in their order.
  StudyFiles (*tabulate)(const std::vector<nlohmann::json>& items) = nullptr;
};

/// @throws InputError("--study") for an unknown name, with all there are.
const StudyInfo& FindStudy(const std::string& name);
/// In the order of the help.
const std::vector<StudyInfo>& Studies();

}  // namespace pregrasp
