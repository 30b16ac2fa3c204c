#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "import/gltf_buffers.h"

namespace kiln {

/// What KHR_draco_mesh_compression packed of one primitive.
class GltfDraco {
 public:
  /// The numbers of an attribute, as `description` (its accessor's) means them. Nothing where it is not packed.
  std::optional<GltfAccessor> attribute(const std::string& name, const GltfAccessor& description) const;

  std::size_t vertex_count() const { return vertex_count_; }
  const std::vector<std::uint32_t>& indices() const { return indices_; }  ///< three for each triangle

 private:
  friend std::optional<GltfDraco> decode_gltf_draco(const GltfDocument& document, GltfBuffers& buffers,
                                                    const GltfDocument::Json& primitive, const std::string& place);
  struct Attribute {
    std::string name;
    int components = 0;
    bool is_normalized = false;  ///< `values` are already
    std::shared_ptr<const std::vector<double>> values;
  };

  std::size_t vertex_count_ = 0;
  std::vector<std::uint32_t> indices_;
  std::vector<Attribute> attributes_;
};

/// Nothing where the primitive is not packed. Throws BadInput.
std::optional<GltfDraco> decode_gltf_draco(const GltfDocument& document, GltfBuffers& buffers,
                                           const GltfDocument::Json& primitive, const std::string& place);

}  // namespace kiln
