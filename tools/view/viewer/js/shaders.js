// Light as in the software renderer (tools/view/render/detail/shade.cpp): a warm key light with a
// red terminator, a cool fill, sky and ground, a rim, a filmic curve. At the edges of triangles
// values are taken inside of them (centroid), else thin parts such as the rims of lips get dark
// specks.

const VERSION = '#version 300 es\n';

const PLACE = `
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
uniform mat3 turn;
uniform vec3 shift;
uniform mat4 view;
`;

export const HEAD_VERTEX = `${VERSION}${PLACE}
layout(location = 2) in vec4 paint;
layout(location = 3) in float heat;
layout(location = 4) in vec3 rest;
layout(location = 5) in vec2 skin;
centroid out vec3 grain;
centroid out vec2 rough;
centroid out vec3 at;
centroid out vec3 facing;
centroid out vec3 albedo;
centroid out float sky;
centroid out float warmth;
const mat3 GRAIN = mat3(0.8365, 0.1303, -0.5323, 0.0, 0.9713, 0.2377, 0.5480, -0.1988, 0.8125) /
    0.512;
vec3 linear(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, vec3(lessThanEqual(c, vec3(0.04045))));
}
void main() {
  at = turn * place + shift;
  facing = turn * normal;
  albedo = linear(paint.rgb);
  sky = paint.a;
  warmth = heat;
  // It lies oblique, so that no surface shows how it repeats.
  grain = GRAIN * rest;
  rough = (skin - vec2(128, 0)) / 127.0;
  gl_Position = view * vec4(at, 1);
}`;

export const HEAD_FRAGMENT = `${VERSION}
precision highp float;
precision highp sampler3D;
centroid in vec3 grain;
centroid in vec2 rough;
uniform sampler3D grains;
centroid in vec3 at;
centroid in vec3 facing;
centroid in vec3 albedo;
centroid in float sky;
centroid in float warmth;
uniform vec3 eye, back, key, fill, rim;
uniform vec3 wrap;
uniform float shine, rimShare, gloss;
uniform int sharpness;
uniform bool eyeball;
uniform vec4 tint;
uniform float opacity;
out vec4 colour;

const vec3 KEY = vec3(2.35, 2.20, 2.0);
const vec3 FILL = vec3(0.34, 0.42, 0.54);
const vec3 SKY = vec3(0.46, 0.48, 0.52);
const vec3 GROUND = vec3(0.26, 0.22, 0.20);
const vec3 RIM = vec3(0.85, 0.92, 1.0);

vec3 wrapped(float cosine, vec3 share) {
  vec3 v = max((cosine + share) / (1.0 + share), 0.0);
  return v * (0.35 + 0.65 * v);
}
float power(float base, int squarings) {
  for (int i = 0; i < squarings; ++i) base *= base;
  return base;
}
vec3 filmic(vec3 x) {
  x = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x,
      vec3(lessThanEqual(x, vec3(0.0031308))));
}
float highlight(vec3 n) {
  float k = max(dot(n, normalize(key + back)), 0.0);
  return (235.0 * smoothstep(0.972, 0.983, k) + 30.0 * power(k, 5)) / 255.0;
}
vec3 lit(vec3 n, vec3 surface) {
  vec3 toEye = normalize(eye - at);
  float cosine = dot(n, key);
  float open = 0.25 + 0.75 * sky;
  vec3 light = KEY * wrapped(cosine, wrap) * open;
  light += (FILL * wrapped(dot(n, fill), vec3(0.3)) + mix(GROUND, SKY, 0.5 + 0.5 * n.y)) *
      vec3(sqrt(max(sky, 0.0)), sky, sky);
  vec3 c = surface * light;
  float edge = 1.0 - max(dot(n, toEye), 0.0);
  c += RIM * (rimShare * edge * edge * edge * max(dot(n, rim) + 0.25, 0.0) * sky);
  float half_ = max(dot(n, normalize(key + toEye)), 0.0);
  vec3 shade = mix(vec3(1.0), surface * 6.0, gloss);
  c += KEY * shade * (shine * rough.y * power(half_, sharpness) * open * max(cosine, 0.0));
  return c * 0.62;
}
vec3 heatColour(float t) {
  return t < 0.5 ? mix(vec3(0.34, 0.38, 0.43), vec3(0.95, 0.70, 0.08), t * 2.0) :
      mix(vec3(0.95, 0.75, 0.10), vec3(0.85, 0.03, 0.03), t * 2.0 - 1.0);
}
void main() {
  vec3 n = facing / max(length(facing), 1e-6);
  vec3 surface = warmth >= 0.0 ? heatColour(min(warmth, 1.0)) : mix(albedo, tint.rgb, tint.a);
  vec3 shown = filmic(lit(n, surface));
  // The upper lid is between the eye and the light.
  if (eyeball) shown = shown * (1.0 - 0.4 * smoothstep(0.0, 0.42, n.y)) + highlight(n);
  vec2 relief = (texture(grains, grain).rg * 255.0 - 128.0) / 128.0;
  shown *= 1.0 + 0.09 * abs(rough.x) * (rough.x < 0.0 ? relief.y : relief.x);
  colour = vec4(clamp(shown, 0.0, 1.0), opacity);
}`;

export const LINE_VERTEX = `${VERSION}${PLACE}
out float side;
uniform vec3 eye;
void main() {
  vec3 at = turn * place + shift;
  side = dot(turn * normal, eye - at);
  gl_Position = view * vec4(at, 1);
}`;

export const LINE_FRAGMENT = `${VERSION}
precision highp float;
in float side;
uniform vec4 ink;
out vec4 colour;
void main() {
  if (side < 0.0) discard;
  colour = ink;
}`;

/** How a material answers to light: how far it goes around, red first; strength and exponent
    2^sharpness of the highlight; rim; how much the highlight takes the colour of the surface. */
export const LOOKS = {
  skin: {wrap: [0.42, 0.22, 0.16], shine: 0.10, sharpness: 4, rim: 0.22},
  eye: {wrap: [0.25, 0.22, 0.20], shine: 0, sharpness: 1, rim: 0},
  teeth: {wrap: [0.2, 0.2, 0.2], shine: 0.35, sharpness: 5, rim: 0},
  wet: {wrap: [0.3, 0.15, 0.1], shine: 0.25, sharpness: 5, rim: 0},
  hair: {wrap: [0.15, 0.12, 0.10], shine: 0.14, sharpness: 4, rim: 0.3, gloss: 0.85},
  cloth: {wrap: [0.15, 0.15, 0.15], shine: 0.02, sharpness: 3, rim: 0.12},
};
