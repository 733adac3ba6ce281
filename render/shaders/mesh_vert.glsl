layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row_x;
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 color;
layout(location = 6) in vec4 surface;

#ifdef TRANSLUCENT
uniform float nearer;  // share of the distance
#endif

invariant gl_Position;
out vec3 v_p;
out vec3 v_n;
flat out vec4 v_color;
flat out vec4 v_surface;

void main() {
  vec4 p = vec4(position, 1.0);
  v_p = vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
  // Rows of the cofactor matrix turn normals, also where the instance is scaled.
  v_n = vec3(dot(cross(row_y.xyz, row_z.xyz), normal), dot(cross(row_z.xyz, row_x.xyz), normal),
             dot(cross(row_x.xyz, row_y.xyz), normal));
  v_color = color;
  v_surface = surface;
  gl_Position = clip_from_world * vec4(v_p, 1.0);
#ifdef TRANSLUCENT
  gl_Position.z *= 1.0 + nearer;  // reversed depth
#endif
}
