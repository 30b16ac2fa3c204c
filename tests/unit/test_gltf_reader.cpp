// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "gltf_builder.h"
#include "import/readers.h"
#include "import_support.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_gltf_reader {

namespace fs = std::filesystem;
using import_support::append;
using import_support::signed_volume;
using import_support::warns;
using import_support::write;
using Json = nlohmann::json;

class GltfReader : public testing::Test {
 protected:
  SourceMesh read(const GltfBuilder& builder) const { return read_gltf(write(path("scene.glb"), builder.glb())); }
  std::string refusal(const GltfBuilder& builder) const {
    return import_support::refusal(read_gltf, write(path("scene.glb"), builder.glb()));
  }
  fs::path path(const std::string& name) const { return scratch_.folder() / name; }

  /// Makes a sphere of radius 1 that a node of the scene places.
  GltfBuilder sphere(const Json& node) const {
    GltfBuilder builder;
    Json placed = node;
    placed["mesh"] = builder.mesh(builder.primitive(mesh_));
    builder.json["nodes"] = {placed};
    return builder;
  }

  double sphere_volume() const {
    double sum = 0;
    for (const Triangle& t : mesh_.triangles)
      sum += static_cast<double>(mesh_.positions[t[0]].dot(mesh_.positions[t[1]].cross(mesh_.positions[t[2]])));
    return sum / 6;
  }

  /// Makes a square of two triangles in the plane z = 0, facing +z, with texture coordinates in glTF's convention.
  Json square(GltfBuilder& builder) const {
    const std::vector<Eigen::Vector3f> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<Eigen::Vector2f> uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0.25f}};
    return {
        {"attributes", {{"POSITION", builder.floats("VEC3", positions)}, {"TEXCOORD_0", builder.floats("VEC2", uvs)}}},
        {"indices", builder.indices<std::uint8_t>(5121, {0, 1, 2, 0, 2, 3})}};
  }

  TriangleMesh mesh_ = shapes::icosphere(2);
  Scratch scratch_;
};

TEST_F(GltfReader, ReadsTheSameOfAllContainers) {
  const GltfBuilder builder = sphere(Json::object());
  const SourceMesh binary = read(builder);
  write(path("my buffer.bin"), builder.binary);
  const SourceMesh beside = read_gltf(write(path("beside.gltf"), builder.gltf("my%20buffer.bin")));
  const SourceMesh within = read_gltf(
      write(path("within.gltf"), builder.gltf("data:application/octet-stream;base64," + base64(builder.binary))));
  ASSERT_EQ(binary.faces.size(), mesh_.triangles.size());
  ASSERT_EQ(binary.places.size(), mesh_.positions.size());
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
    EXPECT_EQ(binary.places[i], mesh_.positions[i].cast<double>());
  EXPECT_EQ(beside.places, binary.places);
  EXPECT_EQ(within.places, binary.places);
  EXPECT_EQ(beside.normals, binary.normals);
  EXPECT_EQ(beside.further_files, std::vector<fs::path>{path("my buffer.bin")});
  EXPECT_TRUE(binary.is_unwelded);
  EXPECT_NEAR(binary.precision, std::ldexp(1, -23), 1e-8);
  EXPECT_TRUE(binary.warnings.empty());
}

TEST_F(GltfReader, PutsMeshesWhereTheSceneHasThem) {
  GltfBuilder builder = sphere({{"scale", {2, 1, 1}}, {"translation", {0, 0, 1}}});
  // A parent that turns +x to +y and moves by a distance that floats cannot resolve beside the sphere.
  builder.json["nodes"].push_back({{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1e9, 0, 0, 1}}, {"children", {0}}});
  builder.json["nodes"].push_back({{"mesh", 0}});  // in no scene
  builder.json["scenes"] = {{{"nodes", {1}}}};
  builder.json["scene"] = 0;
  const SourceMesh mesh = read(builder);
  ASSERT_EQ(mesh.places.size(), mesh_.positions.size());
  for (std::size_t i = 0; i < mesh.places.size(); ++i) {
    const Eigen::Vector3d p = mesh_.positions[i].cast<double>();
    EXPECT_LT((mesh.places[i] - Eigen::Vector3d(1e9 - p.y(), 2 * p.x(), p.z() + 1)).norm(), 1e-6);
  }
}

