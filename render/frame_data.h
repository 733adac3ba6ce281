#pragma once

#include "render/frame_content.h"
#include "render/gl_objects.h"
#include "render/light.h"

namespace pregrasp {

/// The uniform block of shaders/frame.glsl (std140), which says what each number is.
struct FrameBlock {
  float clip_from_world[16];
  float shadow_from_world[kShadowLayers][16];
  float view_from_world[16];
  float eye[4], to_light[4], map_x[4], map_y[4], shadow_width[4], picture[4], target[4], ground[4],
      tuning[4];
};

/// What all passes of a picture read, on the GPU side.
class FrameData {
 public:
  FrameData();

  void Upload(const FrameContent& content, const MeshCache& cache);
  void SetBlock(const FrameBlock& block);
  /// The content's lines as instances, attributes as line_vert.glsl reads them.
  const GlVertexArray& lines() const { return line_vao_; }

 private:
  GlVertexArray line_vao_;
  GlBuffer block_, lines_, face_color_buffer_;
  GlTexture face_colors_;
};

}  // namespace pregrasp
