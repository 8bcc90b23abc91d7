#include "src/view/render/shaders.h"

namespace tutu::app::shaders {

const char* const k_preamble = R"glsl(#version 330 core
uniform mat4 clip_from_world;
uniform vec3 eye;
uniform vec2 picture; // pixels
uniform vec2 picture_corner; // of the picture in the framebuffer, pixels
uniform float pixel_scale; // of these make one of the finished picture, in each direction
)glsl";

const char* const k_fragment_preamble = R"glsl(
const vec3 k_key_colour = vec3(0.92, 0.88, 0.82); // warm
const vec3 k_fill_colour = vec3(0.13, 0.15, 0.19); // cool
const vec3 k_rim_colour = vec3(0.55, 0.57, 0.62);
const vec3 k_fill_direction = vec3(0.777, 0.291, 0.558); // from low on the other side of the key

// Half a step of noise against banding: interleaved gradient noise [Jimenez 2014], the same all over a finished pixel.
vec3 dither(vec3 s) {
  float noise = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy / pixel_scale), vec2(0.06711056, 0.00583715))));
  return s + (noise - 0.5) / 255.0;
}

// Linear light to sRGB, highlights rolled off softly above 0.8.
vec3 encode(vec3 c) {
  vec3 over = max(c - 0.8, 0.0);
  c = min(c, 0.8) + 0.2 * over / (over + 0.2);
  return dither(mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)));
}

// The studio's paper: bright behind the subject, a little darker towards the corners. It fills most of a picture, so it
// is painted in sRGB straight away, and so is the floor: neither needs light added up.
vec3 backdrop() {
  vec2 p = (gl_FragCoord.xy - picture_corner - vec2(0.5, 0.54) * picture) / picture.y;
  float r = min(dot(p, p) * 0.95, 1.0);
  return mix(vec3(0.906, 0.910, 0.918), vec3(0.722, 0.740, 0.775), r * (2.0 - r));
}
)glsl";

const char* const k_surface_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 colour;
uniform mat4 light_from_world; // to texture space of the shadow map, 0..1 in all axes
uniform float offset;          // m outwards
uniform float shadow_bias;     // m outwards, for the look-up only
uniform int first_back;        // vertices from this one on are the sheet's back
out vec3 v_world, v_normal, v_colour, v_light;
out float v_back;
void main() {
  v_world = position + offset * normal;
  v_normal = normal;
  v_colour = colour;
  v_back = gl_VertexID >= first_back ? 1.0 : 0.0;
  v_light = (light_from_world * vec4(v_world + shadow_bias * normal, 1.0)).xyz;
  gl_Position = clip_from_world * vec4(v_world, 1.0);
}
)glsl";

const char* const k_surface_fragment = R"glsl(
in vec3 v_world, v_normal, v_colour, v_light;
in float v_back;
uniform vec3 key_direction; // towards the light
uniform vec3 rim_direction; // towards the light behind the subject
uniform float ground_height;
uniform float texel; // of the shadow map
uniform float sheen;
uniform sampler2DShadow shadow_map;
out vec4 result;

// 3 x 3 bilinear taps: a soft edge about six texels wide.
float key_visibility() {
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) sum += texture(shadow_map, v_light + vec3(1.8 * texel * vec2(x, y), 0.0));
  return sum / 9.0;
}

