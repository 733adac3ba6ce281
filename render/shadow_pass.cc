#include "render/shadow_pass.h"

#include "render/gl_state.h"

namespace pregrasp {
namespace {

void SetLinear() {
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

}  // namespace

ShadowTargets::ShadowTargets(int n)
    : size(n),
      map(MakeTextureArray(GL_DEPTH_COMPONENT32F, n, kShadowLayers)),
      blockers(MakeTextureArray(GL_R32F, n / 4, kShadowLayers)),
      coarse(MakeTextureArray(GL_R32F, n / 16, kShadowLayers)),
      clear(MakeTextureArray(GL_R32F, n / 16, kShadowLayers)) {
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, blockers.get());
  SetLinear();
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, map.get());
  SetLinear();
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    draw[layer] = MakeLayerFramebuffer(GL_DEPTH_ATTACHMENT, map, layer);
    draw_blockers[layer] = MakeLayerFramebuffer(GL_COLOR_ATTACHMENT0, blockers, layer);
    draw_coarse[layer] = MakeLayerFramebuffer(GL_COLOR_ATTACHMENT0, coarse, layer);
    draw_clear[layer] = MakeLayerFramebuffer(GL_COLOR_ATTACHMENT0, clear, layer);
  }
}

ShadowPass::ShadowPass()
    : empty_(MakeVertexArray()),
      depth_({"frame", "shadow_vert"}, {"depth_frag"}),
      nearest_({"screen_vert"}, {"nearest_frag"}),
      spread_({"screen_vert"}, {"spread_frag"}) {
  for (const GlProgram* program : {&nearest_, &spread_}) {
    program->Use();
    program->SetSampler("depths", kScratchArray);
  }
}

void ShadowPass::Run(const FrameContent& content, const ShadowFit& fit,
                     const ShadowTargets& targets) const {
  SetBlend(false);
  SetDepth(GL_LESS, true);
  gl.Enable(GL_DEPTH_CLAMP);
  gl.Viewport(0, 0, targets.size, targets.size);
  depth_.Use();
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw[layer].get());
    ClearDepth(1.0F);
    gl.Uniform1i(depth_.uniform("layer"), layer);
    if (fit.layers[layer].needed) DrawSurfaces(content.solids);
  }
  gl.Disable(GL_DEPTH_CLAMP);

  gl.Disable(GL_DEPTH_TEST);
  BindTexture(kShadowMap, GL_TEXTURE_2D_ARRAY, targets.map.get());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_NONE);
  nearest_.Use();
  Reduce(nearest_, targets.map, targets.draw_blockers, targets.size / 4);
  Reduce(nearest_, targets.blockers, targets.draw_clear, targets.size / 16);
  spread_.Use();
  gl.Uniform2f(spread_.uniform("direction"), 1.0F, 0.0F);
  Reduce(spread_, targets.clear, targets.draw_coarse, targets.size / 16);
  gl.Uniform2f(spread_.uniform("direction"), 0.0F, 1.0F);
  Reduce(spread_, targets.coarse, targets.draw_clear, targets.size / 16);

  BindTexture(kShadowMap, GL_TEXTURE_2D_ARRAY, targets.map.get());
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  BindTexture(kBlockerMap, GL_TEXTURE_2D_ARRAY, targets.blockers.get());
  BindTexture(kClearMap, GL_TEXTURE_2D_ARRAY, targets.clear.get());
}

void ShadowPass::Reduce(const GlProgram& program, const GlTexture& from,
                        const std::array<GlFramebuffer, kShadowLayers>& to, int size) const {
  gl.Viewport(0, 0, size, size);
  BindTexture(kScratchArray, GL_TEXTURE_2D_ARRAY, from.get());
  for (int layer = 0; layer < kShadowLayers; ++layer) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, to[layer].get());
    gl.Uniform1i(program.uniform("layer"), layer);
    DrawScreen(empty_);
  }
}

}  // namespace pregrasp
