in vec3 v_p;
in vec3 v_n;
flat in vec4 v_color;
flat in vec4 v_surface;
out vec4 pixel;

void main() {
  vec3 n = normalize(mat3(view_from_world) * v_n);
  pixel = vec4((gl_FrontFacing ? n : -n) * 0.5 + 0.5, 1.0);
}
