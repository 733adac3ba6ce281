#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/job/step_facts.h"

namespace pregrasp {

/// The simulated time 0 as a time stamp of the log, in seconds since 1970: 2000-01-01 00:00:00 UTC.
/// (MRPT takes a time stamp of 0 for none.)
inline constexpr double kRawlogEpoch = 946684800.0;

/// Writes run.rawlog, an MRPT log that rawlog-edit and RawLogViewer open. What each entry holds is
/// in app/recording/README.md. The same steps give the same bytes.
class RawlogWriter {
 public:
  /// @param header  what the log's global comment says, as JSON. @throws InputError as CheckedFile.
  RawlogWriter(const std::filesystem::path& file, const nlohmann::ordered_json& header);
  ~RawlogWriter();

  /// Appends step `number` (from 1): an empty CActionCollection and a CSensoryFrame.
  /// @param line  the step's line of steps.jsonl.
  void Add(const StepFacts& step, int number, const std::string& line);
  void Close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A log read back through MRPT.
struct Rawlog {                  // NOLINT(bugprone-exception-escape): moving JSON does not throw
  nlohmann::json header;         ///< the global comment
  std::vector<StepFacts> steps;  ///< from each step's comment
  std::vector<std::string> pictures;  ///< of each step, as MRPT names the file, relative to the
                                      ///< folder of images
};

/// @throws InputError if the file cannot be read, is damaged, is not what RawlogWriter writes, or
/// if a step's typed observations and its comment contradict each other.
Rawlog LoadRawlog(const std::filesystem::path& file);

}  // namespace pregrasp
