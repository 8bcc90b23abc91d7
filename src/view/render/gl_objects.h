// Owners of OpenGL objects. A context must be current in all their functions, destructors included.
#pragma once

#include <epoxy/gl.h>
#include <string>
#include <utility>

#include "src/view/render/camera.h"

namespace tutu::app {

/// Any OpenGL name with its own `glDelete...`. Move-only.
template <typename Policy> class GlObject {
public:
  GlObject() : name_(Policy::create()) {}
  ~GlObject() {
    if (name_ != 0) Policy::destroy(name_);
  }
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }

  GLuint name() const { return name_; }

private:
  GLuint name_;
};

struct BufferPolicy {
  static GLuint create() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayPolicy {
  static GLuint create() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TexturePolicy {
  static GLuint create() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct FramebufferPolicy {
  static GLuint create() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct RenderbufferPolicy {
  static GLuint create() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};

using VertexArray = GlObject<VertexArrayPolicy>;
using Texture = GlObject<TexturePolicy>;
using Framebuffer = GlObject<FramebufferPolicy>;
using Renderbuffer = GlObject<RenderbufferPolicy>;

/// A buffer that is filled anew each frame; its storage only grows.
class StreamBuffer {
public:
  /// Binds to `target` and replaces the contents. Nothing is uploaded for 0 bytes.
  void upload(GLenum target, const void* data, std::size_t bytes);
  GLuint name() const { return object_.name(); }

private:
  GlObject<BufferPolicy> object_;
  std::size_t capacity_ = 0;
};

/// A vertex and a fragment shader, linked.
class Program {
public:
  /// The sources follow the shared preambles of shaders.h. Throws std::runtime_error with the compiler's log, named
  /// `label`.
  Program(const char* label, const char* vertex, const char* fragment);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(name_); }
  // Setters work on the program in use. A name the compiler optimised away is ignored, as OpenGL does.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, const Eigen::Vector2f& value) const;
  void set(const char* uniform, const Vec3f& value) const;
  void set(const char* uniform, const Colour& value) const;
  void set(const char* uniform, const Mat4f& value) const;

private:
  GLuint name_ = 0;
};

/// Binds `buffer` as float attribute `location` of the bound vertex array; `divisor` 1 = one an instance.
void float_attribute(GLuint location, GLuint buffer, int components, std::size_t stride, std::size_t offset,
                     GLuint divisor = 0);

/// Binds `texture` to `unit` as 2D texture.
void bind_texture(GLuint unit, GLuint texture);

} // namespace tutu::app
