#include "app/session/session.h"

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/peak_memory.h"
#include "app/core/sha256.h"
#include "app/job/planner_settings.h"
#include "app/recording/partial_directory.h"

namespace pregrasp {
namespace {

RunSummary::Seconds SumSeconds(const Timeline& timeline) {
  RunSummary::Seconds seconds;
  const auto take = [&](const char* stage, std::optional<double>& into) {
    const auto found = timeline.seconds().find(stage);
    if (found != timeline.seconds().end()) into = found->second;
  };
  take("geometry", seconds.geometry);
  take("graph", seconds.graph);
  take("trajectory", seconds.trajectory);
  take("grasp", seconds.grasp);
  take("motion", seconds.motion);
  return seconds;
}

std::string SceneLabel(const Scene& scene) { return scene.file.empty() ? scene.name : scene.file; }

}  // namespace

std::map<std::string, std::string> HashInputs(const std::filesystem::path& weights) {
  std::map<std::string, std::string> hashes;
  for (const std::filesystem::path& file :
       {weights / "score.safetensors", weights / "generator.safetensors"}) {
    std::error_code none;
    if (std::filesystem::exists(file, none)) hashes[file.filename().string()] = Sha256OfFile(file);
  }
  return hashes;
}

Session::Session(Scene scene, const SessionConfig& config) : config_(config) {
  job_ = std::make_unique<Job>(
      JobSetup{std::move(scene), config.seed, config.planner, config.weights}, config.threads);
  timeline_ = std::make_unique<Timeline>(*job_);
  start_ = &timeline_->root();
  drawer_ = std::make_unique<PictureDrawer>(
      job_->scene(), PictureLabels{config.seed, SceneLabel(job_->scene()), config.command});
  timeline_->SetListener([this](const Node& node) {
    if (recorder_) recorder_->Add(node);
  });
}

Session::~Session() = default;

const Session::Node& Session::Settle(double seconds) {
  if (timeline_->nodes().size() > 1) {
    throw InputError("", "", "to settle before anything else is done", "a later step");
  }
  start_ = &timeline_->Do(*start_, Verb::kSettle, {{"seconds", seconds}});
  return *start_;
}

void Session::Shoot(const Node& node, const Shot& shot) {
  shot.config.Validate();
  shots_[node.number] = shot;
  if (recorder_) recorder_->Shoot(node, shot);
}

void Session::ShootToFile(const Node& node, const Shot& shot, const std::filesystem::path& file) {
  shot.config.Validate();
  RequireOutsideRuns(file);
  if (config_.pictures == PictureMode::kNone) return;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  drawer_->Draw(node.facts, *timeline_, shot, file);
}

std::unique_ptr<Recorder> Session::OpenRecorder(const std::filesystem::path& directory,
                                                PictureMode pictures) {
  RunInfo info;
  info.seed = config_.seed;
  info.dt = world().config().dt;
  info.command = config_.command;
  info.scene_file = SceneLabel(scene());
  info.inputs = HashInputs(config_.weights);
  info.settings_at_start = PlannerSettings(config_.planner);
  auto recorder =
      std::make_unique<Recorder>(directory, *timeline_, pictures, *drawer_, std::move(info));
  for (const auto& node : timeline_->nodes()) {
    ThrowIfInterrupted();
    recorder->Add(*node);
    const auto shot = shots_.find(node->number);
    if (shot != shots_.end()) recorder->Shoot(*node, shot->second);
  }
  return recorder;
}

void Session::Record(const std::filesystem::path& directory, PictureMode pictures) {
  if (recorder_) {
    throw InputError("", "dir", "one recording at a time",
                     "a second one, while " + recorder_->directory().string() + " is open");
  }
  recorder_ = OpenRecorder(directory, config_.pictures.value_or(pictures));
}

// A summary of grasps says whether the object could be grasped at the start.
void Session::CompleteVerdict() {
  for (const auto& node : timeline_->nodes()) {
    if (node->command.verb != Verb::kGrasp) continue;
    timeline_->Do(timeline_->root(), Verb::kVerdict);
    return;
  }
}

void Session::Finish(Recorder& recorder, const std::optional<std::string>& status,
                     const Node* node) {
  recorder.DrawPending();
  const Node& end = node != nullptr ? *node : FindFurthest(*timeline_);
  RunSummary summary = Summarize(*timeline_, end);
  if (status) summary.status = *status;
  summary.seconds = SumSeconds(*timeline_);
  summary.seconds.total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - opened_).count();
  summary.peak_rss_mb = PeakMegabytes();
  recorder.Finish(end, std::move(summary));
}

std::filesystem::path Session::Save(const std::optional<std::filesystem::path>& directory,
                                    const Node* node) {
  if (recorder_ && (!directory || *directory == recorder_->directory())) {
    std::filesystem::path where = recorder_->directory();
    FinishRecording(std::nullopt, node);
    return where;
  }
  if (!directory) throw InputError("", "dir", "a folder, as nothing is recorded", "nothing");
  CompleteVerdict();
  const std::unique_ptr<Recorder> recorder =
      OpenRecorder(*directory, config_.pictures.value_or(PictureMode::kKey));
  Finish(*recorder, std::nullopt, node);
  return *directory;
}

void Session::SaveState(const std::filesystem::path& directory, const Node& node) {
  const std::unique_ptr<Recorder> recorder = OpenRecorder(directory, PictureMode::kNone);
  Finish(*recorder, std::nullopt, &node);
}

void Session::Restore(std::vector<StepFacts> steps, double tolerance) {
  for (StepFacts& step : steps) {
    const Node& node = timeline_->Restore(std::move(step), tolerance);
    if (node.command.verb == Verb::kSettle) start_ = &node;
  }
}

void Session::FinishRecording(const std::optional<std::string>& status, const Node* node,
                              const std::string& error) {
  if (!recorder_) return;
  if (!status) CompleteVerdict();
  // Whoever ends the program kills it soon; after Ctrl-C there is time, or a second one.
  if (status && TerminationRequested()) recorder_->DropPending();
  try {
    recorder_->DrawPending();
  } catch (const Interrupted&) {
    if (!status) throw;  // the recording goes on
    recorder_->DropPending();
  }
  const std::unique_ptr<Recorder> recorder = std::move(recorder_);
  recorder->SetError(error);
  Finish(*recorder, status, node);
}

}  // namespace pregrasp
