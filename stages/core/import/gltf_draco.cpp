// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_draco.h"

#include <memory>

#include "mesh/draco_decode.h"

// KHR_draco_mesh_compression: attributes are known by Draco's unique ids, and interpreted as their accessors say.

namespace kiln {

namespace {

std::shared_ptr<std::vector<double>> values_of(const draco::PointAttribute& attribute, std::size_t points) {
  const auto components = static_cast<std::size_t>(attribute.num_components());
  auto values = std::make_shared<std::vector<double>>(points * components);
  for (std::size_t i = 0; i < points; ++i)
    attribute.ConvertValue<double>(attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i))),
                                   static_cast<std::int8_t>(components), values->data() + i * components);
  return values;
}

}  // namespace

std::optional<GltfAccessor> GltfDraco::attribute(const std::string& name, const GltfAccessor& description) const {
  for (const Attribute& attribute : attributes_) {
    if (attribute.name != name) continue;
    GltfAccessor accessor = description;
    accessor.count = vertex_count_;
    accessor.components = attribute.components;
    accessor.normalized = description.normalized && !attribute.is_normalized;
    accessor.decoded = attribute.values;
    return accessor;
  }
  return std::nullopt;
}

std::optional<GltfDraco> decode_gltf_draco(const GltfDocument& document, GltfBuffers& buffers,
                                           const GltfJson& primitive, const std::string& place) {
  const auto* extension = document.extension(primitive, "KHR_draco_mesh_compression", place);
  if (extension == nullptr) return std::nullopt;
  const auto bytes = buffers.view(document.required_index(*extension, "bufferView", place), place);
  const auto mesh = decode_draco(bytes, document.file().string() + ": the packed part of " + place, "export it again");
  GltfDraco result;
  result.vertex_count_ = mesh->num_points();
  for (std::uint32_t i = 0; i < mesh->num_faces(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      result.indices_.push_back(mesh->face(draco::FaceIndex(i))[static_cast<std::size_t>(corner)].value());
  const auto* attributes = document.object(*extension, "attributes", place);
  if (attributes == nullptr) return result;
  for (const auto& [name, id] : attributes->items()) {
    const std::size_t unique_id = document.required_index(*attributes, name.c_str(), place);
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(unique_id));
    if (attribute == nullptr || attribute->num_components() < 1 || attribute->num_components() > 16)
      document.fail(place + " names the attribute " + std::to_string(unique_id) + " of its packed part for " + name,
                    "one that is there");
    result.attributes_.push_back(
        {name, attribute->num_components(), attribute->normalized(), values_of(*attribute, mesh->num_points())});
  }
  return result;
}

}  // namespace kiln
