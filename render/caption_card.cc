#include "render/caption_card.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/label_layout.h"

namespace pregrasp {
namespace {

const std::string kEllipsis = "\u2026";

// One line of the card, ready to draw.
struct CardLine {
  FontFace face = FontFace::kSans;
  float size = 14.0F;
  std::string text = {};
  std::string value = {};  // second column of a row
  bool row = false;
  bool title = false;

  double height() const { return std::round(size * (title ? 1.62 : 1.5)); }
};

// A title that would be broken is set smaller first, down to the size of prose.
float TitleSize(FontSet& fonts, const OverlayStyle& style, const std::string& title, double width) {
  const float fitting =
      style.title *
      static_cast<float>(width / fonts.TextWidth(FontFace::kBold, style.title, title));
  // In quarters of a pixel, and a little less than what fits: widths do not grow evenly with sizes.
  return std::clamp(std::floor(3.9F * fitting) / 4.0F, style.text, style.title);
}

// A title is broken between its parts, which three blanks divide, before it is within one.
std::vector<std::string> WrapTitle(FontSet& fonts, float size, const std::string& title,
                                   double width) {
  const std::string kGap = "   ";
  std::vector<std::string> lines;
  for (std::size_t start = 0; start <= title.size();) {
    const std::size_t end = std::min(title.find(kGap, start), title.size());
    const std::string part = title.substr(start, end - start);
    start = end + kGap.size();
    const std::string longer = lines.empty() ? part : lines.back() + kGap + part;
    if (!lines.empty() && fonts.TextWidth(FontFace::kBold, size, longer) <= width) {
      lines.back() = longer;
      continue;
    }
    for (std::string& line : WrapText(fonts, FontFace::kBold, size, part, width)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

std::vector<CardLine> LayOutLines(FontSet& fonts, const OverlayStyle& style,
                                  const RenderCaption& caption, double width) {
  std::vector<CardLine> lines;
  if (!caption.title.empty()) {
    const float size = fonts.TextWidth(FontFace::kBold, style.title, caption.title) <= width
                           ? style.title
                           : TitleSize(fonts, style, caption.title, width);
    for (const std::string& text : WrapTitle(fonts, size, caption.title, width)) {
      lines.push_back({FontFace::kBold, size, text, "", false, true});
    }
  }
  for (const std::string& line : caption.lines) {
    if (const auto tab = line.find('\t'); tab != std::string::npos) {
      lines.push_back(
          {FontFace::kSans, style.text, line.substr(0, tab), line.substr(tab + 1), true, false});
    } else if (line.find("  ") != std::string::npos) {
      lines.push_back(
          {FontFace::kMono, style.text, FitText(fonts, FontFace::kMono, style.text, line, width)});
    } else {
      for (const std::string& text : WrapText(fonts, FontFace::kSans, style.text, line, width)) {
        lines.push_back({FontFace::kSans, style.text, text});
      }
    }
  }
  return lines;
}

// Cuts rows to the width and returns where their second column starts.
double AlignRows(FontSet& fonts, const OverlayStyle& style, std::vector<CardLine>& lines,
                 double width) {
  double column = 0.0;
  for (const CardLine& line : lines) {
    if (line.row) {
      column = std::max<double>(column, fonts.TextWidth(line.face, line.size, line.text));
    }
  }
  column = std::min(std::ceil(column + style.px(14.0)), 0.6 * width);
  for (CardLine& line : lines) {
    if (!line.row) continue;
    line.text = FitText(fonts, line.face, line.size, line.text, column - style.px(6.0));
    line.value = FitText(fonts, FontFace::kMono, line.size, line.value, width - column);
  }
  return column;
}

double CutToHeight(const OverlayStyle& style, std::vector<CardLine>& lines, double room) {
  double height = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && height + lines[i].height() > room) {
      lines.resize(i);
      if (!lines.back().title) lines.back() = {FontFace::kSans, style.text, kEllipsis};
      break;
    }
    height += lines[i].height();
  }
  return height;
}

void DrawScale(Canvas& canvas, const Rect& bar, const std::vector<Rgba>& colors) {
  const auto last = static_cast<double>(colors.size() - 1);
  const int columns = static_cast<int>(bar.width);
  for (int x = 0; x < columns; ++x) {
    const double t = last * std::clamp((x + 0.5) / bar.width, 0.0, 1.0);
    const auto i = std::min(static_cast<std::size_t>(t), colors.size() - 1);
    const Rgba& p = colors[i];
    const Rgba& q = colors[std::min(i + 1, colors.size() - 1)];
    const auto f = static_cast<float>(t - static_cast<double>(i));
    canvas.FillRect({bar.x + x, bar.y, 1.0, bar.height},
                    {p.r + f * (q.r - p.r), p.g + f * (q.g - p.g), p.b + f * (q.b - p.b), 1.0F});
  }
}

}  // namespace

std::string FitText(FontSet& fonts, FontFace face, float size, const std::string& text,
                    double width) {
  if (fonts.TextWidth(face, size, text) <= width) return text;
  std::u32string characters = DecodeUtf8(text);
  while (!characters.empty()) {
    characters.pop_back();
    while (!characters.empty() && characters.back() == U' ') characters.pop_back();
    std::string cut = EncodeUtf8(characters) + kEllipsis;
    if (fonts.TextWidth(face, size, cut) <= width) return cut;
  }
  return "";
}

std::vector<std::string> WrapText(FontSet& fonts, FontFace face, float size,
                                  const std::string& text, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(' ', start), text.size());
    const std::string word = text.substr(start, end - start);
    std::string longer = line;
    if (!line.empty()) longer += ' ';
    longer += word;
    if (line.empty() || fonts.TextWidth(face, size, longer) <= width) {
      line = longer;
    } else {
      lines.push_back(FitText(fonts, face, size, line, width));
      line = word;
    }
    start = end + 1;
  }
  lines.push_back(FitText(fonts, face, size, line, width));
  return lines;
}

