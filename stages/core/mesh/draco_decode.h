// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <draco/mesh/mesh.h>
#include <memory>
#include <span>
#include <string>

namespace kiln {

/// Decodes the bytes of a Draco file or of a part of another file. Throws BadInput, whose message begins with `name`
/// and ends with `remedy`, where they hold points without triangles or are not a whole Draco mesh. Memory stays in
/// proportion to the bytes.
std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::uint8_t> bytes, const std::string& name,
                                          const std::string& remedy);

/// Metadata entry that holds MeshFrame::origin; left out where the origin is 0.
inline constexpr char draco_origin_entry[] = "kiln-origin";

/// Returns the origin that a mesh's metadata names, else 0.
Eigen::Vector3d draco_origin(const draco::Mesh& mesh);

}  // namespace kiln
