uniform samplerBuffer face_colors;
uniform float strength;        // multiplies opacity
in vec3 v_p;
in vec3 v_n;
flat in vec4 v_color;
flat in vec4 v_surface;
out vec4 pixel;

void main() {
  vec3 n = normalize(v_n);
  if (!gl_FrontFacing) n = -n;
  vec3 albedo = v_color.rgb;
  if (v_surface.z >= 0.0) albedo = texelFetch(face_colors, int(v_surface.z) + gl_PrimitiveID).rgb;
  // Denser where the surface turns away, as glass is: the shape can be read through itself.
  float rim = 1.0 - abs(dot(n, normalize(eye.xyz - v_p)));
  vec3 light = albedo * (0.55 + 0.25 * n.z + 0.3 * max(dot(n, to_light.xyz), 0.0));
  pixel = vec4(Display(light), clamp(v_color.a * (0.8 + 0.9 * rim * rim), 0.0, 1.0) * strength);
}
