// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/glb_mesh.h"

#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <meshoptimizer.h>
#include <optional>
#include <utility>

#include "mesh/draco_stream.h"
#include "mesh/tangent_space.h"

namespace kiln {

namespace {

constexpr const char* draco_extension = "KHR_draco_mesh_compression";
constexpr int vertex_target = 34962, index_target = 34963;  // ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER
constexpr int type_uint8 = 5121, type_uint16 = 5123, type_uint32 = 5125, type_float = 5126;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and values are copied as they are");

const char* type_of(int components) {
  constexpr std::array names = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return names.at(static_cast<std::size_t>(components) - 1);
}

/// Values of one attribute at all vertices.
struct Values {
  std::string name;
  int components = 0, component_type = type_float;
  std::size_t stride = 0;  ///< a multiple of 4
  std::string bytes;
};

template <class Vector>
Values values_of(const std::string& name, const std::vector<Vector>& vectors) {
  constexpr int components = Vector::RowsAtCompileTime;
  Values values{name, components, type_float, sizeof(Vector), std::string(vectors.size() * sizeof(Vector), '\0')};
  static_assert(sizeof(Vector) == components * sizeof(float));
  if (!vectors.empty()) std::memcpy(values.bytes.data(), vectors.data(), values.bytes.size());
  return values;
}

Values values_of(const IntegerAttribute& attribute) {
  const auto components = static_cast<std::size_t>(attribute.components);
  const std::size_t width = attribute.bits == 8 ? 1 : 2, stride = (components * width + 3) / 4 * 4;
  const std::size_t count = attribute.values.size() / components;
  Values values{glb_attribute_name(attribute.name), attribute.components,
                attribute.bits == 8 ? type_uint8 : type_uint16, stride, std::string(count * stride, '\0')};
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    for (std::size_t k = 0; k < components; ++k)
      std::memcpy(values.bytes.data() + vertex * stride + k * width, &attribute.values[vertex * components + k], width);
  return values;
}

std::vector<Values> all_values(const GlbMesh& mesh) {
  const TriangleMesh& source = mesh.mesh.mesh;
  std::vector<Values> all = {values_of("POSITION", source.positions)};
  if (!source.normals.empty()) all.push_back(values_of("NORMAL", source.normals));
  if (!source.uvs.empty()) all.push_back(values_of("TEXCOORD_0", source.uvs));
  if (!source.texture_uvs.empty()) all.push_back(values_of("TEXCOORD_1", source.texture_uvs));
  if (!mesh.tangents.empty()) all.push_back(values_of("TANGENT", mesh.tangents));
  for (const IntegerAttribute& attribute : mesh.mesh.attributes) all.push_back(values_of(attribute));
  return all;
}

/// Describes an attribute without saying where its bytes are. Positions state their box.
Json accessor_of(const Values& values, const std::vector<Eigen::Vector3f>& positions) {
  Json accessor = {
      {"componentType", values.component_type}, {"count", positions.size()}, {"type", type_of(values.components)}};
  if (values.name != "POSITION") return accessor;
  const BoundingBox box = bounding_box(positions);
  accessor["min"] = {box.lowest.x(), box.lowest.y(), box.lowest.z()};
  accessor["max"] = {box.highest.x(), box.highest.y(), box.highest.z()};
  return accessor;
}

/// Tells the type of indices; the largest number of each is left for restarts of strips.
int index_type(std::size_t vertices) { return vertices < UINT16_MAX ? type_uint16 : type_uint32; }

Json index_accessor(std::size_t vertices, std::size_t triangles) {
  return {{"componentType", index_type(vertices)}, {"count", 3 * triangles}, {"type", "SCALAR"}};
}

std::string index_bytes(const std::vector<Triangle>& triangles, std::size_t vertices) {
  std::string bytes;
  const std::size_t width = index_type(vertices) == type_uint16 ? 2 : 4;
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t index : triangle) bytes.append(reinterpret_cast<const char*>(&index), width);
  return bytes;
}

AddedMesh add_draco(GlbFile& file, const GlbMesh& mesh) {
  const DracoStream stream = encode_draco(mesh.mesh, mesh.tangents);
  const GlbMesh decoded{stream.decoded, stream.tangents};
  const TriangleMesh& stored = decoded.mesh.mesh;
  std::map<std::string, std::optional<std::uint32_t>> ids = {{"POSITION", stream.position_id},
                                                             {"NORMAL", stream.normal_id},
                                                             {"TEXCOORD_0", stream.uv_id},
                                                             {"TEXCOORD_1", stream.texture_uv_id},
                                                             {"TANGENT", stream.tangent_id}};
  for (const IntegerAttribute& attribute : decoded.mesh.attributes)
    ids[glb_attribute_name(attribute.name)] = attribute.unique_id;

  file.use_extension(draco_extension, true);
  Json attributes, packed;
  for (const Values& values : all_values(decoded)) {
    attributes[values.name] = file.add("accessors", accessor_of(values, stored.positions));
    packed[values.name] = ids.at(values.name).value();
  }
  const std::size_t indices = file.add("accessors", index_accessor(stored.positions.size(), stored.triangles.size()));
  const std::size_t view = file.add_bytes(stream.bytes);
  return {{{"attributes", attributes},
           {"indices", indices},
           {"extensions", {{draco_extension, {{"bufferView", view}, {"attributes", packed}}}}}},
          stored.positions.size(),
          stored.triangles.size()};
}

AddedMesh add_plain(GlbFile& file, const GlbMesh& mesh) {
  const TriangleMesh& source = mesh.mesh.mesh;
  Json attributes;
  for (const Values& values : all_values(mesh)) {
    Json accessor = accessor_of(values, source.positions);
    accessor["bufferView"] = file.add_bytes(values.bytes, {{"byteStride", values.stride}, {"target", vertex_target}});
    attributes[values.name] = file.add("accessors", std::move(accessor));
  }
  Json accessor = index_accessor(source.positions.size(), source.triangles.size());
  accessor["bufferView"] =
      file.add_bytes(index_bytes(source.triangles, source.positions.size()), {{"target", index_target}});
  return {{{"attributes", attributes}, {"indices", file.add("accessors", std::move(accessor))}},
          source.positions.size(),
          source.triangles.size()};
}

/// Orders triangles and vertices for the vertex cache, which is what the packing is made for, and packs them.
AddedMesh add_meshopt(GlbFile& file, const GlbMesh& mesh) {
  const TriangleMesh& source = mesh.mesh.mesh;
  const std::size_t vertices = source.positions.size();
  std::vector<std::uint32_t> indices;
  for (const Triangle& triangle : source.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), vertices);
  std::vector<std::uint32_t> order(vertices);
  const std::size_t used = meshopt_optimizeVertexFetchRemap(order.data(), indices.data(), indices.size(), vertices);
  meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), order.data());

  meshopt_encodeVertexVersion(0);
  meshopt_encodeIndexVersion(1);
  std::vector<Eigen::Vector3f> positions(used);
  meshopt_remapVertexBuffer(positions.data(), source.positions.data(), vertices, sizeof(Eigen::Vector3f), order.data());
  Json attributes;
  for (const Values& values : all_values(mesh)) {
    std::string ordered(used * values.stride, '\0');
    meshopt_remapVertexBuffer(ordered.data(), values.bytes.data(), vertices, values.stride, order.data());
    std::string packed(meshopt_encodeVertexBufferBound(used, values.stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                             ordered.data(), used, values.stride));
    Json accessor = accessor_of(values, positions);
    accessor["bufferView"] = file.add_packed(packed, used, values.stride, "ATTRIBUTES", vertex_target);
    attributes[values.name] = file.add("accessors", std::move(accessor));
  }
  std::string packed(meshopt_encodeIndexBufferBound(indices.size(), used), '\0');
  packed.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                          indices.data(), indices.size()));
  Json accessor = index_accessor(used, source.triangles.size());
  const std::size_t width = index_type(used) == type_uint16 ? 2 : 4;
  accessor["bufferView"] = file.add_packed(packed, indices.size(), width, "TRIANGLES", index_target);
  return {{{"attributes", attributes}, {"indices", file.add("accessors", std::move(accessor))}},
          used,
          source.triangles.size()};
}

}  // namespace

