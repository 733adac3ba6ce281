#include "render/hand_bodies.h"

#include <algorithm>

#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

// Without its hue: a blue pad would read as the little finger's contact.
Rgba WithoutHue(const Rgba& color) {
  const float luminance = 0.2126F * color.r + 0.7152F * color.g + 0.0722F * color.b;
  return {luminance, luminance, luminance, color.a};
}

}  // namespace

void AddHand(RenderScene& scene, const HandModel& hand, const HandConfiguration& configuration,
             const std::array<bool, kNumFingers>& touching,
             const std::vector<std::string>& marked_parts) {
  const auto X_WL = CalcLinkPoses(hand, configuration);
  for (const HandShape& shape : ShapesOf(hand)) {
    const auto& [r, g, b, a] = shape.rgba;
    Rgba color{r, g, b, a};
    if (const std::optional<Finger> finger = hand.FingerOf(shape.link)) {
      color = touching[static_cast<int>(*finger)] ? FingerColor(*finger) : WithoutHue(color);
    }
    const std::string& link = hand.links[shape.link].name;
    const bool marked = std::any_of(
        marked_parts.begin(), marked_parts.end(),
        [&](const std::string& part) { return part.substr(0, part.find('/')) == link; });
    if (marked) color = BadColor();
    RenderBody body;
    body.mesh = shape.mesh;
    body.X_WB = X_WL[shape.link];
    scene.bodies.push_back(WithLook(body, color, 0.45F));
  }
}

}  // namespace pregrasp
