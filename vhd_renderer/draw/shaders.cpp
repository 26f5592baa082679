#include "vhd_renderer/draw/shaders.hpp"

namespace counterpart {
namespace {

// Colours are encoded with a square root: as good as sRGB to the eye and one instruction.
const char* const kVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texture_place;
layout(location = 3) in vec4 X_BO_row0;
layout(location = 4) in vec4 X_BO_row1;
layout(location = 5) in vec4 X_BO_row2;
uniform mat4 X_CB;
uniform mat4 clip_from_camera;
uniform mat4 shadow_from_B;
uniform float k[5];
uniform float usable_r2;
out vec3 p_O;
out vec3 p_B;
out vec3 n_B;
out vec3 p_S;
out vec2 uv;

vec2 distort(vec2 xy) {
  float r2 = dot(xy, xy);
  if (r2 > usable_r2) {  // far outside the picture: goes on straight
    float s = sqrt(usable_r2 / r2);
    return distort_inside(xy * s) / s;
  }
  return distort_inside(xy);
}

void main() {
  vec4 p = vec4(position, 1.0);
  p_O = position;
  p_B = vec3(dot(X_BO_row0, p), dot(X_BO_row1, p), dot(X_BO_row2, p));
  n_B = vec3(dot(X_BO_row0.xyz, normal), dot(X_BO_row1.xyz, normal), dot(X_BO_row2.xyz, normal));
  uv = texture_place;
  p_S = (shadow_from_B * vec4(p_B, 1.0)).xyz;
  vec3 p_C = (X_CB * vec4(p_B, 1.0)).xyz;
  if (p_C.z > 0.01) p_C.xy = distort(p_C.xy / p_C.z) * p_C.z;
  gl_Position = clip_from_camera * vec4(p_C, 1.0);
}
)";

const char* const kDistortInside = R"(
vec2 distort_inside(vec2 xy) {
  float r2 = dot(xy, xy);
  float radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return xy * radial + vec2(2.0 * k[2] * xy.x * xy.y + k[3] * (r2 + 2.0 * xy.x * xy.x),
                            k[2] * (r2 + 2.0 * xy.y * xy.y) + 2.0 * k[3] * xy.x * xy.y);
}
)";

const char* const kShadowVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 3) in vec4 X_BO_row0;
layout(location = 4) in vec4 X_BO_row1;
layout(location = 5) in vec4 X_BO_row2;
uniform mat4 shadow_from_B;
void main() {
  vec4 p = vec4(position, 1.0);
  vec4 p_B = vec4(dot(X_BO_row0, p), dot(X_BO_row1, p), dot(X_BO_row2, p), 1.0);
  gl_Position = vec4((shadow_from_B * p_B).xyz * 2.0 - 1.0, 1.0);
}
)";

const char* const kFragmentHead = R"(#version 330 core
in vec3 p_O;
in vec3 p_B;
in vec3 n_B;
in vec3 p_S;
in vec2 uv;
uniform sampler2D image;
uniform sampler2DShadow shadow_map;
uniform vec3 light_direction;
uniform vec3 light_colour;
uniform vec3 ambient_up;
uniform vec3 ambient_down;
uniform vec3 eye_B;
uniform vec3 colour;
uniform vec2 highlight;  // strength, exponent
uniform vec2 shadow_edge;  // half the width of a shadow's edge in the map, depth bias
uniform vec4 parameters;
layout(location = 0) out vec4 drawn;

float in_light() {
  vec3 q = vec3(p_S.xy, p_S.z - shadow_edge.y);
  float e = shadow_edge.x;
  return 0.5 * (texture(shadow_map, q + vec3(-e, -0.5 * e, 0.0)) + texture(shadow_map, q + vec3(e, 0.5 * e, 0.0)));
}

vec3 ambient(vec3 n) { return mix(ambient_down, ambient_up, n.z * 0.5 + 0.5); }
)";

const char* const kPlainSurface = R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec3 texel = texture(image, place).rgb;
  return texel * texel * tint;
}
)";

const char* const kEncodedSurface = R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) { return texture(image, place).rgb * tint; }
)";

// A drawn thing is never quite black: black is the key colour.
const char* const kLit = R"(
void main() {
  CUTOUT
  vec3 albedo = surface_colour(uv, p_O, colour);
  vec3 n = normalize(n_B);
  if (!gl_FrontFacing) n = -n;
  float lambert = dot(n, light_direction);
  vec3 sum = albedo * ambient(n);
  if (lambert > 0.0) {
    vec3 h = normalize(normalize(eye_B - p_B) + light_direction);
    float shine = highlight.x * pow(max(dot(n, h), 0.0), highlight.y);
    sum += (albedo * lambert + shine) * light_colour * in_light();
  }
  drawn = vec4(max(sqrt(sum), 0.004), 1.0);
}
)";

const char* const kUnlit = R"(
void main() { drawn = vec4(max(sqrt(surface_colour(uv, p_O, colour)), 0.004), 1.0); }
)";

const char* const kLevel = R"(
uniform vec3 level_shade;
uniform vec3 level_light;
void main() {
  float light = texture(shadow_map, vec3(p_S.xy, p_S.z - shadow_edge.y));
  drawn = vec4(max(surface_colour(uv, p_O, colour) * mix(level_shade, level_light, light), 0.004), 1.0);
}
)";

const char* const kPainted = R"(
void main() { drawn = vec4(max(surface_colour(uv, p_O, colour), 0.004), 1.0); }
)";

// The direct light is a share of all light here; the picture's numbers are square roots of light.
const char* const kCatcher = R"(
void main() {
  vec3 n = normalize(n_B);
  float direct = max(dot(n, light_direction), 0.0) * light_colour.g;
  float share = direct / (direct + ambient(n).g);
  drawn = vec4(0.0, 0.0, 0.0, 1.0 - sqrt(1.0 - share * (1.0 - in_light())));
}
)";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), with);
  return text;
}

}  // namespace

std::string vertex_shader() {
  return replaced(kVertex, "\nvec2 distort(", std::string(kDistortInside) + "\nvec2 distort(");
}

std::string shadow_vertex_shader() {
  return kShadowVertex;
}

std::string shadow_fragment_shader() {
  return "#version 330 core\nvoid main() {}\n";
}

std::string fragment_shader(ShadingModel model, const std::string& surface_glsl) {
  const bool encoded = model == ShadingModel::level || model == ShadingModel::painted;
  const std::string plain = encoded ? kEncodedSurface : kPlainSurface;
  const std::string head = kFragmentHead + (surface_glsl.empty() ? plain : surface_glsl);
  switch (model) {
    case ShadingModel::lit:
      return head + replaced(kLit, "CUTOUT", "");
    case ShadingModel::cutout:
      return head + replaced(kLit, "CUTOUT", "if (texture(image, uv).a < 0.5) discard;");
    case ShadingModel::unlit:
      return head + kUnlit;
    case ShadingModel::level:
      return head + kLevel;
    case ShadingModel::painted:
      return head + kPainted;
    case ShadingModel::catcher:
      break;
  }
  return head + kCatcher;
}

}  // namespace counterpart
