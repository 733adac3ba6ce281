#pragma once

#include <array>

#include "render/gl_objects.h"
#include "render/light.h"

namespace pregrasp {

/// What a tile of the picture is drawn into, and, if it is multisampled, resolved into.
struct TileTargets {
  TileTargets(int width, int height, int samples);

  int width, height, samples;
  GlTexture color, depth, resolved;
  GlFramebuffer draw, read;
};

/// Depths seen from the light, and the same at a quarter of the size with each texel the
/// nearest of 4 x 4.
struct ShadowTargets {
  explicit ShadowTargets(int size);

  int size;
  GlTexture map, blockers;
  std::array<GlFramebuffer, kShadowLayers> draw, draw_blockers;
};

/// Depths and normals of the whole picture at reduced size, and the occlusion made from them.
struct OcclusionTargets {
  OcclusionTargets(int width, int height);

  int width, height;
  GlTexture depth, normal, raw, open;
  GlFramebuffer draw, draw_raw, draw_open;
};

}  // namespace pregrasp
