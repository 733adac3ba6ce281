#pragma once

#include <string>

#include "app/scene/shape.h"

namespace pregrasp {

/// A mesh as Wavefront OBJ text, six decimals, and back. Only v and f lines with plain indices.
/// @throws InputError  a line of another kind, an index out of range; `where` names the file.
std::string WriteObj(const TriangleMesh& mesh);
TriangleMesh ReadObj(const std::string& text, const std::string& where);

}  // namespace pregrasp
