#pragma once

#include <array>
#include <memory>
#include <optional>

#include "render/frame_content.h"
#include "render/gl_objects.h"
#include "render/renderer.h"
#include "render/targets.h"

namespace pregrasp {

/// The uniform block of shaders/frame.glsl (std140).
struct FrameBlock {
  float clip_from_world[16];
  float shadow_from_world[kShadowLayers][16];
  float view_from_world[16];
  float eye[4], to_light[4], map_x[4], map_y[4], shadow_width[4], picture[4], target[4], ground[4],
      tuning[4];
};

/// The steps of a picture. Each leaves its own state behind and sets all that it needs, so that
/// their order is fixed only by what they read.
class Passes {
 public:
  Passes();

  /// Uploads what all passes of a picture read.
  void Begin(const FrameContent& content, const MeshCache& cache);
  void SetFrame(const FrameBlock& frame);

  void DrawShadows(const FrameContent& content, const ShadowTargets& targets);
  void DrawOcclusion(const FrameContent& content, const OcclusionTargets& targets, bool ground);
  /// @param occlusion  null where the quality has none.
  void DrawTile(const FrameContent& content, RenderQuality quality, const TileTargets& tile,
                const ShadowTargets& shadows, const OcclusionTargets* occlusion, bool ground,
                const std::array<int, 4>& viewport);

 private:
  /// Programs that depend on the quality; made when first used.
  struct Lighting {
    explicit Lighting(RenderQuality quality);
    GlProgram solid, ground, bevel;
  };

  const Lighting& LightingOf(RenderQuality quality);
  void DrawSurfaces(const std::vector<Draw>& draws);
  void DrawGhosts(const FrameContent& content);
  void DrawCones(const FrameContent& content);
  void DrawOverlays(const FrameContent& content);
  void DrawLines(const FrameContent& content);
  void DrawBevels(const FrameContent& content, const GlProgram& program);
  void DrawPlainEdges(const Draw& draw, const GpuEdges& edges, const Rgba& color, float width);

  GlVertexArray empty_, line_vao_;
  GlBuffer frame_, lines_, face_color_buffer_;
  GlTexture face_colors_;
  GlProgram depth_, blockers_, normal_, ground_normal_, occlusion_, occlusion_blur_, background_;
  GlProgram shadow_, ghost_, flat_, line_, edge_;
  std::array<std::unique_ptr<Lighting>, 3> lighting_;
};

}  // namespace pregrasp
