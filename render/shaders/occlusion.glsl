// Ambient occlusion at this pixel from the picture's coarser occlusion buffer: its four nearest
// texels, weighted by how near their surface is to this one, so that nothing bleeds over edges.
uniform sampler2D occlusion_map;
uniform sampler2D occlusion_depths;

float Openness() {
#ifdef OCCLUSION
  vec2 size = vec2(textureSize(occlusion_map, 0));
  vec2 at = (gl_FragCoord.xy + picture.zw) / picture.xy * size - 0.5;
  ivec2 low = ivec2(floor(at)), last = ivec2(size) - 1;
  vec2 f = at - vec2(low);
  float depth = 1.0 / gl_FragCoord.w;
  // As much as the surface itself changes from texel to texel, and a little.
  float tolerance = 1.5 * picture.x / size.x * fwidth(depth) + 0.02 * tuning.y;
  float sum = 0.0, weights = 1e-5;
  for (int i = 0; i < 4; ++i) {
    ivec2 o = ivec2(i & 1, i >> 1);
    ivec2 texel = clamp(low + o, ivec2(0), last);
    float other = tuning.x / max(texelFetch(occlusion_depths, texel, 0).r, 1e-9);
    float near = clamp(2.0 - abs(other - depth) / tolerance, 0.0, 1.0);
    vec2 b = mix(1.0 - f, f, vec2(o));
    float w = (b.x * b.y + 0.02) * (near + 1e-4);
    sum += w * texelFetch(occlusion_map, texel, 0).r;
    weights += w;
  }
  return (sum + 1e-5) / weights;
#else
  return 1.0;
#endif
}
