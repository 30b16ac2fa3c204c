// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "import/source_mesh.h"

namespace kiln {

/// Helpers shared by tests of readers.
namespace import_support {

inline std::filesystem::path write(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::remove(file);  // ext4 waits for the disk if a file is truncated and written again
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Computes the volume that the faces enclose; negative if they are inside out.
inline double signed_volume(const SourceMesh& mesh) {
  double sum = 0;
  for (const SourceMesh::Face& face : mesh.faces) {
    const auto corners = mesh.corners_of(face);
    for (std::size_t k = 2; k < corners.size(); ++k)
      sum += mesh.places[corners[0].place].dot(mesh.places[corners[k - 1].place].cross(mesh.places[corners[k].place]));
  }
  return sum / 6;
}

/// Finds the smallest cosine between a corner's normal and its face's.
inline double worst_normal(const SourceMesh& mesh) {
  double worst = 1;
  for (const SourceMesh::Face& face : mesh.faces) {
    const auto corners = mesh.corners_of(face);
    const Eigen::Vector3d& origin = mesh.places[corners[0].place];
    const Eigen::Vector3d flat =
        (mesh.places[corners[1].place] - origin).cross(mesh.places[corners[2].place] - origin).normalized();
    for (const SourceMesh::Corner& corner : corners)
      worst = std::min(worst, flat.dot(mesh.normals.at(corner.normal).cast<double>()));
  }
  return worst;
}

/// Returns the message with which `read` refuses `file`; empty if it does not.
inline std::string refusal(const std::function<SourceMesh(const std::filesystem::path&)>& read,
                           const std::filesystem::path& file) {
  try {
    read(file);
  } catch (const BadInput& fault) {
    return fault.what();
  }
  return {};
}

inline bool warns(const SourceMesh& mesh, const std::string& part) {
  for (const std::string& warning : mesh.warnings)
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

/// Reads `rounds` damaged copies of a good file: each must be refused or read as a sound mesh. Returns how many were
/// refused.
inline int read_damaged(const std::function<SourceMesh(const std::filesystem::path&)>& read,
                        const std::filesystem::path& file, const std::string& good, int rounds, std::size_t first = 0) {
  std::mt19937 random(7);
  const auto below = [&random](std::size_t end) { return random() % end; };
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string bytes = good;
    if (below(5) == 0) {
      bytes.resize(below(bytes.size()));
    } else {
      for (std::size_t changes = 1 + below(4); changes > 0; --changes)
        bytes[first + below(bytes.size() - first)] = static_cast<char>(below(2) == 0 ? below(256) : 255 * below(2));
    }
    write(file, bytes);
    try {
      const SourceMesh mesh = read(file);
      EXPECT_FALSE(mesh.faces.empty());
      for (const SourceMesh::Corner& corner : mesh.corners) {
        EXPECT_TRUE(corner.place < mesh.places.size() && mesh.places[corner.place].allFinite());
        EXPECT_TRUE(corner.uv == SourceMesh::none || corner.uv < mesh.uvs.size());
        EXPECT_TRUE(corner.normal == SourceMesh::none || corner.normal < mesh.normals.size());
      }
    } catch (const BadInput&) {
      ++refused;
    }
  }
  return refused;
}

}  // namespace import_support

}  // namespace kiln
