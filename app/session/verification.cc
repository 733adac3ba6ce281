#include "app/session/verification.h"

#include <fmt/format.h>
#include <unistd.h>

#include <sstream>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/job/facts_json.h"
#include "app/job/planner_settings.h"
#include "app/recording/build_info.h"
#include "app/recording/checked_file.h"
#include "app/recording/loaded_run.h"
#include "app/recording/scene_file.h"
#include "app/session/saved_state.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A folder of our own, removed with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "pregrasp-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) ThrowErrno(pattern, "room for the recomputed run");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

nlohmann::json LoadManifest(const fs::path& run) {
  const fs::path file = run / "manifest.json";
  return ParseJson(ReadFile(file), file.string());
}

std::vector<std::string> ReadLinesOf(const fs::path& file) {
  std::vector<std::string> lines;
  std::istringstream in(ReadFile(file));
  for (std::string line; std::getline(in, line);) lines.push_back(std::move(line));
  return lines;
}

}  // namespace

Provenance FindProvenance(const fs::path& run, const fs::path& weights) {
  const nlohmann::json manifest = LoadManifest(run);
  const JsonReader reader(manifest, (run / "manifest.json").string());
  if (reader["planner_version"].Text() != ProgramVersion()) {
    reader["planner_version"].Fail(
        fmt::format("{}, which this program can recompute", ProgramVersion()));
  }
  const std::map<std::string, std::string> here = HashInputs(weights);
  for (const auto& input : reader["inputs"].json().items()) {
    const auto found = here.find(input.key());
    if (found == here.end()) reader["inputs"][input.key()].Fail("a file that is here");
    if (input.value() != found->second) {
      reader["inputs"][input.key()].Fail("SHA-256 " + found->second);
    }
  }
  Provenance provenance;
  provenance.same_build = reader["program_sha256"].Text() == Sha256OfProgram() &&
                          reader["libraries"].json() == nlohmann::json(BuildLibraries()) &&
                          reader["processor"].Text() == ProcessorFeatures();
  provenance.build = fmt::format("commit {}, {}, {}", reader["git_hash"].Text().substr(0, 12),
                                 reader["compiler"].Text(), reader["processor"].Text());
  return provenance;
}

void RecomputeRun(const fs::path& run, const fs::path& target, const VerifyConfig& config,
                  RunComparison& comparison) {
  const nlohmann::json manifest = LoadManifest(run);
  const std::vector<Command> journal = LoadJournal(run);
  const std::vector<std::string> lines = ReadLinesOf(run / "steps.jsonl");
  Session session(LoadScene(run / "scene.json"),
                  RunSessionConfig(run, config.threads, config.weights));
  session.Record(target, PictureMode::kNone);
  Timeline& timeline = session.timeline();
  for (std::size_t i = 0; i < journal.size(); ++i) {
    ThrowIfInterrupted();
    if (config.progress) config.progress(static_cast<int>(i), static_cast<int>(journal.size()));
    const Command& command = journal[i];
    const std::string where = fmt::format("journal.jsonl, line {}", i + 1);
    try {
      const Timeline::Node& node =
          i == 0 ? timeline.root()
                 : timeline.Do(timeline.Find(command.node), command.verb, command.options);
      if (node.number != static_cast<int>(i) + 1) {
        comparison.Add({where, {"", "what " + node.id() + " did", "a command of its own", {}}});
        return;
      }
      const std::string line = FormatJson(FactsToJson(node.facts, node.number));
      if (i < lines.size()) comparison.CompareSteps(lines[i], line, node.number);
    } catch (const InputError& error) {
      comparison.Add({where, {"", error.what(), "a command that can be applied", {}}});
      return;
    }
    if (comparison.done()) return;
  }
  const nlohmann::json summary =
      ParseJson(ReadFile(run / "summary.json"), (run / "summary.json").string());
  // Whether the user interrupted it, or the script failed, is not of the run's making.
  std::optional<std::string> status;
  for (const char* ended : {"interrupted", "failed"}) {
    if (summary.is_object() && summary.value("status", nlohmann::json()) == ended) status = ended;
  }
  const JsonReader step(manifest, (run / "manifest.json").string());
  try {
    session.FinishRecording(status, &timeline.Find(step["step"].Text()));
  } catch (const InputError& error) {
    comparison.Add({"manifest.json", {"step", error.what(), "a step of the run", {}}});
  }
}

Verification VerifyRun(const fs::path& run, const VerifyConfig& config) {
  Verification verification{FindProvenance(run, config.weights), 0, RunComparison(0.0)};
  if (!verification.provenance.same_build) {
    verification.comparison = RunComparison(kOtherBuildTolerance);
  }
  RunComparison& comparison = verification.comparison;
  const ScratchFolder scratch;
  const fs::path recomputed = scratch.path() / "run";
  RecomputeRun(run, recomputed, config, comparison);
  if (fs::exists(recomputed)) {
    verification.num_steps = static_cast<int>(LoadJournal(recomputed).size());
    // The steps were compared as they came; a second time costs little.
    comparison.CompareRuns(run, recomputed);
    if (!comparison.done()) {
      if (auto fault = FindFaultOfPictures(run)) comparison.Add(std::move(*fault));
    }
  }
  return verification;
}

}  // namespace pregrasp
