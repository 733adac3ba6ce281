#include "render/picture_pass.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "app/core/interrupt.h"
#include "render/gl_state.h"

namespace pregrasp {
namespace {

// How much nearer, as a share of the distance, what is drawn later passes where it lies in one
// plane with what was drawn before: above the rounding of depths, far below what can be seen.
constexpr float kCoplanarStep = 1e-5F;

// Widths of drawn edges, in pixels of a picture 720 high.
constexpr float kBevelWidth = 1.5F, kEdgeWidth = 1.2F;

Rgba Darker(const Rgba& color, float share, float alpha) {
  return {share * color.r, share * color.g, share * color.b, alpha};
}

void SetColor(GLint location, const Rgba& color) {
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  gl.Uniform4fv(location, 1, rgba);
}

}  // namespace

TileTargets::TileTargets(int w, int h, int n)
    : width(w),
      height(h),
      samples(n),
      color(MakeTexture2D(GL_RGBA8, w, h, n)),
      depth(MakeTexture2D(GL_DEPTH_COMPONENT32F, w, h, n)),
      draw(MakeFramebuffer(&color, &depth)) {
  if (samples > 0) {
    resolved = MakeTexture2D(GL_RGBA8, w, h);
    read = MakeFramebuffer(&resolved, nullptr);
  }
}

PicturePass::Lighting::Lighting(RenderQuality quality) {
  // How far (share of the view's height) and with how many taps shadows are softened.
  std::vector<std::string> defines;
  if (quality == RenderQuality::kDraft) {
    defines = {"SHADOW_TAPS 8", "SHADOW_SEARCH 8", "SHADOW_REACH 0.02"};
  } else {
    defines = {"SHADOW_TAPS 32", "SHADOW_SEARCH 16", "SHADOW_REACH 0.04"};
  }
  if (quality == RenderQuality::kStill) defines.emplace_back("OCCLUSION");
  solid = GlProgram({"frame", "mesh_vert"}, {"frame", "light", "shadow", "occlusion", "solid_frag"},
                    defines);
  ground = GlProgram({"frame", "ground_vert"},
                     {"frame", "light", "shadow", "occlusion", "ground_frag"}, defines);
  defines.emplace_back("BEVEL");
  bevel = GlProgram({"frame", "edge_vert"}, {"frame", "light", "shadow", "edge_frag"}, defines);
  for (const GlProgram* program : {&solid, &ground, &bevel}) {
    program->Use();
    program->SetSampler("shadow_map", kShadowMap);
    program->SetSampler("blocker_map", kBlockerMap);
    program->SetSampler("clear_map", kClearMap);
    program->SetSampler("occlusion_map", kOcclusionMap);
    program->SetSampler("occlusion_depths", kOcclusionDepths);
    program->SetSampler("face_colors", kFaceColors);
  }
}

PicturePass::PicturePass()
    : empty_(MakeVertexArray()),
      depth_({"frame", "mesh_vert"}, {"depth_frag"}),
      background_({"screen_vert"}, {"frame", "light", "background_frag"}),
      ghost_({"frame", "mesh_vert"}, {"frame", "light", "ghost_frag"}, {"TRANSLUCENT"}),
      line_({"frame", "line_vert"}, {"frame", "light", "line_frag"}),
      edge_({"frame", "edge_vert"}, {"frame", "light", "edge_frag"}) {
  ghost_.Use();
  ghost_.SetSampler("face_colors", kFaceColors);
}

const PicturePass::Lighting& PicturePass::LightingOf(RenderQuality quality) {
  auto& lighting = lighting_[static_cast<int>(quality)];
  if (!lighting) lighting = std::make_unique<Lighting>(quality);
  return *lighting;
}

void PicturePass::Run(const FrameContent& content, const FrameData& data, RenderQuality quality,
                      bool ground, const TileTargets& tile, const TileView& view) {
  const Lighting& lighting = LightingOf(quality);
  gl.BindFramebuffer(GL_FRAMEBUFFER, tile.draw.get());
  gl.Viewport(-view.x, -view.y, view.width, view.height);
  SetColorWrites(true);
  ClearDepth(0.0F);
  gl.Disable(GL_DEPTH_TEST);
  SetBlend(false);
  background_.Use();
  DrawScreen(empty_);
  ThrowIfInterrupted();  // the first time, each of these makes Mesa compile its shaders
  DrawSolids(content, lighting.solid);
  ThrowIfInterrupted();
  SetBlend(true);  // the floor fades into the background
  if (ground) {
    lighting.ground.Use();
    DrawGround(empty_);
  }
  ThrowIfInterrupted();
  DrawBevels(content, lighting.bevel);
  for (const Draw& draw : content.solids) {
    DrawPlainEdges(draw, draw.all_edges, Darker(draw.color, 0.15F, 0.75F));
  }
  ThrowIfInterrupted();
  DrawHiddenArrows(content);
  DrawGhosts(content);
  DrawCones(content);
  DrawLines(content, data);
}

// Depths first: lighting costs far more than geometry, and is then paid once a pixel.
void PicturePass::DrawSolids(const FrameContent& content, const GlProgram& lit) const {
  SetColorWrites(false);
  SetDepth(GL_GREATER, true);
  depth_.Use();
  DrawSurfaces(content.solids);
  DrawSurfaces(content.annotations);
  SetColorWrites(true);
  SetDepth(GL_EQUAL, false);
  lit.Use();
  DrawSurfaces(content.solids);
  DrawSurfaces(content.annotations);
  SetDepth(GL_GREATER, true);
}

void PicturePass::DrawBevels(const FrameContent& content, const GlProgram& program) const {
  program.Use();
  SetDepth(GL_GREATER, false);
  gl.Uniform1f(program.uniform("width"), kBevelWidth);
  const GLint model = program.uniform("world_from_body"), color = program.uniform("color"),
              surface = program.uniform("surface");
  for (const Draw& draw : content.solids) {
    const bool face_colors = draw.material[2] >= 0.0F;
    if (draw.creases == nullptr || draw.creases->count == 0 || face_colors) continue;
    Rgba faint = draw.color;
    faint.a = 0.8F;
    SetColor(color, faint);
    gl.Uniform4fv(surface, 1, draw.material.data());
    gl.UniformMatrix4fv(model, 1, GL_FALSE, draw.X_WB.data());
    gl.BindVertexArray(draw.creases->vao.get());
    gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, draw.creases->count);
  }
}

