#include "app/page/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/page/run_steps.h"
#include "app/pictures/words.h"
#include "render/canvas.h"
#include "render/caption_card.h"
#include "render/font.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr int kSmallestCell = 160;  // [pixels]
constexpr int kSentenceLines = 4;

// How many columns give cells of 16:9 with words below that fill the sheet best.
int ChooseColumns(int width, int height, int cells, double words) {
  int best = 1;
  double best_width = 0.0;
  for (int columns = 1; columns <= cells; ++columns) {
    const int rows = (cells + columns - 1) / columns;
    const double wide = width, high = height;
    const double cell = std::min(wide / columns, (high / rows - words) * 16.0 / 9.0);
    if (cell > best_width) {
      best_width = cell;
      best = columns;
    }
  }
  return best;
}

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

void Paste(Image& sheet, const Image& picture, int x, int y) {
  for (int row = 0; row < picture.height; ++row) {
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(row) * picture.width * 3;
    std::copy(from, from + static_cast<std::ptrdiff_t>(picture.width) * 3,
              sheet.rgb.begin() + (static_cast<std::ptrdiff_t>(y + row) * sheet.width + x) * 3);
  }
}

}  // namespace

Image DrawContactSheet(const LoadedRun& run, const Shot& shot, const std::optional<Vector3>& view,
                       std::size_t most) {
  const std::vector<const StepFacts*> story = RunSteps(run).FindStory(most);
  const int width = shot.config.width, count = static_cast<int>(story.size());
  const auto type = static_cast<float>(
      std::round(4.0 * std::clamp(width / 120.0, 9.0, 26.0) * shot.config.font_scale) / 4.0);
  const double line = std::round(1.35 * type);
  const double words = std::round((kSentenceLines + 1.8) * line), gap = std::round(0.6 * type);
  const int columns = ChooseColumns(width, shot.config.height, count, words);
  const int rows = (count + columns - 1) / columns;
  const int cell = static_cast<int>((width - gap) / columns - gap);
  if (cell < kSmallestCell) {
    throw InputError("--size", "",
                     fmt::format("room for {} pictures of {} pixels", count, kSmallestCell),
                     fmt::format("{} pixels each", cell));
  }
  Shot one = shot;
  one.config.card = one.config.footer = false;
  one.config.width = cell;
  one.config.height = cell * 9 / 16;
  PictureDrawer drawer(run.scene, {run.summary.seed, run.scene.name, ""});
  one.config.camera = drawer.FrameSteps(story, run, one.config, view);

  Image sheet;
  sheet.width = width;
  sheet.height = static_cast<int>(rows * (one.config.height + words + gap) + gap);
  sheet.rgb.assign(static_cast<std::size_t>(sheet.width) * sheet.height * 3, 0xF6);
  FontSet fonts;
  const Rgba ink = FromSrgb(0x22262C), soft = FromSrgb(0x5C6570);
  for (int i = 0; i < count; ++i) {
    const StepFacts& step = *story[static_cast<std::size_t>(i)];
    const int row = i / columns, column = i % columns;
    const double x = gap + column * (cell + gap);
    double y = gap + row * (one.config.height + words + gap);
    Paste(sheet, drawer.Render(step, run, one), static_cast<int>(x), static_cast<int>(y));
    Canvas canvas(sheet, fonts);
    y += one.config.height + 1.3 * line;
    const std::string title = fmt::format("{}. {}   t = {:.2f} s", i + 1, step.id, step.t);
    canvas.DrawText(FontFace::kBold, type, {x, y},
                    FitText(fonts, FontFace::kBold, type, title, cell), ink);
    const std::string sentence = Sentence(DescribeStep(run.scene, step, run));
    std::vector<std::string> lines = WrapText(fonts, FontFace::kSans, type, sentence, cell);
    if (lines.size() > kSentenceLines) {
      lines.resize(kSentenceLines);
      lines.back() = FitText(fonts, FontFace::kSans, type, lines.back() + " \u2026 ", cell);
    }
    for (const std::string& text : lines) {
      y += line;
      canvas.DrawText(FontFace::kSans, type, {x, y}, text, soft);
    }
  }
  return sheet;
}

}  // namespace pregrasp
