#include "src/view/render/gl_objects.h"

#include "src/view/render/shaders.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace tutu::app {
namespace {

std::string log_of_shader(GLuint shader) {
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return log.data();
}

GLuint compile(GLenum kind, const char* label, const char* source) {
  const GLuint shader = glCreateShader(kind);
  const char* const shared = kind == GL_FRAGMENT_SHADER ? shaders::k_fragment_preamble : "";
  const std::array<const char*, 3> parts = {shaders::k_preamble, shared, source};
  glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    const std::string log = log_of_shader(shader);
    glDeleteShader(shader);
    throw std::runtime_error(std::string("the graphics driver rejects the shader '") + label + "': " + log);
  }
  return shader;
}

} // namespace

void StreamBuffer::upload(GLenum target, const void* data, std::size_t bytes) {
  glBindBuffer(target, object_.name());
  if (bytes == 0) return;
  if (bytes > capacity_) capacity_ = std::max(bytes, capacity_ + capacity_ / 2);
  // Fresh storage each time, so that the driver need not wait for draws that still read the old contents.
  glBufferData(target, static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
  glBufferSubData(target, 0, static_cast<GLsizeiptr>(bytes), data);
}

Program::Program(const char* label, const char* vertex, const char* fragment) {
  const GLuint vertex_shader = compile(GL_VERTEX_SHADER, label, vertex);
  GLuint fragment_shader = 0;
  try {
    fragment_shader = compile(GL_FRAGMENT_SHADER, label, fragment);
  } catch (...) {
    glDeleteShader(vertex_shader);
    throw;
  }
  name_ = glCreateProgram();
  glAttachShader(name_, vertex_shader);
  glAttachShader(name_, fragment_shader);
  glLinkProgram(name_);
  glDeleteShader(vertex_shader);
  glDeleteShader(fragment_shader);
  GLint good = 0;
  glGetProgramiv(name_, GL_LINK_STATUS, &good);
  if (good) return;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteProgram(name_);
  throw std::runtime_error(std::string("the graphics driver cannot link the shader '") + label + "': " + log.data());
}

Program::~Program() { glDeleteProgram(name_); }

void Program::set(const char* uniform, int value) const { glUniform1i(glGetUniformLocation(name_, uniform), value); }
void Program::set(const char* uniform, float value) const { glUniform1f(glGetUniformLocation(name_, uniform), value); }
void Program::set(const char* uniform, const Eigen::Vector2f& value) const {
  glUniform2fv(glGetUniformLocation(name_, uniform), 1, value.data());
}
void Program::set(const char* uniform, const Vec3f& value) const {
  glUniform3fv(glGetUniformLocation(name_, uniform), 1, value.data());
}
void Program::set(const char* uniform, const Colour& value) const {
  glUniform3fv(glGetUniformLocation(name_, uniform), 1, value.data());
}
void Program::set(const char* uniform, const Mat4f& value) const {
  glUniformMatrix4fv(glGetUniformLocation(name_, uniform), 1, GL_FALSE, value.data());
}

void float_attribute(GLuint location, GLuint buffer, int components, std::size_t stride, std::size_t offset,
                     GLuint divisor) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        reinterpret_cast<const void*>(offset)); // OpenGL passes an offset as a pointer
  glVertexAttribDivisor(location, divisor);
}

void bind_texture(GLuint unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
}

} // namespace tutu::app
