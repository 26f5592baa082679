#include "vhd_renderer/draw/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vhd_renderer/draw/gl_context.hpp"
#include "vhd_renderer/draw/gl_objects.hpp"
#include "vhd_renderer/draw/shaders.hpp"

namespace counterpart {
namespace {

struct DrawMesh {
  GlVertexArray array;
  GlBuffer positions, normals, uvs, indices;
  std::size_t vertices = 0;
  GLsizei index_count = 0;
};

struct DrawProgram {
  GlProgram program;
  GLint X_CB, clip_from_camera, shadow_from_B, k, usable_r2, light_direction, light_colour, ambient_up, ambient_down,
      eye_B, colour, highlight, shadow_edge, parameters, level_shade, level_light;
  Eigen::Vector4f parameter_values = Eigen::Vector4f::Zero();
};

constexpr GLenum kImageUnit = 0;
constexpr GLenum kShadowUnit = 1;

DrawProgram with_locations(GlProgram program) {
  const auto at = [id = program.id()](const char* name) { return glGetUniformLocation(id, name); };
  DrawProgram result{std::move(program),
                     at("X_CB"),
                     at("clip_from_camera"),
                     at("shadow_from_B"),
                     at("k"),
                     at("usable_r2"),
                     at("light_direction"),
                     at("light_colour"),
                     at("ambient_up"),
                     at("ambient_down"),
                     at("eye_B"),
                     at("colour"),
                     at("highlight"),
                     at("shadow_edge"),
                     at("parameters"),
                     at("level_shade"),
                     at("level_light")};
  glUseProgram(result.program.id());
  glUniform1i(glGetUniformLocation(result.program.id(), "image"), kImageUnit);
  glUniform1i(glGetUniformLocation(result.program.id(), "shadow_map"), kShadowUnit);
  return result;
}

GlTexture target_texture(GLint format, GLenum layout, GLenum type, int width, int height) {
  GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

// From what the depth buffer holds (0..1) to z in C.
float depth_from_window(float window_depth) {
  if (window_depth >= 1.f) return std::numeric_limits<float>::infinity();
  return static_cast<float>(kFar_m * kNear_m / (kFar_m - static_cast<double>(window_depth) * (kFar_m - kNear_m)));
}

// Takes B to the unit cube of the shadow map.
Eigen::Matrix4f shadow_from_B(const Lighting& lighting, float radius_m) {
  const Eigen::Vector3f z = lighting.direction_B.normalized();
  const Eigen::Vector3f helper = std::abs(z.z()) < 0.9f ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
  const Eigen::Vector3f x = helper.cross(z).normalized();
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.block<1, 3>(0, 0) = x.transpose() / (2 * radius_m);
  m.block<1, 3>(1, 0) = z.cross(x).transpose() / (2 * radius_m);
  m.block<1, 3>(2, 0) = -z.transpose() / (4 * radius_m);
  m.block<3, 1>(0, 3) = Eigen::Vector3f::Constant(0.5f) - m.block<3, 3>(0, 0) * lighting.shadow_centre_B;
  return m;
}

// All that a shadow map depends on, but the places of the vertices.
std::vector<float> shadows_of(const Eigen::Matrix4f& from_B, std::span<const DrawItem> items) {
  std::vector<float> all(from_B.data(), from_B.data() + from_B.size());
  for (const DrawItem& item : items) {
    if (!item.casts_shadow) continue;
    all.push_back(static_cast<float>(item.mesh));
    for (const Eigen::Affine3f& X_BO : item.X_BO) all.insert(all.end(), X_BO.data(), X_BO.data() + 16);
  }
  return all;
}

}  // namespace

Eigen::Vector3f level_light(const Lighting& lighting) {
  const float lambert = std::max(0.f, lighting.direction_B.normalized().z());
  return (lighting.ambient_up + lighting.colour * lambert).cwiseSqrt();
}

struct Renderer::State {
  std::unique_ptr<GlContext> context;  // first, so that it outlives every name below
  int width = 0, height = 0, shadow_size = 0;
  GlTexture colour_target, depth_target, shadow_map;
  GlFramebuffer picture, shadow;
  GlBuffer instances;
  std::vector<DrawMesh> meshes;
  std::vector<GlTexture> textures;
  std::vector<DrawProgram> programs;  // by SurfaceId
  GlProgram shadow_program;
  GLint shadow_program_matrix = -1;
  std::vector<float> instance_rows;
  std::vector<float> shadow_map_shows;  // what it was last drawn from; empty: nothing

