#pragma once

#include <vector>

#include "render/frame_content.h"
#include "render/gl.h"

namespace pregrasp {

// State that passes set in full each time, so that none depends on what another left behind.

/// Texture units; each is used for one thing only.
enum TextureUnit {
  kShadowMap = 0,
  kBlockerMap,
  kClearMap,
  kOcclusionMap,
  kOcclusionDepths,
  kFaceColors,
  kScratch0,
  kScratch1,
  kScratchArray
};

inline void BindTexture(TextureUnit unit, GLenum target, GLuint name) {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(target, name);
}

inline void SetBlend(bool on) {
  if (on) {
    gl.Enable(GL_BLEND);
    gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    gl.Disable(GL_BLEND);
  }
}

inline void SetDepth(GLenum func, bool write) {
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(func);
  gl.DepthMask(write ? GL_TRUE : GL_FALSE);
}

inline void SetColorWrites(bool on) {
  const GLboolean value = on ? GL_TRUE : GL_FALSE;
  gl.ColorMask(value, value, value, value);
}

inline void ClearDepth(float value) {
  gl.DepthMask(GL_TRUE);
  gl.ClearBufferfv(GL_DEPTH, 0, &value);
}

inline void DrawSurface(const Draw& draw) {
  gl.BindVertexArray(draw.surface->vao.get());
  gl.DrawElementsInstancedBaseInstance(GL_TRIANGLES, draw.surface->index_count, GL_UNSIGNED_INT,
                                       nullptr, draw.count, static_cast<GLuint>(draw.first));
}

/// Leaves out back faces where nobody can see them.
inline void DrawSurfaces(const std::vector<Draw>& draws) {
  for (const Draw& draw : draws) {
    if (draw.closed) gl.Enable(GL_CULL_FACE);
    DrawSurface(draw);
    if (draw.closed) gl.Disable(GL_CULL_FACE);
  }
}

/// Three vertices without attributes: screen_vert.glsl makes them cover everything.
inline void DrawScreen(const GlVertexArray& empty) {
  gl.BindVertexArray(empty.get());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

/// Four, of which ground_vert.glsl makes the floor. Seen from below there is none: it would hide
/// everything.
inline void DrawGround(const GlVertexArray& empty) {
  gl.Enable(GL_CULL_FACE);
  gl.BindVertexArray(empty.get());
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  gl.Disable(GL_CULL_FACE);
}

}  // namespace pregrasp
