#include "render/hand_bodies.h"

#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {

void AddHand(RenderScene& scene, const HandModel& hand, const HandConfiguration& configuration,
             const std::array<bool, kNumFingers>& touching) {
  const auto X_WL = CalcLinkPoses(hand, configuration);
  for (const HandShape& shape : ShapesOf(hand)) {
    const auto& [r, g, b, a] = shape.rgba;
    Rgba color{r, g, b, a};
    const std::optional<Finger> finger = hand.FingerOf(shape.link);
    if (finger && touching[static_cast<int>(*finger)]) color = FingerColor(*finger);
    RenderBody body;
    body.mesh = shape.mesh;
    body.X_WB = X_WL[shape.link];
    scene.bodies.push_back(WithLook(body, color, 0.45F));
  }
}

}  // namespace pregrasp