// Forces and cones point into bodies: what bodies hide of them shines through faintly.
void PicturePass::DrawHiddenArrows(const FrameContent& content) const {
  SetDepth(GL_LESS, false);
  ghost_.Use();
  gl.Uniform1f(ghost_.uniform("nearer"), 0.0F);
  gl.Uniform1f(ghost_.uniform("strength"), 0.55F);
  DrawSurfaces(content.arrows);
}

// Sorted from far to near. Of each body only the nearest layer shows: a pass that writes depth
// alone comes first. Each ghost passes a little nearer than the last, so that faces in one plane,
// as of a thing that slides, do not fight.
void PicturePass::DrawGhosts(const FrameContent& content) const {
  float nearer = 0.0F;
  for (const Draw& draw : content.ghosts) {
    ghost_.Use();
    nearer += kCoplanarStep;
    gl.Uniform1f(ghost_.uniform("nearer"), nearer);
    gl.Uniform1f(ghost_.uniform("strength"), 1.0F);
    SetColorWrites(false);
    SetDepth(GL_GREATER, true);
    DrawSurface(draw);
    SetColorWrites(true);
    SetDepth(GL_EQUAL, false);
    DrawSurface(draw);
    SetDepth(GL_GREATER, false);
    DrawPlainEdges(
        draw, draw.all_edges != nullptr ? draw.all_edges : draw.creases,
        draw.outline ? draw.color : Darker(draw.color, 0.6F, std::min(1.0F, 1.8F * draw.color.a)));
  }
}

void PicturePass::DrawCones(const FrameContent& content) const {
  ghost_.Use();
  gl.Uniform1f(ghost_.uniform("nearer"), 0.0F);
  gl.Enable(GL_CULL_FACE);
  for (const Draw& draw : content.cones) {
    for (const auto& [func, strength] : {std::pair(GL_LESS, 0.7F), std::pair(GL_GREATER, 1.0F)}) {
      SetDepth(static_cast<GLenum>(func), false);
      gl.Uniform1f(ghost_.uniform("strength"), strength);
      for (const int hidden : {GL_FRONT, GL_BACK}) {
        gl.CullFace(static_cast<GLenum>(hidden));
        DrawSurface(draw);
      }
    }
  }
  gl.CullFace(GL_BACK);
  gl.Disable(GL_CULL_FACE);
}

void PicturePass::DrawLines(const FrameContent& content, const FrameData& data) const {
  if (content.lines.empty()) return;
  line_.Use();
  gl.BindVertexArray(data.lines().get());
  SetDepth(GL_GREATER, false);
  gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(content.lines.size()));
}

void PicturePass::DrawPlainEdges(const Draw& draw, const GpuEdges* edges, const Rgba& color) const {
  if (edges == nullptr || edges->count == 0) return;
  edge_.Use();
  gl.Uniform1f(edge_.uniform("width"), kEdgeWidth);
  SetColor(edge_.uniform("color"), color);
  gl.UniformMatrix4fv(edge_.uniform("world_from_body"), 1, GL_FALSE, draw.X_WB.data());
  gl.BindVertexArray(edges->vao.get());
  SetDepth(GL_GREATER, false);
  gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, edges->count);
}

}  // namespace pregrasp
