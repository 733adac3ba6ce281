#include "app/recording/summary.h"

#include "app/core/json_text.h"
#include "app/job/fields_json.h"
#include "app/recording/checked_file.h"

namespace pregrasp {

void WriteSummary(const std::filesystem::path& file, const RunSummary& summary) {
  WriteFile(file, FormatJsonIndented(fields::Write(summary)));
}

RunSummary LoadSummary(const std::filesystem::path& file) {
  const nlohmann::json document = ParseJson(ReadFile(file), file.string());
  RunSummary summary;
  fields::Read(JsonReader(document, file.string()), summary);
  return summary;
}

}  // namespace pregrasp