namespace {

// The first of these corners, unless at another one a card hides clearly less of some thing: a
// small one that is hidden wholly counts more than the corner of a table.
Rect ChooseCorner(const Vector2& size, const std::vector<Vector2>& corners, double margin,
                  const CardArea& area) {
  constexpr double kClearly = 0.02;  // of a thing
  std::optional<Rect> best;
  double covered = 0.0;
  for (const Vector2& corner : corners) {
    const Rect card{corner.x(), corner.y(), size.x(), size.y()};
    if (best && area.taken && card.Overlaps(area.taken->Grown(margin))) continue;
    const double share = CalcHiddenShares(card, area.outlines);
    if (best && share >= covered - kClearly) continue;
    covered = share;
    best = card;
  }
  return *best;
}

}  // namespace

std::optional<Rect> DrawCaptionCard(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                                    const RenderCaption& caption, const CardArea& area) {
  const double pad = style.px(16.0), bar = style.px(4.0), margin = style.px(20.0);
  const double most =
      std::min(std::max(0.42 * canvas.width(), 180.0), canvas.width() - 2.0 * margin) - 2.0 * pad -
      bar;
  std::vector<CardLine> lines = LayOutLines(fonts, style, caption, most);
  if (lines.empty()) return std::nullopt;
  const double column = AlignRows(fonts, style, lines, most);
  const double height = CutToHeight(style, lines, 0.8 * area.bottom - margin - 1.5 * pad);
  double width = 0.0;
  for (const CardLine& line : lines) {
    width = std::max<double>(
        width, line.row ? column + fonts.TextWidth(FontFace::kMono, line.size, line.value)
                        : fonts.TextWidth(line.face, line.size, line.text));
  }
  const Vector2 size(std::ceil(width) + 2.0 * pad + bar, std::ceil(height) + 1.5 * pad);
  const double right = canvas.width() - margin - size.x(), low = area.bottom - margin - size.y();
  const Rect card =
      ChooseCorner(size, {{margin, margin}, {right, margin}, {margin, low}}, margin, area);
  canvas.FillRoundedRect(card, style.px(5.0), style.panel);
  canvas.FillRect({card.x, card.y, bar, card.height}, style.accent);
  double y = card.y + 0.75 * pad;
  for (const CardLine& line : lines) {
    const double cap = fonts.CapHeight(line.face, line.size);
    const Vector2 at(card.x + bar + pad, y + 0.5 * (line.height() + cap));
    canvas.DrawText(line.face, line.size, at, line.text,
                    line.title ? style.bright : (line.row ? style.muted : style.normal));
    if (line.row) {
      canvas.DrawText(FontFace::kMono, line.size, at + Vector2(column, 0.0), line.value,
                      style.bright);
    }
    y += line.height();
  }
  return card;
}

