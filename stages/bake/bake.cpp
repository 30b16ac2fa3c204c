// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "bake/bounce/bounced_light.h"
#include "bake/backends.h"
#include "base/errors.h"
#include "base/stopwatch.h"
#include "sh/basis.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// What a result tells besides the transfer.
BakeResult describe(const Integration& integration, const Stopwatch& stopwatch) {
  BakeResult result;
  result.backend = integration.backend();
  result.sampling = integration.sampling();
  result.directions = integration.directions();
  result.unoccluded = integration.unoccluded();
  result.choice = integration.choice();
  result.shadow_choice = integration.shadow_choice();
  result.seconds = stopwatch.seconds();
  return result;
}

/// The same after the engine has worked, `before` being its work ahead of that.
BakeResult describe(Integration& integration, const TransferWork& before, const Stopwatch& stopwatch) {
  BakeResult result = describe(integration, stopwatch);
  result.renderer = integration.engine().renderer();
  result.software_renderer = integration.engine().is_software();
  result.work = integration.engine().work() - before;
  return result;
}

ProgressFunction part_of(const ProgressFunction& progress, std::size_t part, std::size_t parts) {
  return [&progress, part, parts](double fraction) {
    progress((static_cast<double>(part) + fraction) / static_cast<double>(parts));
  };
}

/// Every `step`-th receiver's transfer.
std::vector<TransferVectors> thin_out(const std::vector<TransferVectors>& channels, std::size_t step) {
  std::vector<TransferVectors> thinned;
  for (const TransferVectors& channel : channels) {
    TransferVectors& some = thinned.emplace_back((channel.receivers + step - 1) / step, channel.coefficients);
    for (int i = 0; i < channel.coefficients; ++i)
      for (std::size_t r = 0; r < some.receivers; ++r) some.plane(i)[r] = channel.plane(i)[r * step];
  }
  return thinned;
}

/// Every `step`-th receiver, without what is filled.
TexelReceivers thin_out(const TexelReceivers& receivers, std::size_t step) {
  TexelReceivers thinned;
  thinned.width = receivers.width;
  thinned.height = receivers.height;
  for (std::size_t r = 0; r < receivers.texels.size(); r += step) {
    thinned.texels.push_back(receivers.texels[r]);
    thinned.positions.push_back(receivers.positions[r]);
    thinned.normals.push_back(receivers.normals[r]);
    if (!receivers.albedos.empty()) thinned.albedos.push_back(receivers.albedos[r]);
  }
  return thinned;
}

/// Every which receiver is looked at, so that about `most` are.
std::size_t step_to(std::size_t receivers, std::size_t most) { return std::max<std::size_t>(1, receivers / most); }

/// Direct light takes the first part of the progress where light bounces.
constexpr double direct_share = 0.3;

/// Bakes some of the receivers and interpolates others; gives what came of it.
AdaptiveReport bake_adaptively(Integration& integration, const TexelReceivers& receivers, const BakeSettings& settings,
                               TransferVectors& transfer, const ProgressFunction& progress) {
  std::vector<std::uint8_t> known(receivers.texels.size(), 1);
  for (std::uint32_t r : integration.tested()) known[r] = 0;
  const BakeSome bake_some = [&](std::span<const std::uint32_t> some) {
    std::vector<Eigen::Vector3f> positions, normals;
    for (std::uint32_t r : some) {
      positions.push_back(receivers.positions[r]);
      normals.push_back(receivers.normals[r]);
    }
    return direct_transfer(integration.engine(), {positions, normals}, integration.direction_list(), settings.bands,
                           no_progress);
  };
  return adaptive_transfer(receivers, std::move(known), bake_some, settings.adaptive, transfer, progress);
}

/// Multiplies each receiver's transfer by its albedo, if there are any.
void put_albedo(std::vector<TransferVectors>& channels, std::span<const Eigen::Vector3f> albedos) {
  const auto is_grey = [](const Eigen::Vector3f& albedo) {
    return albedo.x() == albedo.y() && albedo.y() == albedo.z();
  };
  if (!std::all_of(albedos.begin(), albedos.end(), is_grey)) channels.resize(3, channels.front());
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (int i = 0; i < channels[c].coefficients; ++i)
      for (std::size_t r = 0; r < albedos.size(); ++r)
        channels[c].plane(i)[r] *= albedos[r][static_cast<Eigen::Index>(c)];
}