void main() {
  vec3 view = normalize(eye - v_world);
  float squared = dot(v_normal, v_normal);
  vec3 n = squared > 1e-6 ? v_normal * inversesqrt(squared) : view; // it vanishes midway around a hem
  vec3 albedo = v_colour * mix(1.0, 0.62, v_back);

  float facing = clamp(dot(n, view), 0.0, 1.0);
  float edge = 1.0 - facing;
  float visible = key_visibility();

  // Light wraps a little around the form, so that the terminator is soft.
  float key = clamp((dot(n, key_direction) + 0.15) / 1.15, 0.0, 1.0) * visible;
  float fill = 0.5 + 0.5 * dot(n, k_fill_direction);
  // Light from above and its return from the bright floor; the key's shadow stands in for occlusion.
  float up = 0.5 + 0.5 * n.y;
  float low = clamp((v_world.y - ground_height) * 2.5, 0.0, 1.0);
  vec3 ambient = mix(vec3(0.215, 0.205, 0.200), vec3(0.330, 0.345, 0.370), up);
  ambient *= mix(0.72, 1.0, visible) * mix(0.80, 1.0, low);

  vec3 halfway = normalize(key_direction + view);
  float shine = max(dot(n, halfway), 0.0);
  shine *= shine; shine *= shine; // ^4
  float broad = shine * shine * shine; // ^12
  float tight = broad * broad * broad; // ^36
  float rim = edge * edge * edge * clamp(0.35 + dot(n, rim_direction), 0.0, 1.0);

  // What reaches a shaded place has met the surface before, so shadows are deeper in colour than lights.
  vec3 deep = albedo * albedo / max(max(albedo.r, max(albedo.g, albedo.b)), 1e-3);
  vec3 light = mix(albedo, deep, 0.4) * (ambient + k_fill_colour * fill) + albedo * k_key_colour * key;
  light += k_rim_colour * rim * mix(albedo, vec3(1.0), 0.25) * mix(1.0, 0.5, v_back);
  light += k_key_colour * visible * (0.045 * tight + 0.02 * broad);
  // Silk: a broad highlight in the cloth's own colour and a bright grazing edge.
  vec3 gloss = mix(albedo, vec3(1.0), 0.15);
  light += sheen * gloss * (0.22 * broad * visible + 0.22 * edge * edge * (0.35 + 0.65 * visible));
  result = vec4(encode(light), 1.0);
}
)glsl";

const char* const k_wire_fragment = R"glsl(
in vec3 v_world, v_normal, v_colour, v_light;
in float v_back;
out vec4 result;
void main() { result = vec4(encode(v_colour * 0.18), 0.6); }
)glsl";

const char* const k_depth_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform float offset;
void main() { gl_Position = clip_from_world * vec4(position + offset * normal, 1.0); }
)glsl";

const char* const k_depth_fragment = R"glsl(
void main() {}
)glsl";

const char* const k_fullscreen_vertex = R"glsl(
out vec2 v_uv;
void main() {
  v_uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(2.0 * v_uv - 1.0, 1.0, 1.0);
}
)glsl";

// What the shadow map says about the floor. Red: the key light is blocked. Green: so is it, by something near the
// floor.
const char* const k_ground_mask_fragment = R"glsl(
in vec2 v_uv;
uniform mat4 light_from_world;
uniform vec3 corner;       // world position of the mask's uv 0
uniform float size;        // m, the mask's side
uniform float depth_range; // m, along the light, from 0 to 1 of the map
uniform float rise;        // m of height per m along the light
uniform float shadow_radius; // in uv of the shadow map
uniform sampler2D shadow_depth;
out vec4 result;
void main() {
  vec3 world = corner + size * vec3(v_uv.x, 0.0, v_uv.y);
  vec3 here = (light_from_world * vec4(world, 1.0)).xyz;
  vec2 inside = step(0.0, here.xy) * step(here.xy, vec2(1.0));
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    vec2 shift = shadow_radius * vec2((i & 1) - 0.5, (i >> 1) - 0.5);
    float depth = texture(shadow_depth, here.xy + shift).r;
    float gap = here.z - depth;
    float height = max(gap, 0.0) * depth_range * rise;
    sum += step(1e-5, gap) * step(depth, 0.9999) * vec2(1.0, exp2(-9.0 * height));
  }
  result = vec4(sum * 0.25 * inside.x * inside.y, 0.0, 1.0);
}
)glsl";

