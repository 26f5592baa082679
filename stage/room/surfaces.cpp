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
  float dark = 0.5 + parameters.z * wave.x * wave.y;
  vec3 wood = texture(image, place).rgb;  // red: light squares, green: dark ones, blue: the rim
  vec3 field = mix(vec3(0.837, 0.707, 0.539) * wood.r, vec3(0.447, 0.303, 0.205) * wood.g, dark);
  vec2 inside = clamp((half_side - abs(q)) / w + 0.5, 0.0, 1.0);
  return mix(vec3(0.339, 0.219, 0.155) * wood.b, field, inside.x * inside.y) * tint;
}
)";
}

std::string wooden_piece_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  float g = texture(image, at.xy * 14.0).r;
  return tint * (g * g * 1.35);
}
)";
}

std::string skin_surface() {
  return R"(
vec3 surface_colour(vec2 place, vec3 at, vec3 tint) {
  float tips = smoothstep(0.125, 0.165, at.x) + 0.6 * (1.0 - smoothstep(-0.055, -0.030, at.z));
  float mottle = sin(at.x * 170.0 + 3.0 * sin(at.y * 210.0)) * sin(at.y * 190.0 + at.z * 160.0);
  float knuckles = exp(-(at.x - 0.089) * (at.x - 0.089) * 8000.0) * smoothstep(-0.01, 0.01, at.z);
  vec3 skin = tint * (1.0 + 0.035 * mottle);
  skin = mix(skin, tint * vec3(1.06, 0.80, 0.78), clamp(0.55 * tips + 0.35 * knuckles, 0.0, 0.8));
  return skin;
}
)";
}

}  // namespace counterpart::stage
