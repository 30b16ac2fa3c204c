// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "base/files.h"
#include "gltf_builder.h"
#include "import/readers.h"
#include "import_support.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_gltf_packed {

using import_support::signed_volume;
using import_support::worst_normal;
using import_support::write;
using Json = nlohmann::json;

/// Spheres packed by the libraries that define the packing.
class GltfPacked : public testing::Test {
 protected:
  GltfBuilder draco() {
    GltfBuilder builder;
    save_draco(scratch_.folder() / "part.drc", mesh_);
    // save_draco writes positions as attribute 0 and normals as attribute 1.
    const std::size_t view = builder.view(read_text(scratch_.folder() / "part.drc"));
    const std::size_t position = unbacked(builder, "VEC3", mesh_.positions.size());
    const std::size_t normal = unbacked(builder, "VEC3", mesh_.positions.size());
    builder.mesh(
        {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
         {"indices", unbacked(builder, "SCALAR", 3 * mesh_.triangles.size())},
         {"extensions",
          {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}}}}}});
    builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return builder;
  }

  /// Positions by the exponential filter, normals by the octahedral one, indices of 16 bits.
  GltfBuilder meshopt(int exponent_bits = 15) {
    GltfBuilder builder;
    const std::size_t count = mesh_.positions.size();
    std::vector<std::uint32_t> positions(3 * count);
    meshopt_encodeFilterExp(positions.data(), count, 12, exponent_bits, mesh_.positions.front().data());
    std::vector<std::int8_t> normals(4 * count);
    std::vector<Eigen::Vector4f> wide;
    for (const Eigen::Vector3f& normal : mesh_.normals) wide.emplace_back(normal.x(), normal.y(), normal.z(), 0.f);
    meshopt_encodeFilterOct(normals.data(), count, 4, 8, wide.front().data());
    std::vector<std::uint16_t> indices;
    for (const std::uint32_t corner : GltfBuilder::corners_of(mesh_))
      indices.push_back(static_cast<std::uint16_t>(corner));
    std::string packed(meshopt_encodeIndexBufferBound(indices.size(), count), '\0');
    packed.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                            indices.data(), indices.size()));
    const std::size_t position =
        pack(builder, vertex_bytes(positions.data(), count, 12), "EXPONENTIAL", 12, count, "VEC3", 5126, false);
    const std::size_t normal =
        pack(builder, vertex_bytes(normals.data(), count, 4), "OCTAHEDRAL", 4, count, "VEC3", 5120, true);
    const std::size_t index = builder.accessor(builder.view(packed), "SCALAR", 5123, indices.size());
    describe(builder, "TRIANGLES", "NONE", 2, indices.size());
    builder.mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", index}});
    builder.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    // The fallback buffer has no bytes.
    builder.json["buffers"] = {
        {{"byteLength", builder.binary.size()}},
        {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    return builder;
  }

  SourceMesh read(const GltfBuilder& builder) const {
    return read_gltf(write(scratch_.folder() / "packed.glb", builder.glb()));
  }
  std::string refusal(const GltfBuilder& builder) const {
    return import_support::refusal(read_gltf, write(scratch_.folder() / "packed.glb", builder.glb()));
  }

  /// Returns the largest distance of the vertices from the unit sphere.
  static double worst_radius(const SourceMesh& mesh) {
    double worst = 0;
    for (const Eigen::Vector3d& place : mesh.places) worst = std::max(worst, std::abs(place.norm() - 1));
    return worst;
  }

  TriangleMesh mesh_ = shapes::icosphere(3);
  Scratch scratch_;

 private:
  static std::size_t unbacked(GltfBuilder& builder, const char* type, std::size_t count) {
    const bool is_index = std::string(type) == "SCALAR";
    builder.json["accessors"].push_back({{"type", type}, {"componentType", is_index ? 5125 : 5126}, {"count", count}});
    return builder.json["accessors"].size() - 1;
  }

  static std::string vertex_bytes(const void* vertices, std::size_t count, std::size_t stride) {
    std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), vertices,
                                             count, stride));
    return packed;
  }

  static void describe(GltfBuilder& builder, const char* mode, const char* filter, std::size_t stride,
                       std::size_t count) {
    Json& view = builder.json["bufferViews"].back();
    Json packed = view;
    packed["mode"] = mode;
    packed["filter"] = filter;
    packed["byteStride"] = stride;
    packed["count"] = count;
    view = {{"buffer", 1}, {"byteLength", stride * count}, {"extensions", {{"EXT_meshopt_compression", packed}}}};
    if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
  }

  static std::size_t pack(GltfBuilder& builder, const std::string& bytes, const char* filter, std::size_t stride,
                          std::size_t count, const char* type, int component, bool normalized) {
    const std::size_t accessor = builder.accessor(builder.view(bytes), type, component, count, normalized);
    describe(builder, "ATTRIBUTES", filter, stride, count);
    return accessor;
  }
};

TEST_F(GltfPacked, ReadsDraco) {
  const SourceMesh mesh = read(draco());
  EXPECT_EQ(mesh.faces.size(), mesh_.triangles.size());
  EXPECT_LT(worst_radius(mesh), 2e-5);  // a step of 16 bits, 2 / 65535
  EXPECT_GT(worst_normal(mesh), 0.98);
  EXPECT_NEAR(signed_volume(mesh), 4.1888, 0.1);
}

TEST_F(GltfPacked, ReadsMeshopt) {
  const SourceMesh mesh = read(meshopt());
  EXPECT_EQ(mesh.faces.size(), mesh_.triangles.size());
  EXPECT_LT(worst_radius(mesh), 2e-4);  // a step of 15 bits with a sign, 2^-14, of three coordinates
  EXPECT_GT(worst_normal(mesh), 0.97);
  EXPECT_NEAR(signed_volume(mesh), 4.1888, 0.1);
}

TEST_F(GltfPacked, RefusesNumbersThatDoNotFit) {
  const auto expect = [this](const char* key, const Json& value, const std::string& part) {
    GltfBuilder builder = meshopt();
    builder.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    const std::string message = refusal(builder);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect("byteStride", 7, "a stride of 7 bytes");
  expect("byteStride", 1024, "a stride of 1024 bytes");
  expect("count", 1000000000, "announces");
  expect("mode", "SOMETHING", "the mode 'SOMETHING'");
  expect("filter", "QUATERNION", "the filter 'QUATERNION'");
  GltfBuilder unknown = draco();
  unknown.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 9;
  EXPECT_NE(refusal(unknown).find("names the attribute 9"), std::string::npos);
}

TEST_F(GltfPacked, ReadsOrRefusesDamagedFiles) {
  for (const GltfBuilder& builder : {draco(), meshopt()}) {
    const std::string good = builder.glb();
    const std::size_t first = good.size() - builder.binary.size();  // the packed bytes
    EXPECT_GT(import_support::read_damaged(read_gltf, scratch_.folder() / "damaged.glb", good, 1500, first), 100);
  }
}

}  // namespace test_gltf_packed
}  // namespace kiln
