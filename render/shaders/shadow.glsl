// Soft shadows by percentage-closer filtering whose width follows the distance of what blocks the
// light (Fernando, "Percentage-closer soft shadows", 2005). The taps lie on one fixed spiral, enough
// of them that each step of a penumbra is below what eight bits show after the hardware's bilinear
// comparison: no noise, so no grain. Depths are compared along the receiver's own plane, which keeps
// wide filters free of self-shadowing without lifting shadows off what casts them.
uniform sampler2DArrayShadow shadow_map;
uniform sampler2DArray blocker_map;

// Vogel's spiral: each tap is the last one turned by the golden angle, evenly dense over the disc.
const mat2 kTurn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);

// The software rasteriser runs both sides of a branch but leaves a loop once no pixel of its block is
// in it: so whether to filter at all is part of the loops' bounds. (An array of taps would tell the
// compiler how long the loops can be, and it would unroll them.)
float LayerShadow(bool wanted, int layer, vec3 p, vec2 slope) {
  vec3 at = (shadow_from_world[layer] * vec4(p, 1.0)).xyz;
  float width = shadow_width[layer], depth = shadow_width[2 + layer];
  float texel = width / tuning.w;
  float most = min(SHADOW_REACH * target.w, 48.0 * texel);
  float steepness = abs(slope.x) + abs(slope.y);
  // Mean distance of what lies nearer the light, over all that could matter.
  float receiver = at.z * depth;
  float blockers = 0.0, weights = 0.0;
  float bias = 4.2 * texel * steepness + 0.2 * texel;
  vec2 turned = vec2(1.0, 0.0);
  int count = wanted ? SHADOW_SEARCH : 0;
  for (int i = 0; i < count; ++i) {
    vec2 offset = most * sqrt((float(i) + 0.7) / float(SHADOW_SEARCH)) * turned;
    turned = kTurn * turned;
    float z = textureLod(blocker_map, vec3(at.xy + offset / width, layer), 0.0).r * depth;
    float gap = receiver + dot(slope, offset) - z - bias;
    float weight = clamp(gap / (0.5 * texel), 0.0, 1.0);
    blockers += weight * gap;
    weights += weight;
  }
  // On a steep receiver near blockers drown in the bias of this search: filter there in any case.
  bool none = weights == 0.0 && steepness < 0.2;
  bool all = weights > float(SHADOW_SEARCH) - 0.01;
  float radius = weights > 0.0 ? to_light.w * blockers / weights : 0.0;
  radius = clamp(radius, 1.1 * texel, most);
  bias = steepness * 0.8 * texel + 0.15 * texel;
  float lit = 0.0;
  count = wanted && !none && !all ? SHADOW_TAPS : 0;
  for (int i = 0; i < count; ++i) {
    vec2 offset = radius * sqrt((float(i) + 0.5) / float(SHADOW_TAPS)) * turned;
    turned = kTurn * turned;
    float z = (receiver + dot(slope, offset) - bias) / depth;
    lit += texture(shadow_map, vec4(at.xy + offset / width, layer, min(z, 1.0)));
  }
  return all ? 0.0 : none ? 1.0 : lit / float(SHADOW_TAPS);
}

// How much of the light reaches p, on a surface with geometric normal n. 1: all.
float Shadow(bool wanted, vec3 p, vec3 n) {
  // How much depth along the light grows per metre across the map, on the plane of the surface.
  vec2 slope = vec2(dot(n, map_x.xyz), dot(n, map_y.xyz)) / max(dot(n, to_light.xyz), 0.15);
  slope *= min(1.0, 4.0 / max(length(slope), 1e-6));
  vec2 inner = abs((shadow_from_world[0] * vec4(p, 1.0)).xy - 0.5);
  vec2 outer = abs((shadow_from_world[1] * vec4(p, 1.0)).xy - 0.5);
  float out0 = smoothstep(0.45, 0.47, max(inner.x, inner.y));
  float out1 = smoothstep(0.47, 0.5, max(outer.x, outer.y));
  float lit = LayerShadow(wanted && out0 < 1.0, 0, p, slope);
  float far = LayerShadow(wanted && out0 > 0.0 && out1 < 1.0, 1, p, slope);
  return mix(lit, mix(far, 1.0, out1), out0);
}
