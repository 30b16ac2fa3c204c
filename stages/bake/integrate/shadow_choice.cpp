// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/integrate/shadow_choice.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "bake/backends.h"
#include "bake/planes/quantisation_floor.h"
#include "base/progress.h"
#include "sh/directions.h"

namespace kiln {

namespace {

constexpr int smallest_size = 256, largest_size = 4096;
constexpr int most_directions = 512;

}  // namespace

ShadowSizeChoice choose_shadow_size(const Receivers& sample, const BakeJob& job) {
  const BakeSettings& settings = job.settings;
  const std::vector<Eigen::Vector3f> directions = sample_directions(
      Sampling::fibonacci, std::min(settings.directions, most_directions), static_cast<std::uint64_t>(job.seed));
  const auto integrate = [&](TransferEngine& engine) {
    engine.set_receivers(sample, settings.bands);
    engine.add(directions, no_progress);
    return engine.sums().transfer();
  };
  const TransferVectors truth = integrate(*make_engine(BakeBackend::embree, job.occluders, settings, job.threads));
  ShadowSizeChoice choice;
  choice.floor = quantisation_floor(truth, settings.bits);
  BakeSettings sized = settings;
  for (int size = smallest_size; size <= largest_size && !choice.reached; size *= 2) {
    sized.shadow_size = size;
    const std::unique_ptr<TransferEngine> engine = make_engine(BakeBackend::egl, job.occluders, sized, job.threads);
    choice.size_texels = size;
    choice.error = relative_l2(integrate(*engine), truth);
    choice.reached = choice.error <= choice.floor;
  }
  return choice;
}

}  // namespace kiln
