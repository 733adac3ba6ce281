layout(location = 0) in vec3 position;
layout(location = 2) in vec4 row_x;
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
uniform int layer;

void main() {
  vec4 p = vec4(position, 1.0);
  vec4 p_W = vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1.0);
  vec4 map = shadow_from_world[layer] * p_W;
  gl_Position = vec4(2.0 * map.xy - 1.0, map.z, 1.0);
}
