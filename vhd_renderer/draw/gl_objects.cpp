#include "vhd_renderer/draw/gl_objects.hpp"

#include <array>

namespace counterpart {
namespace {

struct ShaderKind {
  static GLuint make() { return 0; }
  static void drop(GLuint id) { glDeleteShader(id); }
};
using GlShader = GlObject<ShaderKind>;

Result<GlShader> compile(GLenum kind, const std::string& source) {
  GlShader shader(glCreateShader(kind));
  const char* text = source.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint ok = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  std::array<char, 1024> log{};
  glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return failure(ErrorCode::internal, std::string("A shader does not compile: ") + log.data());
}

}  // namespace

Result<GlProgram> link_program(const std::string& vertex_source, const std::string& fragment_source) {
  Result<GlShader> vertex = compile(GL_VERTEX_SHADER, vertex_source);
  if (!vertex) return tl::make_unexpected(vertex.error());
  Result<GlShader> fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
  if (!fragment) return tl::make_unexpected(fragment.error());
  GlProgram program;
  glAttachShader(program.id(), vertex->id());
  glAttachShader(program.id(), fragment->id());
  glLinkProgram(program.id());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  std::array<char, 1024> log{};
  glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  return failure(ErrorCode::internal, std::string("A shader program does not link: ") + log.data());
}

}  // namespace counterpart
