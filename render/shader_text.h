#pragma once

#include <string>

namespace pregrasp {

/// The text of render/shaders/NAME.glsl, compiled in (see embed_shaders.cmake).
std::string ShaderText(const std::string& name);

}  // namespace pregrasp
