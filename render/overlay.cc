#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/core/text.h"
#include "render/caption_card.h"
#include "render/footer.h"
#include "render/label_layout.h"
#include "render/overlay_style.h"

namespace pregrasp {
namespace {

constexpr int kSmallestWidth = 200, kSmallestHeight = 112;

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

std::optional<std::vector<Vector2>> Outline(const RenderBody& body, const CameraView& view) {
  constexpr Eigen::Index kMostPoints = 256;
  const MatrixX3& V = body.mesh->V;
  const Eigen::Index step = std::max<Eigen::Index>(1, V.rows() / kMostPoints);
  std::vector<Vector2> points;
  for (Eigen::Index i = 0; i < V.rows(); i += step) {
    const auto p = view.Project(body.X_WB * V.row(i).transpose());
    if (!p) return std::nullopt;
    points.push_back(*p);
  }
  if (points.size() < 3) return std::nullopt;
  Vector2 low = points[0], high = points[0];
  for (const Vector2& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if ((high - low).x() > 0.6 * view.width || (high - low).y() > 0.6 * view.height) {
    return std::nullopt;
  }
  return ConvexOutline(std::move(points));
}

// Outlines, in the picture, of what labels and cards had better not cover: bodies small enough to
// be what it is about, cones and arrows.
std::vector<std::vector<Vector2>> Outlines(const RenderScene& scene, const CameraView& view,
                                           bool with_ghosts) {
  std::vector<std::vector<Vector2>> outlines;
  for (const RenderBody& body : scene.bodies) {
    if (body.shading != Shading::kSolid && !with_ghosts) continue;
    if (auto outline = Outline(body, view)) outlines.push_back(std::move(*outline));
  }
  for (const RenderCone& cone : scene.cones) {
    const double radius = cone.axis_W.norm() * std::tan(std::min(cone.half_angle, 1.4F));
    const Vector3 rim = cone.p_W + cone.axis_W;
    const Vector3 across_W = radius * view.forward().cross(cone.axis_W).normalized();
    const auto tip = view.Project(cone.p_W), left = view.Project(rim - across_W),
               right = view.Project(rim + across_W);
    if (tip && left && right && across_W.allFinite()) outlines.push_back({*tip, *left, *right});
  }
  for (const RenderArrow& arrow : scene.arrows) {
    const auto from = view.Project(arrow.p_W), to = view.Project(arrow.p_W + arrow.v_W);
    if (from && to) outlines.push_back({*from, *to});
  }
  return outlines;
}

class Overlay {
 public:
  Overlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view)
      : fonts_(fonts),
        canvas_(image, fonts),
        scene_(scene),
        view_(view),
        style_(image, scene.font_scale) {}

  void Draw(double grid_spacing) {
    const RenderCaption& caption = scene_.caption;
    const bool bar = !caption.footer.empty() || caption.progress >= 0.0;
    const FooterText words_below =
        LayOutFooter(fonts_, style_, caption.footer, FooterNote(0, grid_spacing),
                     {canvas_.width(), canvas_.height()});
    const double footer_height = bar ? words_below.height : 0.0;
    const double bottom = canvas_.height() - footer_height;
    const Rect footer{0.0, bottom, canvas_.width(), footer_height};
    std::vector<Rect> obstacles = {footer};
    const double note_room = bar ? 0.0 : style_.px(12.0);
    if (!bar) {
      const int labels = static_cast<int>(scene_.labels.size());
      obstacles.push_back(NoteArea(FooterNote(labels, grid_spacing)));
    }
    const bool has_card = !caption.title.empty() || !caption.lines.empty();
    CardArea area{bottom - note_room, {}, {}, !has_card};
    if (!scene_.fixed_corners) area.outlines = Outlines(scene_, view_, true);
    const auto legend = DrawLegend(canvas_, fonts_, style_, scene_.legend, area);
    if (legend) obstacles.push_back(*legend);
    area.bottom = bottom;
    area.taken = legend;
    if (const auto card = DrawCaptionCard(canvas_, fonts_, style_, caption, area)) {
      obstacles.push_back(*card);
    }
    const int left_out = DrawLabels(std::move(obstacles));
    DrawFooter(words_below, footer, left_out, grid_spacing);
  }

 private:
  // Returns how many labels found no place.
  int DrawLabels(std::vector<Rect> obstacles) {
    const double pad = style_.px(9.0), bar = style_.px(4.0);
    const Rect picture{0.0, 0.0, canvas_.width(), canvas_.height()};
    const double widest = 0.45 * picture.width;  // a box may take no more than part of it
    const float type = LabelType(widest);
    const double height = std::round(type + style_.px(11.0));
    std::vector<LabelRequest> requests;
    std::vector<const RenderLabel*> labels;
    std::vector<std::string> texts;
    int left_out = 0;
    for (const RenderLabel& label : scene_.labels) {
      const auto anchor = view_.Project(label.p_W);
      if (!anchor || !picture.Contains(*anchor)) continue;
      const auto covers = [&anchor](const Rect& rect) { return rect.Contains(*anchor); };
      if (std::any_of(obstacles.begin(), obstacles.end(), covers)) {
        ++left_out;  // a leader into the card would point at its text
        continue;
      }
      texts.push_back(FitText(fonts_, FontFace::kSans, type, label.text, widest));
      const double width = fonts_.TextWidth(FontFace::kSans, type, texts.back());
      requests.push_back({*anchor, {std::ceil(width) + 2.0 * pad + bar, height}});
      labels.push_back(&label);
    }
    LabelArea area;
    area.picture = picture.Grown(-style_.px(8.0));
    area.obstacles = std::move(obstacles);
    area.shapes = Outlines(scene_, view_, false);
    area.scale = style_.scale;
    const auto boxes = LayOutLabels(requests, area);
    // All leaders first: a box may lie over another's leader, never under it.
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (boxes[i]) DrawLeader(*boxes[i], requests[i].anchor, labels[i]->color);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!boxes[i]) {
        ++left_out;
        continue;
      }
      const Rect& box = *boxes[i];
      canvas_.FillRoundedRect(box, style_.px(3.0), style_.panel);
      canvas_.FillRect({box.x, box.y, bar, box.height}, WithAlpha(labels[i]->color, 1.0F));
      const double cap = fonts_.CapHeight(FontFace::kSans, type);
      canvas_.DrawText(FontFace::kSans, type, {box.x + bar + pad, box.y + 0.5 * (box.height + cap)},
                       texts[i], style_.bright);
    }
    return left_out;
  }

