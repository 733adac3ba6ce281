in vec3 v_p;
out vec4 pixel;

// How much of this pixel lies on a grid line of the given spacing, faded out where cells shrink to a
// few pixels.
float Grid(float spacing, float width_px) {
  vec2 at = v_p.xy / spacing;
  vec2 pixel_size = max(fwidth(at), vec2(1e-6));
  vec2 away = abs(fract(at - 0.5) - 0.5) / pixel_size;
  vec2 line = clamp(0.5 * width_px + 0.5 - away, 0.0, 1.0);
  line *= smoothstep(vec2(4.0), vec2(14.0), 1.0 / pixel_size);
  return max(line.x, line.y);
}

void main() {
#ifdef NORMALS
  pixel = vec4((mat3(view_from_world) * vec3(0.0, 0.0, 1.0)) * 0.5 + 0.5, 1.0);
#else
  float away = length(v_p.xy - target.xy) / ground.w;
  float width = max(1.0, 1.1 * tuning.z);
  float line = max(0.10 * Grid(ground.y, width), 0.22 * Grid(10.0 * ground.y, 1.3 * width));
  vec3 albedo = mix(vec3(0.70, 0.71, 0.72), vec3(0.22, 0.25, 0.30), line);
  vec3 up = vec3(0.0, 0.0, 1.0);
  float shadow = Shadow(away < 1.0, v_p, up);
  vec3 light = Lit(v_p, up, albedo, 0.9, 0.0, shadow, Openness());
  pixel = vec4(Display(light), 1.0 - smoothstep(0.25, 0.9, away));
#endif
}
