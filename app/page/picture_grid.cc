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

constexpr int kSmallestCell = 160;     // [pixels]
constexpr float kSmallestType = 8.0F;  // [pixels], below which letters fill in

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

// Words in lines.
struct Words {
  float size = 0.0F;  // of the type [pixels]
  std::vector<std::string> lines;
};

// A grid's measures, and its words in lines. Type and sentences give way, in this order:
// sentences get fewer lines, then all type is smaller, until the pictures are large enough to be
// looked at.
class Layout {
 public:
  explicit Layout(const PictureGrid& grid)
      : grid_(grid), count_(static_cast<int>(grid.cells.size())) {
    beside_ = grid.columns == 1 && count_ > 1 && grid.row_names.size() == grid.cells.size();
    const double usual = std::clamp(grid.width / 120.0, 9.0, 26.0) * grid.font_scale;
    const int fewest = std::min(2, grid.most_lines);
    int best = 0;
    double best_type = usual;
    for (double type = usual; type == usual || type >= kSmallestType; type *= 0.9) {
      SetType(type, fewest);
      if (kInALine * type_ > WidestCell()) continue;  // whatever else
      LayOut(type, fewest);
      if (IsLegible()) {
        for (int lines = grid.most_lines; lines > fewest; --lines) {
          LayOut(type, lines);
          if (IsLegible()) return;
        }
        LayOut(type, fewest);
        return;
      }
      if (cell_ > best) {
        best = cell_;
        best_type = type;
      }
    }
    if (best < kSmallestCell) {
      throw InputError("--size", "",
                       fmt::format("room for {} pictures of {} pixels", count_, kSmallestCell),
                       fmt::format("{} pixels each", best));
    }
    LayOut(best_type, fewest);
  }

  Image Draw() {
    Image sheet;
    sheet.width = width_;
    sheet.height = height_;
    sheet.rgb.assign(static_cast<std::size_t>(sheet.width) * sheet.height * 3, 0xF6);
    Canvas canvas(sheet, fonts_);
    DrawWords(canvas, {type_, heading_}, FontFace::kBold, {gap_, gap_}, ink_);
    for (std::size_t i = 0; i < names_.size() && (beside_ || i < tops_.size()); ++i) {
      const double x = beside_ ? ColumnX(static_cast<int>(i)) : gap_;
      const double top = tops_[beside_ ? 0 : i] - name_height_;
      DrawWords(canvas, names_[i], FontFace::kBold, {x, top}, ink_);
    }
    for (int i = 0; i < count_; ++i) DrawCell(sheet, canvas, i);
    return sheet;
  }

 private:
  static constexpr double kInALine = 13.0;  // type of a line's width: a few words, 25 letters

  int WidestCell() const { return static_cast<int>((grid_.width - gap_) / columns_ - gap_); }

  // Whether one sees what a picture is about, and a line below it has a few words.
  bool IsLegible() const {
    constexpr int kWanted = 240;  // [pixels]
    return cell_ >= std::max(kSmallestCell, std::min(kWanted, WidestCell())) &&
           cell_ >= kInALine * type_;
  }

  double ColumnX(int column) const { return std::floor(gap_ + column * (cell_ + gap_)); }

  void SetType(double type, int most_lines) {
    type_ = static_cast<float>(std::round(4.0 * type) / 4.0);
    line_ = std::round(1.35 * type_);
    gap_ = std::round(0.6 * type_);
    const double words = std::round((most_lines + 1.8) * line_);
    columns_ =
        grid_.columns > 0 ? grid_.columns : ChooseColumns(grid_.width, grid_.height, count_, words);
    if (beside_) columns_ = count_;
    most_lines_ = most_lines;
  }

  void LayOut(double type, int most_lines) {
    SetType(type, most_lines);
    heading_.clear();
    if (!grid_.heading.empty()) {
      heading_ = WrapText(fonts_, FontFace::kBold, type_, grid_.heading, grid_.width - 2.0 * gap_);
    }
    // The widest cells with which the whole is no higher than it may be.
    int high = WidestCell(), low = 0;
    Place(high);
    if (height_ <= grid_.height) return Trim();
    constexpr int kCloseEnough = 2;  // [pixels]
    while (high - low > kCloseEnough) {
      const int middle = (low + high) / 2;
      Place(middle);
      (height_ <= grid_.height ? low : high) = middle;
    }
    Place(low);
    Trim();
  }

  // Where all is with cells of this width.
  void Place(int cell) {
    cell_ = cell;
    titles_.clear();
    sentences_.clear();
    names_.clear();
    for (const PictureGrid::Cell& each : grid_.cells) {
      titles_.push_back(WrapTitle(each.title));
      sentences_.push_back(WrapSentence(each.sentence));
    }
    const double name_width = beside_ ? cell_ : columns_ * (cell_ + gap_) - gap_;
    name_height_ = 0.0;
    for (const std::string& name : grid_.row_names) {
      constexpr std::size_t kMostLines = 2;
      names_.push_back({type_, WrapAtMost(FontFace::kBold, name, name_width, kMostLines)});
      name_height_ = std::max(name_height_, (names_.back().lines.size() + 0.9) * line_);
    }
    tops_.clear();
    double y = gap_;
    if (!heading_.empty()) y += (static_cast<double>(heading_.size()) + 0.6) * line_;
    for (int row = 0; row * columns_ < count_; ++row) {
      std::size_t lines = 0;
      for (int i = row * columns_; i < std::min(count_, (row + 1) * columns_); ++i) {
        const auto k = static_cast<std::size_t>(i);
        lines = std::max(lines, titles_[k].lines.size() + sentences_[k].size());
      }
      y += name_height_;
      tops_.push_back(y);
      y += cell_ * 9 / 16 + std::round((static_cast<double>(lines) + 0.8) * line_) + gap_;
    }
    height_ = static_cast<int>(y);
  }

