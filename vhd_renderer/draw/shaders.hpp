// The GLSL that draw/ is made of.
#pragma once

#include <string>

namespace counterpart {

std::string vertex_shader();
std::string shadow_vertex_shader();
std::string shadow_fragment_shader();

enum class ShadingModel { lit = 1, cutout = 2, unlit = 3, catcher = 4, level = 5, painted = 6 };

// surface_glsl defines surface_colour (see Renderer::add_surface and Shade); empty: colour * texture.
std::string fragment_shader(ShadingModel model, const std::string& surface_glsl);

}  // namespace counterpart
