// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/verify.h"

#include <algorithm>
#include <cstdint>
#include <memory>

#include "bake/backends.h"
#include "bake/bounce/bounced_light.h"
#include "bake/bounce/receiver_albedo.h"
#include "base/progress.h"
#include "sh/directions.h"

namespace kiln {

namespace {

/// Share of the progress that the other backend takes, and that it and the direct rays take.
constexpr double backend_share = 0.3, rays_share = 0.7;

/// Returns every `step`-th receiver's transfer.
std::vector<TransferVectors> thin_out(const std::vector<TransferVectors>& channels, std::size_t step) {
  std::vector<TransferVectors> thinned;
  for (const TransferVectors& channel : channels) {
    TransferVectors& some = thinned.emplace_back((channel.receivers + step - 1) / step, channel.coefficients);
    for (int i = 0; i < channel.coefficients; ++i)
      for (std::size_t r = 0; r < some.receivers; ++r) some.plane(i)[r] = channel.plane(i)[r * step];
  }
  return thinned;
}

/// Returns every `step`-th receiver, without those that are filled.
ReceiverSet thin_out(const ReceiverSet& receivers, std::size_t step) {
  ReceiverSet thinned;
  thinned.width = receivers.width;
  thinned.height = receivers.height;
  for (std::size_t r = 0; r < receivers.slots.size(); r += step) {
    thinned.slots.push_back(receivers.slots[r]);
    thinned.positions.push_back(receivers.positions[r]);
    thinned.normals.push_back(receivers.normals[r]);
    if (!receivers.albedos.empty()) thinned.albedos.push_back(receivers.albedos[r]);
  }
  return thinned;
}

/// Returns the step by which about `most` of the receivers are taken.
std::size_t step_to(std::size_t receivers, std::size_t most) { return std::max<std::size_t>(1, receivers / most); }

/// Returns the settings of `result`'s bake, with the number of directions and of bounces that it came to.
BakeSettings settled(const BakeSettings& settings, const BakeResult& result) {
  BakeSettings fixed = settings;
  fixed.max_error = {};
  fixed.adaptive = 0;
  fixed.casts_shadows = true;  // what leaving them out costs is a part of the error
  if (result.directions > 0) fixed.directions = result.directions;
  fixed.sampling = result.sampling;
  if (result.bounces) fixed.bounces = {.count = static_cast<int>(result.bounces->energy.size())};
  return fixed;
}

BakeBackend other_backend(const BakeResult& result, const BakeSettings& settings) {
  if (result.backend != BakeBackend::embree) return BakeBackend::embree;
  return settings.backend == BakeBackend::automatic ? BakeBackend::beams : BakeBackend::egl;
}

/// Returns the transfer of the job's receivers, by rays along `many` directions. The surface's own light takes the
/// job's number of directions: the last bounce, which shows, takes many.
std::vector<TransferVectors> reference_transfer(const BakeJob& job, std::span<const Eigen::Vector3f> many,
                                                bool bounces) {
  const auto make_rays = [&] { return make_engine(BakeBackend::embree, job.occluders, job.settings, job.threads); };
  const Receivers receivers = job.receivers.view();
  std::vector<TransferVectors> channels = {direct_transfer(*make_rays(), receivers, many, job.settings.bands,
                                                           part_of(job.progress, backend_share, rays_share))};
  if (bounces) {
    std::vector<Eigen::Vector3f> own =
        sample_directions(job.settings.sampling, job.settings.directions, static_cast<std::uint64_t>(job.seed));
    order_coherently(own, block_directions);
    std::vector<TracedReceivers> traced = untraced(receivers);
    add_bounced_light(job, BakeBackend::embree, make_rays(), {own, many}, traced, channels,
                      part_of(job.progress, rays_share, 1));
  }
  multiply_albedo(channels, job.receivers.albedos);
  return channels;
}

}  // namespace

BakeVerification verify(const BakeResult& result, const std::vector<TransferVectors>& stored, const BakeJob& job) {
  BakeVerification verification;
  const bool is_scattered = !result.arriving.empty();
  const std::vector<TransferVectors>& baked = is_scattered ? result.arriving : result.channels;
  const std::size_t all = job.receivers.slots.size();
  const BakeSettings settings = settled(job.settings, result);

  // Step 1: another backend, over the very same directions.
  const std::size_t backend_step = step_to(all, compared_texels);
  const ReceiverSet compared_receivers = thin_out(job.receivers, backend_step);
  BakeJob other{compared_receivers, job.occluders, settings, job.seed, job.threads};
  other.settings.backend = other_backend(result, job.settings);
  other.progress = part_of(job.progress, 0, backend_share);
  const BakeResult other_result = bake(other);
  const std::vector<TransferVectors> compared = thin_out(baked, backend_step);
  verification.other_backend = other_result.renderer;
  verification.backend_texels = compared.front().receivers;
  const bool rays_are_other = other.settings.backend == BakeBackend::embree;
  verification.backend_difference = rays_are_other ? sampled_relative_l2(compared, other_result.channels, all)
                                                   : sampled_relative_l2(other_result.channels, compared, all);

  // Step 2: many rays, from some of the texels.
  const std::size_t step = step_to(all, static_cast<std::size_t>(settings.verify_texels));
  const ReceiverSet some = thin_out(job.receivers, step);
  const BakeJob sampled{some, job.occluders, settings, job.seed, job.threads, {}, job.progress};
  const std::vector<TransferVectors> reference =
      reference_transfer(sampled, sample_directions(Sampling::fibonacci, settings.verify_directions, job.seed + 1u),
                         result.bounces.has_value());
  verification.reference_directions = settings.verify_directions;
  verification.reference_texels = some.slots.size();
  verification.integration_error = sampled_relative_l2(thin_out(baked, step), reference, all);
  if (is_scattered) return verification;
  verification.error = sampled_relative_l2(thin_out(stored, step), reference, all);
  verification.relighting_error = sampled_relighting_error(thin_out(stored, step), reference, all);
  return verification;
}

}  // namespace kiln
