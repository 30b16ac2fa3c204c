// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/integrate/sums_file.h"

#include <bit>
#include <cerrno>
#include <fstream>

#include "base/errors.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/json.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "sums are written as they lie in memory");

constexpr char format[] = "kiln-sums";

std::span<const std::byte> bytes_of(const std::vector<std::int64_t>& values) {
  return std::as_bytes(std::span(values));
}

}  // namespace

void write_sums(const fs::path& path, const SumsFile& file) {
  const Json header = {{"format", format},
                       {"version", 1},
                       {"key", Json::parse(file.key)},
                       {"first_receiver", file.first_receiver},
                       {"receivers", file.sums.receivers},
                       {"coefficients", file.sums.coefficients},
                       {"directions", file.sums.directions},
                       {"blocks_done", file.blocks_done},
                       {"blocks_all", file.blocks_all},
                       {"hash", hash_bytes({bytes_of(file.sums.values)})}};
  const fs::path unfinished = path.string() + ".part";
  {
    std::ofstream stream(unfinished, std::ios::binary);
    stream << header.dump() << '\n';
    const std::span<const std::byte> bytes = bytes_of(file.sums.values);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
      const bool full = disk_is_full(unfinished);
      std::error_code ignored;
      fs::remove(unfinished, ignored);
      fail_to_write(path, "", full ? ENOSPC : 0);
    }
  }
  fs::rename(unfinished, path);
}

SumsFile read_sums(const fs::path& path) {
  const auto bad = [&](const std::string& found) {
    return BadInput(path.string(), found, "sums that kiln-bake wrote", "delete it and bake again");
  };
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  if (!std::getline(stream, line)) throw bad("is empty or cannot be read");
  SumsFile file;
  std::string hash;
  std::error_code failure;
  const std::uintmax_t bytes = fs::file_size(path, failure);
  try {
    const Json header = Json::parse(line);
    if (header.at("format") != format || header.at("version") != 1) throw bad("has another format or version");
    file.key = json_text(header.at("key"));
    file.first_receiver = header.at("first_receiver");
    file.blocks_done = header.at("blocks_done");
    file.blocks_all = header.at("blocks_all");
    hash = header.at("hash");
    const std::size_t receivers = header.at("receivers");
    const int coefficients = header.at("coefficients");
    // Check the header before memory is allocated by its numbers.
    if (failure || coefficients < 1 || coefficients > 65 * 65 ||
        receivers > bytes / sizeof(std::int64_t) / static_cast<std::size_t>(coefficients) ||
        bytes != line.size() + 1 + receivers * static_cast<std::size_t>(coefficients) * sizeof(std::int64_t))
      throw bad("has " + std::to_string(bytes) + " bytes, not what its header says: it was cut off");
    file.sums = TransferSums(receivers, coefficients);
    file.sums.directions = header.at("directions");
  } catch (const Json::exception&) {
    throw bad("has no header");
  }
  stream.read(reinterpret_cast<char*>(file.sums.values.data()),
              static_cast<std::streamsize>(file.sums.values.size() * sizeof(std::int64_t)));
  if (!stream || hash_bytes({bytes_of(file.sums.values)}) != hash) throw bad("is damaged: its hash does not fit");
  return file;
}

std::string hash_points(std::initializer_list<std::span<const Eigen::Vector3f>> lists) {
  std::vector<std::span<const std::byte>> parts;
  for (const auto& list : lists) parts.push_back(std::as_bytes(list));
  return hash_bytes(parts);
}

std::string hash_triangles(std::span<const std::array<std::uint32_t, 3>> triangles) {
  return hash_bytes({std::as_bytes(triangles)});
}

}  // namespace kiln
