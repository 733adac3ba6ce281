#pragma once

#include <string_view>

#include "app/scene/shape.h"

namespace pregrasp {

// Two formats of plain text that assimp reads only as its own writer has them: it takes comments of
// OFF files for numbers, and ends at an STL normal that is not a number.

/// Reads OFF in text, also COFF, NOFF and the like: comments (from # on) and empty lines anywhere,
/// colours and normals left out, polygons triangulated.
/// @throws std::runtime_error saying what is wrong ("has 3 of 8 vertices").
TriangleMesh ParseOff(std::string_view bytes);

/// Whether an STL file is one of text: it begins with "solid", and is not as long as a binary one
/// with its number of triangles, whose header may begin so too.
bool IsTextStl(std::string_view bytes);

/// Reads STL in text: the corners of its facets; their normals, which say nothing new, are left
/// out.
/// @throws std::runtime_error saying what is wrong ("ends within a facet").
TriangleMesh ParseTextStl(std::string_view bytes);

}  // namespace pregrasp
