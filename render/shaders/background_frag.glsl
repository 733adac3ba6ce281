in vec2 v_uv;
out vec4 pixel;

void main() {
  float height = (gl_FragCoord.y + picture.w) / picture.y;
  pixel = vec4(Background(height), 1.0);
}
