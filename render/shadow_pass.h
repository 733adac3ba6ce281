#pragma once

#include <array>

#include "render/frame_content.h"
#include "render/gl_objects.h"
#include "render/light.h"

namespace pregrasp {

/// Depths seen from the light; the same at a quarter of the size, each texel the nearest of 4 x 4;
/// and once more so, then spread to 4 texels around, with room for the steps between.
struct ShadowTargets {
  explicit ShadowTargets(int size);

  int size;
  GlTexture map, blockers, coarse, clear;
  std::array<GlFramebuffer, kShadowLayers> draw, draw_blockers, draw_coarse, draw_clear;
};

class ShadowPass {
 public:
  ShadowPass();

  /// Draws the solids' depths and leaves the maps bound for shaders/shadow.glsl.
  void Run(const FrameContent& content, const ShadowFit& fit, const ShadowTargets& targets) const;

 private:
  void Reduce(const GlProgram& program, const GlTexture& from,
              const std::array<GlFramebuffer, kShadowLayers>& to, int size) const;

  GlVertexArray empty_;
  GlProgram depth_, nearest_, spread_;
};

}  // namespace pregrasp