/// Lets light bounce where settings ask for it; `result.channels` has the direct transfer. Of `memory` was taken what
/// the integration keeps.
void add_bounces(BakeResult& result, Integration& integration, const RayMemory& memory, const TexelReceivers& receivers,
                 const Occluders& occluders, const BakeSettings& settings, int threads,
                 const ProgressFunction& progress) {
  const BounceTarget target = parse_bounces(settings.bounces);
  if (!target.any()) return put_albedo(result.channels, receivers.albedos);
  const BouncedLight light(integration.take_engine(), result.backend, occluders, integration.direction_list(), settings,
                           threads, target, BounceSample(receivers.view(), result.channels.front()),
                           [&](double fraction) { progress(direct_share + (1 - direct_share) * 0.5 * fraction); });
  result.channels.resize(light.channels(), result.channels.front());
  std::vector<TracedReceivers> traced = integration.take_traced();
  result.bounces =
      light.add_to(result.channels, receivers.view(), traced, integration.direction_list(),
                   [&](double fraction) { progress(direct_share + (1 - direct_share) * (0.5 + 0.5 * fraction)); });
  result.bounces->kept_bytes += bounce_memory_share(settings) - memory.left();
  put_albedo(result.channels, receivers.albedos);
}

}  // namespace

BakeResult bake(const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings, int seed,
                int threads, const Checkpoints& checkpoints, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  const bool bounces = parse_bounces(settings.bounces).any();
  const ProgressFunction direct_progress = [&](double fraction) {
    progress(bounces ? direct_share * fraction : fraction);
  };
  RayMemory memory(bounce_memory_share(settings));
  Integration integration(receivers.view(), occluders, settings, seed, threads, direct_progress);
  if (bounces) integration.keep_blocked(memory);
  const TransferWork before = integration.engine().work();
  TransferVectors transfer(receivers.texels.size(), coefficient_count(settings.bands));
  integration.put_unoccluded(transfer);
  std::optional<AdaptiveReport> adaptive;
  if (settings.adaptive > 0) adaptive = bake_adaptively(integration, receivers, settings, transfer, direct_progress);
  for (std::size_t slab = 0; slab < integration.slabs() && !adaptive; ++slab)
    integration.put(slab,
                    integration.sum(slab, {}, checkpoints, part_of(direct_progress, slab, integration.slabs())).sums,
                    transfer);
  BakeResult result = describe(integration, before, stopwatch);
  result.adaptive = adaptive;
  result.channels.push_back(std::move(transfer));
  add_bounces(result, integration, memory, receivers, occluders, settings, threads, progress);
  result.seconds = stopwatch.seconds();
  return result;
}

BakeResult bake_shard(OutputSet& outputs, const Shard& shard, const TexelReceivers& receivers,
                      const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                      const Checkpoints& checkpoints, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  Integration integration(receivers.view(), occluders, settings, seed, threads, progress);
  const TransferWork before = integration.engine().work();
  for (std::size_t slab = 0; slab < integration.slabs(); ++slab)
    write_sums(outputs.add(slab_name(slab)),
               integration.sum(slab, shard, checkpoints, part_of(progress, slab, integration.slabs())));
  BakeResult result = describe(integration, before, stopwatch);
  result.channels.emplace_back(0, coefficient_count(settings.bands));
  return result;
}

BakeResult merge_shards(const std::vector<fs::path>& folders, const TexelReceivers& receivers,
                        const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                        const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  // Step 1: the first shard says how many directions there are, and who integrated them.
  const Json first = read_sums(folders.front() / slab_name(0)).key;
  BakeSettings merged = settings;
  if (settings.max_error.wanted) {
    merged.sampling = Sampling::progressive;
    merged.directions = first.value("directions", 1);
  }
  if (settings.backend == BakeBackend::automatic) bake_options(merged).find("backend")->set(first.value("backend", ""));
  const std::string renderer = first.value("renderer", "");
  merged.max_error = {};
  RayMemory memory(bounce_memory_share(settings));
  Integration integration(receivers.view(), occluders, merged, seed, threads, progress);

  // Step 2: slab after slab, add.
  const int count = static_cast<int>(folders.size());
  TransferVectors transfer(receivers.texels.size(), coefficient_count(settings.bands));
  integration.put_unoccluded(transfer);
  for (std::size_t slab = 0; slab < integration.slabs(); ++slab) {
    std::map<std::string, fs::path> seen;
    TransferSums sums;
    for (const fs::path& folder : folders) {
      const fs::path path = folder / slab_name(slab);
      SumsFile part = read_sums(path);
      const std::string name = part.key.value("shard", "1/1");
      const Shard shard = parse_shard(name);
      if (part.key != integration.key(shard, renderer))
        throw BadInput(path.string(), "holds sums of a bake with other inputs, settings or renderer",
                       "a shard of the same command", "repeat the command of the shards, with --merge for --shard");
      if (shard.count != count)
        throw BadInput(path.string(), "is shard " + name + ", of " + std::to_string(count) + " given",
                       std::to_string(shard.count) + " shards", "give --merge once for each of them");
      if (!part.complete()) throw BadInput(path.string(), "is a checkpoint", "a whole shard", "bake it to its end");
      if (!seen.emplace(name, path).second)
        throw BadInput(path.string(), "is shard " + name + ", as is " + seen[name].string(), "each shard once",
                       "give --merge once for each of them");
      if (sums.values.empty())
        sums = std::move(part.sums);
      else
        sums.add(part.sums);
    }
    integration.put(slab, sums, transfer);
    progress(static_cast<double>(slab + 1) / static_cast<double>(integration.slabs()));
  }
  BakeResult result = describe(integration, stopwatch);
  result.renderer = renderer;
  result.channels.push_back(std::move(transfer));
  add_bounces(result, integration, memory, receivers, occluders, merged, threads, progress);
  result.seconds = stopwatch.seconds();
  return result;
}

