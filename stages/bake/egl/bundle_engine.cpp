// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/bundle_engine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "bake/egl/bundle_lists.h"
#include "bake/egl/receiver_tiles.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr int most_chunk = 36;                        // sums a shader keeps in registers
constexpr std::size_t most_buffer_bytes = 96u << 20;  // llvmpipe has storage blocks of 128 MiB at most
constexpr float depth_rounding = 0x1p-24f;            // of a depth in float32

/// As the shaders have them (std430).
struct GpuReceiver {
  Eigen::Vector4f position, normal;
};
struct GpuTotal {
  std::uint32_t low, high;
};
using GpuHit = std::array<std::uint32_t, 4>;  // triangle, and the weights of its points

int in_fours(int count) { return (count + 3) / 4 * 4; }

/// As many receivers as fit one storage buffer.
struct Group {
  std::size_t first = 0;
  std::size_t count = 0;
  std::vector<NormalCone> cones;
  GlBuffer receivers;
  GlBuffer hits;  // of the block
  GlBuffer totals;
  GlBuffer tiles;
  std::vector<std::uint32_t> facing;  // tiles of the block, as `tiles` now has them
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
    own.chunks = (in_fours(width) + most_chunk - 1) / most_chunk;
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
  const std::size_t receiver_bytes = std::max(sizeof(GpuTotal) * chunk * chunks, sizeof(GpuHit) * block_directions);
  const std::size_t most = most_buffer_bytes / receiver_bytes / tile_receivers * tile_receivers;
  std::vector<Group> groups;
  for (std::size_t first = 0; first < receivers.size(); first += most) {
    Group& group = groups.emplace_back();
    group.first = first;
    group.count = std::min(most, receivers.size() - first);
    group.cones = normal_cones(receivers.normals.subspan(first, group.count));
    std::vector<GpuReceiver> list(group.count);
    for (std::size_t r = 0; r < group.count; ++r) {
      const Eigen::Vector3f &p = receivers.positions[first + r], &n = receivers.normals[first + r];
      list[r] = {{p.x(), p.y(), p.z(), 1}, {n.x(), n.y(), n.z(), 0}};
    }
    group.receivers = make_buffer<GpuReceiver>(list);
    group.hits = make_zero_buffer(static_cast<GLsizeiptr>(group.count * block_directions * sizeof(GpuHit)));
    group.totals = make_zero_buffer(static_cast<GLsizeiptr>(group.count * chunk * chunks * sizeof(GpuTotal)));
    group.tiles = make_refilled_buffer(group.cones.size() * sizeof(std::uint32_t));
  }
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
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, group.receivers.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.hits.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, group.tiles.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, positions.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 9, triangles.name());
  glDispatchCompute(static_cast<GLuint>(group.facing.size()), 1, 1);
}

void BundleEngine::Implementation::sum(const Group& group, int directions) const {
  glUseProgram(sum_program.name());
  glUniform1i(uniform_location(sum_program, "receiver_count"), static_cast<GLint>(group.count));
  glUniform1i(uniform_location(sum_program, "block_directions"), directions);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, group.receivers.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.hits.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, group.totals.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, group.tiles.name());
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
    for (Group& group : groups) {
      group.facing = facing_tiles(group.cones, group.count, block, behind);
      refill_buffer<std::uint32_t>(group.tiles, group.facing);
    }
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
  std::vector<GpuTotal> totals;
  for (const Group& group : groups) {
    totals.resize(group.count);
    for (int i = 0; i < own.width; ++i) {
      glGetNamedBufferSubData(group.totals.name(), static_cast<GLintptr>(i * group.count * sizeof(GpuTotal)),
                              static_cast<GLsizeiptr>(group.count * sizeof(GpuTotal)), totals.data());
      for (std::size_t r = 0; r < group.count; ++r)
        sums.plane(i)[group.first + r] =
            static_cast<std::int64_t>(static_cast<std::uint64_t>(totals[r].high) << 32 | totals[r].low);
    }
  }
  check_gl("gathering along ray bundles");
  return sums;
}

}  // namespace kiln
