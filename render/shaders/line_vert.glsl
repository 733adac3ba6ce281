// A segment as a quad across the view, half a pixel wider than the line on each side.
layout(location = 0) in vec3 p;
layout(location = 1) in vec3 q;
layout(location = 2) in vec4 color;
layout(location = 3) in float width;

out vec2 v_at;                 // along and across [pixels]
flat out float v_length;
flat out float v_width;
flat out vec4 v_color;

void main() {
  vec4 a = clip_from_world * vec4(p, 1.0), b = clip_from_world * vec4(q, 1.0);
  // Cut what lies before the near plane, where w is its distance.
  float near = tuning.x;
  if (a.w < near && b.w < near) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 to_pixels = 0.5 * picture.xy;
  vec2 pa = a.xy / a.w * to_pixels, pb = b.xy / b.w * to_pixels;
  float length_px = length(pb - pa);
  vec2 along = length_px > 1e-4 ? (pb - pa) / length_px : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  v_width = max(width * tuning.z, 1.0);
  v_length = length_px;
  v_color = color;
  float reach = 0.5 * v_width + 1.0;
  bool end = (gl_VertexID & 1) == 1;
  float side = (gl_VertexID >> 1) == 1 ? 1.0 : -1.0;
  v_at = vec2(end ? length_px + reach : -reach, side * reach);
  vec4 c = end ? b : a;
  vec2 offset = along * (end ? reach : -reach) + across * side * reach;
  c.xy += offset / to_pixels * c.w;
  c.z *= 1.0 + 2e-4;  // reversed depth: a touch nearer than the surface it lies on
  gl_Position = c;
}
