// Scalable ambient obscurance (McGuire, Mara, Luebke 2012): taps on a spiral around the pixel, each
// counted by how far it rises over the tangent plane. The spiral turns by one of 16 angles in a
// 4 x 4 pattern, which the blur that follows averages exactly.
uniform sampler2D depths;
uniform sampler2D normals;
in vec2 v_uv;
out float open;

const int kTaps = 16;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(depths, 0) - 1;
  vec2 size = vec2(last + 1);
  if (texelFetch(depths, at, 0).r <= 0.0) {
    open = 1.0;
    return;
  }
  vec3 p = ViewPosition(depths, at, size);
  vec3 n = texelFetch(normals, at, 0).xyz * 2.0 - 1.0;
  float radius = tuning.y;
  float radius_px = min(radius * 0.5 * size.y / (eye.w * -p.z), 0.25 * size.y);
  int cell = ((at.x & 3) * 4 + (at.y & 3)) * 7 & 15;
  float turn = float(cell) * (6.2831853 / 16.0);
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float share = (float(i) + 0.5 + float(cell & 3) * 0.25 - 0.375) / float(kTaps);
    float angle = turn + float(i) * 2.399963;
    ivec2 tap = clamp(at + ivec2(round(share * radius_px * vec2(cos(angle), sin(angle)))), ivec2(0), last);
    vec3 d = ViewPosition(depths, tap, size) - p;
    float dd = dot(d, d), rise = dot(d, n);
    float fall = max(1.0 - dd / (radius * radius), 0.0);
    sum += fall * fall * max(rise - 0.004 * -p.z * 0.5 - 0.02 * radius, 0.0) / (sqrt(dd) + 0.05 * radius);
  }
  open = clamp(1.0 - 3.4 * sum / float(kTaps), 0.0, 1.0);
}
