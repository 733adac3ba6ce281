#include <sstream>

#include "app/core/error.h"
#include "app/recording/checked_file.h"
#include "app/core/json_text.h"
#include "app/recording/manifest.h"
#include "app/recording/run_directory.h"

namespace pregrasp {
namespace {

nlohmann::json LoadJson(const std::filesystem::path& file) {
  return ParseJson(ReadFile(file), file.string());
}

}  // namespace

LoadedRun LoadRun(const std::filesystem::path& directory) {
  if (!IsFinishedRun(directory)) {
    throw InputError(directory.string(), "", "a finished run",
                     "a folder without its manifest.json");
  }
  LoadedRun run;
  run.manifest = LoadJson(directory / "manifest.json");
  run.summary = LoadJson(directory / "summary.json");
  run.scene = LoadJson(directory / "scene.json");
  const std::filesystem::path file = directory / "steps.jsonl";
  std::istringstream lines(ReadFile(file));
  for (std::string line; std::getline(lines, line);) {
    const std::string where = file.string() + ':' + std::to_string(run.steps.size() + 1);
    run.steps.push_back(StepFromJson(ParseJson(line, where), where));
  }
  return run;
}

}  // namespace pregrasp
