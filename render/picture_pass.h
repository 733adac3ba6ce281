#pragma once

#include <array>
#include <memory>

#include "render/frame_content.h"
#include "render/frame_data.h"
#include "render/gl_objects.h"
#include "render/renderer.h"

namespace pregrasp {

/// What a tile of the picture is drawn into, and, if it is multisampled, resolved into.
struct TileTargets {
  TileTargets(int width, int height, int samples);

  int width, height, samples;
  GlTexture color, depth, resolved;
  GlFramebuffer draw, read;
};

/// Where a tile's viewport lies: the whole picture, moved so that the tile is at the origin.
struct TileView {
  int x = 0, y = 0;           ///< the tile's lower left corner in the picture
  int width = 0, height = 0;  ///< of the picture
};

/// Draws what is seen: lit bodies and floor, edges, then what is translucent. Needs
/// the maps that ShadowPass and, for stills, OcclusionPass leave bound.
class PicturePass {
 public:
  PicturePass();

  void Run(const FrameContent& content, const FrameData& data, RenderQuality quality, bool ground,
           const TileTargets& tile, const TileView& view);

 private:
  /// Programs that depend on the quality; made when first used.
  struct Lighting {
    explicit Lighting(RenderQuality quality);
    GlProgram solid, ground, bevel;
  };

  const Lighting& LightingOf(RenderQuality quality);
  void DrawSolids(const FrameContent& content, const GlProgram& lit) const;
  void DrawBevels(const FrameContent& content, const GlProgram& program) const;
  void DrawHiddenArrows(const FrameContent& content) const;
  void DrawGhosts(const FrameContent& content) const;
  void DrawCones(const FrameContent& content) const;
  void DrawLines(const FrameContent& content, const FrameData& data) const;
  void DrawPlainEdges(const Draw& draw, const GpuEdges* edges, const Rgba& color) const;

  GlVertexArray empty_;
  GlProgram depth_, background_, ghost_, line_, edge_;
  std::array<std::unique_ptr<Lighting>, 3> lighting_;
};

}  // namespace pregrasp
