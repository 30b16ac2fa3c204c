#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <draco/mesh/mesh.h>
#include <memory>
#include <span>
#include <string>

namespace kiln {

/// Decodes the bytes of a Draco file or of a part of another file. Throws BadInput, which begins with `name` and ends
/// with `remedy`, where they hold points and no triangles, or are no whole Draco mesh. Memory stays in proportion to
/// the bytes.
std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::uint8_t> bytes, const std::string& name,
                                          const std::string& remedy);

/// The entry of a mesh's metadata that holds MeshFrame::origin, left out where it is 0.
inline constexpr char draco_origin_entry[] = "kiln-origin";

/// The origin that a mesh's metadata names, else 0.
Eigen::Vector3d draco_origin(const draco::Mesh& mesh);

}  // namespace kiln
