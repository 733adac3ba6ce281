// Soft shadows by percentage-closer filtering whose width follows the distance of what blocks the
// light (Fernando, "Percentage-closer soft shadows", 2005). The taps lie on one fixed spiral, enough
// of them that each step of a penumbra is below what eight bits show after the hardware's bilinear
// comparison: no noise, so no grain. Depths are compared along the receiver's own plane, which keeps
// wide filters free of self-shadowing without lifting shadows off what casts them.
//
// The software rasteriser runs both sides of a branch, but leaves a loop once no pixel of its block is
// in it: so whether to look at all is part of the loops' bounds. (An array of taps would tell the
// compiler how long the loops can be, and it would unroll them.)
uniform sampler2DArrayShadow shadow_map;
uniform sampler2DArray blocker_map;  // nearest of 4 x 4 texels
uniform sampler2DArray clear_map;    // nearest of 16 x 16 texels and 64 around them

// Vogel's spiral: each tap is the last one turned by the golden angle, evenly dense over the disc.
const mat2 kTurn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);

// How much of the light reaches p, on a surface with geometric normal n. 1: all, also if not wanted.
float Shadow(bool wanted, vec3 p, vec3 n) {
  // How much depth along the light grows per metre across the map, on the plane of the surface.
  vec2 slope = vec2(dot(n, map_x.xyz), dot(n, map_y.xyz)) / max(dot(n, to_light.xyz), 0.05);
  slope *= min(1.0, 16.0 / max(length(slope), 1e-6));
  float steepness = abs(slope.x) + abs(slope.y);
  bool level = steepness < 1e-3;

  vec3 at = (shadow_from_world[0] * vec4(p, 1.0)).xyz;
  int layer = max(abs(at.x - 0.5), abs(at.y - 0.5)) < 0.46 ? 0 : 1;
  if (layer == 1) at = (shadow_from_world[1] * vec4(p, 1.0)).xyz;
  wanted = wanted && max(abs(at.x - 0.5), abs(at.y - 0.5)) < 0.5;
  float width = shadow_width[layer], depth = shadow_width[2 + layer];
  float texel = width / tuning.w;
  float receiver = at.z * depth;
  float most = clamp(SHADOW_REACH * target.w, 12.0 * texel, 48.0 * texel);

  // On a level receiver one look tells most pixels that nothing can be in the way.
  ivec3 cell = ivec3(at.xy * tuning.w / 16.0, layer);
  float nearest = texelFetch(clear_map, clamp(cell, ivec3(0), textureSize(clear_map, 0) - 1), 0).r;
  wanted = wanted && !(level && nearest * depth >= receiver - 0.2 * texel);

  // Mean distance of what lies nearer the light, over all that could matter.
  float blockers = 0.0, weights = 0.0;
  float bias = 4.2 * texel * steepness + 0.2 * texel;
  float search = level ? float(SHADOW_SEARCH) : float(SHADOW_SEARCH) / 2.0;
  vec2 turned = vec2(1.0, 0.0);
  int count = wanted ? int(search) : 0;
  for (int i = 0; i < count; ++i) {
    vec2 offset = most * sqrt((float(i) + 0.7) / search) * turned;
    turned = kTurn * turned;
    float z = textureLod(blocker_map, vec3(at.xy + offset / width, layer), 0.0).r * depth;
    float gap = receiver + dot(slope, offset) - z - bias;
    float weight = clamp(gap / (0.5 * texel), 0.0, 1.0);
    blockers += weight * gap;
    weights += weight;
  }
  // On a steep receiver near blockers drown in the bias of this search: there the narrowest filter
  // looks for them. It needs few taps, as the hardware's comparison is two texels wide by itself.
  bool none = weights == 0.0 && level;
  float radius = weights > 0.0 ? to_light.w * blockers / weights : 0.0;
  radius = clamp(radius, 1.5 * texel, most);
  // Blocked all over the search: in full shadow, unless the filter reaches as far as the search does,
  // whose blockers are 4 texels wider than they should be.
  bool all = weights > search - 0.01 && radius < most - 6.0 * texel;
  int taps = weights == 0.0 ? 5 : radius < 2.0 * texel ? min(8, SHADOW_TAPS) : SHADOW_TAPS;

  bias = 1.02 * texel * steepness + 0.15 * texel;
  float lit = 0.0;
  count = wanted && !none && !all ? taps : 0;
  for (int i = 0; i < count; ++i) {
    vec2 offset = radius * sqrt((float(i) + 0.5) / float(taps)) * turned;
    turned = kTurn * turned;
    // A surface that bends up beside the receiver by 20 degrees is no blocker.
    float bend = 0.36 * (length(offset) + texel);
    float z = (receiver + dot(slope, offset) - bias - bend) / depth;
    lit += texture(shadow_map, vec4(at.xy + offset / width, layer, min(z, 1.0)));
  }
  return !wanted || none ? 1.0 : all ? 0.0 : lit / float(taps);
}
