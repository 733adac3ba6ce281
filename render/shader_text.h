#pragma once

#include <string>

namespace pregrasp {

/// The text of render/shaders/NAME.glsl, compiled in (cmake/embed_text.cmake).
std::string ShaderText(const std::string& name);

}  // namespace pregrasp