  // A dark rim keeps leaders readable over anything.
  void DrawLeader(const Rect& box, const Vector2& anchor, const Rgba& color) {
    const Vector2 from = LeaderStart(box, anchor);
    const double width = std::max(1.2, 1.6 * style_.scale);
    const Rgba line = WithAlpha(color, 1.0F);
    canvas_.DrawLine(from, anchor, width + 2.0, WithAlpha(style_.panel, 0.45F));
    canvas_.FillDisc(anchor, 2.1 * width + 1.0, WithAlpha(style_.panel, 0.7F));
    canvas_.DrawLine(from, anchor, width, line);
    canvas_.FillDisc(anchor, 2.1 * width, line);
    canvas_.FillDisc(anchor, width, style_.bright);
  }

  static std::string FormatSpacing(double spacing) {
    const bool metres = spacing > 0.999;
    return FormatDouble(std::round(metres ? spacing : 100.0 * spacing)) + (metres ? " m" : " cm");
  }

  static std::string FooterNote(int labels_left_out, double grid_spacing) {
    std::string note;
    if (labels_left_out > 0) {
      note = std::to_string(labels_left_out) +
             (labels_left_out == 1 ? " label has no room" : " labels have no room");
    }
    if (grid_spacing > 0.0) {
      note += (note.empty() ? "grid " : "   grid ") + FormatSpacing(grid_spacing) + " and " +
              FormatSpacing(10.0 * grid_spacing);
    }
    return note;
  }

