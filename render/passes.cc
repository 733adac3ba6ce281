#include "render/passes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pregrasp {
namespace {

// Texture units; each is used for one thing only.
enum Unit {
  kShadowMap = 0,
  kBlockerMap,
  kOcclusionMap,
  kOcclusionDepths,
  kFaceColors,
  kScratch0,
  kScratch1
};

void BindTexture(int unit, GLenum target, GLuint name) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(target, name);
}

void SetBlend(bool on) {
  if (on) {
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    gl.Disable(GL_BLEND);
  }
}

void SetDepth(GLenum func, bool write) {
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(func);
  gl.DepthMask(write ? GL_TRUE : GL_FALSE);
}

void SetColorWrites(bool on) {
  const GLboolean value = on ? GL_TRUE : GL_FALSE;
  gl.ColorMask(value, value, value, value);
}

void ClearDepth(float value) {
  gl.DepthMask(GL_TRUE);
  gl.ClearBufferfv(GL_DEPTH, 0, &value);
}

Rgba Darker(const Rgba& color, float share, float alpha) {
  return {share * color.r, share * color.g, share * color.b, alpha};
}

}  // namespace

Passes::Lighting::Lighting(RenderQuality quality) {
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
    program->SetSampler("occlusion_map", kOcclusionMap);
    program->SetSampler("occlusion_depths", kOcclusionDepths);
    program->SetSampler("face_colors", kFaceColors);
  }
}

Passes::Passes()
    : empty_(MakeVertexArray()),
      line_vao_(MakeVertexArray()),
      frame_(MakeBuffer()),
      lines_(MakeBuffer()),
      face_color_buffer_(MakeBuffer()) {
  shadow_ = GlProgram({"frame", "shadow_vert"}, {"depth_frag"});
  depth_ = GlProgram({"frame", "mesh_vert"}, {"depth_frag"});
  blockers_ = GlProgram({"screen_vert"}, {"blockers_frag"});
  normal_ = GlProgram({"frame", "mesh_vert"}, {"frame", "normal_frag"});
  ground_normal_ = GlProgram({"frame", "ground_vert"}, {"frame", "ground_frag"}, {"NORMALS"});
  occlusion_ = GlProgram({"screen_vert"}, {"frame", "ssao_frag"});
  occlusion_blur_ = GlProgram({"screen_vert"}, {"frame", "ssao_blur_frag"});
  background_ = GlProgram({"screen_vert"}, {"frame", "light", "background_frag"});
  ghost_ = GlProgram({"frame", "mesh_vert"}, {"frame", "light", "ghost_frag"});
  flat_ = GlProgram({"frame", "mesh_vert"}, {"frame", "light", "ghost_frag"}, {"FLAT"});
  line_ = GlProgram({"frame", "line_vert"}, {"frame", "light", "line_frag"});
  edge_ = GlProgram({"frame", "edge_vert"}, {"frame", "light", "edge_frag"});
  blockers_.Use();
  blockers_.SetSampler("depths", kShadowMap);
  for (const GlProgram* program : {&occlusion_, &occlusion_blur_}) {
    program->Use();
    program->SetSampler("depths", kOcclusionDepths);
    program->SetSampler("normals", kScratch0);
    program->SetSampler("occlusion", kScratch1);
  }
  for (const GlProgram* program : {&ghost_, &flat_}) {
    program->Use();
    program->SetSampler("face_colors", kFaceColors);
  }
  GLuint name = 0;
  gl.GenTextures(1, &name);
  face_colors_ = GlTexture(name);
  gl.BindVertexArray(line_vao_.get());
  gl.BindBuffer(GL_ARRAY_BUFFER, lines_.get());
  const std::array<std::pair<int, std::size_t>, 4> parts = {{{3, offsetof(LinePiece, p)},
                                                             {3, offsetof(LinePiece, q)},
                                                             {4, offsetof(LinePiece, color)},
                                                             {1, offsetof(LinePiece, width)}}};
  for (GLuint slot = 0; slot < parts.size(); ++slot) {
    gl.EnableVertexAttribArray(slot);
    gl.VertexAttribPointer(slot, parts[slot].first, GL_FLOAT, GL_FALSE, sizeof(LinePiece),
                           reinterpret_cast<const void*>(parts[slot].second));
    gl.VertexAttribDivisor(slot, 1);
  }
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

const Passes::Lighting& Passes::LightingOf(RenderQuality quality) {
  auto& lighting = lighting_[static_cast<int>(quality)];
  if (!lighting) lighting = std::make_unique<Lighting>(quality);
  return *lighting;
}

void Passes::Begin(const FrameContent& content, const MeshCache& cache) {
  Upload(cache.instances(), GL_ARRAY_BUFFER, content.instances);
  Upload(lines_, GL_ARRAY_BUFFER, content.lines);
  auto colors = content.face_colors;
  if (colors.empty()) colors.push_back({});
  Upload(face_color_buffer_, GL_TEXTURE_BUFFER, colors);
  BindTexture(kFaceColors, GL_TEXTURE_BUFFER, face_colors_.get());
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, face_color_buffer_.get());
}