BakeVerification verify(const BakeResult& result, const std::vector<TransferVectors>& stored,
                        const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings,
                        int seed, int threads, const ProgressFunction& progress) {
  BakeVerification verification;
  const bool is_scattered = !result.arriving.empty();
  const std::vector<TransferVectors>& baked = is_scattered ? result.arriving : result.channels;

  // Step 1: another backend, over the very same directions.
  const BakeBackend other = result.backend != BakeBackend::embree        ? BakeBackend::embree
                            : settings.backend == BakeBackend::automatic ? BakeBackend::beams
                                                                         : BakeBackend::egl;
  BakeSettings other_settings = settings;
  other_settings.backend = other;
  other_settings.max_error = {};
  other_settings.adaptive = 0;
  other_settings.directions = result.directions;
  other_settings.sampling = result.sampling;
  if (result.bounces) other_settings.bounces = std::to_string(result.bounces->energy.size());
  const std::size_t all = receivers.texels.size(), backend_step = step_to(all, compared_texels);
  const BakeResult other_result = bake(thin_out(receivers, backend_step), occluders, other_settings, seed, threads, {},
                                       [&](double fraction) { progress(0.3 * fraction); });
  const std::vector<TransferVectors> compared = thin_out(baked, backend_step);
  verification.other_backend = other_result.renderer;
  verification.backend_texels = compared.front().receivers;
  const bool rays_are_other = other == BakeBackend::embree;
  verification.backend_difference = rays_are_other ? sampled_relative_l2(compared, other_result.channels, all)
                                                   : sampled_relative_l2(other_result.channels, compared, all);

  // Step 2: many rays, from some of the texels.
  const std::size_t step = step_to(all, static_cast<std::size_t>(settings.verify_texels));
  const TexelReceivers some = thin_out(receivers, step);
  const std::vector<Eigen::Vector3f> many =
      sample_directions(Sampling::fibonacci, settings.verify_directions, seed + 1u);
  const std::unique_ptr<TransferEngine> rays = make_engine(BakeBackend::embree, occluders, settings, threads);
  rays->set_receivers(some.view(), settings.bands);
  rays->add(many, [&](double fraction) { progress(0.3 + 0.7 * fraction); });
  std::vector<TransferVectors> reference = {rays->sums().transfer()};
  if (result.bounces) {
    // The surface's light by the bake's own number of directions: the last bounce, which shows, by many.
    std::vector<Eigen::Vector3f> own =
        sample_directions(result.sampling, result.directions, static_cast<std::uint64_t>(seed));
    order_coherently(own, block_directions);
    const BounceTarget target = {.automatic = false, .count = static_cast<int>(result.bounces->energy.size())};
    const BouncedLight light(make_engine(BakeBackend::embree, occluders, settings, threads), BakeBackend::embree,
                             occluders, own, settings, threads, target, BounceSample(some.view(), reference.front()),
                             no_progress);
    reference.resize(light.channels(), reference.front());
    std::vector<TracedReceivers> traced = untraced(some.view());
    light.add_to(reference, some.view(), traced, many, no_progress);
  }
  put_albedo(reference, some.albedos);
  verification.reference_directions = settings.verify_directions;
  verification.reference_texels = some.texels.size();
  verification.integration_error = sampled_relative_l2(thin_out(baked, step), reference, all);
  if (is_scattered) return verification;
  verification.error = sampled_relative_l2(thin_out(stored, step), reference, all);
  verification.relighting_error = sampled_relighting_error(thin_out(stored, step), reference, all);
  return verification;
}

}  // namespace kiln