namespace {

// What the ticks of a scale need not to touch each other.
double WidthOfTicks(FontSet& fonts, const OverlayStyle& style, const RenderLegend& legend,
                    float size) {
  double widest = 0.0;
  for (const auto& [at, text] : legend.ticks) {
    widest = std::max(widest, fonts.TextWidth(FontFace::kSans, size, text) + style.px(8.0));
  }
  return static_cast<double>(legend.ticks.size()) * widest;
}

// Of a legend whose words take no more than this width, as otherwise it hides what it is about.
float LegendType(FontSet& fonts, const OverlayStyle& style, const RenderLegend& legend,
                 double width) {
  constexpr float kSmallest = 8.0F;  // [pixels], below which letters fill in
  float size = style.small;
  const auto fits = [&] {
    bool all = fonts.TextWidth(FontFace::kSans, size, legend.title) <= width &&
               WidthOfTicks(fonts, style, legend, size) <= width;
    for (const auto& [color, text] : legend.swatches) {
      all = all && 2.5 * size + fonts.TextWidth(FontFace::kSans, size, text) <= width;
    }
    return all;
  };
  while (size > kSmallest && !fits()) size -= 0.25F;
  return size;
}

}  // namespace

std::optional<Rect> DrawLegend(Canvas& canvas, FontSet& fonts, const OverlayStyle& style,
                               const RenderLegend& legend, const CardArea& area) {
  if (legend.title.empty() && legend.scale.empty() && legend.swatches.empty()) return std::nullopt;
  const float small = LegendType(fonts, style, legend, 0.5 * canvas.width() - style.px(24.0));
  const double pad = style.px(12.0), line = std::round(small * 1.55);
  const auto text_width = [&](const std::string& text) {
    return static_cast<double>(fonts.TextWidth(FontFace::kSans, small, text));
  };
  const double bar_width = std::max(style.px(220.0), WidthOfTicks(fonts, style, legend, small)),
               bar_height = style.px(12.0);
  double width = std::max(legend.scale.empty() ? 0.0 : bar_width, text_width(legend.title));
  double height = legend.title.empty() ? 0.0 : line;
  if (!legend.scale.empty()) height += bar_height + (legend.ticks.empty() ? 0.0 : line);
  for (const auto& [color, text] : legend.swatches) {
    width = std::max(width, 1.6 * line + text_width(text));
    height += line;
  }
  const double margin = style.px(20.0);
  const Vector2 size(std::ceil(width) + 2.0 * pad, std::ceil(height) + 1.6 * pad);
  const double right = canvas.width() - margin - size.x(), low = area.bottom - margin - size.y();
  if (right < margin || low < margin) return std::nullopt;
  std::vector<Vector2> corners = {{right, low}, {margin, low}};
  if (area.top_is_free) {
    corners.emplace_back(right, margin);
    corners.emplace_back(margin, margin);
  }
  const Rect card = ChooseCorner(size, corners, margin, area);

  canvas.FillRoundedRect(card, style.px(5.0), style.panel);
  double y = card.y + 0.8 * pad;
  const double x = card.x + pad;
  const auto write = [&](double left, const std::string& text, const Rgba& color) {
    const double cap = fonts.CapHeight(FontFace::kSans, small);
    canvas.DrawText(FontFace::kSans, small, {left, y + 0.5 * (line + cap)}, text, color);
  };
  if (!legend.title.empty()) {
    write(x, legend.title, style.normal);
    y += line;
  }
  if (!legend.scale.empty()) {
    DrawScale(canvas, {x, y, bar_width, bar_height}, legend.scale);
    y += bar_height;
    for (const auto& [at, text] : legend.ticks) {
      if (!std::isfinite(at)) continue;
      const double w = text_width(text);
      write(x + std::clamp(std::clamp(at, 0.0, 1.0) * bar_width - 0.5 * w, 0.0,
                           std::max(0.0, width - w)),
            text, style.muted);
    }
    if (!legend.ticks.empty()) y += line;
  }
  for (const auto& [color, text] : legend.swatches) {
    canvas.FillRoundedRect({x, y + 0.18 * line, line, 0.64 * line}, style.px(2.0),
                           WithAlpha(color, 1.0F));
    write(x + 1.6 * line, text, style.normal);
    y += line;
  }
  return card;
}

}  // namespace pregrasp