void Passes::SetFrame(const FrameBlock& frame) {
  Upload(frame_, GL_UNIFORM_BUFFER, std::vector<FrameBlock>{frame});
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.get());
}

void Passes::DrawSurfaces(const std::vector<Draw>& draws) {
  for (const Draw& draw : draws) {
    gl.BindVertexArray(draw.surface->vao.get());
    gl.DrawElementsInstancedBaseInstance(GL_TRIANGLES, draw.surface->index_count, GL_UNSIGNED_INT,
                                         nullptr, draw.count, static_cast<GLuint>(draw.first));
  }
}

void Passes::DrawShadows(const FrameContent& content, const ShadowTargets& targets) {
  SetBlend(false);
  SetDepth(GL_LESS, true);
  gl.Enable(GL_DEPTH_CLAMP);
  gl.Viewport(0, 0, targets.size, targets.size);
  shadow_.Use();
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw[layer].get());
    ClearDepth(1.0F);
    gl.Uniform1i(shadow_.uniform("layer"), layer);
    DrawSurfaces(content.solids);
  }
  gl.Disable(GL_DEPTH_CLAMP);

  gl.Disable(GL_DEPTH_TEST);
  gl.Viewport(0, 0, targets.size / 4, targets.size / 4);
  gl.BindVertexArray(empty_.get());
  blockers_.Use();
  BindTexture(kShadowMap, GL_TEXTURE_2D_ARRAY, targets.map.get());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw_blockers[layer].get());
    gl.Uniform1i(blockers_.uniform("layer"), layer);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  }
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  BindTexture(kBlockerMap, GL_TEXTURE_2D_ARRAY, targets.blockers.get());
}

void Passes::DrawOcclusion(const FrameContent& content, const OcclusionTargets& targets,
                           bool ground) {
  SetBlend(false);
  SetDepth(GL_GREATER, true);
  gl.Viewport(0, 0, targets.width, targets.height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw.get());
  ClearDepth(0.0F);
  normal_.Use();
  DrawSurfaces(content.solids);
  if (ground) {
    gl.Enable(GL_CULL_FACE);
    ground_normal_.Use();
    gl.BindVertexArray(empty_.get());
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl.Disable(GL_CULL_FACE);
  }
  gl.Disable(GL_DEPTH_TEST);
  gl.BindVertexArray(empty_.get());
  BindTexture(kOcclusionDepths, GL_TEXTURE_2D, targets.depth.get());
  BindTexture(kScratch0, GL_TEXTURE_2D, targets.normal.get());
  BindTexture(kScratch1, GL_TEXTURE_2D, targets.raw.get());
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw_raw.get());
  occlusion_.Use();
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw_open.get());
  occlusion_blur_.Use();
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  BindTexture(kOcclusionMap, GL_TEXTURE_2D, targets.open.get());
}

void Passes::DrawTile(const FrameContent& content, RenderQuality quality, const TileTargets& tile,
                      const ShadowTargets& /*shadows*/, const OcclusionTargets* /*occlusion*/,
                      bool ground, const std::array<int, 4>& viewport) {
  const Lighting& lighting = LightingOf(quality);
  gl.BindFramebuffer(GL_FRAMEBUFFER, tile.draw.get());
  gl.Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  ClearDepth(0.0F);
  gl.Disable(GL_DEPTH_TEST);
  SetBlend(false);
  background_.Use();
  gl.BindVertexArray(empty_.get());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);

  // Depths first: lighting costs far more than geometry, and is then paid once a pixel.
  SetColorWrites(false);
  SetDepth(GL_GREATER, true);
  depth_.Use();
  DrawSurfaces(content.solids);
  DrawSurfaces(content.annotations);
  SetColorWrites(true);
  SetDepth(GL_EQUAL, false);
  lighting.solid.Use();
  DrawSurfaces(content.solids);
  DrawSurfaces(content.annotations);
  SetDepth(GL_GREATER, true);
  SetBlend(true);
  if (ground) {
    // Seen from below there is no floor: it would hide everything.
    gl.Enable(GL_CULL_FACE);
    lighting.ground.Use();
    gl.BindVertexArray(empty_.get());
    gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    gl.Disable(GL_CULL_FACE);
  }
  SetDepth(GL_GREATER, false);
  DrawBevels(content, lighting.bevel);
  for (const Draw& draw : content.solids) {
    if (draw.all_edges != nullptr) {
      DrawPlainEdges(draw, *draw.all_edges, Darker(draw.color, 0.15F, 0.75F), 1.1F);
    }
  }
  SetDepth(GL_LESS, false);
  ghost_.Use();
  gl.Uniform1f(ghost_.uniform("strength"), 0.25F);
  DrawSurfaces(content.arrows);
  DrawGhosts(content);
  DrawCones(content);
  DrawLines(content);
  DrawOverlays(content);
}

