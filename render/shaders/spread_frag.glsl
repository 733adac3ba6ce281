// The nearest depth within 4 texels along `direction`; once across and once along makes a square.
uniform sampler2DArray depths;
uniform int layer;
uniform vec2 direction;
in vec2 v_uv;
out float nearest;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depths, 0).xy - 1, step = ivec2(direction);
  nearest = 1.0;
  for (int i = -4; i <= 4; ++i) {
    nearest = min(nearest, texelFetch(depths, ivec3(clamp(at + i * step, ivec2(0), last), layer), 0).r);
  }
}
