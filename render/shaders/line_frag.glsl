in vec2 v_at;
flat in float v_length;
flat in float v_width;
flat in vec4 v_color;
out vec4 pixel;

void main() {
  vec2 outside = vec2(max(max(-v_at.x, v_at.x - v_length), 0.0), v_at.y);
  float alpha = clamp(0.5 * v_width + 0.5 - length(outside), 0.0, 1.0);
  pixel = vec4(Display(v_color.rgb), v_color.a * alpha);
}
