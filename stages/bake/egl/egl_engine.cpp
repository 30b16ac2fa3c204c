// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over directions outermost, one depth map each, against which all texels are shaded [US 7,948,490]. The patent
// alternates between buffers because hardware of its day could not blend into float targets; here sums of a block of
// directions stay in registers and the totals are integers: exact, and read and written once per block.
#include "bake/egl/egl_engine.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/egl/shade_pass.h"
#include "base/errors.h"
#include "base/progress.h"
#include "gpu/egl_context.h"
#include "gpu/program.h"
#include "sh/basis.h"

namespace kiln {

struct EglEngine::Implementation {
  EglContext context;
  ShadowMapSettings settings;
  ShadowRays rays;
  std::optional<ShadowMaps> maps;
  std::optional<ShadePass> shade_pass;
  std::optional<ShBasis> basis;
  std::size_t receivers = 0;
  std::int64_t directions = 0;
  TransferWork work;
};

EglEngine::EglEngine(const TransferScene& scene, const std::string& device, int software_threads,
                     const ShadowMapSettings& settings, ShadowRays rays)
    : implementation_(
          new Implementation{EglContext(device, software_threads), settings, std::move(rays), {}, {}, {}, 0, 0, {}}) {
  assert(block_directions % settings.batch_directions == 0);
  assert(!settings.triangle_ids || implementation_->rays.triangles_below);
  assert(!settings.refine || implementation_->rays.occluded);
  GLint most_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_texels);
  if (settings.size_texels > most_texels)
    throw MachineLacks("depth maps of " + std::to_string(settings.size_texels) + " texels: " + renderer() +
                       " has at most " + std::to_string(most_texels));
  implementation_->maps.emplace(scene, settings);
  check_gl("setting up the depth maps");
}

EglEngine::~EglEngine() = default;

std::string EglEngine::renderer() const { return implementation_->context.renderer(); }

bool EglEngine::is_software() const { return implementation_->context.is_software(); }

TransferWork EglEngine::work() const { return implementation_->work; }

void EglEngine::set_receivers(const Receivers& receivers, int bands) {
  Implementation& own = *implementation_;
  own.shade_pass.reset();  // frees its memory before the next one takes some
  own.basis.emplace(bands);
  own.shade_pass.emplace(receivers, own.basis->size(), own.settings, *own.maps, own.rays);
  own.receivers = receivers.size();
  own.directions = 0;
  check_gl("setting up the receivers");
}

void EglEngine::add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) {
  Implementation& own = *implementation_;
  const std::size_t batch = own.settings.batch_directions;
  const int coefficients = own.basis->size();
  std::vector<float> rows;
  std::vector<double> values(coefficients);
  for (std::size_t first = 0; first < directions.size(); first += block_directions) {
    const auto block = directions.subspan(first, std::min<std::size_t>(block_directions, directions.size() - first));
    rows.clear();
    for (const Eigen::Vector3f& direction : block) {
      own.basis->evaluate<double>(direction.cast<double>(), values);
      rows.insert(rows.end(), values.begin(), values.end());
    }
    own.shade_pass->begin_block(block, rows, own.work);
    for (std::size_t d = 0; d < block.size(); d += batch) {
      const auto part = block.subspan(d, std::min(batch, block.size() - d));
      own.maps->draw(part);
      own.shade_pass->weigh(*own.maps, static_cast<int>(d), static_cast<int>(part.size()));
    }
    own.shade_pass->end_block(own.work);
    glFinish();  // bounds what is queued, so that progress is true and no submission grows long
    progress(static_cast<double>(first + block.size()) / static_cast<double>(directions.size()));
  }
  own.directions += static_cast<std::int64_t>(directions.size());
  check_gl("baking");
}

TransferSums EglEngine::sums() {
  Implementation& own = *implementation_;
  TransferSums sums(own.receivers, own.basis->size());
  own.shade_pass->read(sums);
  sums.directions = own.directions;
  check_gl("reading the transfer back");
  return sums;
}

}  // namespace kiln