// Sorted from far to near. Of each body only the nearest layer shows: a pass that writes depth
// alone comes first.
void Passes::DrawGhosts(const FrameContent& content) {
  for (const Draw& draw : content.ghosts) {
    SetColorWrites(false);
    SetDepth(GL_GREATER, true);
    ghost_.Use();
    DrawSurfaces({draw});
    SetColorWrites(true);
    SetDepth(GL_EQUAL, false);
    gl.Uniform1f(ghost_.uniform("strength"), 1.0F);
    DrawSurfaces({draw});
    SetDepth(GL_GREATER, false);
    const GpuEdges* edges = draw.all_edges != nullptr ? draw.all_edges : draw.creases;
    if (edges != nullptr) {
      const float alpha = std::min(1.0F, 1.8F * draw.color.a);
      DrawPlainEdges(draw, *edges, Darker(draw.color, 0.6F, alpha), 1.2F);
    }
  }
}

void Passes::DrawCones(const FrameContent& content) {
  ghost_.Use();
  gl.Enable(GL_CULL_FACE);
  for (const Draw& draw : content.cones) {
    // Parts inside bodies stay visible, fainter.
    for (const auto& [func, strength] : {std::pair(GL_LESS, 0.45F), std::pair(GL_GREATER, 1.0F)}) {
      SetDepth(static_cast<GLenum>(func), false);
      gl.Uniform1f(ghost_.uniform("strength"), strength);
      for (const GLenum hidden : {GL_FRONT, GL_BACK}) {
        gl.CullFace(hidden);
        DrawSurfaces({draw});
      }
    }
  }
  gl.CullFace(GL_BACK);
  gl.Disable(GL_CULL_FACE);
}

void Passes::DrawLines(const FrameContent& content) {
  if (content.lines.empty()) return;
  line_.Use();
  gl.BindVertexArray(line_vao_.get());
  SetDepth(GL_GREATER, false);
  gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(content.lines.size()));
}

// Over everything else, but among themselves the nearest layer hides the rest.
void Passes::DrawOverlays(const FrameContent& content) {
  if (content.overlays.empty()) return;
  ClearDepth(0.0F);
  flat_.Use();
  gl.Uniform1f(flat_.uniform("strength"), 1.0F);
  SetColorWrites(false);
  SetDepth(GL_GREATER, true);
  DrawSurfaces(content.overlays);
  SetColorWrites(true);
  SetDepth(GL_EQUAL, false);
  DrawSurfaces(content.overlays);
  SetDepth(GL_GREATER, false);
  for (const Draw& draw : content.overlays) {
    if (draw.all_edges != nullptr) {
      DrawPlainEdges(draw, *draw.all_edges, Darker(draw.color, 0.4F, draw.color.a), 1.2F);
    }
  }
}

void Passes::DrawBevels(const FrameContent& content, const GlProgram& program) {
  program.Use();
  const float style[4] = {1.5F, 0.0F, 0.0F, 0.0F};
  gl.Uniform4fv(program.uniform("style"), 1, style);
  const GLint model = program.uniform("world_from_body"), color = program.uniform("color"),
              surface = program.uniform("surface");
  for (const Draw& draw : content.solids) {
    if (draw.creases == nullptr || draw.creases->count == 0 || draw.material[2] >= 0.0F) continue;
    const float rgba[4] = {draw.color.r, draw.color.g, draw.color.b, 0.8F};
    gl.Uniform4fv(color, 1, rgba);
    gl.Uniform4fv(surface, 1, draw.material.data());
    gl.UniformMatrix4fv(model, 1, GL_FALSE, draw.X_WB.data());
    gl.BindVertexArray(draw.creases->vao.get());
    gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, draw.creases->count);
  }
}

void Passes::DrawPlainEdges(const Draw& draw, const GpuEdges& edges, const Rgba& color,
                            float width) {
  if (edges.count == 0) return;
  edge_.Use();
  const float style[4] = {width, 0.0F, 0.0F, 0.0F};
  const float rgba[4] = {color.r, color.g, color.b, color.a};
  gl.Uniform4fv(edge_.uniform("style"), 1, style);
  gl.Uniform4fv(edge_.uniform("color"), 1, rgba);
  gl.UniformMatrix4fv(edge_.uniform("world_from_body"), 1, GL_FALSE, draw.X_WB.data());
  gl.BindVertexArray(edges.vao.get());
  gl.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, edges.count);
}

}  // namespace pregrasp
