#include "render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "app/core/text.h"
#include "render/label_layout.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr int kSmallestWidth = 200, kSmallestHeight = 112;
const std::string kEllipsis = "\u2026";

// Sizes at a picture of 1280 x 720; everything is multiplied by the same scale.
struct Style {
  double scale = 1.0;
  float title = 20.0F, text = 14.0F, small = 12.5F;
  Rgba panel = FromSrgb(0x20262F, 0.88F);
  Rgba accent = ObjectColor();
  Rgba bright = FromSrgb(0xFFFFFF), normal = FromSrgb(0xDCE2EA), muted = FromSrgb(0xA8B3C2);

  explicit Style(const Image& image) {
    scale = std::clamp(std::min(image.width / 1280.0, image.height / 720.0), 0.66, 6.0);
    // Below about ten pixels letters fill in: text shrinks more slowly than the rest.
    const auto sized = [this](float size) {
      return static_cast<float>(std::round(std::max(size * scale, 0.4 * size + 3.6) * 4.0) / 4.0);
    };
    title = sized(title);
    text = sized(text);
    small = sized(small);
  }
  double px(double at_720) const { return std::round(at_720 * scale); }
};

// One line of the card, ready to draw.
struct CardLine {
  FontFace face = FontFace::kSans;
  float size = 14.0F;
  std::string text = {};
  std::string value = {};  // second column of a row
  bool row = false;
  bool title = false;
};

