#include "render/hand_bodies.h"

#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {

void AddHand(RenderScene& scene, const HandConfiguration& hand,
             const std::array<bool, kNumFingers>& touching) {
  const auto X_WL = CalcLinkPoses(ShadowHand(), hand);
  for (const HandShape& shape : ShadowHandShapes()) {
    const auto& [r, g, b, a] = shape.rgba;
    Rgba color{r, g, b, a};
    for (int f = 0; f < kNumFingers; ++f) {
      const Finger finger = static_cast<Finger>(f);
      if (touching[f] && shape.link == DistalLink(finger)) color = FingerColor(finger);
    }
    RenderBody body;
    body.mesh = shape.mesh;
    body.X_WB = X_WL[shape.link];
    scene.bodies.push_back(WithLook(body, color, 0.45F));
  }
}

}  // namespace pregrasp
