#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/core/json_difference.h"

namespace pregrasp {

/// A place where two runs differ.
struct RunDifference {
  std::string place;  ///< the id of a step, or a file and its line: "lift.csv, line 7"
  JsonDifference value;

  /// "path.1.mppi.3: details.best_cost: LEFT 0.5, RIGHT 0.7".
  std::string Sentence(const std::string& left, const std::string& right) const;
};

/// The places where two runs differ, found one after the other: what verify and diff tell.
class RunComparison {
 public:
  /// @param tolerance  the distance (CalcDistance) up to which numbers count as the same. At 0
  /// every bit counts, and nothing is compared beyond the first difference.
  explicit RunComparison(double tolerance = 0.0) : tolerance_(tolerance) {}

  /// Lines of steps.jsonl, number `number` from 1.
  void CompareSteps(const std::string& left, const std::string& right, int number);

  /// All that two run directories say of the same steps: every file but the pictures and what
  /// belongs to them; of summary.json all but seconds and memory, and with a tolerance the hash; of
  /// manifest.json seed, step and settings.
  void CompareRuns(const std::filesystem::path& left, const std::filesystem::path& right);

  void Add(RunDifference difference);

  /// Nothing is to be compared any more.
  bool done() const { return tolerance_ == 0.0 && first_.has_value(); }

  /// The first difference beyond the tolerance.
  const std::optional<RunDifference>& first() const { return first_; }
  /// The first that is none of two numbers: another word, count or length.
  const std::optional<RunDifference>& decision() const { return decision_; }
  /// The largest of two numbers.
  const std::optional<RunDifference>& largest() const { return largest_; }

 private:
  void CompareJson(const std::string& place, const nlohmann::ordered_json& left,
                   const nlohmann::ordered_json& right);
  void CompareLines(const std::string& file, const std::string& left, const std::string& right);
  void CompareTables(const std::string& file, const std::string& left, const std::string& right);
  void CompareLogs(const std::string& file, const std::filesystem::path& left,
                   const std::filesystem::path& right);
  void CompareContents(const std::string& file, const std::filesystem::path& left,
                       const std::filesystem::path& right);
  void CompareFile(const std::string& file, const std::filesystem::path& left,
                   const std::filesystem::path& right);

  double tolerance_;
  std::optional<RunDifference> first_, decision_, largest_;
};

/// A run's finished pictures are those of its steps: each file under frames/ is one of
/// pictures.jsonl and of pictures.rawlog, each with a step of the run. @returns what is not so.
std::optional<RunDifference> FindFaultOfPictures(const std::filesystem::path& directory);

}  // namespace pregrasp