TEST_F(GltfReader, NodesNameParts) {
  GltfBuilder builder;
  const std::size_t ball = builder.mesh(builder.primitive(mesh_));
  builder.json["meshes"][ball]["name"] = "ball";
  builder.json["nodes"] = {{{"mesh", ball}, {"name", "bolt_low"}},
                           {{"mesh", ball}, {"translation", {3, 0, 0}}},
                           {{"name", "bolt_low"}, {"mesh", ball}, {"translation", {6, 0, 0}}},
                           {{"name", "empty"}}};
  const SourceMesh mesh = read(builder);
  EXPECT_EQ(mesh.parts, (std::vector<std::string>{"bolt_low", "ball"}));
  const std::size_t each = mesh_.triangles.size();
  ASSERT_EQ(mesh.faces.size(), 3 * each);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) EXPECT_EQ(mesh.faces[f].part, f / each == 1 ? 1 : 0);
}

TEST_F(GltfReader, TurnsTheWindingOfMirroredMeshes) {
  for (const double sign : {1.0, -1.0}) {
    const SourceMesh mesh = read(sphere({{"scale", {sign * 3, 1, 0.5}}}));
    EXPECT_NEAR(signed_volume(mesh), 1.5 * sphere_volume(), 1e-6);
    // The normal of an ellipsoid at the image of p is p divided by the scaling.
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
      const Eigen::Vector3f truth =
          mesh_.normals[i].cwiseQuotient(Eigen::Vector3f(static_cast<float>(sign) * 3, 1, 0.5f)).normalized();
      EXPECT_LT((mesh.normals[i] - truth).norm(), 1e-6f);
    }
  }
}

TEST_F(GltfReader, ReadsStripsFansAndAllIndexTypes) {
  const std::vector<Eigen::Vector3f> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const auto faces_up = [&](int mode, const std::vector<std::uint32_t>& order, int type) {
    GltfBuilder builder;
    Json primitive = {{"attributes", {{"POSITION", builder.floats("VEC3", positions)}}}, {"mode", mode}};
    if (type == 5121) primitive["indices"] = builder.indices<std::uint8_t>(type, order);
    if (type == 5123) primitive["indices"] = builder.indices<std::uint16_t>(type, order);
    if (type == 5125) primitive["indices"] = builder.indices<std::uint32_t>(type, order);
    builder.mesh(primitive);
    const SourceMesh mesh = read(builder);
    int count = 0;
    for (const SourceMesh::Face& face : mesh.faces) {
      const auto c = mesh.corners_of(face);
      const Eigen::Vector3d& a = mesh.places[c[0].place];
      EXPECT_GT((mesh.places[c[1].place] - a).cross(mesh.places[c[2].place] - a).z(), 0.9);
      ++count;
    }
    return count;
  };
  EXPECT_EQ(faces_up(5, {}, 0), 2);
  EXPECT_EQ(faces_up(5, {0, 1, 2, 3}, 5121), 2);
  EXPECT_EQ(faces_up(5, {0, 1, 2, 3, 3, 0, 0, 1, 2}, 5123), 3);  // joined by triangles of no area
  EXPECT_EQ(faces_up(6, {0, 1, 3, 2}, 5123), 2);
  EXPECT_EQ(faces_up(4, {0, 1, 2, 2, 1, 3}, 5125), 2);
}

TEST_F(GltfReader, NamesIndicesOutOfRange) {
  GltfBuilder builder;
  const std::vector<Eigen::Vector3f> positions(3, Eigen::Vector3f::Zero());
  builder.mesh({{"attributes", {{"POSITION", builder.floats("VEC3", positions)}}},
                {"indices", builder.indices<std::uint16_t>(5123, {0, 1, 3})}});
  const std::string message = refusal(builder);
  EXPECT_NE(message.find("index 2 of mesh 0, primitive 0 is 3"), std::string::npos) << message;
}

TEST_F(GltfReader, ReadsQuantisedAndSparseNumbers) {
  GltfBuilder builder;
  std::string bytes;
  for (const std::int16_t value : {0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}) append(bytes, value);
  Json position = builder.accessor(builder.view(bytes), "VEC3", 5122, 3, true);
  builder.json["bufferViews"].back()["byteStride"] = 8;
  std::string places, values;
  append(places, std::uint16_t{0});
  for (const std::int16_t value : {0, 0, 32767}) append(values, value);
  builder.json["accessors"].back()["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", builder.view(places)}, {"componentType", 5123}}},
      {"values", {{"bufferView", builder.view(values)}}}};
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  builder.json["nodes"] = {{{"mesh", builder.mesh({{"attributes", {{"POSITION", position}}}})}, {"scale", {2, 2, 2}}}};
  const SourceMesh mesh = read(builder);
  EXPECT_EQ(mesh.places, (std::vector<Eigen::Vector3d>{{0, 0, 2}, {2, 0, 0}, {0, -2, 0}}));
}

