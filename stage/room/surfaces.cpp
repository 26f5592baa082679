#include "stage/room/surfaces.hpp"

namespace counterpart::stage {

std::string board_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec2 q = at.xy / parameters.y;  // in squares from the centre
  vec2 w = max(abs(dFdx(q)), abs(dFdy(q))) + 1e-4;
  float half_side = 0.5 * parameters.x;
  // A checker filtered over a pixel: the integral of a square wave, per axis. Cells counted from the bottom left whose
  // numbers sum to an even number are played on (row + column from the top left is odd).
  vec2 c = q + half_side;
  vec2 wave = 2.0 * (abs(fract((c - 0.5 * w) * 0.5) - 0.5) - abs(fract((c + 0.5 * w) * 0.5) - 0.5)) / w;
  float played = 0.5 + 0.5 * wave.x * wave.y;
  float dark = mix(1.0 - played, played, parameters.z);
  vec2 cell = floor(c);
  float pick = fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.5453);
  vec2 turned = dark > 0.5 ? at.xy : at.yx;
  vec3 g = texture(image, turned * vec2(5.0, 9.0) + vec2(pick, pick * 7.3)).rgb;
  g *= g;
  vec3 light_wood = vec3(0.70, 0.50, 0.29) * (0.88 + 0.24 * pick);
  vec3 dark_wood = vec3(0.20, 0.092, 0.042) * (0.85 + 0.30 * pick);
  vec3 field = mix(light_wood, dark_wood, dark) * g;
  vec2 inside = clamp((half_side - abs(q)) / w + 0.5, 0.0, 1.0);
  vec3 rim_grain = texture(image, (abs(q.x) > abs(q.y) ? at.yx : at.xy) * vec2(3.0, 10.0) + 0.37).rgb;
  vec3 rim = vec3(0.115, 0.048, 0.024) * rim_grain * rim_grain;
  return mix(rim, field, inside.x * inside.y);
}
)";
}

std::string table_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec3 texel = texture(image, place).rgb;
  return texel * texel * (0.95 - 0.25 * dot(at.xy, at.xy));
}
)";
}

std::string floor_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec3 texel = texture(image, place * vec2(2.0, 2.0)).rgb;
  float sheen = exp(-0.9 * abs(at.x - 1.0)) * smoothstep(1.5, -2.5, at.y);
  float under_table = smoothstep(0.4, 1.1, length((at.xy - vec2(0.0, -0.15)) * vec2(0.9, 1.2)));
  return texel * texel * (0.35 + 0.45 * sheen) * mix(0.35, 1.0, under_table) + 0.05 * sheen;
}
)";
}

std::string wall_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec3 texel = texture(image, place).rgb;
  return texel * texel * 0.85;
}
)";
}

std::string wooden_piece_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  vec3 g = texture(image, at.xy * 14.0).rgb;
  return tint * g * g * 1.35;
}
)";
}

std::string skin_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  float tips = smoothstep(0.10, 0.145, at.x) + smoothstep(-0.030, -0.055, at.z) * 0.6;
  float mottle = sin(at.x * 170.0 + 3.0 * sin(at.y * 210.0)) * sin(at.y * 190.0 + at.z * 160.0);
  float knuckles = exp(-pow((at.x - 0.086) * 90.0, 2.0)) * smoothstep(-0.01, 0.01, at.z);
  vec3 skin = tint * (1.0 + 0.035 * mottle);
  skin = mix(skin, tint * vec3(1.06, 0.80, 0.78), clamp(0.55 * tips + 0.35 * knuckles, 0.0, 0.8));
  return skin;
}
)";
}

}  // namespace counterpart::stage
