#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/image.h"

namespace pregrasp {

/// Pictures of 16:9 in rows, from left to right, each with words below it.
struct PictureGrid {
  struct Cell {
    /// The picture in this size [pixels]; without one the cell is empty.
    std::function<Image(int width, int height)> draw;
    std::string title, sentence;
    bool marked = false;  ///< by a frame around the picture
  };
  std::string heading;  ///< above all; "" for none
  std::vector<Cell> cells;
  int columns = 0;                     ///< 0: as many as fill it best
  std::vector<std::string> row_names;  ///< above a row each; may be empty
  int most_lines = 4;                  ///< of a sentence; fewer where pictures would be too small
  int width = 1920, height = 1440;     ///< of the whole at most [pixels]: nothing is left blank
  double font_scale = 1.0;
};

/// Rows of one picture each stand side by side, under their names. Type and sentences give way to
/// pictures that would be too small. @throws InputError for a size in which a picture could not be
/// seen.
Image DrawGrid(const PictureGrid& grid);

}  // namespace pregrasp
