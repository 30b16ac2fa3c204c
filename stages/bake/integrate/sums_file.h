// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "base/options.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// The sums of one run of receivers, as checkpoints and shards keep them.
struct SumsFile {
  Json key;  ///< what the sums are of; only files with equal keys go together
  std::size_t first_receiver = 0;
  std::int64_t blocks_done = 0;  ///< of this shard's blocks of directions
  std::int64_t blocks_all = 0;
  TransferSums sums;

  bool complete() const { return blocks_done == blocks_all; }
};

/// Writes it under a temporary name and renames it. Layout: a line of JSON, then the sums as little-endian 64-bit
/// integers, plane after plane; the JSON holds their XXH3 hash. Throws BadInput where it cannot.
void write_sums(const std::filesystem::path& path, const SumsFile& file);

/// Throws BadInput for anything that write_sums did not write, whole.
SumsFile read_sums(const std::filesystem::path& path);

/// XXH3 (128 bits) of positions and normals, or of any points, in hexadecimal.
std::string hash_points(std::initializer_list<std::span<const Eigen::Vector3f>> lists);
std::string hash_triangles(std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace kiln
