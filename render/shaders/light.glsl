// One warm key light, two-tone ambient light from sky and floor, a little from the camera. All
// colours are linear until Display.
const float kPi = 3.14159265;
const vec3 kKey = vec3(0.76, 0.72, 0.66);
const vec3 kSky = vec3(0.345, 0.365, 0.40);
const vec3 kFloor = vec3(0.20, 0.185, 0.17);
const vec3 kFill = vec3(0.10, 0.10, 0.105);

vec3 Ambient(vec3 n) { return mix(kFloor, kSky, smoothstep(-1.0, 1.0, n.z)); }

// What a shiny surface sees in direction r: the two tones, and the light as a wide soft box.
vec3 Surroundings(vec3 r, float roughness) {
  float sharp = mix(0.08, 0.6, roughness);
  vec3 tones = mix(kFloor, kSky, smoothstep(-sharp, sharp, r.z));
  float box = smoothstep(0.80 - sharp, 0.86 + 0.2 * sharp, dot(r, to_light.xyz));
  return tones + box * mix(1.4, 0.25, roughness);
}

// GGX with Smith's visibility in Hammon's approximation ("PBR diffuse lighting for GGX", 2017).
float Highlight(float nh, float nl, float nv, float roughness) {
  float a = roughness * roughness;
  float d = nh * nh * (a * a - 1.0) + 1.0;
  return a * a / (kPi * d * d) * 0.5 / max(mix(2.0 * nl * nv, nl + nv, a), 1e-3);
}

vec3 Lit(vec3 p, vec3 n, vec3 albedo, float roughness, float metallic, float shadow, float open) {
  vec3 v = normalize(eye.xyz - p), l = to_light.xyz, h = normalize(v + l);
  float nl = max(dot(n, l), 0.0), nv = max(dot(n, v), 1e-3), nh = max(dot(n, h), 0.0);
  vec3 f0 = mix(vec3(0.04), albedo, metallic);
  vec3 diffuse = albedo * (1.0 - metallic);
  vec3 grazing = f0 + (max(vec3(1.0 - roughness), f0) - f0) * pow(1.0 - nv, 5.0);
  vec3 f = f0 + (1.0 - f0) * pow(1.0 - max(dot(v, h), 0.0), 5.0);
  vec3 key = kKey * nl * shadow;
  vec3 light = diffuse * (key + open * (Ambient(n) + kFill * nv));
  light += key * kPi * 0.5 * f * min(Highlight(nh, nl, nv, max(roughness, 0.12)), 8.0);
  light += open * grazing * Surroundings(reflect(-v, n), roughness) * mix(0.55, 1.0, metallic);
  return light;
}

// Linear light to sRGB.
vec3 Encode(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// The same, with a shoulder above .7 that keeps highlights from clipping.
vec3 Display(vec3 c) {
  vec3 over = max(c - 0.7, 0.0);
  return Encode(min(c, 0.7) + 0.3 * over / (0.3 + over));
}

vec3 Background(float height) {  // 0 at the picture's lower edge, 1 at the upper
  return mix(vec3(0.885, 0.89, 0.895), vec3(0.76, 0.785, 0.815), smoothstep(0.1, 1.0, height));
}
