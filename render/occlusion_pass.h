#pragma once

#include "render/frame_content.h"
#include "render/gl_objects.h"

namespace pregrasp {

/// Depths and normals of the whole picture at reduced size, and the occlusion made from them.
struct OcclusionTargets {
  OcclusionTargets(int width, int height);

  int width, height;
  GlTexture depth, normal, raw, open;
  GlFramebuffer draw, draw_raw, draw_open;
};

class OcclusionPass {
 public:
  OcclusionPass();

  /// Makes the occlusion and leaves it bound for shaders/occlusion.glsl.
  void Run(const FrameContent& content, bool ground, const OcclusionTargets& targets) const;

 private:
  GlVertexArray empty_;
  GlProgram normal_, ground_, occlusion_, blur_;
};

}  // namespace pregrasp
