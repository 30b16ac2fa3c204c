// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"

#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "bake/adaptive/adaptive.h"
#include "bake/bounce/bounced_light.h"
#include "bake/bounce/receiver_albedo.h"
#include "bake/integrate/integration.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "sh/basis.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Returns a result without the transfer.
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

/// Returns a result without the transfer, after the engine has worked; `before` is what it had done before.
BakeResult describe(Integration& integration, const TransferWork& before, const Stopwatch& stopwatch) {
  BakeResult result = describe(integration, stopwatch);
  result.renderer = integration.engine().renderer();
  result.software_renderer = integration.engine().is_software();
  result.work = integration.engine().work() - before;
  return result;
}

/// Share of the progress that direct light takes where light bounces.
constexpr double direct_share = 0.3;

/// Bakes some of the receivers and interpolates the others.
AdaptiveReport bake_adaptively(const BakeJob& job, Integration& integration, TransferVectors& transfer) {
  const ReceiverSet& receivers = job.receivers;
  const BakeSettings& settings = job.settings;
  std::vector<std::uint8_t> known(receivers.slots.size(), 1);
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
  return adaptive_transfer(receivers, std::move(known), bake_some, settings.adaptive, transfer, job.progress);
}

/// Lets light bounce if the settings ask for it, and multiplies by the receivers' albedo, if they have one;
/// `result.channels` has the direct transfer. `memory` is what the integration kept its rays in.
void add_bounces(BakeResult& result, const BakeJob& job, Integration& integration, const RayMemory& memory) {
  if (job.settings.bounces.any()) {
    std::vector<TracedReceivers> traced = integration.take_traced();
    const BounceDirections directions{integration.direction_list(), integration.direction_list()};
    result.bounces = add_bounced_light(job, result.backend, integration.take_engine(), directions, traced,
                                       result.channels, part_of(job.progress, direct_share, 1));
    result.bounces->kept_bytes += bounce_memory_share(job.settings) - memory.left();
  }
  multiply_albedo(result.channels, job.receivers.albedos);
}

/// Returns the job of the direct light alone: the same, with its part of the progress.
BakeJob direct_job(const BakeJob& job) {
  BakeJob direct = job;
  if (job.settings.bounces.any()) direct.progress = part_of(job.progress, 0, direct_share);
  return direct;
}

/// Bakes without shadows: the transfer follows from the normals.
BakeResult bake_unshadowed(const BakeJob& job) {
  const Stopwatch stopwatch;
  const ReceiverSet& receivers = job.receivers;
  const ShBasis basis(job.settings.bands);
  TransferVectors transfer(receivers.slots.size(), basis.size());
  parallel_for(std::size_t{0}, receivers.slots.size(), 256, [&](std::size_t r) {
    const std::vector<float> values = unoccluded_transfer(basis, receivers.normals[r]);
    for (int i = 0; i < basis.size(); ++i) transfer.plane(i)[r] = values[static_cast<std::size_t>(i)];
  });
  BakeResult result;
  result.renderer = "none: the bake has no shadows";
  result.unoccluded = receivers.slots.size();
  result.channels.push_back(std::move(transfer));
  multiply_albedo(result.channels, receivers.albedos);
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace

BakeResult bake(const BakeJob& job) {
  if (!job.settings.casts_shadows) return bake_unshadowed(job);
  const Stopwatch stopwatch;
  const BakeJob direct = direct_job(job);
  RayMemory memory(bounce_memory_share(job.settings));
  Integration integration(direct);
  if (job.settings.bounces.any()) integration.keep_blocked(memory);
  const TransferWork before = integration.engine().work();
  TransferVectors transfer(job.receivers.slots.size(), coefficient_count(job.settings.bands));
  integration.put_unoccluded(transfer);
  std::optional<AdaptiveReport> adaptive;
  if (job.settings.adaptive > 0) adaptive = bake_adaptively(direct, integration, transfer);
  for (std::size_t slab = 0; slab < integration.slabs() && !adaptive; ++slab)
    integration.put(slab, integration.sum(slab, {}, step_of(direct.progress, slab, integration.slabs())).sums,
                    transfer);
  BakeResult result = describe(integration, before, stopwatch);
  result.adaptive = adaptive;
  result.channels.push_back(std::move(transfer));
  add_bounces(result, job, integration, memory);
  result.seconds = stopwatch.seconds();
  return result;
}

BakeResult bake_shard(OutputSet& outputs, const Shard& shard, const BakeJob& job) {
  const Stopwatch stopwatch;
  Integration integration(job);
  const TransferWork before = integration.engine().work();
  for (std::size_t slab = 0; slab < integration.slabs(); ++slab)
    write_sums(outputs.add(slab_name(slab)),
               integration.sum(slab, shard, step_of(job.progress, slab, integration.slabs())));
  BakeResult result = describe(integration, before, stopwatch);
  result.channels.emplace_back(0, coefficient_count(job.settings.bands));
  return result;
}

BakeResult merge_shards(const std::vector<fs::path>& folders, const BakeJob& given) {
  const Stopwatch stopwatch;
  // Step 1: read from the first shard how many directions there are, and what integrated them.
  const Json first = Json::parse(read_sums(folders.front() / slab_name(0)).key);
  BakeJob job = given;
  BakeSettings& merged = job.settings;
  if (given.settings.max_error.wanted) {
    merged.sampling = Sampling::progressive;
    merged.directions = first.value("directions", 1);
  }
  if (given.settings.backend == BakeBackend::automatic)
    bake_options(merged).find("backend")->set(first.value("backend", ""));
  const std::string renderer = first.value("renderer", "");
  merged.max_error = {};
  RayMemory memory(bounce_memory_share(merged));
  Integration integration(job);

  // Step 2: add the shards' sums, slab after slab.
  const int count = static_cast<int>(folders.size());
  TransferVectors transfer(job.receivers.slots.size(), coefficient_count(merged.bands));
  integration.put_unoccluded(transfer);
  for (std::size_t slab = 0; slab < integration.slabs(); ++slab) {
    std::map<std::string, fs::path> seen;
    TransferSums sums;
    for (const fs::path& folder : folders) {
      const fs::path path = folder / slab_name(slab);
      SumsFile part = read_sums(path);
      const std::string name = Json::parse(part.key).value("shard", "1/1");
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
    job.progress(static_cast<double>(slab + 1) / static_cast<double>(integration.slabs()));
  }
  BakeResult result = describe(integration, stopwatch);
  result.renderer = renderer;
  result.channels.push_back(std::move(transfer));
  add_bounces(result, job, integration, memory);
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace kiln
