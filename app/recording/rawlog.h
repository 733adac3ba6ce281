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

/// Writes run.rawlog or pictures.rawlog, MRPT logs that rawlog-edit and RawLogViewer open. What
/// each entry holds is in app/recording/README.md. The same steps give the same bytes.
class RawlogWriter {
 public:
  /// @param header  what the log's global comment says, as JSON. @throws InputError as CheckedFile.
  RawlogWriter(const std::filesystem::path& file, const nlohmann::ordered_json& header);
  ~RawlogWriter();

  /// Appends a step: an empty CActionCollection and a CSensoryFrame.
  /// @param line     the step's line of steps.jsonl.
  /// @param picture  the name of its picture, in the log's folder of images; "" for none. MRPT
  /// reads the picture whenever it describes the step: it must be there.
  void Add(const StepFacts& step, const std::string& line, const std::string& picture = "");
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
                                      ///< folder of images; "" for none
};

/// @throws InputError if the file cannot be read, is damaged, is not what RawlogWriter writes, or
/// if a step's observations are not those of its comment, with the step and the observation.
Rawlog LoadRawlog(const std::filesystem::path& file);

}  // namespace pregrasp