  void draw_instances(const DrawItem& item);
  void draw_shadow_map(const Eigen::Matrix4f& from_B, std::span<const DrawItem> items);
  void use(const DrawProgram& program, const View& view, const Lighting& lighting, const Eigen::Matrix4f& from_B,
           float radius_m);
  void draw_picture(const View& view, const Lighting& lighting, const Eigen::Matrix4f& from_B, float radius_m,
                    std::span<const DrawItem> items);
};

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::~Renderer() {
  state_->context->make_current();
}

int Renderer::width() const {
  return state_->width;
}
int Renderer::height() const {
  return state_->height;
}
const std::string& Renderer::description() const {
  return state_->context->description();
}

Result<std::unique_ptr<Renderer>> Renderer::create(int width, int height, int shadow_size) {
  if (width < 1 || height < 1 || width > 8192 || height > 8192 || shadow_size < 1 || shadow_size > 8192) {
    return failure(ErrorCode::invalid_argument, "A picture of " + std::to_string(width) + "x" + std::to_string(height) +
                                                    " cannot be drawn; 1 to 8192 pixels a side can.");
  }
  Result<std::unique_ptr<GlContext>> context = GlContext::create();
  if (!context) return tl::make_unexpected(context.error());

  auto state = std::make_unique<State>(
      State{std::move(*context), width, height, shadow_size,
            target_texture(GL_RGBA8, GL_BGRA, GL_UNSIGNED_BYTE, width, height),
            target_texture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width, height),
            target_texture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, shadow_size, shadow_size)});
  glBindTexture(GL_TEXTURE_2D, state->shadow_map.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  // Outside the map everything is in the light.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const std::array<float, 4> far_away{1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, far_away.data());

  glBindFramebuffer(GL_FRAMEBUFFER, state->picture.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, state->colour_target.id(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, state->depth_target.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, state->shadow.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, state->shadow_map.id(), 0);
  glDrawBuffer(GL_NONE);

  for (const ShadingModel model :
       {ShadingModel::lit, ShadingModel::cutout, ShadingModel::unlit, ShadingModel::catcher}) {
    Result<GlProgram> program = link_program(vertex_shader(), fragment_shader(model, ""));
    if (!program) return tl::make_unexpected(program.error());
    state->programs.push_back(with_locations(std::move(*program)));
  }
  Result<GlProgram> shadow_program = link_program(shadow_vertex_shader(), shadow_fragment_shader());
  if (!shadow_program) return tl::make_unexpected(shadow_program.error());
  state->shadow_program = std::move(*shadow_program);
  state->shadow_program_matrix = glGetUniformLocation(state->shadow_program.id(), "shadow_from_B");

  std::unique_ptr<Renderer> renderer(new Renderer(std::move(state)));
  renderer->add_texture(Texture{1, 1, {255, 255, 255, 255}});
  return renderer;
}

Result<MeshId> Renderer::add_mesh(const MeshData& mesh) {
  const std::size_t vertices = mesh.positions_m.size();
  const bool complete =
      mesh.normals.size() == vertices && mesh.uvs.size() == vertices && mesh.triangles.size() % 3 == 0;
  const bool in_range =
      std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](std::uint32_t index) { return index < vertices; });
  if (!complete || !in_range) {
    return failure(ErrorCode::invalid_argument,
                   "A mesh needs a normal and a uv for every position, and triangles that name existing vertices.");
  }
  state_->context->make_current();
  DrawMesh made;
  made.vertices = vertices;
  made.index_count = static_cast<GLsizei>(mesh.triangles.size());
  glBindVertexArray(made.array.id());
  const auto attribute = [](const GlBuffer& buffer, GLuint location, GLint size, const auto& values) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                 GL_STATIC_DRAW);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableVertexAttribArray(location);
  };
  attribute(made.positions, 0, 3, mesh.positions_m);
  attribute(made.normals, 1, 3, mesh.normals);
  attribute(made.uvs, 2, 2, mesh.uvs);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, made.indices.id());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
               mesh.triangles.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, state_->instances.id());
  for (GLuint row = 0; row < 3; ++row) {
    glVertexAttribPointer(3 + row, 4, GL_FLOAT, GL_FALSE, 12 * sizeof(float),
                          reinterpret_cast<const void*>(row * 4 * sizeof(float)));
    glEnableVertexAttribArray(3 + row);
    glVertexAttribDivisor(3 + row, 1);
  }
  glBindVertexArray(0);
  state_->meshes.push_back(std::move(made));
  return MeshId(static_cast<std::uint32_t>(state_->meshes.size() - 1));
}

