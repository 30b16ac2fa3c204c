// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sh/transfer_sums.h"

namespace kiln {

/// Sums of one run of receivers, as checkpoints and shards keep them.
struct SumsFile {
  std::string key;  ///< everything that the sums depend on, as JSON text; only files with equal keys are added
  std::size_t first_receiver = 0;
  std::int64_t blocks_done = 0;  ///< blocks of directions of this shard that are in the sums
  std::int64_t blocks_all = 0;
  TransferSums sums;

  bool complete() const { return blocks_done == blocks_all; }
};

/// Writes the file under a temporary name and renames it. Layout: a line of JSON, then the sums as little-endian 64-bit
/// integers, plane after plane; the JSON holds their XXH3 hash. Throws BadInput where it cannot.
void write_sums(const std::filesystem::path& path, const SumsFile& file);

/// Reads sums. Throws BadInput for anything but a whole file that write_sums wrote.
SumsFile read_sums(const std::filesystem::path& path);

/// Returns the XXH3 hash (128 bits) of positions and normals, or of any points, in hexadecimal.
std::string hash_points(std::initializer_list<std::span<const Eigen::Vector3f>> lists);
std::string hash_triangles(std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace kiln
