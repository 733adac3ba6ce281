#include "app/pipeline/journal.h"

#include <fmt/format.h>

#include <chrono>

#include "app/recording/checked_file.h"

namespace pregrasp {
namespace {

// One OpenGL context for the whole process.
Renderer& SharedRenderer() {
  static Renderer renderer;
  return renderer;
}

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

RunInfo MakeRunInfo(const World& world, std::uint64_t seed) {
  RunInfo info;
  info.seed = seed;
  info.dt = world.config().dt;
  return info;
}

}  // namespace

PictureDrawer::PictureDrawer(std::shared_ptr<const World> world, std::uint64_t seed,
                             std::string remake)
    : world_(std::move(world)), seed_(seed), remake_(std::move(remake)) {}

PictureDrawer::~PictureDrawer() = default;

PictureText PictureDrawer::Caption(const JournalStep& step) const {
  const Scene& scene = world_->scene();
  PictureText text;
  const bool titled = step.shot && !step.shot->title.empty();
  text.title = fmt::format("{}   {}   t = {:.2f} s", scene.name,
                           titled ? step.shot->title : step.record.id, step.record.t);
  text.lines = step.lines;
  if (step.shot && !step.shot->caption.empty()) text.lines = {step.shot->caption};
  text.footer =
      fmt::format("{} · seed {} · {} · t = {:.3f} s", scene.file.empty() ? scene.name : scene.file,
                  seed_, step.record.id, step.record.t);
  if (!remake_.empty()) text.footer += " · again: " + remake_;
  return text;
}

void PictureDrawer::Draw(const JournalStep& step, const WorldState& start,
                         const std::filesystem::path& file) {
  if (!maker_) maker_ = std::make_unique<PictureMaker>(world_);
  PictureConfig config = step.shot ? step.shot->config : PictureConfig{};
  config.trace = step.traced && (config.trace || !step.shot);
  const RenderScene scene =
      maker_->Compose(step.state, step.contacts, start, step.overlay.get(), Caption(step), config);
  WritePng(SharedRenderer().Render(scene, {config.width, config.height, config.quality}), file);
}

JournalWriter::JournalWriter(const std::filesystem::path& directory, const World& world,
                             std::uint64_t seed, PictureMode pictures)
    : run_(directory, world.scene(), MakeRunInfo(world, seed)), pictures_(pictures) {}

void JournalWriter::Write(const JournalStep& step, const WorldState& start, PictureDrawer& drawer) {
  const bool wanted = pictures_ == PictureMode::kAll ||
                      (pictures_ == PictureMode::kKey && (step.shot || step.key || next_ == 0));
  if (wanted) {
    const auto begin = std::chrono::steady_clock::now();
    drawer.Draw(step, start, run_.NextPicture(step.record.id));
    picture_seconds_ += SecondsSince(begin);
  }
  run_.AddStep(step.record);
  ++next_;
}

void JournalWriter::WriteUpToLast(const std::vector<JournalStep>& journal, const WorldState& start,
                                  PictureDrawer& drawer) {
  while (next_ + 1 < journal.size()) Write(journal[next_], start, drawer);
}

void JournalWriter::Finish(const std::vector<JournalStep>& journal, const WorldState& start,
                           PictureDrawer& drawer, const RunOutcome& outcome) {
  while (next_ < journal.size()) Write(journal[next_], start, drawer);
  for (const WorldState& state : outcome.rollout) run_.AddRolloutRow(state);
  if (!outcome.trace_table.empty()) {
    WriteFile(run_.partial() / "trace.jsonl", outcome.trace_table);
  }
  if (!outcome.motion_table.empty()) {
    WriteFile(run_.partial() / "motion.csv", outcome.motion_table);
  }
  nlohmann::json complete = outcome.summary;
  complete["seconds"]["pictures"] = picture_seconds_;
  run_.Finish(complete, outcome.configuration);
}

}  // namespace pregrasp
