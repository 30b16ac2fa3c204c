// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "import/source_mesh.h"
#include "scratch.h"

namespace kiln {

using Reader = SourceMesh (*)(const std::filesystem::path&);

/// Files for testing a reader, in a folder that is removed after the test.
class ImportFiles {
 public:
  ImportFiles(Reader reader, std::string name) : reader_(reader), name_(std::move(name)) {}

  std::filesystem::path write(const std::string& bytes) const {
    const std::filesystem::path file = scratch_.folder() / name_;
    std::filesystem::remove(file);  // ext4 waits for the disk if a file is truncated and written again
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }

  SourceMesh read(const std::string& bytes) const { return reader_(write(bytes)); }

  /// Expects a refusal whose message names the file and contains all of `parts`.
  void expect_refused(const std::string& bytes, const std::vector<std::string>& parts) const {
    const std::filesystem::path file = write(bytes);
    try {
      reader_(file);
      ADD_FAILURE() << "was read, where a refusal with '" << parts[0] << "' was expected";
    } catch (const BadInput& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(file.string(), 0), 0u) << message;
      for (const std::string& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
    }
  }

  /// Reads `count` variants of a good file with bytes changed, cut out, doubled or cut off: each must be read as a
  /// sound mesh or refused. Returns how many were refused.
  int mutate(const std::string& good, int count) const {
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < count; ++i) {
      const std::string bytes = mutant(good, random);
      try {
        expect_sound(read(bytes));
      } catch (const BadInput&) {
        ++refused;
      }
    }
    return refused;
  }

  static void expect_sound(const SourceMesh& mesh) {
    ASSERT_FALSE(mesh.faces.empty());
    ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.places.size());
    for (const Eigen::Vector3f& color : mesh.colors) ASSERT_TRUE(color.minCoeff() >= 0 && color.maxCoeff() <= 1);
    for (const SourceMesh::Face& face : mesh.faces) {
      ASSERT_GE(face.corner_count, 3u);
      ASSERT_LE(std::size_t{face.first_corner} + face.corner_count, mesh.corners.size());
      ASSERT_LT(face.material, static_cast<std::int32_t>(mesh.materials.size()));
      for (const SourceMesh::Corner& corner : mesh.corners_of(face)) {
        ASSERT_LT(corner.place, mesh.places.size());
        ASSERT_TRUE(mesh.places[corner.place].allFinite());
        ASSERT_TRUE(corner.uv == SourceMesh::none || corner.uv < mesh.uvs.size());
        ASSERT_TRUE(corner.normal == SourceMesh::none || corner.normal < mesh.normals.size());
      }
    }
  }

 private:
  static std::string mutant(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t end) { return std::size_t{random()} % std::max<std::size_t>(end, 1); };
    for (std::size_t change = 1 + below(3); change > 0 && !bytes.empty(); --change) {
      const std::size_t at = below(bytes.size()), length = 1 + below(8);
      if (const std::size_t kind = below(8); kind < 4)
        bytes[at] = static_cast<char>(random());
      else if (kind < 5)
        bytes.erase(at, length);
      else if (kind < 6)
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
      else if (kind < 7)
        bytes[at] = "0123456789-.,e \n"[below(16)];
      else
        bytes.resize(at);
    }
    return bytes;
  }

  Scratch scratch_;
  Reader reader_;
  std::string name_;
};

/// Returns the bytes of a number, little-endian or big-endian.
template <class Value>
std::string number_bytes(Value value, bool is_big = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (is_big == (std::endian::native == std::endian::little)) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Counts the warnings that contain a text.
inline long warnings_with(const SourceMesh& mesh, const std::string& part) {
  return std::count_if(mesh.warnings.begin(), mesh.warnings.end(),
                       [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

/// Lists the positions of a face's corners.
inline std::vector<std::uint32_t> places_of(const SourceMesh& mesh, std::size_t face) {
  std::vector<std::uint32_t> places;
  for (const SourceMesh::Corner& corner : mesh.corners_of(mesh.faces[face])) places.push_back(corner.place);
  return places;
}

}  // namespace kiln
