out vec3 v_p;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_p = vec3(target.xy + corner * ground.w, ground.x);
  gl_Position = clip_from_world * vec4(v_p, 1.0);
  gl_Position.z *= 1.0 - 2e-5;  // a table whose top lies in the floor's plane wins
}
