// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/draco_file.h"

namespace kiln {

/// Draco mesh for another file to hold, such as a glTF file, and what every decoder yields of it.
struct DracoStream {
  std::string bytes;
  AttributedMesh decoded;                 ///< positions as stored, its frame the identity; normals as stored
  std::vector<Eigen::Vector4f> tangents;  ///< one per decoded vertex, or empty

  /// Unique ids of the attributes in the stream; none where the mesh has no such attribute. Those of integer attributes
  /// are in `decoded`.
  std::optional<std::uint32_t> position_id, normal_id, uv_id, texture_uv_id, tangent_id;
};

/// Encodes a mesh, with `tangents` (none, or one per vertex; stored exactly) and integer attributes. Positions are
/// stored as they are, relative to the origin of the mesh's frame, whose exponent must be 0; the origin is not stored.
/// Vertices and triangles may change their order, as with save_draco.
DracoStream encode_draco(const AttributedMesh& mesh, const std::vector<Eigen::Vector4f>& tangents,
                         const DracoQuantisation& quantisation = {});

}  // namespace kiln
