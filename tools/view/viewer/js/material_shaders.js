// Light on materials, as tools/view/render/detail/material_light.cpp and material_painter.cpp have
// it: glTF's metallic-roughness, VRM's two tones, none.

export const MATERIAL_VERTEX = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 paint;
layout(location = 4) in vec2 uv;
layout(location = 5) in vec3 own;
layout(location = 6) in vec3 resting;
layout(location = 7) in vec4 tinted;
uniform mat3 turn;
uniform vec3 shift;
uniform mat4 view;
uniform bool plain;
out vec3 at;
out vec3 facing;
out vec2 spot;
out vec4 tone;
centroid out float sky;
vec3 linear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}
// The maker's normal turns as that of the mesh does.
vec3 along() {
  float cosine = dot(resting, normal);
  if (dot(own, own) < 0.1 || cosine < -0.9) return normal;
  vec3 axis = cross(resting, normal);
  vec3 across = cross(axis, own);
  return own + across + cross(axis, across) / (1.0 + cosine);
}
void main() {
  at = turn * place + shift;
  facing = turn * along();
  spot = uv;
  tone = vec4(plain ? linear(paint.rgb) : tinted.rgb, tinted.a);
  sky = paint.a;
  gl_Position = view * vec4(at, 1);
}`;

export const MATERIAL_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at;
in vec3 facing;
in vec2 spot;
in vec4 tone;
centroid in float sky;
uniform sampler2D baseMap, normalMap, metalMap, occlusionMap, emissiveMap, shadeMap;
uniform vec3 eye, key, fill, rim;
uniform int shading, alphaMode;
uniform bool bumpy;
uniform float cutoff, normalScale, metallic, roughness, specular, strength;
uniform vec4 factor;
uniform vec3 emission, shade, rimLight;
uniform float shadeShift, toony, rimPower, rimLift;
uniform vec4 tint;
uniform float opacity;
out vec4 colour;

const vec3 KEY = vec3(0.86, 0.82, 0.76);
const vec3 FILL = vec3(0.16, 0.20, 0.26);
const vec3 RIM = vec3(0.26, 0.28, 0.31);
const vec3 ABOVE = vec3(0.40, 0.41, 0.43);
const vec3 BELOW = vec3(0.25, 0.23, 0.22);

struct Surface { vec3 diffuse, shine; float edge, alpha; vec3 n, v; float facing; };

vec3 lamp(Surface s, vec3 l, vec3 light) {
  float nl = clamp(dot(s.n, l), 0.0, 1.0);
  vec3 h = normalize(l + s.v);
  float nh = clamp(dot(s.n, h), 0.0, 1.0);
  float square = s.alpha * s.alpha;
  float bump = nh * nh * (square - 1.0) + 1.0;
  float shadow = 0.5 / max(nl * sqrt(square + (1.0 - square) * s.facing * s.facing) +
      s.facing * sqrt(square + (1.0 - square) * nl * nl), 1e-6);
  float fresnel = pow(1.0 - clamp(dot(s.v, h), 0.0, 1.0), 5.0);
  vec3 mirror = mix(s.shine, vec3(s.edge), fresnel);
  float below = 1.0 - mix(0.04 * specular, s.edge, fresnel);
  return (s.diffuse * below + mirror * (square / (bump * bump) * shadow)) * light * nl;
}
vec3 skyAt(vec3 d) { return mix(BELOW, ABOVE, 0.5 + 0.5 * d.y); }

// Khronos PBR Neutral.
vec3 neutral(vec3 c) {
  float low = min(c.r, min(c.g, c.b));
  c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
  float peak = max(c.r, max(c.g, c.b));
  if (peak < 0.76) return c;
  float top = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
  return mix(c * (top / peak), vec3(top), 1.0 - 1.0 / (0.15 * (peak - top) + 1.0));
}

// Tangents by derivatives, so that of the facet; a back is turned as a whole.
vec3 bumped(vec3 n, float side) {
  vec3 texel = texture(normalMap, spot).xyz * 2.0 - 1.0;
  vec3 q0 = dFdx(at), q1 = dFdy(at);
  vec2 s0 = dFdx(spot), s1 = dFdy(spot);
  vec3 second = cross(q1, n), first = cross(n, q0);
  vec3 right = second * s0.x + first * s1.x;
  vec3 down = second * s0.y + first * s1.y;
  float most = max(dot(right, right), dot(down, down));
  if (!(most > 0.0)) return n;
  float scale = side * inversesqrt(most) * normalScale;
  return normalize(right * (texel.x * scale) - down * (texel.y * scale) + n * texel.z);
}
vec3 srgb(vec3 x) {
  x = clamp(x, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x,
      vec3(lessThanEqual(x, vec3(0.0031308))));
}
vec3 lit(vec3 albedo, vec3 n, vec3 v, vec3 glow) {
  vec3 metal = texture(metalMap, spot).rgb;
  float share = metallic * metal.b;
  float rough = clamp(roughness * metal.g, 0.045, 1.0);
  Surface s = Surface(albedo * (1.0 - share), mix(vec3(0.04 * specular), albedo, share),
      specular * (1.0 - share) + share, rough * rough, n, v, clamp(dot(n, v), 0.0, 1.0));
  float open = clamp(3.5 * sky, 0.0, 1.0);
  vec3 depth = vec3(sqrt(open), open, open);
  float occlusion = 1.0 + strength * (texture(occlusionMap, spot).r - 1.0);
  vec3 c = (lamp(s, key, KEY) + lamp(s, rim, RIM)) * (0.25 + 0.75 * open) +
      lamp(s, fill, FILL) * depth;
  c += (s.diffuse * skyAt(n) + s.shine * skyAt(reflect(-v, n)) * share) * depth * occlusion;
  return neutral(c + glow);
}
vec3 toon(vec3 albedo, vec3 n, vec3 v, vec3 glow) {
  float edge = 1.0 - toony;
  float level = dot(n, key) + shadeShift;
  float light = edge > 0.0 ? clamp((level + edge) / (2.0 * edge), 0.0, 1.0) : step(0.0, level);
  float grazing = clamp(1.0 - dot(n, v) + rimLift, 0.0, 1.0);
  return mix(shade * tone.rgb * texture(shadeMap, spot).rgb, albedo, light) + glow +
      rimLight * pow(grazing, max(rimPower, 1e-3));
}
void main() {
  vec4 base = texture(baseMap, spot) * factor * tone;
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 n = facing / max(length(facing), 1e-6) * side;
  if (bumpy) n = bumped(n, side);
  if (alphaMode == 1 && base.a < cutoff) discard;
  vec3 v = normalize(eye - at);
  vec3 albedo = mix(base.rgb, tint.rgb, tint.a);
  vec3 glow = emission * texture(emissiveMap, spot).rgb;
  vec3 shown = shading == 0 ? lit(albedo, n, v, glow) :
      shading == 1 ? albedo : toon(albedo, n, v, glow);
  colour = vec4(srgb(shown), (alphaMode == 2 ? clamp(base.a, 0.0, 1.0) : 1.0) * opacity);
}`;
