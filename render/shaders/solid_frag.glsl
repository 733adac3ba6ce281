uniform samplerBuffer face_colors;
in vec3 v_p;
in vec3 v_n;
flat in vec4 v_color;
flat in vec4 v_surface;
out vec4 pixel;

void main() {
  vec3 face = normalize(cross(dFdx(v_p), dFdy(v_p)));
  vec3 n = normalize(v_n);
  if (!gl_FrontFacing) n = -n;
  if (dot(face, n) < 0.0) face = -face;
  vec3 albedo = v_color.rgb;
  if (v_surface.z >= 0.0) albedo = texelFetch(face_colors, int(v_surface.z) + gl_PrimitiveID).rgb;
  float shadow = 1.0, open = 1.0;
  if (v_surface.w < 0.5) {
    open = Openness();
    // Light that grazes a smooth surface fades before its facets would show in the shadow.
    float fade = smoothstep(0.02, 0.2, dot(n, to_light.xyz));
    shadow = fade * Shadow(fade > 0.0, v_p, face);
  }
  if (v_surface.z >= 0.0) {
    // A legend says what these colours mean: light may shade them a little, never to another one.
    vec3 light = Lit(v_p, n, vec3(0.6), 1.0, 0.0, shadow, open);
    pixel = vec4(Encode(albedo * (0.8 + 0.2 * min(light.g / 0.5, 1.0))), 1.0);
    return;
  }
  pixel = vec4(Display(Lit(v_p, n, albedo, v_surface.x, v_surface.y, shadow, open)), 1.0);
}
