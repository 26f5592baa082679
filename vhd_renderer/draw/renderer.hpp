// Draws meshes as one camera sees them, off screen, into a picture with alpha. It knows nothing of humans, boards or
// games. One renderer belongs to the thread that made it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/figure.hpp"
#include "vhd_renderer/draw/mesh.hpp"
#include "vhd_renderer/draw/view.hpp"

namespace counterpart {

enum class MeshId : std::uint32_t {};
enum class TextureId : std::uint32_t { white = 0 };

// How a surface answers the light. Further ones come from `add_surface`.
enum class SurfaceId : std::uint32_t {
  lit = 0,      // colour * texture under the light, shadowed; alpha 1
  cutout = 1,   // the same, and texels with alpha < 0.5 are holes
  unlit = 2,    // colour * texture as it is
  catcher = 3,  // stands for a real thing: hides what is behind, is black (the key colour), and its alpha says how much
                // the shadows of the drawn things darken it
};

// How a surface of one's own is lit.
enum class Shade {
  lit,    // by the light's direction and shadows; surface_colour gives linear colour
  unlit,  // not at all; linear colour
  level,  // faces z of B: direct light is the same all over, one look tells the shadow; surface_colour gives the
          // colour's square root
  painted,  // not at all; the square root, as a texture holds it. What is cheapest
};

struct Material {
  SurfaceId surface = SurfaceId::lit;
  TextureId texture = TextureId::white;
  Eigen::Vector3f colour{1, 1, 1};  // linear
  float gloss = 0.1f;               // 0..1, strength of the highlight
  float polish = 24;                // exponent of the highlight
  bool double_sided = false;
};

struct DrawItem {
  MeshId mesh{};
  Material material;
  std::vector<Eigen::Affine3f> X_BO{Eigen::Affine3f::Identity()};  // an instance each; rotation and even scale only
  bool casts_shadow = true;
  bool visible = true;  // false: only its shadow is drawn
};

struct Lighting {
  Eigen::Vector3f direction_B{0.3f, 0.4f, 0.85f};  // towards the light, any length
  Eigen::Vector3f colour{1, 1, 1};                 // linear; 1 = a white surface facing it is white
  Eigen::Vector3f ambient_up{0.35f, 0.35f, 0.38f};
  Eigen::Vector3f ambient_down{0.2f, 0.18f, 0.16f};
  Eigen::Vector3f shadow_centre_B{0, 0, 0};  // shadows are computed inside this sphere
  float shadow_radius_m = 0.6f;              // 0: no shadows
  float softness_m = 0.006f;                 // width of a shadow's edge
};

// The colour (its square root) by which the light multiplies a white surface that faces B's z, out of every shadow:
// what Shade::level gives there.
Eigen::Vector3f level_light(const Lighting& lighting);

struct DrawOptions {
  Eigen::Vector4f background{0, 0, 0, 0};  // b, g, r, a; 0..1
  bool depth = false;
  std::optional<cv::Rect> box;  // draw and read back only this part of the picture
};

struct Drawing {
  cv::Mat bgra;     // CV_8UC4, whole picture size; outside the box nothing is touched (background)
  cv::Mat depth_m;  // CV_32FC1, z in C, +inf where nothing is; only if asked for
};

class Renderer {
 public:
  // width, height: pixels, 1..8192. shadow_size: texels a side of the shadow map.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> create(int width, int height, int shadow_size = 1024);
  ~Renderer();

  int width() const;
  int height() const;
  const std::string& description() const;  // of the OpenGL in use

  // Indices must be in range; fails with invalid_argument otherwise.
  [[nodiscard]] Result<MeshId> add_mesh(const MeshData& mesh);

  // New places for all vertices of a mesh, for what is skinned on the CPU. Sizes must be those of `add_mesh`.
  void update_mesh(MeshId mesh, std::span<const Eigen::Vector3f> positions_m, std::span<const Eigen::Vector3f> normals);

  TextureId add_texture(const Texture& texture);

  // glsl defines `vec3 surface_colour(vec2 uv, vec3 p_O, vec3 colour)`: linear colour of a point before light, from the
  // mesh's uv, the point in the mesh's own frame and the material's colour. It may use `uniform sampler2D image` (the
  // material's texture, encoded: square it) and `uniform vec4 parameters`. Empty glsl: texture times colour.
  [[nodiscard]] Result<SurfaceId> add_surface(const std::string& glsl, Shade shade = Shade::lit);
  void set_parameters(SurfaceId surface, const Eigen::Vector4f& parameters);

  // In the order given: near things first spare the work on what they hide.
  Drawing draw(const View& view, const Lighting& lighting, std::span<const DrawItem> items,
               const DrawOptions& options = {});

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
