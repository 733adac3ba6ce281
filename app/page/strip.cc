#include "app/page/strip.h"

#include <fmt/format.h>

#include "app/core/check.h"
#include "app/pictures/words.h"

namespace pregrasp {
namespace {

// The sentences; where there are only rows of a table, these.
std::string Sentence(const std::vector<std::string>& lines) {
  std::string prose, rows;
  for (const std::string& line : lines) {
    const auto tab = line.find('\t');
    if (tab == std::string::npos) {
      prose += (prose.empty() ? "" : " ") + line;
    } else {
      rows += (rows.empty() ? "" : "; ") + line.substr(0, tab) + ": " + line.substr(tab + 1);
    }
  }
  return prose.empty() ? rows : prose;
}

// One camera for all of them, by the first one's scene.
CameraConfig FrameStrip(const std::vector<StripStep>& steps, const PictureConfig& config,
                        const std::optional<Vector3>& view) {
  std::vector<StripStep> sources;
  std::vector<std::vector<const StepFacts*>> shown;  // of each
  for (const StripStep& each : steps) {
    if (each.step == nullptr) continue;
    std::size_t i = 0;
    while (i < sources.size() && sources[i].drawer != each.drawer) ++i;
    if (i == sources.size()) {
      sources.push_back(each);
      shown.emplace_back();
    }
    shown[i].push_back(each.step);
  }
  PREGRASP_CHECK(!sources.empty());
  MatrixX3 focus_W(0, 3);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const MatrixX3 more = sources[i].drawer->CalcFocus(shown[i], *sources[i].steps, config);
    focus_W.conservativeResize(focus_W.rows() + more.rows(), 3);
    focus_W.bottomRows(more.rows()) = more;
  }
  return sources.front().drawer->Frame(focus_W, config, view);
}

PictureGrid MakeGrid(const std::vector<StripStep>& steps, const Shot& shot,
                     const std::optional<Vector3>& view) {
  PictureGrid grid;
  grid.cells = MakeCells(steps, shot, view);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    grid.cells[i].title = fmt::format("{}. {}", i + 1, grid.cells[i].title);
  }
  grid.width = shot.config.width;
  grid.height = shot.config.height;
  grid.font_scale = shot.config.font_scale;
  return grid;
}

}  // namespace

PictureLabels LabelsOf(const LoadedRun& run) {
  return {run.summary.seed, run.manifest.value("scene_file", run.scene.name),
          run.manifest.value("command", "")};
}

std::vector<PictureGrid::Cell> MakeCells(const std::vector<StripStep>& steps, const Shot& shot,
                                         const std::optional<Vector3>& view) {
  Shot one = shot;
  one.config.card = one.config.footer = false;
  const bool framed = !one.config.camera;
  if (framed) {
    one.config.width = 1600;  // of any picture of 16:9
    one.config.height = 900;
    one.config.camera = FrameStrip(steps, one.config, view);
  }
  std::vector<PictureGrid::Cell> cells;
  for (const StripStep& each : steps) {
    PictureGrid::Cell& cell = cells.emplace_back();
    if (each.step == nullptr) continue;
    cell.title = fmt::format("{}   t = {:.2f} s", each.step->id, each.step->t);
    cell.sentence = Sentence(DescribeStep(each.drawer->scene(), *each.step, *each.steps));
    Shot own = one;
    if (framed) {
      own.config.camera =
          each.drawer->FrameOnWay(*one.config.camera, *each.step, *each.steps, one.config);
    }
    cell.draw = [each, own](int width, int height) {
      Shot shot_of_cell = own;
      shot_of_cell.config.width = width;
      shot_of_cell.config.height = height;
      return each.drawer->Render(*each.step, *each.steps, shot_of_cell);
    };
  }
  return cells;
}

Image DrawStrip(const std::vector<StripStep>& steps, const Shot& shot,
                const std::optional<Vector3>& view) {
  constexpr int kOneRow = 4, kLines = 8;
  PictureGrid grid = MakeGrid(steps, shot, view);
  const int count = static_cast<int>(steps.size());
  if (count <= kOneRow) grid.columns = count;
  grid.most_lines = kLines;
  return DrawGrid(grid);
}

Image DrawStripOfRun(const LoadedRun& run, const std::vector<std::string>& ids, const Shot& shot,
                     const std::optional<Vector3>& view) {
  PictureDrawer drawer(run.scene, LabelsOf(run));
  std::vector<StripStep> steps;
  steps.reserve(ids.size());
  for (const std::string& id : ids) steps.push_back({&run.Get(id), &run, &drawer});
  return DrawStrip(steps, shot, view);
}

Image DrawContactSheet(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
                       std::size_t most) {
  PictureDrawer drawer(run.scene, LabelsOf(run));
  return DrawContactSheet(RunSteps(run), run, drawer, shot, view, most);
}

Image DrawContactSheet(const RunSteps& steps, const FactsSource& source, PictureDrawer& drawer,
                       const Shot& shot, const std::optional<Vector3>& view, std::size_t most) {
  std::vector<StripStep> story;
  for (const StepFacts* step : steps.FindStory(most)) story.push_back({step, &source, &drawer});
  return DrawGrid(MakeGrid(story, shot, view));
}

}  // namespace pregrasp