TEST_F(GltfReader, ReadsMaterialsAndPictures) {
  GltfBuilder builder;
  Json primitive = square(builder);
  primitive["material"] = 0;
  builder.mesh(primitive);
  const std::string picture = "\x89PNG and so on";
  builder.json["images"] = {{{"bufferView", builder.view(picture)}, {"mimeType", "image/png"}}};
  builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  builder.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const Json transform = {{"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 3}}};
  builder.json["materials"] = {
      {{"name", "bark"},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 1, 0.5}},
         {"metallicFactor", 0},
         {"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}}};
  const SourceMesh mesh = read(builder);
  ASSERT_EQ(mesh.materials.size(), 1u);
  const SourceMaterial& material = mesh.materials[0];
  EXPECT_EQ(material.name, "bark");
  EXPECT_EQ(material.diffuse, Eigen::Vector3f(0.5f, 0.25f, 1));
  EXPECT_TRUE(material.linear_diffuse && material.has_diffuse);
  EXPECT_EQ(std::string(material.texture->picture.bytes->begin(), material.texture->picture.bytes->end()), picture);
  EXPECT_EQ(material.texture->wrap_u, SourceTexture::Wrap::clamp);
  EXPECT_EQ(material.texture->wrap_v, SourceTexture::Wrap::mirror);
  EXPECT_EQ(material.opacity.factor, 0.5f);
  EXPECT_EQ(material.opacity.channel, SourceShare::Channel::alpha);
  ASSERT_TRUE(material.opacity.texture);
  EXPECT_EQ(material.opacity.texture->wrap_u, SourceTexture::Wrap::clamp);
  EXPECT_EQ(material.roughness.factor, 1);
  EXPECT_EQ(material.metalness.factor, 0);
  EXPECT_EQ(mesh.faces[0].material, 0);
  // glTF's (0, 0.25) is three quarters up. By the extension's words it is scaled to (0, 0.75), turned by 90 degrees
  // counter-clockwise as seen where v points down, to (0.75, 0), and moved to (1.25, 0.25): three quarters up again.
  EXPECT_EQ(mesh.uvs[mesh.corners[5].uv], Eigen::Vector2f(0, 0.75f));
  const Eigen::Vector2f looked_up = material.texture->transform * Eigen::Vector3f(0, 0.75f, 1);
  EXPECT_LT((looked_up - Eigen::Vector2f(1.25f, 0.75f)).norm(), 1e-6f);
}

TEST_F(GltfReader, TakesTheSetOfCoordinatesThatThePictureNames) {
  GltfBuilder builder;
  Json primitive = square(builder);
  primitive["attributes"]["TEXCOORD_1"] = builder.floats("VEC2", std::vector<Eigen::Vector2f>(4, {0.125f, 0.25f}));
  primitive["material"] = 0;
  builder.mesh(primitive);
  builder.json["images"] = {{{"uri", "a%20b.png"}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["materials"] = {
      {{"extensions",
        {{"KHR_materials_pbrSpecularGlossiness",
          {{"diffuseFactor", {0.5, 0.5, 0.5, 1}}, {"diffuseTexture", {{"index", 0}, {"texCoord", 1}}}}}}}}};
  const SourceMesh mesh = read(builder);
  EXPECT_EQ(mesh.uvs[mesh.corners[0].uv], Eigen::Vector2f(0.125f, 0.75f));
  EXPECT_EQ(mesh.materials[0].texture->picture.file, path("a b.png"));
  EXPECT_EQ(mesh.materials[0].diffuse, Eigen::Vector3f::Constant(0.5f));
}

TEST_F(GltfReader, AlphaModesSayWhetherOpacityCuts) {
  const auto material = [this](Json extra) {
    GltfBuilder builder;
    Json primitive = square(builder);
    primitive["material"] = 0;
    builder.mesh(primitive);
    builder.json["images"] = {{{"uri", "a.png"}}};
    builder.json["textures"] = {{{"source", 0}}};
    Json object = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}},
        {"emissiveFactor", {1, 0, 2}},
        {"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}};
    object.update(extra);
    builder.json["materials"] = {object};
    return read(builder).materials.at(0);
  };
  EXPECT_FALSE(material(Json::object()).opacity.is_given()) << "alpha of an opaque material says nothing";
  EXPECT_FALSE(material({{"alphaMode", "MASK"}, {"alphaCutoff", 0}}).opacity.is_given()) << "all of it reaches 0";
  EXPECT_EQ(material({{"alphaMode", "MASK"}}).opacity_cutoff, 0.5f);
  const SourceMaterial cut = material({{"alphaMode", "MASK"}, {"alphaCutoff", 0.75}});
  EXPECT_TRUE(cut.opacity.texture);
  EXPECT_EQ(cut.opacity_cutoff, 0.75f);
  EXPECT_EQ(cut.metalness.channel, SourceShare::Channel::blue);
  EXPECT_EQ(cut.roughness.channel, SourceShare::Channel::green);
  EXPECT_TRUE(cut.roughness.texture && cut.metalness.texture);
  EXPECT_EQ(cut.emission, Eigen::Vector3f(1, 0, 2));
  EXPECT_FALSE(cut.emission_texture) << "of other texture coordinates than the colour's";
}

TEST_F(GltfReader, ReadsColorsAsLinear) {
  GltfBuilder builder;
  Json primitive = square(builder);
  std::string bytes;
  for (int i = 0; i < 4; ++i)
    for (const std::uint16_t value : {65535, 13107, 0, 65535}) append(bytes, value);
  primitive["attributes"]["COLOR_0"] = builder.accessor(builder.view(bytes), "VEC4", 5123, 4, true);
  builder.mesh(primitive);
  builder.mesh(square(builder));  // without colours: white
  const SourceMesh mesh = read(builder);
  ASSERT_EQ(mesh.colors.size(), 8u);
  EXPECT_TRUE(mesh.linear_colors);
  EXPECT_LT((mesh.colors[2] - Eigen::Vector3f(1, 0.2f, 0)).norm(), 1e-6f);
  EXPECT_EQ(mesh.colors[5], Eigen::Vector3f::Ones());
}

TEST_F(GltfReader, PutsSkinsWhereTheirJointsRest) {
  GltfBuilder builder;
  Json primitive = square(builder);
  std::string joints;
  for (const int joint : {0, 0, 1, 1})
    for (const int value : {joint, 0, 0, 0}) append(joints, static_cast<std::uint8_t>(value));
  primitive["attributes"]["JOINTS_0"] = builder.accessor(builder.view(joints), "VEC4", 5121, 4);
  primitive["attributes"]["WEIGHTS_0"] =
      builder.floats("VEC4", std::vector<Eigen::Vector4f>(4, Eigen::Vector4f(1, 0, 0, 0)));
  std::string inverse;
  for (int joint = 0; joint < 2; ++joint)
    for (int k = 0; k < 16; ++k) append(inverse, k == 13 && joint == 1 ? -1.f : k % 5 == 0 ? 1.f : 0.f);
  const std::size_t mesh_index = builder.mesh(primitive);
  builder.json["skins"] = {
      {{"joints", {1, 2}}, {"inverseBindMatrices", builder.accessor(builder.view(inverse), "MAT4", 5126, 2)}}};
  builder.json["nodes"] = {{{"mesh", mesh_index}, {"skin", 0}, {"translation", {9, 9, 9}}},  // not used, by the format
                           {{"translation", {0, 0, 5}}, {"children", {2}}},
                           {{"translation", {0, 3, 0}}}};
  const SourceMesh mesh = read(builder);
  // The lower vertices follow joint 1, the upper ones joint 2, which was bound at y = 1 and rests at y = 3, z = 5.
  EXPECT_EQ(mesh.places, (std::vector<Eigen::Vector3d>{{0, 0, 5}, {1, 0, 5}, {1, 3, 5}, {0, 3, 5}}));
  EXPECT_TRUE(warns(mesh, "skinned mesh"));
}

TEST_F(GltfReader, AppliesTheDefaultWeightsOfMorphTargets) {
  GltfBuilder builder;
  Json primitive = square(builder);
  primitive["targets"] = {{{"POSITION", builder.floats("VEC3", std::vector<Eigen::Vector3f>(4, {0, 0, 2}))}}};
  builder.mesh(primitive);
  builder.json["meshes"][0]["weights"] = {0.25};
  builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"weights", {1}}}};
  const SourceMesh mesh = read(builder);
  EXPECT_EQ(mesh.places[0].z(), 0.5);
  EXPECT_EQ(mesh.places[4].z(), 2);
  EXPECT_TRUE(warns(mesh, "morph targets"));
}

TEST_F(GltfReader, PlacesInstances) {
  GltfBuilder builder = sphere(Json::object());
  const std::size_t places = builder.floats("VEC3", std::vector<Eigen::Vector3f>{{10, 0, 0}, {0, 20, 0}});
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
  const SourceMesh mesh = read(builder);
  ASSERT_EQ(mesh.faces.size(), 2 * mesh_.triangles.size());
  EXPECT_EQ(mesh.places.back(), mesh_.positions.back().cast<double>() + Eigen::Vector3d(0, 20, 0));
}

TEST_F(GltfReader, RefusesWhatItCannotRead) {
  const auto with = [this](const std::function<void(GltfBuilder&)>& change) {
    GltfBuilder builder = sphere(Json::object());
    change(builder);
    return refusal(builder);
  };
  const auto expect = [&](const std::string& part, const std::function<void(GltfBuilder&)>& change) {
    const std::string message = with(change);
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' not in: " << message;
  };
  expect("NV_wonder", [](GltfBuilder& b) { b.json["extensionsRequired"] = {"NV_wonder"}; });
  expect("version '1.0'", [](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; });
  expect("beneath itself", [](GltfBuilder& b) { b.json["nodes"][0]["children"] = {0}; });
  expect("a child of", [](GltfBuilder& b) { b.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}}; });
  expect("beyond bufferView 0", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 163; });
  expect("covers the bytes", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 99999999; });
  expect("element 7 of \"accessors\"",
         [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 7; });
  expect("NORMAL of mesh 0, primitive 0 has",
         [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 1; });
  expect("points or lines", [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 1; });
  expect("is no JSON array", [](GltfBuilder& b) { b.json["nodes"] = "none"; });
  expect("no whole number", [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = -1; });
  expect("is not finite", [](GltfBuilder& b) { b.binary.replace(0, 4, "\xff\xff\xff\xff"); });
  // Copies without end: a small file must not take all memory.
  expect("out of all proportion", [](GltfBuilder& b) {
    for (int i = 0; i < 30000; ++i) b.json["nodes"].push_back({{"mesh", 0}});
  });
}

