#include "render/occlusion_pass.h"

#include "render/gl_state.h"

namespace pregrasp {

OcclusionTargets::OcclusionTargets(int w, int h)
    : width(w),
      height(h),
      depth(MakeTexture2D(GL_DEPTH_COMPONENT32F, w, h)),
      normal(MakeTexture2D(GL_RGB10_A2, w, h)),
      raw(MakeTexture2D(GL_R8, w, h)),
      open(MakeTexture2D(GL_R8, w, h)),
      draw(MakeFramebuffer(&normal, &depth)),
      draw_raw(MakeFramebuffer(&raw, nullptr)),
      draw_open(MakeFramebuffer(&open, nullptr)) {}

OcclusionPass::OcclusionPass()
    : empty_(MakeVertexArray()),
      normal_({"frame", "mesh_vert"}, {"frame", "normal_frag"}),
      ground_({"frame", "ground_vert"}, {"frame", "ground_frag"}, {"NORMALS"}),
      occlusion_({"screen_vert"}, {"frame", "view_position", "ssao_frag"}),
      blur_({"screen_vert"}, {"frame", "view_position", "ssao_blur_frag"}) {
  for (const GlProgram* program : {&occlusion_, &blur_}) {
    program->Use();
    program->SetSampler("depths", kOcclusionDepths);
    program->SetSampler("normals", kScratch0);
    program->SetSampler("occlusion", kScratch1);
  }
}

void OcclusionPass::Run(const FrameContent& content, bool ground,
                        const OcclusionTargets& targets) const {
  SetBlend(false);
  SetDepth(GL_GREATER, true);
  gl.Viewport(0, 0, targets.width, targets.height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw.get());
  ClearDepth(0.0F);
  normal_.Use();
  DrawSurfaces(content.solids);
  if (ground) {
    ground_.Use();
    DrawGround(empty_);
  }
  gl.Disable(GL_DEPTH_TEST);
  BindTexture(kOcclusionDepths, GL_TEXTURE_2D, targets.depth.get());
  BindTexture(kScratch0, GL_TEXTURE_2D, targets.normal.get());
  BindTexture(kScratch1, GL_TEXTURE_2D, targets.raw.get());
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw_raw.get());
  occlusion_.Use();
  DrawScreen(empty_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets.draw_open.get());
  blur_.Use();
  DrawScreen(empty_);
  BindTexture(kOcclusionMap, GL_TEXTURE_2D, targets.open.get());
}

}  // namespace pregrasp