  // Of the note where there is no footer, which then is no wider than part of the picture.
  float NoteType(const std::string& note) {
    constexpr float kSmallest = 8.0F;
    float size = style_.small;
    while (size > kSmallest &&
           fonts_.TextWidth(FontFace::kSans, size, note) > 0.5 * canvas_.width()) {
      size -= 0.25F;
    }
    return size;
  }

  Rect NoteArea(const std::string& note) {
    const float size = NoteType(note);
    const double width = note.empty() ? 0.0 : fonts_.TextWidth(FontFace::kSans, size, note);
    const double height = note.empty() ? 0.0 : style_.px(10.0) + size;
    return {canvas_.width() - style_.px(16.0) - width, canvas_.height() - height, width, height};
  }

  void DrawFooter(const FooterText& text, const Rect& footer, int labels_left_out,
                  double grid_spacing) {
    const double pad = style_.px(16.0);
    // Where both have no room it says what is missing, and the grid is seen anyway.
    // Where both have no room it says what is missing, and the grid is seen anyway.
    const auto draw_note = [&](float size, double baseline, const Rgba& color, double room) {
      const auto width = [&](const std::string& note) {
        return static_cast<double>(fonts_.TextWidth(FontFace::kSans, size, note));
      };
      std::string note = FooterNote(labels_left_out, grid_spacing);
      if (width(note) > room && labels_left_out > 0) note = FooterNote(labels_left_out, 0.0);
      note = FitText(fonts_, FontFace::kSans, size, note, room);
      canvas_.DrawText(FontFace::kSans, size, {canvas_.width() - pad - width(note), baseline}, note,
                       color);
    };
    const double whole = canvas_.width() - 2.0 * pad;
    if (footer.height == 0.0) {
      const float size = NoteType(FooterNote(labels_left_out, grid_spacing));
      draw_note(size, canvas_.height() - style_.px(10.0), style_.on_floor, whole);
      return;
    }
    canvas_.FillRect(footer, style_.panel);
    const double line = std::max(2.0, style_.px(3.0));
    if (scene_.caption.progress >= 0.0) {
      const double share = std::min(scene_.caption.progress, 1.0);
      canvas_.FillRect({0.0, footer.y, share * footer.width, line}, style_.accent);
    }
    const double cap = fonts_.CapHeight(FontFace::kMono, text.size);
    const double first = footer.height - (text.lines.size() - 1.0) * text.line_height;
    double baseline = footer.y + 0.5 * (first + line + cap) - 1.0;
    for (std::size_t i = 0; i < text.lines.size(); ++i) {
      if (i == text.note_line) {
        const double taken = fonts_.TextWidth(FontFace::kMono, text.size, text.lines[i]);
        draw_note(text.size, baseline, style_.muted, whole - (taken > 0.0 ? taken + pad : 0.0));
      }
      canvas_.DrawText(FontFace::kMono, text.size, {pad, baseline}, text.lines[i], style_.normal);
      baseline += text.line_height;
    }
  }

  // As large as the style has it, or smaller, so that the longest label is not cut.
  float LabelType(double width) {
    constexpr float kSmallest = 8.0F;  // [pixels], below which letters fill in
    float size = style_.text;
    for (const RenderLabel& label : scene_.labels) {
      while (size > kSmallest && fonts_.TextWidth(FontFace::kSans, size, label.text) > width) {
        size -= 0.25F;
      }
    }
    return size;
  }

  FontSet& fonts_;
  Canvas canvas_;
  const RenderScene& scene_;
  const CameraView& view_;
  const OverlayStyle style_;
};

}  // namespace

void DrawOverlay(Image& image, FontSet& fonts, const RenderScene& scene, const CameraView& view,
                 double grid_spacing) {
  if (image.width < kSmallestWidth || image.height < kSmallestHeight) return;
  Overlay(image, fonts, scene, view).Draw(grid_spacing);
}

}  // namespace pregrasp
