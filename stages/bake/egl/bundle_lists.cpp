// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/bundle_lists.h"

#include <algorithm>
#include <string>

#include "bake/egl/views.h"
#include "base/errors.h"
#include "gpu/program.h"

namespace kiln {

namespace {

constexpr std::size_t most_heads_bytes = 32u << 20;
constexpr std::size_t most_entries_bytes = 96u << 20;  // llvmpipe has storage blocks of 128 MiB at most
constexpr std::size_t entry_bytes = 12;
constexpr std::size_t first_capacity = 1u << 20;
constexpr GLuint end_of_list = ~0u;

GlBuffer make_entries(std::size_t capacity) { return make_refilled_buffer(capacity * entry_bytes); }

}  // namespace

BundleLists::BundleLists(const ReflectingSurface& surface, const ShadowMapSettings& settings)
    : size_(settings.size_texels),
      closed_(surface.closed),
      indices_(static_cast<GLsizei>(3 * surface.triangles.size())),
      batch_(std::clamp<std::size_t>(most_heads_bytes / (sizeof(GLuint) * size_ * size_), 1,
                                     static_cast<std::size_t>(settings.batch_directions))),
      capacity_(first_capacity),
      hull_(surface.hull.begin(), surface.hull.end()),
      positions_(make_buffer(surface.positions)),
      triangles_(make_buffer(surface.triangles)),
      views_(make_refilled_buffer(batch_ * sizeof(View))),
      heads_(make_refilled_buffer(batch_ * size_ * size_ * sizeof(GLuint))),
      entries_(make_entries(capacity_)),
      counter_(make_refilled_buffer(sizeof(GLuint))),
      surface_(make_vertex_array()),
      framebuffer_(make_framebuffer()),
      program_(load_program({"bake_bundle.vert", "bake_bundle.frag"})) {
  glVertexArrayVertexBuffer(surface_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
  glVertexArrayAttribFormat(surface_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
  glEnableVertexArrayAttrib(surface_.name(), 0);
  glVertexArrayElementBuffer(surface_.name(), triangles_.name());
  glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size_);
  glNamedFramebufferParameteri(framebuffer_.name(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size_);
}

std::uint32_t BundleLists::draw_once(std::span<const Eigen::Vector3f> directions) {
  refill_buffer<View>(views_, fit_views(hull_, directions, size_));
  const GLuint zero = 0;
  glClearNamedBufferData(counter_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  glClearNamedBufferData(heads_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &end_of_list);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, views_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, heads_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, entries_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, counter_.name());

  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_DEPTH_TEST);
  glViewport(0, 0, size_, size_);
  if (closed_)
    glEnable(GL_CULL_FACE);
  else
    glDisable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glBindVertexArray(surface_.name());
  glUseProgram(program_.name());
  glUniform1i(uniform_location(program_, "size"), size_);
  glUniform1ui(uniform_location(program_, "capacity"), static_cast<GLuint>(capacity_));
  const auto count = static_cast<GLsizei>(directions.size());
  const GLsizei step = 3 * std::max<GLsizei>(1, most_bundle_triangles / count);
  for (GLsizei begin = 0; begin < indices_; begin += step) {
    glUniform1ui(uniform_location(program_, "first_triangle"), static_cast<GLuint>(begin / 3));
    glDrawElementsInstanced(GL_TRIANGLES, std::min(step, indices_ - begin), GL_UNSIGNED_INT,
                            reinterpret_cast<const void*>(static_cast<std::uintptr_t>(begin) * sizeof(std::uint32_t)),
                            count);
    if (begin + step < indices_) glFlush();
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  GLuint entries = 0;
  glGetNamedBufferSubData(counter_.name(), 0, sizeof entries, &entries);
  return entries;
}

std::size_t BundleLists::draw(std::span<const Eigen::Vector3f> directions) {
  constexpr std::size_t most_entries = most_entries_bytes / entry_bytes;
  for (;;) {
    const std::size_t count = std::min(batch_, directions.size());
    const std::size_t entries = draw_once(directions.first(count));
    if (entries <= capacity_) return count;
    if (entries <= most_entries) {
      capacity_ = std::min(most_entries, entries + entries / 4);
      entries_ = make_entries(capacity_);
    } else if (count > 1) {
      batch_ = count / 2;
    } else {
      throw MachineLacks("bundles of rays of " + std::to_string(size_) + " texels a side have " +
                         std::to_string(entries) + " layers together; there is room for " +
                         std::to_string(most_entries) + "; lower --shadow-size");
    }
  }
}

}  // namespace kiln
