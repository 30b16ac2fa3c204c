// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/shade_pass.h"

#include <algorithm>
#include <array>
#include <string>

#include "bake/egl/shadow_refine.h"
#include "gpu/program.h"

namespace kiln {

namespace {

using TileCounts = std::array<std::uint32_t, 3>;  // behind, lit, shadowed

/// Returns how many texels a side a receiver is compared with. One alone would not show that a shadow's edge is near.
int taps(const ShadowMapSettings& settings) {
  if (settings.filter == ShadowFilter::three_by_three) return 3;
  return settings.filter == ShadowFilter::two_by_two || settings.refine ? 2 : 1;
}

bool marks(const ShadowMapSettings& settings) { return settings.count_ambiguous || settings.refine; }

GlProgram load_weigh_program(const ShadowMapSettings& settings) {
  const auto flag = [](bool on) { return on ? "1" : "0"; };
  return load_program({"bake_weigh.comp"}, {{"TAPS", std::to_string(taps(settings))},
                                            {"STEEPEST_SLOPE", std::to_string(ShadowMapSettings::steepest_slope)},
                                            {"RECEIVER_PLANE", flag(settings.receiver_plane)},
                                            {"TRIANGLE_IDS", flag(settings.triangle_ids)},
                                            {"MIDPOINT", flag(settings.faces == ShadowFaces::midpoint)},
                                            {"MARK", flag(marks(settings))},
                                            {"REGIONS", flag(settings.regions)},
                                            {"CELL", std::to_string(region_texels)}});
}

}  // namespace

ShadePass::ShadePass(const Receivers& receivers, int coefficients, const ShadowMapSettings& settings,
                     const ShadowMaps& maps, const ShadowRays& rays)
    : settings_(settings),
      receivers_(receivers),
      rays_(rays),
      coefficients_(coefficients),
      chunk_(std::min(in_fours(coefficients), most_register_sums)),
      chunks_((coefficients + chunk_ - 1) / chunk_),
      weigh_program_(load_weigh_program(settings)),
      sum_program_(load_program({"bake_sum.comp"},
                                {{"BLOCK", std::to_string(block_directions)}, {"CHUNK", std::to_string(chunk_)}})) {
  for (int chunk = 0; chunk < chunks_; ++chunk)
    rows_.push_back(make_refilled_buffer(static_cast<std::size_t>(block_directions) * chunk_ * sizeof(float)));
  for_each_group(receivers.size(), chunk_ * chunks_, sizeof(float) * block_directions,
                 [&](std::size_t first, std::size_t count) { add_group(first, count); });
  if (settings.triangle_ids) find_corners(maps);
  if (settings.regions) tile_counts_ = make_zero_buffer(sizeof(TileCounts), GL_DYNAMIC_STORAGE_BIT);
}

void ShadePass::find_corners(const ShadowMaps& maps) {
  const std::vector<std::uint32_t> below = rays_.triangles_below(receivers_);
  for (Group& group : groups_) {
    std::vector<std::array<std::uint32_t, 4>> corners;
    for (std::size_t r = group.first; r < group.first + group.count; ++r) {
      const auto& [a, b, c] = maps.corners()[below[r]];
      corners.push_back({a, b, c, 0});
    }
    group.corners = make_buffer<std::array<std::uint32_t, 4>>(corners);
  }
}

void ShadePass::add_group(std::size_t first, std::size_t count) {
  Group& group = groups_.emplace_back(receivers_, first, count, chunk_ * chunks_);
  group.weights = make_zero_buffer(static_cast<GLsizeiptr>(count * block_directions * sizeof(float)),
                                   marks(settings_) ? GL_DYNAMIC_STORAGE_BIT : 0);
  if (settings_.regions)
    group.bounds = make_buffer<TileBounds>(tile_bounds(
        {receivers_.positions.subspan(first, count), receivers_.normals.subspan(first, count)}, group.cones));
}

void ShadePass::begin_block(std::span<const Eigen::Vector3f> directions, std::span<const float> rows,
                            TransferWork& work) {
  block_.assign(directions.begin(), directions.end());
  std::vector<float> part(static_cast<std::size_t>(block_directions) * chunk_);
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    std::fill(part.begin(), part.end(), 0.f);
    const int first = chunk * chunk_, count = std::min(chunk_, coefficients_ - first);
    for (std::size_t d = 0; d < directions.size(); ++d)
      std::copy_n(rows.begin() + d * coefficients_ + first, count, part.begin() + d * chunk_);
    refill_buffer<float>(rows_[chunk], part);
  }
  for (Group& group : groups_) {
    work.pairs += group.count * directions.size();
    group.face(directions, work.behind_tiles);
    if (directions.size() < block_directions)
      glClearNamedBufferData(group.weights.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
  }
}

void ShadePass::weigh(const ShadowMaps& maps, int first, int directions) {
  if (settings_.regions) {
    maps.draw_regions(directions);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, tile_counts_.name());
  }
  glUseProgram(weigh_program_.name());
  maps.bind();
  glUniform1i(uniform_location(weigh_program_, "batch_directions"), directions);
  glUniform1i(uniform_location(weigh_program_, "first_row"), first);
  const auto set = [&](const char* name, double value) {
    glUniform1f(uniform_location(weigh_program_, name), static_cast<float>(value));
  };
  set("depth_bias", settings_.depth_bias.value_or(0));
  set("position_bias", settings_.depth_bias ? 0 : maps.position_rounding());
  set("angle_bias_texels", settings_.angle_bias_texels);
  set("normal_offset_texels", settings_.normal_offset_texels);
  set("error_band_texels", settings_.error_band_texels);
  set("depth_rounding", maps.depth_rounding());
  for (const Group& group : groups_) {
    if (group.facing.empty()) continue;
    glUniform1i(uniform_location(weigh_program_, "receiver_count"), static_cast<GLint>(group.count));
    group.bind();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.weights.name());
    if (settings_.triangle_ids) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, group.corners.name());
    if (settings_.regions) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, group.bounds.name());
    glDispatchCompute(static_cast<GLuint>(group.facing.size()), 1, 1);
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ShadePass::resolve(const Group& group, TransferWork& work) const {
  std::vector<float> weights(group.count * block_.size());
  glGetNamedBufferSubData(group.weights.name(), 0, static_cast<GLsizeiptr>(weights.size() * sizeof(float)),
                          weights.data());
  if (resolve_ambiguous({weights, group.first, group.count, group.facing}, receivers_, block_, settings_.refine, rays_,
                        work))
    refill_buffer<float>(group.weights, weights);
}

