// Averages the 4 x 4 pixels that hold one turn of the spiral each, as far as they lie on this pixel's
// plane.
uniform sampler2D occlusion;
uniform sampler2D depths;
uniform sampler2D normals;
in vec2 v_uv;
out float open;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depths, 0) - 1;
  vec2 size = vec2(last + 1);
  vec3 p = ViewPosition(depths, at, size);
  vec3 n = texelFetch(normals, at, 0).xyz * 2.0 - 1.0;
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      ivec2 tap = clamp(at + ivec2(x, y), ivec2(0), last);
      float off = abs(dot(n, ViewPosition(depths, tap, size) - p));
      float w = clamp(2.0 - off / (0.05 * tuning.y), 0.001, 1.0);
      sum += w * texelFetch(occlusion, tap, 0).r;
      weights += w;
    }
  }
  open = sum / weights;
}
