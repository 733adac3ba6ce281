#pragma once

#include <string>

#include "app/recording/mrpt_scene.h"

namespace pregrasp {

/// MrptCodec::EncodeScene.
std::string EncodeMrptScene(const MrptScene& scene);

}  // namespace pregrasp
