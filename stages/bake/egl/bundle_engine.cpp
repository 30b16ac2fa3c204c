// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/bundle_engine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "bake/egl/bundle_lists.h"
#include "bake/egl/receiver_groups.h"
#include "base/progress.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr float depth_rounding = 0x1p-24f;  // error of a depth in float32

using GpuHit = std::array<std::uint32_t, 4>;  // triangle, and the weights of its points

struct Group : ReceiverGroup {
  using ReceiverGroup::ReceiverGroup;
  GlBuffer hits;  // hits of the block
};

}  // namespace

struct BundleEngine::Implementation {
  EglContext context;
  ShadowMapSettings settings;
  std::optional<BundleLists> lists;
  GlBuffer positions, triangles, points;
  GlProgram find_program, sum_program;
  float position_rounding = 0;  // rounding_offset of the surface, object units
  int width = 0, chunk = 0, chunks = 0;
  std::vector<GlBuffer> radiance;  // one per chunk

  std::vector<Group> make_groups(const Receivers& receivers) const;
  void find(const Group& group, int first_row, int directions) const;
  void sum(const Group& group, int directions) const;
};

BundleEngine::BundleEngine(const ReflectingSurface& surface, const std::string& device, int software_threads,
                           const ShadowMapSettings& settings)
    : implementation_(new Implementation{EglContext(device, software_threads),
                                         settings,
                                         {},
                                         {},
                                         {},
                                         {},
                                         {},
                                         {},
                                         rounding_offset(surface.hull),
                                         0,
                                         0,
                                         0,
                                         {}}) {
  Implementation& own = *implementation_;
  own.lists.emplace(surface, settings);
  own.positions = make_buffer(surface.positions);
  own.triangles = make_buffer(surface.triangles);
  own.points = make_buffer(surface.points);
  own.find_program =
      load_program({"bake_bundle_find.comp"}, {{"STEEPEST_SLOPE", std::to_string(ShadowMapSettings::steepest_slope)},
                                               {"RECEIVER_PLANE", settings.receiver_plane ? "1" : "0"}});
  check_gl("setting up the ray bundles");
}

BundleEngine::~BundleEngine() = default;

std::string BundleEngine::renderer() const { return implementation_->context.renderer(); }

void BundleEngine::set_radiance(std::span<const float> values, int width) {
  Implementation& own = *implementation_;
  const std::size_t points = values.size() / static_cast<std::size_t>(width);
  if (width != own.width) {
    own.width = width;
    own.chunks = (in_fours(width) + most_register_sums - 1) / most_register_sums;
    own.chunk = in_fours((width + own.chunks - 1) / own.chunks);
    own.sum_program = load_program({"bake_bundle_sum.comp"}, {{"CHUNK", std::to_string(own.chunk)}});
  }
  own.radiance.clear();
  std::vector<float> part(points * own.chunk);
  for (int c = 0; c < own.chunks; ++c) {
    std::fill(part.begin(), part.end(), 0.f);
    const int first = c * own.chunk, count = std::min(own.chunk, width - first);
    for (std::size_t p = 0; p < points; ++p)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(p * width + first), count,
                  part.begin() + static_cast<std::ptrdiff_t>(p * own.chunk));
    own.radiance.push_back(make_buffer<float>(part));
  }
  check_gl("setting up what the surface sends");
}

std::vector<Group> BundleEngine::Implementation::make_groups(const Receivers& receivers) const {
  std::vector<Group> groups;
  for_each_group(receivers.size(), chunk * chunks, sizeof(GpuHit) * block_directions,
                 [&](std::size_t first, std::size_t count) {
                   Group& group = groups.emplace_back(receivers, first, count, chunk * chunks);
                   group.hits = make_zero_buffer(static_cast<GLsizeiptr>(count * block_directions * sizeof(GpuHit)));
                 });
  return groups;
}

void BundleEngine::Implementation::find(const Group& group, int first_row, int directions) const {
  const auto set = [&](const char* name, double value) {
    glUniform1f(uniform_location(find_program, name), static_cast<float>(value));
  };
  const auto set_integer = [&](const char* name, std::size_t value) {
    glUniform1i(uniform_location(find_program, name), static_cast<GLint>(value));
  };
  glUseProgram(find_program.name());
  set("depth_bias", settings.depth_bias.value_or(0));
  set("position_bias", settings.depth_bias ? 0 : position_rounding);
  set("angle_bias_texels", settings.angle_bias_texels);
  set("normal_offset_texels", settings.normal_offset_texels);
  set("depth_rounding", depth_rounding);
  set_integer("size", static_cast<std::size_t>(lists->size_texels()));
  set_integer("first_row", static_cast<std::size_t>(first_row));
  set_integer("batch_directions", static_cast<std::size_t>(directions));
  set_integer("receiver_count", group.count);
  group.bind();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.hits.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, positions.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 9, triangles.name());
  glDispatchCompute(static_cast<GLuint>(group.facing.size()), 1, 1);
}

void BundleEngine::Implementation::sum(const Group& group, int directions) const {
  glUseProgram(sum_program.name());
  glUniform1i(uniform_location(sum_program, "receiver_count"), static_cast<GLint>(group.count));
  glUniform1i(uniform_location(sum_program, "block_directions"), directions);
  group.bind();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.hits.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 9, points.name());
  for (int c = 0; c < chunks; ++c) {
    glUniform1i(uniform_location(sum_program, "first_coefficient"), c * chunk);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 10, radiance[static_cast<std::size_t>(c)].name());
    glDispatchCompute(static_cast<GLuint>(group.facing.size()), 1, 1);
  }
}

TransferSums BundleEngine::gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                  const ProgressFunction& progress) {
  Implementation& own = *implementation_;
  std::vector<Group> groups = own.make_groups(receivers);
  for (std::size_t begin = 0; begin < directions.size(); begin += block_directions) {
    const auto block = directions.subspan(begin, std::min<std::size_t>(block_directions, directions.size() - begin));
    std::uint64_t behind = 0;
    for (Group& group : groups) group.face(block, behind);
    for (std::size_t first = 0; first < block.size();) {
      const std::size_t drawn = own.lists->draw(block.subspan(first));
      for (const Group& group : groups)
        if (!group.facing.empty()) own.find(group, static_cast<int>(first), static_cast<int>(drawn));
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
      first += drawn;
    }
    for (const Group& group : groups)
      if (!group.facing.empty()) own.sum(group, static_cast<int>(block.size()));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();  // bounds what is queued, so that progress is true and no submission grows long
    progress(static_cast<double>(begin + block.size()) / static_cast<double>(directions.size()));
  }

  TransferSums sums(receivers.size(), own.width);
  sums.directions = static_cast<std::int64_t>(directions.size());
  for (const Group& group : groups) group.read(sums);
  check_gl("gathering along ray bundles");
  return sums;
}

}  // namespace kiln
