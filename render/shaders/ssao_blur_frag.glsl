uniform sampler2D occlusion;
uniform sampler2D depths;
in vec2 v_uv;
out float open;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depths, 0) - 1;
  float depth = tuning.x / max(texelFetch(depths, at, 0).r, 1e-9);
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      ivec2 tap = clamp(at + ivec2(x, y), ivec2(0), last);
      float other = tuning.x / max(texelFetch(depths, tap, 0).r, 1e-9);
      float w = clamp(2.0 - abs(other - depth) / (0.25 * tuning.y), 0.001, 1.0);
      sum += w * texelFetch(occlusion, tap, 0).r;
      weights += w;
    }
  }
  open = sum / weights;
}
