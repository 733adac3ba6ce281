#include "render/footer.h"

#include <algorithm>
#include <cmath>

#include "render/caption_card.h"

namespace pregrasp {
namespace {

constexpr std::size_t kMostLines = 3;  // at the usual size
constexpr float kSmallest = 8.0F;      // [pixels], below which monospaced letters fill in

// As many leading characters of a word as fit, at least one.
std::size_t FindBreak(FontSet& fonts, float size, const std::u32string& word, double width) {
  std::size_t count = 1;
  while (count < word.size() &&
         fonts.TextWidth(FontFace::kMono, size, EncodeUtf8(word.substr(0, count + 1))) <= width) {
    ++count;
  }
  return count;
}

// Breaks at blanks, and words that are wider than a line within.
std::vector<std::string> BreakText(FontSet& fonts, float size, const std::string& text,
                                   double width) {
  const auto fits = [&](const std::string& line) {
    return fonts.TextWidth(FontFace::kMono, size, line) <= width;
  };
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(' ', start), text.size());
    std::string word = text.substr(start, end - start);
    start = end + 1;
    if (!line.empty() && fits(line + ' ' + word)) {
      line += ' ' + word;
      continue;
    }
    if (!line.empty()) lines.push_back(line);
    while (!fits(word)) {
      const std::u32string characters = DecodeUtf8(word);
      const std::size_t count = FindBreak(fonts, size, characters, width);
      if (count == characters.size()) break;
      lines.push_back(EncodeUtf8(characters.substr(0, count)));
      word = EncodeUtf8(characters.substr(count));
    }
    line = word;
  }
  lines.push_back(line);
  return lines;
}

// On one line, on two that part before the last dot, where the command begins, or on more.
std::vector<std::string> BreakFooter(FontSet& fonts, float size, const std::string& text,
                                     double width) {
  const std::string kDot = " \u00b7 ";
  const auto fits = [&](const std::string& line) {
    return fonts.TextWidth(FontFace::kMono, size, line) <= width;
  };
  if (fits(text)) return {text};
  const std::size_t dot = text.rfind(kDot);
  if (dot != std::string::npos) {
    const std::string before = text.substr(0, dot), after = text.substr(dot + kDot.size());
    if (fits(before) && fits(after)) return {before, after};
  }
  return BreakText(fonts, size, text, width);
}

}  // namespace

FooterText LayOutFooter(FontSet& fonts, const OverlayStyle& style, const std::string& text,
                        const std::string& note, const Vector2& picture) {
  const double pad = style.px(16.0), width = picture.x() - 2.0 * pad;
  const auto text_width = [&](FontFace face, float size, const std::string& line) {
    return static_cast<double>(fonts.TextWidth(face, size, line));
  };
  FooterText footer;
  footer.size = style.small;
  const auto lay_out = [&] {
    const double room = width - pad - text_width(FontFace::kSans, footer.size, note);
    const auto has_room = [&](const std::string& line) {
      return line.empty() || text_width(FontFace::kMono, footer.size, line) <= room;
    };
    footer.lines = BreakFooter(fonts, footer.size, text, width);
    // One line with no room for the note is better two of text, the note beside the first.
    const std::size_t dot = text.rfind(" \u00b7 ");
    if (footer.lines.size() == 1 && !has_room(text) && dot != std::string::npos) {
      footer.lines = {text.substr(0, dot), text.substr(dot + 4)};
    }
    footer.note_line = footer.lines.size();
    for (std::size_t i = footer.lines.size(); i-- > 0;) {
      if (footer.note_line == footer.lines.size() && has_room(footer.lines[i])) {
        footer.note_line = i;
      }
    }
    if (footer.note_line == footer.lines.size()) footer.lines.emplace_back();
  };
  lay_out();
  while (footer.lines.size() > kMostLines && footer.size - 0.5F >= kSmallest) {
    footer.size -= 0.5F;
    lay_out();
  }
  footer.line_height = std::round(1.4 * footer.size);
  const double first = std::round(footer.size + style.px(17.0));
  const auto most = static_cast<std::size_t>(
      1.0 + std::max(0.0, (0.5 * picture.y() - first) / footer.line_height));
  if (footer.lines.size() > most) {
    footer.lines.resize(most);
    footer.lines.back() =
        FitText(fonts, FontFace::kMono, footer.size, footer.lines.back() + " \u2026", width);
    footer.note_line = std::min(footer.note_line, most - 1);
  }
  footer.height = first + (footer.lines.size() - 1.0) * footer.line_height;
  return footer;
}

}  // namespace pregrasp