void ShadePass::end_block(TransferWork& work) {
  if (settings_.regions) {
    TileCounts counts{};
    glGetNamedBufferSubData(tile_counts_.name(), 0, sizeof counts, counts.data());
    work.behind_tiles += counts[0];
    work.lit_tiles += counts[1];
    work.shadowed_tiles += counts[2];
    refill_buffer<std::uint32_t>(tile_counts_, TileCounts{});
  }
  if (marks(settings_))
    for (const Group& group : groups_)
      if (!group.facing.empty()) resolve(group, work);
  glUseProgram(sum_program_.name());
  for (const Group& group : groups_) {
    if (group.facing.empty()) continue;
    glUniform1i(uniform_location(sum_program_, "receiver_count"), static_cast<GLint>(group.count));
    group.bind();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, group.weights.name());
    for (int chunk = 0; chunk < chunks_; ++chunk) {
      glUniform1i(uniform_location(sum_program_, "first_coefficient"), chunk * chunk_);
      glBindBufferBase(GL_UNIFORM_BUFFER, 0, rows_[chunk].name());
      glDispatchCompute(static_cast<GLuint>(group.facing.size()), 1, 1);
    }
  }
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void ShadePass::read(TransferSums& sums) const {
  for (const Group& group : groups_) group.read(sums);
}

}  // namespace kiln