void Renderer::update_mesh(MeshId mesh, std::span<const Eigen::Vector3f> positions_m,
                           std::span<const Eigen::Vector3f> normals) {
  const DrawMesh& known = state_->meshes.at(static_cast<std::size_t>(mesh));
  if (positions_m.size() != known.vertices || normals.size() != known.vertices) return;
  state_->shadow_map_shows.clear();
  state_->context->make_current();
  const auto bytes = static_cast<GLsizeiptr>(known.vertices * sizeof(Eigen::Vector3f));
  glBindBuffer(GL_ARRAY_BUFFER, known.positions.id());
  glBufferData(GL_ARRAY_BUFFER, bytes, positions_m.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, known.normals.id());
  glBufferData(GL_ARRAY_BUFFER, bytes, normals.data(), GL_STREAM_DRAW);
}

TextureId Renderer::add_texture(const Texture& texture) {
  state_->context->make_current();
  GlTexture made;
  glBindTexture(GL_TEXTURE_2D, made.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, texture.width, texture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               texture.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  state_->textures.push_back(std::move(made));
  return TextureId(static_cast<std::uint32_t>(state_->textures.size() - 1));
}

Result<SurfaceId> Renderer::add_surface(const std::string& glsl, Shade shade) {
  state_->context->make_current();
  const ShadingModel model = shade == Shade::lit     ? ShadingModel::lit
                             : shade == Shade::unlit ? ShadingModel::unlit
                             : shade == Shade::level ? ShadingModel::level
                                                     : ShadingModel::painted;
  Result<GlProgram> program = link_program(vertex_shader(), fragment_shader(model, glsl));
  if (!program) return tl::make_unexpected(program.error());
  state_->programs.push_back(with_locations(std::move(*program)));
  return SurfaceId(static_cast<std::uint32_t>(state_->programs.size() - 1));
}

void Renderer::set_parameters(SurfaceId surface, const Eigen::Vector4f& parameters) {
  state_->programs.at(static_cast<std::size_t>(surface)).parameter_values = parameters;
}

void Renderer::State::draw_instances(const DrawItem& item) {
  const DrawMesh& mesh = meshes.at(static_cast<std::size_t>(item.mesh));
  instance_rows.clear();
  for (const Eigen::Affine3f& X_BO : item.X_BO) {
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 4; ++col) instance_rows.push_back(X_BO.matrix()(row, col));
    }
  }
  glBindVertexArray(mesh.array.id());
  glBindBuffer(GL_ARRAY_BUFFER, instances.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instance_rows.size() * sizeof(float)), instance_rows.data(),
               GL_STREAM_DRAW);
  glDrawElementsInstanced(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr,
                          static_cast<GLsizei>(item.X_BO.size()));
}

void Renderer::State::draw_shadow_map(const Eigen::Matrix4f& from_B, std::span<const DrawItem> items) {
  std::vector<float> wanted = shadows_of(from_B, items);
  if (wanted == shadow_map_shows) return;  // the camera alone has moved
  shadow_map_shows = std::move(wanted);
  glBindFramebuffer(GL_FRAMEBUFFER, shadow.id());
  glViewport(0, 0, shadow_size, shadow_size);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_CULL_FACE);
  glUseProgram(shadow_program.id());
  glUniformMatrix4fv(shadow_program_matrix, 1, GL_FALSE, from_B.data());
  for (const DrawItem& item : items) {
    if (item.casts_shadow && !item.X_BO.empty()) draw_instances(item);
  }
}

void Renderer::State::use(const DrawProgram& p, const View& view, const Lighting& lighting,
                          const Eigen::Matrix4f& from_B, float radius_m) {
  glUseProgram(p.program.id());
  const Eigen::Matrix4f X_CB = view.X_CB.matrix().cast<float>();
  const Eigen::Matrix4f clip = clip_from_camera(view.intrinsics);
  const Eigen::Vector3f eye = camera_position_B(view).cast<float>();
  const Eigen::Vector3f to_light = lighting.direction_B.normalized();
  std::array<float, 5> k{};
  std::transform(view.intrinsics.dist.begin(), view.intrinsics.dist.end(), k.begin(),
                 [](double value) { return static_cast<float>(value); });
  glUniformMatrix4fv(p.X_CB, 1, GL_FALSE, X_CB.data());
  glUniformMatrix4fv(p.clip_from_camera, 1, GL_FALSE, clip.data());
  glUniformMatrix4fv(p.shadow_from_B, 1, GL_FALSE, from_B.data());
  glUniform1fv(p.k, 5, k.data());
  glUniform1f(p.usable_r2, static_cast<float>(usable_radius_squared(view.intrinsics.dist)));
  glUniform3fv(p.light_direction, 1, to_light.data());
  glUniform3fv(p.light_colour, 1, lighting.colour.data());
  glUniform3fv(p.ambient_up, 1, lighting.ambient_up.data());
  glUniform3fv(p.ambient_down, 1, lighting.ambient_down.data());
  glUniform3fv(p.eye_B, 1, eye.data());
  // Two texels keep a lit surface from shadowing itself.
  const float texel = 1.f / static_cast<float>(shadow_size);
  glUniform2f(p.shadow_edge, std::max(0.5f * texel, lighting.softness_m / (4 * radius_m)), 1.5f * texel);
  glUniform4fv(p.parameters, 1, p.parameter_values.data());
  const Eigen::Vector3f level_shade = lighting.ambient_up.cwiseSqrt();
  const Eigen::Vector3f in_light = level_light(lighting);
  glUniform3fv(p.level_shade, 1, level_shade.data());
  glUniform3fv(p.level_light, 1, in_light.data());
}