class Overlay {
 public:
  Overlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view,
          double grid_spacing)
      : image_(image),
        fonts_(fonts),
        canvas_(image, fonts),
        scene_(scene),
        view_(view),
        grid_spacing_(grid_spacing),
        style_(image) {}

  void Draw() {
    const double footer_height = FooterHeight();
    footer_ = {0.0, image_.height - footer_height, static_cast<double>(image_.width),
               footer_height};
    const std::optional<Rect> card = DrawCard();
    const std::optional<Rect> legend = DrawLegend();
    std::vector<Rect> obstacles = {footer_};
    if (card) obstacles.push_back(*card);
    if (legend) obstacles.push_back(*legend);
    const int left_out = DrawLabels(obstacles);
    DrawFooter(left_out);
  }

 private:
  double FooterHeight() const {
    const bool empty = scene_.caption.footer.empty() && scene_.caption.progress < 0.0;
    return empty ? 0.0 : std::round(style_.small + style_.px(17.0));
  }

  std::vector<CardLine> CardLines(double width) {
    std::vector<CardLine> lines;
    if (!scene_.caption.title.empty()) {
      for (const std::string& text :
           WrapText(fonts_, FontFace::kBold, style_.title, scene_.caption.title, width)) {
        lines.push_back({FontFace::kBold, style_.title, text, "", false, true});
      }
    }
    for (const std::string& line : scene_.caption.lines) {
      if (const auto tab = line.find('\t'); tab != std::string::npos) {
        lines.push_back(
            {FontFace::kSans, style_.text, line.substr(0, tab), line.substr(tab + 1), true, false});
      } else if (line.find("  ") != std::string::npos) {
        lines.push_back({FontFace::kMono, style_.text,
                         FitText(fonts_, FontFace::kMono, style_.text, line, width)});
      } else {
        for (const std::string& text :
             WrapText(fonts_, FontFace::kSans, style_.text, line, width)) {
          lines.push_back({FontFace::kSans, style_.text, text});
        }
      }
    }
    return lines;
  }

  // Cuts rows to the width and returns where their second column starts.
  double AlignRows(std::vector<CardLine>& lines, double width) {
    double column = 0.0;
    for (const CardLine& line : lines) {
      if (line.row) column = std::max<double>(column, Width(line.face, line.size, line.text));
    }
    column = std::min(std::ceil(column + style_.px(14.0)), 0.6 * width);
    for (CardLine& line : lines) {
      if (!line.row) continue;
      line.text = FitText(fonts_, line.face, line.size, line.text, column - style_.px(6.0));
      line.value = FitText(fonts_, FontFace::kMono, line.size, line.value, width - column);
    }
    return column;
  }

  std::optional<Rect> DrawCard() {
    const double pad = style_.px(16.0), bar = style_.px(4.0), margin = style_.px(20.0);
    const double most = std::max(0.42 * image_.width, 180.0) - 2.0 * pad - bar;
    std::vector<CardLine> lines = CardLines(most);
    if (lines.empty()) return std::nullopt;
    const double column = AlignRows(lines, most);
    // What does not fit in height is left out, and an ellipsis says so.
    const double room = 0.72 * image_.height - footer_.height - 2.0 * pad;
    double height = 0.0, width = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i > 0 && height + LineHeight(lines[i]) > room) {
        lines.resize(i);
        if (!lines.back().title) lines.back() = {FontFace::kSans, style_.text, kEllipsis};
        break;
      }
      height += LineHeight(lines[i]);
    }
    for (const CardLine& line : lines) {
      width =
          std::max<double>(width, line.row ? column + Width(FontFace::kMono, line.size, line.value)
                                           : Width(line.face, line.size, line.text));
    }
    const Rect card{margin, margin, std::ceil(width) + 2.0 * pad + bar,
                    std::ceil(height) + 1.5 * pad};
    canvas_.FillRoundedRect(card, style_.px(5.0), style_.panel);
    canvas_.FillRect({card.x, card.y, bar, card.height}, style_.accent);
    double y = card.y + 0.75 * pad;
    for (const CardLine& line : lines) {
      const double baseline =
          y + LineHeight(line) * 0.5 + 0.5 * fonts_.CapHeight(line.face, line.size);
      const Vector2 at(card.x + bar + pad, baseline);
      canvas_.DrawText(line.face, line.size, at, line.text,
                       line.title ? style_.bright
                       : line.row ? style_.muted
                                  : style_.normal);
      if (line.row) {
        canvas_.DrawText(FontFace::kMono, line.size, at + Vector2(column, 0.0), line.value,
                         style_.bright);
      }
      y += LineHeight(line);
    }
    return card;
  }

  std::optional<Rect> DrawLegend() {
    const RenderLegend& legend = scene_.legend;
    if (legend.title.empty() && legend.scale.empty() && legend.swatches.empty())
      return std::nullopt;
    const double pad = style_.px(12.0), line = std::round(style_.small * 1.55);
    const double bar_width = style_.px(220.0), bar_height = style_.px(12.0);
    double width = legend.scale.empty() ? 0.0 : bar_width;
    double height = 0.0;
    if (!legend.title.empty()) {
      width = std::max<double>(width, Width(FontFace::kSans, style_.small, legend.title));
      height += line;
    }
    if (!legend.scale.empty()) height += bar_height + (legend.ticks.empty() ? 0.0 : line);
    for (const auto& [color, text] : legend.swatches) {
      width = std::max<double>(width, 1.6 * line + Width(FontFace::kSans, style_.small, text));
      height += line;
    }
    const double margin = style_.px(20.0);
    Rect card{0, 0, std::ceil(width) + 2.0 * pad, std::ceil(height) + 1.6 * pad};
    card.x = image_.width - margin - card.width;
    card.y = footer_.y - margin - card.height;
    if (card.x < 0.5 * image_.width - card.width || card.y < 0.0) return std::nullopt;
    canvas_.FillRoundedRect(card, style_.px(5.0), style_.panel);
    double y = card.y + 0.8 * pad;
    const double x = card.x + pad;
    const auto text = [&](double left, const std::string& what, const Rgba& color) {
      const double cap = fonts_.CapHeight(FontFace::kSans, style_.small);
      canvas_.DrawText(FontFace::kSans, style_.small, {left, y + 0.5 * line + 0.5 * cap}, what,
                       color);
    };
    if (!legend.title.empty()) {
      text(x, legend.title, style_.normal);
      y += line;
    }
    if (!legend.scale.empty()) {
      DrawScale({x, y, bar_width, bar_height});
      y += bar_height;
      for (const auto& [at, label] : legend.ticks) {
        const double where = std::clamp(at, 0.0, 1.0);
        const double w = Width(FontFace::kSans, style_.small, label);
        text(x + std::clamp(where * bar_width - 0.5 * w, 0.0, std::max(0.0, width - w)), label,
             style_.muted);
      }
      if (!legend.ticks.empty()) y += line;
    }
    for (const auto& [color, label] : legend.swatches) {
      canvas_.FillRoundedRect({x, y + 0.18 * line, line, 0.64 * line}, style_.px(2.0),
                              WithAlpha(color, 1.0F));
      text(x + 1.6 * line, label, style_.normal);
      y += line;
    }
    return card;
  }

  void DrawScale(const Rect& bar) {
    const auto& colors = scene_.legend.scale;
    const auto last = static_cast<double>(colors.size() - 1);
    for (double x = 0.0; x < bar.width; x += 1.0) {
      const double t = last * std::clamp((x + 0.5) / bar.width, 0.0, 1.0);
      const auto i = std::min(static_cast<std::size_t>(t), colors.size() - 1);
      const Rgba& p = colors[i];
      const Rgba& q = colors[std::min(i + 1, colors.size() - 1)];
      const auto f = static_cast<float>(t - static_cast<double>(i));
      canvas_.FillRect({bar.x + x, bar.y, 1.0, bar.height},
                       {p.r + f * (q.r - p.r), p.g + f * (q.g - p.g), p.b + f * (q.b - p.b), 1.0F});
    }
  }

  // Outlines, in the picture, of the bodies that are small enough to be what it is about.
  std::vector<std::vector<Vector2>> Outlines() const;

  // Returns how many labels found no place.
  int DrawLabels(const std::vector<Rect>& obstacles) {
    const double pad_x = style_.px(9.0), bar = style_.px(4.0);
    const double height = std::round(style_.text + style_.px(11.0));
    std::vector<LabelRequest> requests;
    std::vector<const RenderLabel*> labels;
    for (const RenderLabel& label : scene_.labels) {
      const auto anchor = view_.Project(label.p_W);
      const Rect whole{0.0, 0.0, static_cast<double>(image_.width),
                       static_cast<double>(image_.height)};
      if (!anchor || !whole.Contains(*anchor)) continue;
      const double width = std::ceil(Width(FontFace::kSans, style_.text, label.text));
      requests.push_back({*anchor, {width + 2.0 * pad_x + bar, height}});
      labels.push_back(&label);
    }
    LabelArea area;
    area.picture =
        Rect{0.0, 0.0, static_cast<double>(image_.width), static_cast<double>(image_.height)}.Grown(
            -style_.px(8.0));
    area.obstacles = obstacles;
    area.shapes = Outlines();
    area.scale = style_.scale;
    const auto boxes = LayOutLabels(requests, area);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i])
        DrawLeader(LeaderStart(*boxes[i], requests[i].anchor), requests[i].anchor,
                   labels[i]->color);
    }
    int left_out = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!boxes[i]) {
        ++left_out;
        continue;
      }
      const Rect& box = *boxes[i];
      canvas_.FillRoundedRect(box, style_.px(3.0), style_.panel);
      canvas_.FillRect({box.x, box.y, bar, box.height}, WithAlpha(labels[i]->color, 1.0F));
      const double cap = fonts_.CapHeight(FontFace::kSans, style_.text);
      canvas_.DrawText(FontFace::kSans, style_.text,
                       {box.x + bar + pad_x, box.y + 0.5 * (box.height + cap)}, labels[i]->text,
                       style_.bright);
    }
    return left_out;
  }

  void DrawLeader(const Vector2& from, const Vector2& anchor, const Rgba& color) {
    const double width = std::max(1.2, 1.6 * style_.scale);
    canvas_.DrawLine(from, anchor, width + 1.6, FromSrgb(0x20262F, 0.35F));
    canvas_.FillDisc(anchor, 1.9 * width + 1.0, FromSrgb(0x20262F, 0.6F));
    canvas_.DrawLine(from, anchor, width, WithAlpha(color, 1.0F));
    canvas_.FillDisc(anchor, 1.9 * width, WithAlpha(color, 1.0F));
  }

  void DrawFooter(int labels_left_out) {
    std::string note;
    if (labels_left_out > 0) {
      note = std::to_string(labels_left_out) +
             (labels_left_out == 1 ? " label has no room" : " labels have no room");
    }
    if (grid_spacing_ > 0.0) {
      const std::string spacing = grid_spacing_ < 0.999
                                      ? FormatDouble(std::round(grid_spacing_ * 100.0)) + " cm"
                                      : FormatDouble(std::round(grid_spacing_)) + " m";
      note += (note.empty() ? "grid " : "   grid ") + spacing;
    }
    const double pad = style_.px(16.0);
    const double note_width = Width(FontFace::kSans, style_.small, note);
    const double cap = fonts_.CapHeight(FontFace::kMono, style_.small);
    if (footer_.height > 0.0) {
      canvas_.FillRect(footer_, style_.panel);
      const double line = std::max(2.0, style_.px(3.0));
      if (scene_.caption.progress >= 0.0) {
        const double share = std::min(scene_.caption.progress, 1.0);
        canvas_.FillRect({0.0, footer_.y, share * image_.width, line}, style_.accent);
      }
      const double baseline = footer_.y + 0.5 * (footer_.height + line + cap) - 1.0;
      canvas_.DrawText(FontFace::kSans, style_.small, {image_.width - pad - note_width, baseline},
                       note, style_.muted);
      const double room = image_.width - 3.0 * pad - note_width;
      canvas_.DrawText(FontFace::kMono, style_.small, {pad, baseline},
                       FitText(fonts_, FontFace::kMono, style_.small, scene_.caption.footer, room),
                       style_.normal);
    } else if (!note.empty()) {
      canvas_.DrawText(FontFace::kSans, style_.small,
                       {image_.width - pad - note_width, image_.height - style_.px(10.0)}, note,
                       FromSrgb(0x5A6470));
    }
  }

  double LineHeight(const CardLine& line) const {
    return std::round(line.size * (line.title ? 1.62 : 1.5));
  }
  double Width(FontFace face, float size, const std::string& text) {
    return fonts_.TextWidth(face, size, text);
  }

  Image& image_;
  FontSet& fonts_;
  Canvas canvas_;
  const RenderScene& scene_;
  const CameraView& view_;
  const double grid_spacing_;
  const Style style_;
  Rect footer_;
};

