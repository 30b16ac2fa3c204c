// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "import/gltf_buffers.h"

namespace kiln {

/// One primitive packed by KHR_draco_mesh_compression.
class GltfDraco {
 public:
  /// Returns the numbers of an attribute, interpreted as `description` (its accessor) says; nothing where it is not
  /// packed.
  std::optional<GltfAccessor> attribute(const std::string& name, const GltfAccessor& description) const;

  std::size_t vertex_count() const { return vertex_count_; }
  const std::vector<std::uint32_t>& indices() const { return indices_; }  ///< three per triangle

 private:
  friend std::optional<GltfDraco> decode_gltf_draco(const GltfDocument& document, GltfBuffers& buffers,
                                                    const GltfJson& primitive, const std::string& place);
  struct Attribute {
    std::string name;
    int components = 0;
    bool is_normalized = false;  ///< `values` are normalised already
    std::shared_ptr<const std::vector<double>> values;
  };

  std::size_t vertex_count_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<Attribute> attributes_;
};

/// Decodes a packed primitive; nothing where it is not packed. Throws BadInput.
std::optional<GltfDraco> decode_gltf_draco(const GltfDocument& document, GltfBuffers& buffers,
                                           const GltfJson& primitive, const std::string& place);

}  // namespace kiln