  // Nothing is left blank beside pictures that cannot be wider, as the whole is high enough.
  void Trim() {
    width_ = std::min(grid_.width, static_cast<int>(std::ceil(gap_ + columns_ * (cell_ + gap_))));
    if (grid_.width - width_ < columns_ + gap_) width_ = grid_.width;  // rounded off
    for (const std::string& line : heading_) {
      const double needed = 2.0 * gap_ + fonts_.TextWidth(FontFace::kBold, type_, line);
      width_ = std::max(width_, std::min(grid_.width, static_cast<int>(std::ceil(needed))));
    }
  }

  bool Fits(FontFace face, float size, const std::string& text, double width) {
    return fonts_.TextWidth(face, size, text) <= width;
  }

  std::vector<std::string> WrapAtMost(FontFace face, const std::string& text, double width,
                                      std::size_t most) {
    std::vector<std::string> lines = WrapText(fonts_, face, type_, text, width);
    if (lines.size() > most) {
      lines.resize(most);
      lines.back() = FitText(fonts_, face, type_, lines.back() + " \u2026 ", width);
    }
    return lines;
  }

  std::vector<std::string> WrapSentence(const std::string& sentence) {
    return WrapAtMost(FontFace::kSans, sentence, cell_, static_cast<std::size_t>(most_lines_));
  }

  // Id and time are below each other where they have no room side by side, and smaller where they
  // have none then.
  Words WrapTitle(const std::string& title) {
    Words words{type_, {title}};
    if (Fits(FontFace::kBold, type_, title, cell_)) return words;
    if (const std::size_t gap = title.find("   "); gap != std::string::npos) {
      words.lines = {title.substr(0, gap), title.substr(gap + 3)};
    }
    for (const std::string& line : words.lines) {
      // In quarters of a pixel, and a little less than what fits: widths do not grow evenly.
      const double share = cell_ / fonts_.TextWidth(FontFace::kBold, type_, line);
      const double fitting = std::floor(3.9 * share * type_) / 4.0;
      words.size = std::max(std::min(kSmallestType, type_),
                            std::min(words.size, static_cast<float>(fitting)));
    }
    for (std::string& line : words.lines) {
      line = FitText(fonts_, FontFace::kBold, words.size, line, cell_);
    }
    return words;
  }

  void DrawWords(Canvas& canvas, const Words& words, FontFace face, const Vector2& at,
                 const Rgba& color) const {
    double y = at.y();
    for (const std::string& text : words.lines) {
      y += line_;
      canvas.DrawText(face, words.size, {at.x(), y}, text, color);
    }
  }

  void DrawCell(Image& sheet, Canvas& canvas, int number) {
    const auto i = static_cast<std::size_t>(number);
    const PictureGrid::Cell& cell = grid_.cells[i];
    const int row = number / columns_, high = cell_ * 9 / 16;
    const double x = ColumnX(number % columns_);
    double y = std::floor(tops_[static_cast<std::size_t>(row)]);
    const Rect frame{x, y, static_cast<double>(cell_), static_cast<double>(high)};
    if (cell.marked) canvas.FillRect(frame.Grown(0.8 * gap_), BadColor());
    if (cell.draw) {
      Paste(sheet, cell.draw(cell_, high), static_cast<int>(x), static_cast<int>(y));
    } else {
      canvas.FillRect(frame, FromSrgb(0xE6E8EA));
    }
    y += high + 0.3 * line_;
    DrawWords(canvas, titles_[i], FontFace::kBold, {x, y}, ink_);
    y += static_cast<double>(titles_[i].lines.size()) * line_;
    DrawWords(canvas, {type_, sentences_[i]}, FontFace::kSans, {x, y}, soft_);
  }

  const PictureGrid& grid_;
  FontSet fonts_;
  const Rgba ink_ = FromSrgb(0x22262C), soft_ = FromSrgb(0x5C6570);
  const int count_;
  bool beside_ = false;  // rows of one picture are laid out as one row
  float type_ = 0.0F;
  double line_ = 0.0, gap_ = 0.0, name_height_ = 0.0;
  int columns_ = 1, cell_ = 0, width_ = 0, height_ = 0, most_lines_ = 1;
  std::vector<std::string> heading_;
  std::vector<Words> names_, titles_;
  std::vector<std::vector<std::string>> sentences_;
  std::vector<double> tops_;  // of each row's pictures
};

}  // namespace

Image DrawGrid(const PictureGrid& grid) { return Layout(grid).Draw(); }

}  // namespace pregrasp
