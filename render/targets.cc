#include "render/targets.h"

#include "app/core/check.h"

namespace pregrasp {
namespace {

GlFramebuffer Attached(const GlTexture* color, const GlTexture* depth) {
  GlFramebuffer framebuffer = MakeFramebuffer();
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  if (color != nullptr) {
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color->get(), 0);
  }
  if (depth != nullptr) {
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth->get(), 0);
  }
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  PREGRASP_CHECK(status == GL_FRAMEBUFFER_COMPLETE, status);
  return framebuffer;
}

GlFramebuffer AttachedLayer(GLenum attachment, const GlTexture& array, int layer) {
  GlFramebuffer framebuffer = MakeFramebuffer();
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  gl.FramebufferTextureLayer(GL_FRAMEBUFFER, attachment, array.get(), 0, layer);
  if (attachment == GL_DEPTH_ATTACHMENT) {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
  }
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  PREGRASP_CHECK(status == GL_FRAMEBUFFER_COMPLETE, status);
  return framebuffer;
}

void SetLinear(GLenum target) {
  gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace

TileTargets::TileTargets(int w, int h, int n)
    : width(w),
      height(h),
      samples(n),
      color(MakeTexture2D(GL_RGBA8, w, h, n)),
      depth(MakeTexture2D(GL_DEPTH_COMPONENT32F, w, h, n)),
      draw(Attached(&color, &depth)) {
  if (samples > 0) {
    resolved = MakeTexture2D(GL_RGBA8, w, h);
    read = Attached(&resolved, nullptr);
  }
}

ShadowTargets::ShadowTargets(int n)
    : size(n),
      map(MakeTextureArray(GL_DEPTH_COMPONENT32F, n, kShadowLayers)),
      blockers(MakeTextureArray(GL_R32F, n / 4, kShadowLayers)) {
  SetLinear(GL_TEXTURE_2D_ARRAY);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, map.get());
  SetLinear(GL_TEXTURE_2D_ARRAY);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    draw[layer] = AttachedLayer(GL_DEPTH_ATTACHMENT, map, layer);
    draw_blockers[layer] = AttachedLayer(GL_COLOR_ATTACHMENT0, blockers, layer);
  }
}

OcclusionTargets::OcclusionTargets(int w, int h)
    : width(w),
      height(h),
      depth(MakeTexture2D(GL_DEPTH_COMPONENT32F, w, h)),
      normal(MakeTexture2D(GL_RGB10_A2, w, h)),
      raw(MakeTexture2D(GL_R8, w, h)),
      open(MakeTexture2D(GL_R8, w, h)),
      draw(Attached(&normal, &depth)),
      draw_raw(Attached(&raw, nullptr)),
      draw_open(Attached(&open, nullptr)) {}

}  // namespace pregrasp
