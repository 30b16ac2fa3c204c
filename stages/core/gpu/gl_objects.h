// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <span>
#include <utility>

namespace kiln {

/// Owner of one GL name; the context that made it must be current at destruction.
template <void (*destroy)(GLuint)>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  ~GlObject() {
    if (name_ != 0) destroy(name_);
  }
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }

  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

inline void destroy_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void destroy_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void destroy_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void destroy_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void destroy_program(GLuint name) { glDeleteProgram(name); }
inline void destroy_sampler(GLuint name) { glDeleteSamplers(1, &name); }

using GlBuffer = GlObject<destroy_buffer>;
using GlTexture = GlObject<destroy_texture>;
using GlFramebuffer = GlObject<destroy_framebuffer>;
using GlVertexArray = GlObject<destroy_vertex_array>;
using GlProgram = GlObject<destroy_program>;
using GlSampler = GlObject<destroy_sampler>;

/// Makes a buffer of fixed size with this content.
template <class Value>
GlBuffer make_buffer(std::span<const Value> values, GLbitfield flags = 0) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(values.size_bytes()), values.data(), flags);
  return GlBuffer(name);
}

/// Makes a zeroed buffer of `bytes`.
inline GlBuffer make_zero_buffer(GLsizeiptr bytes, GLbitfield flags = 0) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, bytes, nullptr, flags);
  glClearNamedBufferData(name, GL_R32F, GL_RED, GL_FLOAT, nullptr);
  return GlBuffer(name);
}

/// Makes a buffer of `bytes` whose content is replaced again and again.
inline GlBuffer make_refilled_buffer(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return GlBuffer(name);
}

template <class Value>
void refill_buffer(const GlBuffer& buffer, std::span<const Value> values) {
  glNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(values.size_bytes()), values.data());
}

inline GlTexture make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return GlTexture(name);
}

inline GlFramebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

inline GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

}  // namespace kiln
