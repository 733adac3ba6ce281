#include "app/recording/run_directory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "app/core/check.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/job/facts_json.h"
#include "app/recording/build_info.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"
#include "app/recording/partial_directory.h"
#include "app/recording/rawlog.h"
#include "app/recording/rollout_table.h"
#include "app/recording/scene_file.h"
#include "app/recording/summary.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json RawlogHeader(const Scene& scene, const RunInfo& info) {
  return {{"schema", "pregrasp.rawlog/1"},
          {"planner_version", ProgramVersion()},
          {"git_hash", GitHash()},
          {"scene", scene.name},
          {"seed", info.seed}};
}

Json ManifestFields(const RunInfo& info, const std::string& step,
                    const nlohmann::json& configuration) {
  std::map<std::string, std::string> libraries = BuildLibraries();
  libraries.insert(info.libraries.begin(), info.libraries.end());
  Json fields = {{"planner_version", ProgramVersion()},
                 {"git_hash", GitHash()},
                 {"program_sha256", Sha256OfProgram()},
                 {"compiler", Compiler()},
                 {"processor", ProcessorFeatures()},
                 {"libraries", libraries},
                 {"inputs", info.inputs},
                 {"command", info.command},
                 {"scene_file", info.scene_file},
                 {"seed", info.seed},
                 {"step", step},
                 {"settings_at_start", info.settings_at_start},
                 {"configuration", configuration}};
  if (!info.error.empty()) fields["error"] = info.error;
  return fields;
}

bool IsStepId(const std::string& id) {
  return !id.empty() && std::all_of(id.begin(), id.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '_' || c == '-' || c == '~';
  });
}

// The bytes of a file, none if it does not exist.
std::string ReadIfThere(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? ReadFile(file) : "";
}

}  // namespace

struct RunDirectory::Impl {
  Impl(const fs::path& path, const Scene& s, RunInfo i)
      : scene(s),
        info(std::move(i)),
        directory(path),
        partial(path),
        steps(partial.path() / "steps.jsonl"),
        journal(partial.path() / "journal.jsonl"),
        rollout(partial.path() / "rollout.csv"),
        rawlog(partial.path() / "run.rawlog", RawlogHeader(scene, info)) {}

  Scene scene;
  RunInfo info;
  fs::path directory;
  PartialDirectory partial;
  CheckedFile steps, journal, rollout;
  RawlogWriter rawlog;
  struct Pictures {
    Pictures(const fs::path& lines_file, const fs::path& log_file, const Json& header)
        : lines(lines_file), rawlog(log_file, header) {}

    CheckedFile lines;
    RawlogWriter rawlog;
  };
  std::optional<Pictures> pictures;
  int num_steps = 0;
};

RunDirectory::RunDirectory(const fs::path& directory, const Scene& scene, RunInfo info) {
  ValidateScene(scene);
  impl_ = std::make_unique<Impl>(directory, scene, std::move(info));
  WriteScene(partial(), impl_->scene, impl_->info.dt);
  impl_->rollout.Write(RolloutHeader(impl_->scene));
}

RunDirectory::~RunDirectory() = default;

const fs::path& RunDirectory::partial() const { return impl_->partial.path(); }
const fs::path& RunDirectory::directory() const { return impl_->directory; }

std::string PictureName(int number, const std::string& id) {
  std::string name = id;
  std::replace(name.begin(), name.end(), '.', '-');
  return fmt::format("{:04}_{}.png", number, name);
}

fs::path RunDirectory::PictureFile(int number, const std::string& step_id) const {
  const fs::path frames = partial() / "frames";
  MakeFolder(frames);
  return frames / PictureName(number, step_id);
}

int RunDirectory::AddStep(const StepFacts& step) {
  PREGRASP_CHECK(IsStepId(step.id), step.id);
  const int number = ++impl_->num_steps;
  const std::string line = FormatJson(FactsToJson(step, number));
  impl_->steps.Write(line + '\n');
  impl_->rawlog.Add(step, line);
  Json command = {{"id", step.id}};
  command.update(CommandToJson(step.command));
  impl_->journal.Write(FormatJson(command) + '\n');
  return number;
}

void RunDirectory::AddPicture(const StepFacts& step, int number, const Json& shot) {
  if (!impl_->pictures) {
    impl_->pictures.emplace(partial() / "pictures.jsonl", partial() / "pictures.rawlog",
                            RawlogHeader(impl_->scene, impl_->info));
  }
  const std::string name = PictureName(number, step.id);
  Json line = {{"picture", "frames/" + name}, {"step", step.id}};
  line.update(shot);
  impl_->pictures->lines.Write(FormatJson(line) + '\n');
  impl_->pictures->rawlog.Add(step, FormatJson(FactsToJson(step, number)), name);
}

void RunDirectory::AddRolloutRow(const WorldState& state) {
  const auto& bodies = impl_->scene.bodies;
  PREGRASP_CHECK(static_cast<std::ptrdiff_t>(state.bodies.size()) ==
                     std::count_if(bodies.begin(), bodies.end(),
                                   [](const Body& body) { return body.movable(); }),
                 state.bodies.size());
  impl_->rollout.Write(RolloutRow(state));
}

void RunDirectory::SetError(std::string error) { impl_->info.error = std::move(error); }

void RunDirectory::Finish(RunSummary summary, const std::string& step,
                          const nlohmann::json& configuration) {
  impl_->steps.Close();
  impl_->journal.Close();
  impl_->rollout.Close();
  impl_->rawlog.Close();
  if (impl_->pictures) {
    impl_->pictures->lines.Close();
    impl_->pictures->rawlog.Close();
    // MRPT's tools look for a log's pictures in <name of the log>_Images.
    MakeLink(partial() / "pictures_Images", "frames");
  }
  summary.hash = Sha256(ReadFile(partial() / "rollout.csv") + ReadIfThere(partial() / "lift.csv") +
                        ReadIfThere(partial() / "motion.csv"));
  WriteSummary(partial() / "summary.json", summary);
  WriteManifest(partial(), ManifestFields(impl_->info, step, configuration));
  impl_->partial.Commit();
}

}  // namespace pregrasp
