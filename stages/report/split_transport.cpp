// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/split_transport.h"

#include <algorithm>

#include "raycast/ray_transfer.h"
#include "report/bounce_paths.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {

namespace {

constexpr int path_directions = 512;             // of each of two sets, where light bounces
constexpr std::size_t receivers_at_once = 4096;  // bounds the memory of entries

std::uint64_t seed_of_set(const SplitLight& light, std::uint64_t set) { return light.seed + 2 + set; }

}  // namespace

SplitTransport::SplitTransport(const SceneMesh& scene, const TriangleMesh& surface, const SplitLight& light)
    : scene_(scene), light_(light), rays_(scene.mesh), offset_(rounding_offset(scene.mesh.positions)) {
  if (!light.scattering.empty())
    scatter_ = std::make_unique<const ScatterPaths>(surface, light.scattering, light.mm_per_unit);
  if (light.bounces > 0)
    paths_ = std::make_unique<const BouncePaths>(rays_, scene, light.bounces, offset_, light.wavelengths_nm);
}

TransferRows SplitTransport::direct(const Receivers& receivers, int bands,
                                    std::span<const Eigen::Vector3f> directions) const {
  return in_rows(transfer_by_rays(rays_, receivers, directions, bands, offset_));
}

Station SplitTransport::bounced(const Receivers& receivers, int bands) const {
  return {bounced_by(receivers, bands, 0), bounced_by(receivers, bands, 1)};
}

TransferRows SplitTransport::bounced_by(const Receivers& receivers, int bands, std::uint64_t set) const {
  const int coefficients = coefficient_count(bands);
  const std::size_t carried = light_.wavelengths_nm.empty() ? 3 : light_.wavelengths_nm.size();
  std::vector<TransferVectors> colors(carried, TransferVectors(receivers.size(), coefficients));
  if (paths_) {
    const std::uint64_t seed = seed_of_set(light_, set);
    paths_->add(receivers, sample_directions(Sampling::fibonacci, path_directions, seed), seed << 32, colors);
  }
  return in_rows(colors, light_.channels);
}

Station SplitTransport::beneath(const Receivers& receivers, int bands,
                                const std::vector<std::uint64_t>& numbers) const {
  return {beneath_by(receivers, bands, numbers, 0), beneath_by(receivers, bands, numbers, 1)};
}

TransferRows SplitTransport::beneath_by(const Receivers& receivers, int bands,
                                        const std::vector<std::uint64_t>& numbers, std::uint64_t set) const {
  const int coefficients = coefficient_count(bands);
  TransferRows all{static_cast<std::size_t>(coefficients) * static_cast<std::size_t>(light_.channels), {}};
  const PathWalker walker(rays_, scene_, light_.bounces, offset_);
  for (std::size_t begin = 0; begin < receivers.size(); begin += receivers_at_once) {
    const std::size_t size = std::min(receivers_at_once, receivers.size() - begin);
    std::vector<std::uint64_t> of_set(size);
    std::transform(numbers.begin() + static_cast<std::ptrdiff_t>(begin),
                   numbers.begin() + static_cast<std::ptrdiff_t>(begin + size), of_set.begin(),
                   [&](std::uint64_t number) { return (seed_of_set(light_, set) << 32) + number; });
    const ScatterEntries entries = scatter_->entries(
        {receivers.positions.subspan(begin, size), receivers.normals.subspan(begin, size)}, light_.lines, of_set);
    std::vector<TransferVectors> colors(3, TransferVectors(size, coefficients)), unbounced = colors;
    add_scattered(entries, walker, of_set, colors, unbounced);
    const TransferRows rows = in_rows(colors, light_.channels);
    all.values.insert(all.values.end(), rows.values.begin(), rows.values.end());
  }
  return all;
}

}  // namespace kiln
