// An edge of a mesh between two faces, drawn if at least one of them faces the camera.
layout(location = 0) in vec3 p;
layout(location = 1) in vec3 q;
layout(location = 2) in vec3 n;
layout(location = 3) in vec3 m;
uniform mat4 world_from_body;
uniform float width;           // [pixels] at 720

out vec2 v_at;
out vec3 v_p;
flat out vec3 v_n;
flat out float v_outline;      // 1: one of the two faces is turned away
flat out float v_length;
flat out float v_width;

void main() {
  vec3 wp = (world_from_body * vec4(p, 1.0)).xyz, wq = (world_from_body * vec4(q, 1.0)).xyz;
  vec3 wn = mat3(world_from_body) * n, wm = mat3(world_from_body) * m;
  vec4 a = clip_from_world * vec4(wp, 1.0), b = clip_from_world * vec4(wq, 1.0);
  float near = tuning.x;
  vec3 to_eye = eye.xyz - wp;
  bool n_seen = dot(wn, to_eye) > 0.0, m_seen = dot(wm, to_eye) > 0.0;
  bool hidden = !n_seen && !m_seen;
  v_outline = n_seen != m_seen ? 1.0 : 0.0;
  if (hidden || (a.w < near && b.w < near)) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  if (a.w < near) {
    float t = (near - a.w) / (b.w - a.w);
    a = mix(a, b, t);
    wp = mix(wp, wq, t);
  }
  if (b.w < near) {
    float t = (near - b.w) / (a.w - b.w);
    b = mix(b, a, t);
    wq = mix(wq, wp, t);
  }
  vec2 to_pixels = 0.5 * picture.xy;
  vec2 pa = a.xy / a.w * to_pixels, pb = b.xy / b.w * to_pixels;
  v_length = length(pb - pa);
  vec2 along = v_length > 1e-4 ? (pb - pa) / v_length : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  v_width = max(width * tuning.z, 1.0);
  v_n = normalize(wn + wm + 1e-6);
  float reach = 0.5 * v_width + 0.5;
  bool end = (gl_VertexID & 1) == 1;
  float side = (gl_VertexID >> 1) == 1 ? 1.0 : -1.0;
  v_at = vec2(end ? v_length : 0.0, side * reach);
  v_p = end ? wq : wp;
  vec4 c = end ? b : a;
  c.xy += across * side * reach / to_pixels * c.w;
  c.z *= 1.0 + 4e-4;
  gl_Position = c;
}
