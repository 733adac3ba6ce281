#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/overlay_style.h"

namespace pregrasp {

/// The words at a picture's bottom, ready to draw.
struct FooterText {
  float size = 12.5F;              ///< of the type [pixels]
  std::vector<std::string> lines;  ///< at least one, which may be empty
  double line_height = 0.0;        ///< [pixels]
  double height = 0.0;             ///< of the whole [pixels]
  std::size_t note_line = 0;       ///< the line at whose right the note stands
};

/// Puts the footer's text on one line beside the note or, where that has no room, on several: none
/// of its characters is left out, as it has a command that is to be typed again. What would take
/// many lines is set smaller first. Only a footer higher than half the picture is cut, with an
/// ellipsis. @param note  what is said at its right. @param picture  its width and height [pixels].
FooterText LayOutFooter(FontSet& fonts, const OverlayStyle& style, const std::string& text,
                        const std::string& note, const Vector2& picture);

}  // namespace pregrasp
