#include "app/recording/loaded_run.h"

#include <functional>
#include <sstream>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/text.h"
#include "app/job/facts_json.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"
#include "app/recording/scene_file.h"
#include "app/recording/summary.h"

namespace pregrasp {
namespace {

// Calls read(value, where) with each line of a file.
void ReadLines(const std::filesystem::path& file,
               const std::function<void(const nlohmann::json&, const std::string&)>& read) {
  std::istringstream lines(ReadFile(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = file.string() + ':' + std::to_string(++number);
    read(ParseJson(line, where), where);
  }
}

}  // namespace

const StepFacts& LoadedRun::Get(const std::string& id) const {
  const auto found = number_of.find(id);
  if (found != number_of.end()) return steps[static_cast<std::size_t>(found->second) - 1];
  std::vector<std::string> ids;
  for (const auto& [known, number] : number_of) ids.push_back(known);
  const std::string nearest = FindNearest(id, ids);
  throw InputError(directory.string(), "step",
                   nearest.empty() ? "the id of a step of the run" : '"' + nearest + '"',
                   '"' + id + '"');
}

std::vector<Command> LoadJournal(const std::filesystem::path& directory) {
  std::vector<Command> journal;
  ReadLines(directory / "journal.jsonl", [&](const nlohmann::json& line, const std::string& where) {
    journal.push_back(CommandFromJson(line, where));
  });
  return journal;
}

LoadedRun LoadRun(const std::filesystem::path& directory) {
  RequireFinishedRun(directory);
  LoadedRun run;
  run.directory = directory;
  const std::filesystem::path manifest = directory / "manifest.json";
  run.manifest = ParseJson(ReadFile(manifest), manifest.string());
  run.summary = LoadSummary(directory / "summary.json");
  run.scene = LoadScene(directory / "scene.json");
  ReadLines(directory / "steps.jsonl", [&](const nlohmann::json& line, const std::string& where) {
    run.steps.push_back(FactsFromJson(line, where));
    run.number_of[run.steps.back().id] = static_cast<int>(run.steps.size());
  });
  for (std::size_t i = 0; i < run.steps.size(); ++i) {  // what is followed back comes to an end
    const auto parent = run.number_of.find(run.steps[i].command.node);
    if (parent == run.number_of.end() || parent->second <= static_cast<int>(i)) continue;
    throw InputError((directory / "steps.jsonl").string() + ':' + std::to_string(i + 1),
                     "command.node", "the id of an earlier step", '"' + parent->first + '"');
  }
  run.journal = LoadJournal(directory);
  return run;
}

}  // namespace pregrasp
