// Where the surface seen by a texel lies, in the camera's axes.
vec3 ViewPosition(sampler2D depths, ivec2 at, vec2 size) {
  float depth = tuning.x / max(texelFetch(depths, at, 0).r, 1e-9);
  vec2 ndc = 2.0 * (vec2(at) + 0.5) / size - 1.0;
  return vec3(ndc * eye.w * vec2(picture.x / picture.y, 1.0), -1.0) * depth;
}
