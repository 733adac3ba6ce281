#include "app/session/saved_state.h"

#include <fmt/format.h>

#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/job/planner_settings.h"
#include "app/recording/checked_file.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "app/session/verification.h"

namespace pregrasp {

SessionConfig RunSessionConfig(const std::filesystem::path& run, int threads,
                               const std::filesystem::path& weights) {
  const std::filesystem::path file = run / "manifest.json";
  const nlohmann::json manifest = ParseJson(ReadFile(file), file.string());
  const JsonReader reader(manifest, file.string());
  SessionConfig session;
  if (!reader["seed"].json().is_number_unsigned()) reader["seed"].Fail("a whole number from 0");
  session.seed = manifest["seed"].get<std::uint64_t>();
  session.threads = threads;
  session.pictures = PictureMode::kNone;
  ApplySettings(reader["settings_at_start"].json(), session.planner);
  session.weights = weights;
  return session;
}

ResumedSession ResumeSession(const std::filesystem::path& run, int threads,
                             const std::filesystem::path& weights) {
  RequireFinishedRun(run);
  const Provenance provenance = FindProvenance(run, weights);
  if (const auto mismatch = VerifyManifest(run)) {
    throw InputError(run.string(), "", "the files that were written", mismatch->Sentence());
  }
  LoadedRun loaded = LoadRun(run);
  SessionConfig config = RunSessionConfig(run, threads, weights);
  config.pictures.reset();
  const JsonReader manifest(loaded.manifest, (run / "manifest.json").string());
  config.command = manifest["command"].Text();
  loaded.scene.file = manifest["scene_file"].Text();
  ResumedSession resumed;
  resumed.session = std::make_shared<Session>(std::move(loaded.scene), config);
  try {
    resumed.session->Restore(std::move(loaded.steps),
                             provenance.same_build ? 0.0 : kOtherBuildTolerance);
    resumed.node = &resumed.session->timeline().Find(manifest["step"].Text());
  } catch (const InputError& error) {
    throw InputError((run / "steps.jsonl").string() + ": " + error.what());
  }
  return resumed;
}

}  // namespace pregrasp