const char* const k_blur_fragment = R"glsl(
in vec2 v_uv;
uniform vec2 pitch; // uv between taps
uniform sampler2D image;
out vec4 result;
void main() {
  // Gaussian of standard deviation 1.3 taps.
  vec2 sum = vec2(0.0);
  float total = 0.0;
  for (int i = -3; i <= 3; ++i) {
    float weight = exp(-0.3 * float(i * i));
    sum += weight * texture(image, v_uv + float(i) * pitch).rg;
    total += weight;
  }
  result = vec4(sum / total, 0.0, 1.0);
}
)glsl";

const char* const k_backdrop_fragment = R"glsl(
in vec2 v_uv;
out vec4 result;
void main() { result = vec4(dither(backdrop()), 1.0); }
)glsl";

const char* const k_ground_vertex = R"glsl(
uniform vec3 centre;
uniform float radius;
out vec2 v_plane; // m from the centre
void main() {
  vec2 side = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  v_plane = side * radius;
  gl_Position = clip_from_world * vec4(centre + vec3(v_plane.x, 0.0, -v_plane.y), 1.0);
}
)glsl";

const char* const k_ground_fragment = R"glsl(
in vec2 v_plane;
uniform vec2 mask_scale, mask_shift; // plane to mask uv
uniform float pool;                  // m, radius of the pool of light
uniform sampler2D near_mask, wide_mask;
out vec4 result;
void main() {
  vec2 uv = v_plane * mask_scale + mask_shift;
  vec2 close = texture(near_mask, uv).rg;
  vec2 wide = texture(wide_mask, uv).rg;
  // Sharp where the blocker touches the floor, soft where it is high above.
  float contact = clamp(close.g / max(close.r, 0.02), 0.0, 1.0);
  float key = mix(wide.r, max(wide.r, close.r), contact);
  float occlusion = clamp(1.6 * wide.g + 0.35 * close.g, 0.0, 1.0);
  vec3 paper = backdrop();
  float d = dot(v_plane, v_plane) / (pool * pool);
  float glow = 1.0 / (1.0 + d * d);
  vec3 floor_colour = mix(paper * 0.968, vec3(0.925, 0.925, 0.928), 0.75 * glow);
  floor_colour = mix(paper, floor_colour, clamp(3.0 - 0.5 * d, 0.0, 1.0));
  floor_colour *= 1.0 - key * vec3(0.245, 0.233, 0.210);
  floor_colour *= 1.0 - occlusion * vec3(0.225, 0.220, 0.205);
  result = vec4(dither(floor_colour), 1.0);
}
)glsl";

const char* const k_capsule_vertex = R"glsl(
layout(location = 0) in vec4 unit; // point of the unit sphere, and which end it belongs to: 0 = a, 1 = b
layout(location = 1) in vec3 end_a;
layout(location = 2) in vec3 end_b;
layout(location = 3) in vec2 radii; // at a and b
layout(location = 4) in vec3 colour;
out vec3 v_world, v_normal, v_colour;
void main() {
  vec3 axis = end_b - end_a;
  float len = length(axis);
  axis = len > 1e-9 ? axis / len : vec3(0.0, 1.0, 0.0);
  vec3 other = abs(axis.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 u = normalize(cross(other, axis));
  // The equators slide to where the cone touches the balls: a ball's latitudes shrink on one side and grow on the other.
  float lean = clamp((radii.y - radii.x) / max(len, 1e-9), -1.0, 1.0);
  float latitude = asin(clamp(unit.y, -1.0, 1.0)), rim = -asin(lean), quarter = asin(1.0);
  latitude = unit.w < 0.5 ? rim + latitude * (1.0 + rim / quarter) : rim + latitude * (1.0 - rim / quarter);
  vec2 round = unit.xz / max(length(unit.xz), 1e-9);
  v_normal = cos(latitude) * (round.x * u + round.y * cross(u, axis)) + sin(latitude) * axis;
  v_world = mix(end_a, end_b, unit.w) + mix(radii.x, radii.y, unit.w) * v_normal;
  v_colour = colour;
  gl_Position = clip_from_world * vec4(v_world, 1.0);
}
)glsl";