TEST_F(GltfReader, SaysWhichFileIsMissingOrTruncated) {
  const GltfBuilder builder = sphere(Json::object());
  const auto refused = [this](const std::string& name, const std::string& bytes) {
    return import_support::refusal(read_gltf, write(path(name), bytes));
  };
  EXPECT_NE(refused("a.gltf", builder.gltf("gone.bin")).find("gone.bin, which does not exist"), std::string::npos);
  write(path("short.bin"), builder.binary.substr(9));
  EXPECT_NE(refused("b.gltf", builder.gltf("short.bin")).find("(short.bin) is truncated"), std::string::npos);
  const std::string whole = builder.glb();
  for (const std::size_t size : {std::size_t{15}, std::size_t{200}, whole.size() - 1})
    EXPECT_NE(refused("c.glb", whole.substr(0, size)).find("truncated"), std::string::npos);
  EXPECT_NE(refused("d.gltf", R"({"asset": {"version")").find("truncated"), std::string::npos);
  const std::string nonsense = refused("e.gltf", "solid thing\nfacet");
  EXPECT_NE(nonsense.find("is no JSON"), std::string::npos);
  EXPECT_EQ(nonsense.find("truncated"), std::string::npos);
  EXPECT_NE(refused("f.gltf", std::string(100000, '[')).find("nested deeper"), std::string::npos);
}

TEST_F(GltfReader, ReadsOrRefusesDamagedFiles) {
  GltfBuilder builder = sphere({{"scale", {1, 2, 1}}});
  builder.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}}}}};
  EXPECT_GT(import_support::read_damaged(read_gltf, path("damaged.glb"), builder.glb(), 1500), 100);
  // Damage to the JSON alone, which is where most faults are.
  const GltfBuilder small = [&] {
    GltfBuilder b;
    b.mesh(square(b));
    b.json["nodes"] = {{{"mesh", 0}, {"translation", {1, 2, 3}}}, {{"children", {0}}}};
    b.json["scenes"] = {{{"nodes", {1}}}};
    return b;
  }();
  const std::string text = small.gltf("data:application/octet-stream;base64," + base64(small.binary));
  EXPECT_GT(import_support::read_damaged(read_gltf, path("damaged.gltf"), text, 2500), 1000);
}

}  // namespace test_gltf_reader
}  // namespace kiln
