#include "app/page/picture_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "render/canvas.h"
#include "render/caption_card.h"
#include "render/font.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr int kSmallestCell = 160;  // [pixels]

// How many columns give cells of 16:9 with words below that fill the grid best.
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

void Paste(Image& sheet, const Image& picture, int x, int y) {
  for (int row = 0; row < picture.height; ++row) {
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(row) * picture.width * 3;
    std::copy(from, from + static_cast<std::ptrdiff_t>(picture.width) * 3,
              sheet.rgb.begin() + (static_cast<std::ptrdiff_t>(y + row) * sheet.width + x) * 3);
  }
}

// A grid's measures, and its words in lines.
class Layout {
 public:
  explicit Layout(const PictureGrid& grid) : grid_(grid) {
    const int count = static_cast<int>(grid.cells.size());
    type_ = static_cast<float>(
        std::round(4.0 * std::clamp(grid.width / 120.0, 9.0, 26.0) * grid.font_scale) / 4.0);
    line_ = std::round(1.35 * type_);
    gap_ = std::round(0.6 * type_);
    const double words = std::round((grid.most_lines + 1.8) * line_);
    columns_ =
        grid.columns > 0 ? grid.columns : ChooseColumns(grid.width, grid.height, count, words);
    rows_ = (count + columns_ - 1) / columns_;
    if (!grid.heading.empty()) {
      heading_ = WrapText(fonts_, FontFace::kBold, type_, grid.heading, grid.width - 2.0 * gap_);
    }
    const double names = grid.row_names.empty() ? 0.0 : 1.9 * line_;
    const double above = HeadingHeight() + gap_;
    const double high = (grid.height - above) / rows_ - names - gap_ - words;
    cell_ = static_cast<int>(
        std::min((grid.width - gap_) / columns_ - gap_, std::max(high, 0.0) * 16.0 / 9.0));
    if (cell_ < kSmallestCell) {
      throw InputError("--size", "",
                       fmt::format("room for {} pictures of {} pixels", count, kSmallestCell),
                       fmt::format("{} pixels each", cell_));
    }
    for (const PictureGrid::Cell& cell : grid.cells) sentences_.push_back(Wrap(cell.sentence));
    double y = above;
    for (int row = 0; row < rows_; ++row) {
      std::size_t lines = 0;
      for (int i = row * columns_; i < std::min(count, (row + 1) * columns_); ++i) {
        lines = std::max(lines, sentences_[static_cast<std::size_t>(i)].size());
      }
      y += names;
      tops_.push_back(y);
      y += cell_ * 9 / 16 + std::round((static_cast<double>(lines) + 1.8) * line_) + gap_;
    }
    height_ = static_cast<int>(y);
  }

  Image Draw() {
    Image sheet;
    sheet.width = grid_.width;
    sheet.height = height_;
    sheet.rgb.assign(static_cast<std::size_t>(sheet.width) * sheet.height * 3, 0xF6);
    Canvas canvas(sheet, fonts_);
    double y = gap_;
    for (const std::string& text : heading_) {
      y += line_;
      canvas.DrawText(FontFace::kBold, type_, {gap_, y}, text, ink_);
    }
    for (std::size_t row = 0; row < grid_.row_names.size() && row < tops_.size(); ++row) {
      canvas.DrawText(
          FontFace::kBold, type_, {gap_, tops_[row] - 0.8 * line_},
          FitText(fonts_, FontFace::kBold, type_, grid_.row_names[row], grid_.width - 2.0 * gap_),
          ink_);
    }
    for (int i = 0; i < static_cast<int>(grid_.cells.size()); ++i) DrawCell(sheet, canvas, i);
    return sheet;
  }

 private:
  double HeadingHeight() const {
    return heading_.empty() ? 0.0 : (static_cast<double>(heading_.size()) + 0.6) * line_;
  }

  std::vector<std::string> Wrap(const std::string& sentence) {
    std::vector<std::string> lines = WrapText(fonts_, FontFace::kSans, type_, sentence, cell_);
    const auto most = static_cast<std::size_t>(grid_.most_lines);
    if (lines.size() > most) {
      lines.resize(most);
      lines.back() = FitText(fonts_, FontFace::kSans, type_, lines.back() + " \u2026 ", cell_);
    }
    return lines;
  }

  void DrawCell(Image& sheet, Canvas& canvas, int number) {
    const auto i = static_cast<std::size_t>(number);
    const PictureGrid::Cell& cell = grid_.cells[i];
    const int row = number / columns_, column = number % columns_, high = cell_ * 9 / 16;
    const double x = std::floor(gap_ + column * (cell_ + gap_));
    double y = std::floor(tops_[static_cast<std::size_t>(row)]);
    const Rect frame{x, y, static_cast<double>(cell_), static_cast<double>(high)};
    if (cell.marked) canvas.FillRect(frame.Grown(0.8 * gap_), BadColor());
    if (cell.draw) {
      Paste(sheet, cell.draw(cell_, high), static_cast<int>(x), static_cast<int>(y));
    } else {
      canvas.FillRect(frame, FromSrgb(0xE6E8EA));
    }
    y += high + 1.3 * line_;
    canvas.DrawText(FontFace::kBold, type_, {x, y},
                    FitText(fonts_, FontFace::kBold, type_, cell.title, cell_), ink_);
    for (const std::string& text : sentences_[i]) {
      y += line_;
      canvas.DrawText(FontFace::kSans, type_, {x, y}, text, soft_);
    }
  }

  const PictureGrid& grid_;
  FontSet fonts_;
  const Rgba ink_ = FromSrgb(0x22262C), soft_ = FromSrgb(0x5C6570);
  float type_ = 0.0F;
  double line_ = 0.0, gap_ = 0.0;
  int columns_ = 1, rows_ = 1, cell_ = 0, height_ = 0;
  std::vector<std::string> heading_;
  std::vector<std::vector<std::string>> sentences_;
  std::vector<double> tops_;  // of each row's pictures
};

}  // namespace

Image DrawGrid(const PictureGrid& grid) { return Layout(grid).Draw(); }

}  // namespace pregrasp
