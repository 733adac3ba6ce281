// BEVEL: a crease catches light as the narrow bevel of a real edge does, or, where one of its faces is
// turned away, is drawn as an outline; it tells where one thing ends before another of its colour.
// Otherwise a plain line.
uniform vec4 color;            // linear; opacity
uniform vec4 surface;
in vec2 v_at;
in vec3 v_p;
flat in vec3 v_n;
flat in float v_outline;
flat in float v_length;
flat in float v_width;
out vec4 pixel;

void main() {
  float alpha = clamp(0.5 * v_width + 0.5 - abs(v_at.y), 0.0, 1.0) * color.a;
#ifdef BEVEL
  alpha *= smoothstep(4.0, 16.0, v_length / tuning.z);
  float facing = dot(v_n, to_light.xyz);
  float shadow = smoothstep(0.02, 0.2, facing) * Shadow(facing > 0.0, v_p, v_n);
  vec3 light = Lit(v_p, v_n, color.rgb, surface.x, surface.y, shadow, 1.0);
  vec3 bevel = Display(1.12 * light + 0.06 + 0.10 * shadow), outline = Display(0.22 * color.rgb);
  pixel = vec4(mix(bevel, outline, v_outline), mix(alpha, 0.6 * alpha, v_outline));
#else
  pixel = vec4(Display(color.rgb), alpha);
#endif
}
