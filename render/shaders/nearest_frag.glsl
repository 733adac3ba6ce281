// A sixteenth of a depth map's texels, each the one of 4 x 4 that is nearest the light.
uniform sampler2DArray depths;
uniform int layer;
in vec2 v_uv;
out float nearest;

void main() {
  vec2 size = vec2(textureSize(depths, 0).xy);
  vec2 corner = 4.0 * floor(gl_FragCoord.xy);
  vec4 a = textureGather(depths, vec3((corner + 1.0) / size, layer));
  vec4 b = textureGather(depths, vec3((corner + vec2(3.0, 1.0)) / size, layer));
  vec4 c = textureGather(depths, vec3((corner + vec2(1.0, 3.0)) / size, layer));
  vec4 d = textureGather(depths, vec3((corner + 3.0) / size, layer));
  vec4 m = min(min(a, b), min(c, d));
  nearest = min(min(m.x, m.y), min(m.z, m.w));
}