GlbMesh glb_mesh_of(const AttributedMesh& source, bool with_tangents) {
  GlbMesh result{source, {}};
  TriangleMesh& mesh = result.mesh.mesh;
  if (with_tangents)
    for (const TangentFrame& frame : tangent_frames(mesh))
      result.tangents.emplace_back(frame.tangent.x(), frame.tangent.y(), frame.tangent.z(), frame.sign);
  for (Eigen::Vector3f& position : mesh.positions)
    position = (mesh.frame.unit() * position.cast<double>()).cast<float>();
  mesh.frame = {};
  for (std::vector<Eigen::Vector2f>* uvs : {&mesh.uvs, &mesh.texture_uvs})
    for (Eigen::Vector2f& uv : *uvs) uv.y() = 1 - uv.y();
  mesh.colors.clear();
  return result;
}

std::string glb_attribute_name(const std::string& attribute) {
  std::string name = "_" + attribute;
  for (char& letter : name)
    letter = letter == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return name;
}

AddedMesh add_mesh(GlbFile& file, const GlbMesh& mesh, GlbMeshForm form) {
  switch (form) {
    case GlbMeshForm::draco:
      return add_draco(file, mesh);
    case GlbMeshForm::meshopt:
      return add_meshopt(file, mesh);
    case GlbMeshForm::plain:
      return add_plain(file, mesh);
  }
  return {};
}

}  // namespace kiln
