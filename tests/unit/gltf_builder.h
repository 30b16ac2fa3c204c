// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "import_support.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Builds glTF files for tests.
class GltfBuilder {
 public:
  using Json = nlohmann::json;

  Json json = {{"asset", {{"version", "2.0"}}}, {"bufferViews", Json::array()}, {"accessors", Json::array()}};
  std::string binary;

  std::size_t view(const std::string& bytes) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
    binary += bytes;
    return json["bufferViews"].size() - 1;
  }

  std::size_t accessor(std::size_t view_index, const char* type, int component_type, std::size_t count,
                       bool normalized = false) {
    json["accessors"].push_back({{"bufferView", view_index},
                                 {"type", type},
                                 {"componentType", component_type},
                                 {"count", count},
                                 {"normalized", normalized}});
    return json["accessors"].size() - 1;
  }

  template <class Vector>
  std::size_t floats(const char* type, const std::vector<Vector>& values) {
    std::string bytes;
    for (const Vector& value : values)
      for (int k = 0; k < value.size(); ++k) import_support::append(bytes, value[k]);
    return accessor(view(bytes), type, 5126, values.size());
  }

  template <class Index>
  std::size_t indices(int component_type, const std::vector<std::uint32_t>& values) {
    std::string bytes;
    for (const std::uint32_t value : values) import_support::append(bytes, static_cast<Index>(value));
    return accessor(view(bytes), "SCALAR", component_type, values.size());
  }

  /// Adds a mesh of one primitive.
  std::size_t mesh(Json primitive) {
    json["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
    return json["meshes"].size() - 1;
  }

  static std::vector<std::uint32_t> corners_of(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    return corners;
  }

  /// Makes a primitive of a mesh's positions, normals and triangles.
  Json primitive(const TriangleMesh& mesh) {
    Json result = {{"attributes", {{"POSITION", floats("VEC3", mesh.positions)}}},
                   {"indices", indices<std::uint32_t>(5125, corners_of(mesh))}};
    if (!mesh.normals.empty()) result["attributes"]["NORMAL"] = floats("VEC3", mesh.normals);
    return result;
  }

  std::string glb() const {
    Json text_json = json;
    if (!text_json.contains("buffers")) text_json["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = text_json.dump(), chunk = binary;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    chunk.resize((chunk.size() + 3) / 4 * 4);
    std::string bytes = "glTF";
    for (const std::size_t word : {std::size_t{2}, 28 + text.size() + chunk.size(), text.size()})
      import_support::append(bytes, static_cast<std::uint32_t>(word));
    bytes += "JSON" + text;
    import_support::append(bytes, static_cast<std::uint32_t>(chunk.size()));
    return bytes + std::string("BIN\0", 4) + chunk;
  }

  std::string gltf(const std::string& uri) const {
    Json text = json;
    text["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
    return text.dump();
  }
};

inline std::string base64(const std::string& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

}  // namespace kiln