// Andrew's monotone chain.
std::vector<Vector2> ConvexOutline(std::vector<Vector2> points) {
  std::sort(points.begin(), points.end(), [](const Vector2& a, const Vector2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vector2> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vector2& p : points) {
      while (hull.size() >= start + 2) {
        const Vector2 u = hull[hull.size() - 1] - hull[hull.size() - 2];
        const Vector2 v = p - hull[hull.size() - 2];
        if (u.x() * v.y() - u.y() * v.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<std::vector<Vector2>> Overlay::Outlines() const {
  constexpr int kMostPoints = 256;
  std::vector<std::vector<Vector2>> outlines;
  for (const RenderBody& body : scene_.bodies) {
    if (body.shading != Shading::kSolid) continue;
    const MatrixX3& V = body.mesh->V;
    const Eigen::Index step = std::max<Eigen::Index>(1, V.rows() / kMostPoints);
    std::vector<Vector2> points;
    bool behind = false;
    for (Eigen::Index i = 0; i < V.rows(); i += step) {
      const auto p = view_.Project(body.X_WB * V.row(i).transpose());
      behind = behind || !p;
      if (p) points.push_back(*p);
    }
    if (behind || points.size() < 3) continue;
    Vector2 low = points[0], high = points[0];
    for (const Vector2& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    if ((high - low).x() > 0.6 * image_.width || (high - low).y() > 0.6 * image_.height) continue;
    outlines.push_back(ConvexOutline(std::move(points)));
  }
  return outlines;
}

}  // namespace

std::string FitText(FontSet& fonts, FontFace face, float size, const std::string& text,
                    double width) {
  if (fonts.TextWidth(face, size, text) <= width) return text;
  std::u32string characters = DecodeUtf8(text);
  while (!characters.empty()) {
    characters.pop_back();
    while (!characters.empty() && characters.back() == U' ') characters.pop_back();
    const std::string cut = EncodeUtf8(characters) + kEllipsis;
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
    const std::string longer = line.empty() ? word : line + " " + word;
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

void DrawOverlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view,
                 double grid_spacing) {
  if (image.width < kSmallestWidth || image.height < kSmallestHeight) return;
  Overlay(image, fonts, scene, view, grid_spacing).Draw();
}

}  // namespace pregrasp