const char* const k_capsule_fragment = R"glsl(
in vec3 v_world, v_normal, v_colour;
uniform vec3 key_direction;
uniform vec2 opacity; // facing the eye, at the outline
out vec4 result;
void main() {
  vec3 n = normalize(v_normal);
  float facing = clamp(dot(n, normalize(eye - v_world)), 0.0, 1.0);
  float edge = 1.0 - facing;
  float outline = smoothstep(0.62, 0.92, edge);
  vec3 body = v_colour * (0.55 + 0.55 * max(dot(n, key_direction), 0.0));
  vec3 c = mix(body, v_colour * 0.30, outline);
  result = vec4(encode(c), mix(opacity.x, opacity.y, max(outline, edge * edge)));
}
)glsl";

const char* const k_line_vertex = R"glsl(
layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
layout(location = 2) in vec3 colour;
layout(location = 3) in vec2 widths; // at a and b, times half_width
uniform float half_width; // pixels, without the soft edge
uniform float nearer;     // of the depth: before the sheet whose middle it is
out vec3 v_colour;
noperspective out vec2 v_across; // pixels: from the middle, half the width
void main() {
  vec4 from = clip_from_world * vec4(a, 1.0), to = clip_from_world * vec4(b, 1.0);
  // Cut at the near plane, where the division below loses its meaning.
  float from_near = from.z + from.w, to_near = to.z + to.w;
  if (from_near < 0.0 && to_near > 0.0) from = mix(from, to, from_near / (from_near - to_near));
  if (to_near < 0.0 && from_near > 0.0) to = mix(to, from, to_near / (to_near - from_near));
  vec2 along = (to.xy / to.w - from.xy / from.w) * picture;
  float len = length(along);
  along = len > 1e-6 ? along / len : vec2(1.0, 0.0);
  float wide = half_width * (gl_VertexID < 2 ? widths.x : widths.y);
  float side = (gl_VertexID & 1) == 0 ? -wide - 1.0 : wide + 1.0;
  vec4 end = gl_VertexID < 2 ? from : to;
  float outwards = min(wide, half_width) * (gl_VertexID < 2 ? -1.0 : 1.0);
  vec2 shift = vec2(-along.y, along.x) * side + along * outwards;
  v_across = vec2(side, wide);
  v_colour = colour;
  gl_Position = max(from_near, to_near) <= 0.0 ? vec4(2.0, 2.0, 2.0, 1.0)
                                               : vec4(end.xy + 2.0 * shift / picture * end.w, end.z - nearer * end.w, end.w);
}
)glsl";

const char* const k_line_fragment = R"glsl(
in vec3 v_colour;
noperspective in vec2 v_across;
out vec4 result;
void main() { result = vec4(encode(v_colour), clamp(v_across.y + 0.5 - abs(v_across.x), 0.0, 1.0)); }
)glsl";

const char* const k_point_vertex = R"glsl(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 colour;
uniform float radius;          // m
uniform float pixels_per_unit; // at distance 1
uniform float least;           // pixels across
out float v_size;
out vec3 v_colour;
void main() {
  v_colour = colour;
  gl_Position = clip_from_world * vec4(position, 1.0);
  gl_Position.z -= 2e-4 * gl_Position.w; // before the sheet whose middle it is
  v_size = max(2.0 * radius * pixels_per_unit / max(gl_Position.w, 1e-3), least);
  gl_PointSize = v_size + 1.0;
}
)glsl";

const char* const k_point_fragment = R"glsl(
in float v_size;
in vec3 v_colour;
out vec4 result;
void main() {
  float r = length(gl_PointCoord - 0.5) * (v_size + 1.0);
  float shade = mix(1.25, 0.7, clamp(length(gl_PointCoord - vec2(0.38, 0.34)) * 1.6, 0.0, 1.0));
  result = vec4(encode(v_colour * shade), clamp(0.5 * v_size + 0.5 - r, 0.0, 1.0));
}
)glsl";

} // namespace tutu::app::shaders