void Renderer::State::draw_picture(const View& view, const Lighting& lighting, const Eigen::Matrix4f& from_B,
                                   float radius_m, std::span<const DrawItem> items) {
  glFrontFace(GL_CW);  // rows run downwards: see clip_from_camera
  glCullFace(GL_BACK);
  glActiveTexture(GL_TEXTURE0 + kShadowUnit);
  glBindTexture(GL_TEXTURE_2D, shadow_map.id());
  glActiveTexture(GL_TEXTURE0 + kImageUnit);
  const DrawProgram* in_use = nullptr;
  for (const DrawItem& item : items) {
    if (!item.visible || item.X_BO.empty()) continue;
    const DrawProgram& program = programs.at(static_cast<std::size_t>(item.material.surface));
    if (in_use != &program) use(program, view, lighting, from_B, radius_m);
    in_use = &program;
    if (item.material.double_sided) {
      glDisable(GL_CULL_FACE);
    } else {
      glEnable(GL_CULL_FACE);
    }
    glUniform3fv(program.colour, 1, item.material.colour.data());
    glUniform2f(program.highlight, item.material.gloss, item.material.polish);
    glBindTexture(GL_TEXTURE_2D, textures.at(static_cast<std::size_t>(item.material.texture)).id());
    draw_instances(item);
  }
}

Drawing Renderer::draw(const View& view, const Lighting& lighting, std::span<const DrawItem> items,
                       const DrawOptions& options) {
  State& s = *state_;
  s.context->make_current();
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  const bool shadows = lighting.shadow_radius_m > 0;
  const float radius_m = shadows ? lighting.shadow_radius_m : 1.f;
  const Eigen::Matrix4f from_B = shadow_from_B(lighting, radius_m);
  s.draw_shadow_map(from_B, shadows ? items : std::span<const DrawItem>{});

  const cv::Rect whole(0, 0, s.width, s.height);
  const cv::Rect box = options.box ? (*options.box & whole) : whole;
  const Eigen::Vector4f& b = options.background;
  Drawing drawing;
  drawing.bgra.create(s.height, s.width, CV_8UC4);
  if (box != whole) drawing.bgra = cv::Scalar(b[0], b[1], b[2], b[3]) * 255;
  if (options.depth) {
    drawing.depth_m = cv::Mat(s.height, s.width, CV_32FC1, cv::Scalar(std::numeric_limits<float>::infinity()));
  }
  if (box.empty()) return drawing;

  glBindFramebuffer(GL_FRAMEBUFFER, s.picture.id());
  glViewport(0, 0, s.width, s.height);
  glEnable(GL_SCISSOR_TEST);
  glScissor(box.x, box.y, box.width, box.height);
  glClearColor(b[2], b[1], b[0], b[3]);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  s.draw_picture(view, lighting, from_B, radius_m, items);

  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, s.width);
  glReadPixels(box.x, box.y, box.width, box.height, GL_BGRA, GL_UNSIGNED_BYTE, drawing.bgra.ptr(box.y, box.x));
  if (options.depth) {
    glReadPixels(box.x, box.y, box.width, box.height, GL_DEPTH_COMPONENT, GL_FLOAT, drawing.depth_m.ptr(box.y, box.x));
    for (int row = box.y; row < box.y + box.height; ++row) {
      float* depths = drawing.depth_m.ptr<float>(row);
      std::transform(depths + box.x, depths + box.x + box.width, depths + box.x, depth_from_window);
    }
  }
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  return drawing;
}

}  // namespace counterpart
