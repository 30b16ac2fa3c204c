// SPDX-License-Identifier: GPL-3.0-or-later
// glTF files of assets: what they hold against closed forms, and read back by the importer. Other people's readers hold
// them in tests/gltf.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

#include "asset/write_asset.h"
#include "base/json.h"
#include "export/export_asset.h"
#include "export/sky_pictures.h"
#include "export/surface_textures.h"
#include "export_samples.h"
#include "image/image_file.h"
#include "image/png_file.h"
#include "image/srgb.h"
#include "import/readers.h"
#include "maps/detail_maps.h"
#include "mesh/tangent_space.h"
#include "mesh/uv_raster.h"
#include "scratch.h"
#include "sh/basis.h"
#include "shapes.h"

namespace kiln {

namespace test_export {

using test::Sample;
using test::write;

constexpr GlbMeshForm all_forms[] = {GlbMeshForm::draco, GlbMeshForm::meshopt, GlbMeshForm::plain};

/// Splits a glb into its JSON and its bytes.
std::pair<Json, std::string> parts_of(const std::string& glb) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(glb.at(at + k))) << 8 * k;
    return value;
  };
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(number(4), 2u);
  EXPECT_EQ(number(8), glb.size());
  const std::size_t json_length = number(12);
  EXPECT_EQ(json_length % 4, 0u);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  EXPECT_EQ(glb.substr(24 + json_length, 4), std::string("BIN\0", 4));
  return {Json::parse(glb.substr(20, json_length)), glb.substr(28 + json_length, number(20 + json_length))};
}

std::string image_bytes(const Json& json, const std::string& buffer, std::size_t texture) {
  const Json& image = json["images"][json["textures"][texture]["source"].get<std::size_t>()];
  const Json& view = json["bufferViews"][image["bufferView"].get<std::size_t>()];
  return buffer.substr(view["byteOffset"], view["byteLength"]);
}

Image<std::uint8_t> decoded(const std::string& png, const Scratch& scratch) {
  std::ofstream(scratch / "picture.png", std::ios::binary) << png;
  return read_png8(scratch / "picture.png");
}

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Writes the same vector of object space at every texel of a normal map, by `bits`.
void write_normals(const std::filesystem::path& file, const Image<float>& normals, int bits) {
  const Image<std::uint16_t> wide = quantise_normals(normals);
  if (bits == 16) return write_png(file, wide);
  Image<std::uint8_t> narrow(wide.width(), wide.height(), 3);
  for (std::size_t k = 0; k < wide.values().size(); ++k)
    narrow.values()[k] = static_cast<std::uint8_t>((wide.values()[k] + 128) / 257);
  write_png(file, narrow);
}

Eigen::Vector3f vector_at(const Image<std::uint8_t>& picture, std::size_t k) {
  Eigen::Vector3f vector;
  for (int c = 0; c < 3; ++c)
    vector[c] = static_cast<float>(picture.values()[3 * k + static_cast<std::size_t>(c)]) / 255 * 2 - 1;
  return vector;
}

TEST(Export, PlaneHasNormalsInItsTangentSpace) {
  // u runs along +X, v along -Z, so the frame is (+X, -Z, +Y); turned about Y, u and the vectors turn alike. Mirrored
  // in u, the tangent points along -X and the bitangent, which its sign keeps along +v, along -Z still.
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3f, 0.9f, 0.2f).normalized();
  for (const bool is_mirrored : {false, true}) {
    Scratch scratch;
    Sample sample{shapes::plane(2)};
    if (is_mirrored) {
      for (Eigen::Vector2f& uv : sample.mesh.uvs) uv.x() = 1 - uv.x();
    }
    Image<float> normals(sample.side, sample.side, 3);
    for (std::size_t k = 0; k < normals.values().size(); ++k) normals.values()[k] = normal[static_cast<int>(k % 3)];
    sample.description.normals_file = normal_map_name;
    write(scratch.folder(), sample);
    write_normals(scratch / normal_map_name, normals, 16);
    const PrtAsset asset = load_prt_asset(scratch.folder());
    const Image<std::uint8_t> map = decoded(tangent_normal_picture(scratch.folder(), asset), scratch);
    const Eigen::Vector3f expected((is_mirrored ? -1.0f : 1.0f) * normal.x(), -normal.z(), normal.y());
    for (std::size_t k = 0; k < map.values().size() / 3; ++k)
      ASSERT_LT((vector_at(map, k) - expected).cwiseAbs().maxCoeff(), 1.5f / 255) << is_mirrored << " texel " << k;
  }
}

TEST(Export, SphereWithNormalsOfItsOwnIsFlatInTangentSpace) {
  Scratch scratch;
  Sample sample{shapes::cube_sphere(24)};
  sample.side = 96;
  sample.description.normals_file = normal_map_name;
  write(scratch.folder(), sample);
  const TriangleMesh mesh = load_draco(scratch / atlas_mesh_name);
  const UvRaster raster = rasterise_uvs(mesh, sample.side, sample.side);
  // The high mesh's normals are tilted by 25 degrees towards the bitangent, dP/dv with the part along u taken out,
  // which is found from each face's own corners here.
  const auto tilt = static_cast<float>(25 * std::numbers::pi / 180);
  Image<float> normals(sample.side, sample.side, 3);
  std::size_t covered = 0;
  for (std::size_t k = 0; k < raster.texels.size(); ++k) {
    const TexelSource& source = raster.texels[k];
    Eigen::Vector3f vector = Eigen::Vector3f::UnitY();
    if (source.covered()) {
      const Triangle& t = mesh.triangles[source.triangle];
      Eigen::Matrix<float, 3, 2> edges;
      Eigen::Matrix2f uvs;
      for (int e = 0; e < 2; ++e) {
        edges.col(e) = mesh.positions[t[static_cast<std::size_t>(e) + 1]] - mesh.positions[t[0]];
        uvs.col(e) = mesh.uvs[t[static_cast<std::size_t>(e) + 1]] - mesh.uvs[t[0]];
      }
      const Eigen::Matrix<float, 3, 2> along = edges * uvs.inverse();
      const Eigen::Vector3f n = interpolate(mesh, mesh.positions, source).normalized();
      const Eigen::Vector3f u = (along.col(0) - n.dot(along.col(0)) * n).normalized();
      const Eigen::Vector3f side = n.cross(u) * (n.cross(u).dot(along.col(1)) < 0 ? -1.0f : 1.0f);
      vector = std::cos(tilt) * n + std::sin(tilt) * side;
      ++covered;
    }
    for (int c = 0; c < 3; ++c) normals.values()[3 * k + static_cast<std::size_t>(c)] = vector[c];
  }
  ASSERT_GT(covered, 4000u);
  write_normals(scratch / normal_map_name, normals, 16);
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const Image<std::uint8_t> map = decoded(tangent_normal_picture(scratch.folder(), asset), scratch);
  const Eigen::Vector3f expected(0, std::sin(tilt), std::cos(tilt));
  // Frames of faces and of vertices differ by a cell's share of the sphere, 90 / 24 degrees.
  for (std::size_t k = 0; k < raster.texels.size(); ++k)
    if (raster.texels[k].covered()) {
      ASSERT_LT((vector_at(map, k) - expected).norm(), 0.05f) << "texel " << k;
    }
}

TEST(Export, TangentMapsOfEightBitsAreCopied) {
  Scratch scratch;
  Sample sample{shapes::plane(2)};
  sample.description.normals_file = normal_map_name;
  sample.description.normal_space = NormalSpace::tangent;
  write(scratch.folder(), sample);
  Image<float> normals(sample.side, sample.side, 3);
  for (std::size_t k = 0; k < normals.values().size(); ++k)
    normals.values()[k] = k % 3 == 2 ? 0.8f : 0.6f * (k % 3 == 0);
  write_normals(scratch / normal_map_name, normals, 8);
  const PrtAsset asset = load_prt_asset(scratch.folder());
  EXPECT_EQ(tangent_normal_picture(scratch.folder(), asset), text_of_file(scratch / normal_map_name));
  write_normals(scratch / normal_map_name, normals, 16);
  const Image<std::uint8_t> map = decoded(tangent_normal_picture(scratch.folder(), asset), scratch);
  EXPECT_LT((vector_at(map, 7) - Eigen::Vector3f(0.6f, 0, 0.8f)).cwiseAbs().maxCoeff(), 1.01f / 255);
}

TEST(Export, OcclusionIsTheOpenShareOfTheSky) {
  const struct {
    std::vector<float> open;
    int bits;
    float expected;
  } cases[] = {{{1}, 8, 1},
               {{0.4f}, 16, 0.4f},
               {{0}, 8, 0},
               {{0.5f, 0.25f, 1}, 16, 0.5f * 0.2126f + 0.25f * 0.7152f + 0.0722f},
               {{1.5f}, 16, 1}};
  for (const auto& one : cases) {
    Scratch scratch;
    Sample sample{shapes::plane(1, 1, 0, 0)};
    sample.open = one.open;
    sample.bits = one.bits;
    write(scratch.folder(), sample);
    const auto picture = occlusion_picture(sky_transfer(load_prt_asset(scratch.folder())));
    ASSERT_EQ(picture.channels(), 1);
    for (const std::uint8_t value : picture.values())
      ASSERT_NEAR(value / 255.0, one.expected, 0.51 / 255) << one.open.size() << " of " << one.open[0];
  }
}

TEST(Export, PicturesOfBandsZeroAndOneAreTheNormalWhereNothingOccludes) {
  Scratch scratch;
  Sample sample{shapes::cube_sphere(12)};
  sample.side = 64;
  sample.bits = 16;
  write(scratch.folder(), sample);
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const SkyPictures sky = sky_pictures(sky_transfer(asset));
  EXPECT_EQ(sky.clamped_texels, 0u);
  const UvRaster raster = rasterise_uvs(asset.mesh, asset.width, asset.height);
  std::size_t covered = 0;
  for (std::size_t k = 0; k < raster.texels.size(); ++k) {
    if (!raster.texels[k].covered()) continue;
    ++covered;
    const Eigen::Vector3f n = interpolate(asset.mesh, asset.mesh.normals, raster.texels[k]).normalized();
    ASSERT_EQ(sky.pictures[0].values()[k], 255);
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(sky.pictures[static_cast<std::size_t>(axis) + 1].values()[k] / 255.0 * 2 - 1, n[axis], 1.1 / 255);
  }
  EXPECT_GT(covered, 1500u);

  // What a shader of engines adds up is the exit radiance of the two bands: light of one direction, closed form.
  const Eigen::Vector3f d = Eigen::Vector3f(1, 2, 3).normalized();
  const ShBasis basis(2);
  std::array<float, 4> light{};
  basis.evaluate<float>(d, light);
  for (float& value : light) value *= std::numbers::pi_v<float>;
  for (std::size_t k = 0; k < raster.texels.size(); k += 97) {
    if (!raster.texels[k].covered()) continue;
    const Eigen::Vector3f n = interpolate(asset.mesh, asset.mesh.normals, raster.texels[k]).normalized();
    const auto value = [&](std::size_t p) { return static_cast<float>(sky.pictures[p].values()[k]) / 255; };
    const float shaded =
        0.282095f * light[0] * value(0) +
        0.325735f * (light[3] * (2 * value(1) - 1) + light[1] * (2 * value(2) - 1) + light[2] * (2 * value(3) - 1));
    // pi (A_0 / pi B_00^2 + A_1 / pi B_1 . B_1) = 1/4 + n.d / 2
    EXPECT_NEAR(shaded, 0.25f + 0.5f * n.dot(d), 0.01f);
  }

  // Light that is stronger from one side than any open surface has it does not fit, and is counted.
  SkyTransfer strong = sky_transfer(asset);
  strong.y.values()[5] = 1.2f;
  EXPECT_EQ(sky_pictures(strong).clamped_texels, 1u);
}

TEST(Export, BaseColorHasAlbedoAndOpacity) {
  Scratch scratch;
  Sample sample{shapes::plane(1, 1, 0, 0)};
  sample.side = 8;
  PrtDescription& asset = sample.description;
  asset.albedo = PrtAlbedo::of_picture(albedo_map_name);
  asset.opacity_file = opacity_map_name;
  Image<std::uint8_t> albedo(8, 8, 3), opacity(8, 8, 1);
  for (std::size_t k = 0; k < albedo.values().size(); ++k) albedo.values()[k] = static_cast<std::uint8_t>(k);
  for (std::size_t k = 0; k < opacity.values().size(); ++k) opacity.values()[k] = static_cast<std::uint8_t>(255 - k);
  write(scratch.folder(), sample);
  write_png(scratch / albedo_map_name, albedo);
  write_png(scratch / opacity_map_name, opacity);
  const auto both = decoded(base_color_picture(scratch.folder(), load_prt_asset(scratch.folder()), {}), scratch);
  ASSERT_EQ(both.channels(), 4);
  for (std::size_t k = 0; k < 64; ++k) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(both.values()[4 * k + c], albedo.values()[3 * k + c]);
    ASSERT_EQ(both.values()[4 * k + 3], opacity.values()[k]);
  }
  // An opacity of twice the size: a colour of that size, from which nothing is lost; alpha is the file's own.
  const Image<std::uint8_t> fine(16, 16, 1, 77);
  write_png(scratch / opacity_map_name, fine);
  write_png(scratch / albedo_map_name, Image<std::uint8_t>(8, 8, 3, 120));
  const auto larger = decoded(base_color_picture(scratch.folder(), load_prt_asset(scratch.folder()), {}), scratch);
  ASSERT_EQ(larger.width(), 16);
  for (std::size_t k = 0; k < 256; ++k)
    for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(larger.values()[4 * k + c], c == 3 ? 77 : 120);

  const auto [json, buffer] = parts_of(export_asset(scratch.folder(), scratch / "leaf.glb", {}).glb);
  const Json& material = json["materials"][0];
  EXPECT_EQ(material["alphaMode"], "MASK");
  EXPECT_EQ(material["alphaCutoff"], 0.5);
  EXPECT_EQ(material["doubleSided"], true);
  EXPECT_FALSE(material["pbrMetallicRoughness"].contains("baseColorFactor"));
}

TEST(Export, TransferThatHasTheAlbedoColorsTheBase) {
  Scratch scratch;
  Sample sample{shapes::plane(1, 1, 0, 0)};
  sample.open = {0.8f, 0.4f, 0.2f};
  sample.bits = 16;
  sample.description.albedo = PrtAlbedo::of_transfer();
  write(scratch.folder(), sample);
  const auto [json, buffer] = parts_of(export_asset(scratch.folder(), scratch / "a.glb", {}).glb);
  const Json& material = json["materials"][0];
  EXPECT_FALSE(material.contains("occlusionTexture"));
  const Image<std::uint8_t> color =
      decoded(image_bytes(json, buffer, material["pbrMetallicRoughness"]["baseColorTexture"]["index"]), scratch);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(linear_from_srgb(static_cast<float>(color.at(5, 5, c)) / 255), sample.open[static_cast<std::size_t>(c)],
                0.005f);
}

TEST(Export, RoughnessIsThatOfTheMapsThatShip) {
  Scratch scratch;
  Sample sample{shapes::plane(1, 1, 0, 0)};
  // A PNG's 0 and 1 stand for 0.2 and 0.6.
  sample.description.maps = {{"roughness", "roughness.png", PlaneRange{0.2, 0.6}}};
  write(scratch.folder(), sample);
  write_png(scratch / "roughness.png", Image<std::uint16_t>(8, 8, 1, 32768));
  const auto [json, buffer] = parts_of(export_asset(scratch.folder(), scratch / "a.glb", {}).glb);
  const Json& surface = json["materials"][0]["pbrMetallicRoughness"];
  EXPECT_EQ(surface["metallicFactor"], 1);
  const Image<std::uint8_t> map =
      decoded(image_bytes(json, buffer, surface["metallicRoughnessTexture"]["index"]), scratch);
  EXPECT_NEAR(map.at(3, 3, 1) / 255.0, 0.4, 0.51 / 255);
  EXPECT_EQ(map.at(3, 3, 2), 0);
}

/// Reads a file back by the importer and holds it against the mesh that was exported.
void expect_same_shape(const std::string& glb, const TriangleMesh& mesh, const Scratch& scratch, double step,
                       float uv_step) {
  std::ofstream(scratch / "back.glb", std::ios::binary) << glb;
  const SourceMesh back = read_source_mesh(scratch / "back.glb");
  ASSERT_EQ(back.faces.size(), mesh.triangles.size());
  ASSERT_EQ(back.corners.size(), 3 * mesh.triangles.size());
  // Triangles come in another order, and begin at another corner: each is looked for by its middle and its uvs'.
  std::vector<std::uint8_t> is_taken(mesh.triangles.size());
  for (const SourceMesh::Face& face : back.faces) {
    bool is_found = false;
    for (std::size_t t = 0; t < mesh.triangles.size() && !is_found; ++t) {
      for (std::size_t turn = 0; turn < 3 && !is_found && is_taken[t] == 0; ++turn) {
        bool is_same = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const SourceMesh::Corner& corner = back.corners_of(face)[k];
          const std::uint32_t vertex = mesh.triangles[t][(k + turn) % 3];
          const Eigen::Vector3d place = mesh.frame.to_file(mesh.positions[vertex].cast<double>());
          is_same = is_same && (back.places[corner.place] - place).cwiseAbs().maxCoeff() <= step &&
                    (mesh.uvs.empty() || (back.uvs[corner.uv] - mesh.uvs[vertex]).cwiseAbs().maxCoeff() <= uv_step) &&
                    back.normals[corner.normal].normalized().dot(mesh.normals[vertex]) > 0.9999f;
        }
        is_found = is_same;
        if (is_same) is_taken[t] = 1;
      }
    }
    ASSERT_TRUE(is_found);
  }
}

TEST(Export, ImporterReadsBackTheSameShape) {
  Scratch scratch;
  Sample sample{shapes::cube_sphere(5)};
  sample.description.normals_file = normal_map_name;
  write(scratch.folder(), sample);
  write_normals(scratch / normal_map_name, Image<float>(32, 32, 3, 0.57735f), 16);
  const TriangleMesh mesh = load_draco(scratch / atlas_mesh_name);
  for (const GlbMeshForm form : all_forms) {
    const std::string glb = export_asset(scratch.folder(), scratch / "a.glb", {form, false}).glb;
    // Draco's steps are 1/65,535 of the box, whose side is 2, and of the unit square; floats of 1 - v are exact to half
    // a step of theirs.
    const bool is_exact = form != GlbMeshForm::draco;
    expect_same_shape(glb, mesh, scratch, is_exact ? 0 : 2.0 / 65535, is_exact ? 1e-7f : 1.0f / 65535);
    const auto [json, buffer] = parts_of(glb);
    EXPECT_FALSE(json["materials"][0].contains("doubleSided"));
    const Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
    EXPECT_TRUE(attributes.contains("TANGENT"));
    EXPECT_EQ(json["accessors"][attributes["POSITION"].get<std::size_t>()]["count"], mesh.positions.size());
  }
}

TEST(Export, PlacesFarAwayStandInTheNode) {
  Scratch scratch;
  Sample sample{shapes::plane(3)};
  sample.mesh.frame.origin = {4.5e6, -12, 7.25e5};
  write(scratch.folder(), sample);
  const TriangleMesh mesh = load_draco(scratch / atlas_mesh_name);
  const std::string glb = export_asset(scratch.folder(), scratch / "a.glb", {}).glb;
  EXPECT_EQ(parts_of(glb).first["nodes"][0]["translation"], Json({4.5e6, -12.0, 7.25e5}));
  expect_same_shape(glb, mesh, scratch, 1.0 / 65535, 1.0f / 65535);
}

TEST(Export, HugeAndTinyMeshesKeepTheirUnits) {
  for (const int exponent : {40, -40}) {
    Scratch scratch;
    Sample sample{shapes::plane(3)};
    sample.mesh.frame.exponent = exponent;
    write(scratch.folder(), sample);
    const TriangleMesh mesh = load_draco(scratch / atlas_mesh_name);
    for (const GlbMeshForm form : all_forms)
      expect_same_shape(export_asset(scratch.folder(), scratch / "a.glb", {form, false}).glb, mesh, scratch,
                        std::ldexp(1.0 / 65535, exponent), 1.0f / 65535);
  }
}

TEST(Export, PlanesAndManifestAreTheFolders) {
  for (const int bits : {8, 16}) {
    Scratch scratch;
    Sample sample{shapes::plane(2)};
    sample.bits = bits;
    sample.bands = 3;
    write(scratch.folder(), sample);
    std::filesystem::create_directory(scratch / "web");
    const ExportedAsset exported =
        export_asset(scratch.folder(), scratch / "web/asset.glb", {GlbMeshForm::plain, true});
    const auto [json, buffer] = parts_of(exported.glb);
    const Json& material = json["materials"][0];
    const Json& prt = material["extensions"]["KILN_prt"];
    EXPECT_EQ(prt["manifest"], Json::parse(text_of_file(scratch / ranges_name)));
    ASSERT_EQ(prt["pictures"].size(), 9u);
    for (const auto& [name, picture] : prt["pictures"].items())
      EXPECT_EQ(image_bytes(json, buffer, picture["index"]), text_of_file(scratch / name)) << name;
    EXPECT_EQ(material["extras"]["kiln"], "../ranges.json");
    EXPECT_EQ(json["extensionsUsed"], Json({"KILN_prt"}));
    EXPECT_FALSE(json.contains("extensionsRequired"));
    ASSERT_TRUE(exported.sky_pictures);
    EXPECT_EQ(exported.glb, export_asset(scratch.folder(), scratch / "web/asset.glb", {GlbMeshForm::plain, true}).glb);
  }
}

TEST(Export, SaysWhatStaysInTheFolder) {
  Scratch scratch;
  Sample sample{shapes::plane(2)};
  sample.description.levels = {{"lod_1.drc", 4, 0.1, 3}, {"lod_2.drc", 2, 0.2, 6}};
  sample.description.maps = {{"ao", "ao.png", PlaneRange{0, 1}}, {"height", "height.exr", {}}};
  write(scratch.folder(), sample);
  const ExportedAsset exported = export_asset(scratch.folder(), scratch / "a.glb", {});
  ASSERT_EQ(exported.warnings.size(), 2u);
  EXPECT_EQ(exported.warnings[0], "2 levels of detail stay in the folder: the file holds the finest mesh");
  EXPECT_EQ(exported.warnings[1], "further maps stay in the folder: ao, height");
  EXPECT_EQ(exported.metrics["left_out"].size(), 2u);
}

TEST(Export, VerticesKeepTheirTransfer) {
  Scratch scratch;
  TriangleMesh mesh = shapes::icosphere(2);
  OutputSet outputs(scratch.folder());
  PrtDescription description;
  description.bands = 3;
  description.channels = 1;
  description.bits = 8;
  write_vertex_asset(outputs, description, mesh, [&](int, int coefficient) {
    VertexPlane plane{std::vector<float>(mesh.positions.size()), {-1, 1}};
    for (std::size_t v = 0; v < plane.values.size(); ++v)
      plane.values[v] = mesh.positions[v][coefficient % 3] * static_cast<float>(coefficient % 2 == 0 ? 1 : -1);
    return plane;
  });
  outputs.commit();
  const AttributedMesh stored = load_attributed_draco(scratch / vertex_mesh_name);
  for (const GlbMeshForm form : all_forms) {
    const std::string glb = export_asset(scratch.folder(), scratch / "a.glb", {form, false}).glb;
    const auto [json, buffer] = parts_of(glb);
    const Json& prt = json["materials"][0]["extensions"]["KILN_prt"];
    EXPECT_FALSE(prt.contains("pictures"));
    EXPECT_FALSE(json.contains("textures"));
    EXPECT_EQ(prt["attributes"]["kiln-prt-0-2"], "_KILN_PRT_0_2");
    expect_same_shape(glb, stored.mesh, scratch, form == GlbMeshForm::draco ? 2.0 / 65535 : 0, 0);
    if (form != GlbMeshForm::plain) continue;
    // The ninth coefficient is the only component of the third attribute, padded to four bytes.
    const Json& accessor =
        json["accessors"][json["meshes"][0]["primitives"][0]["attributes"]["_KILN_PRT_0_2"].get<std::size_t>()];
    EXPECT_EQ(accessor["type"], "SCALAR");
    EXPECT_EQ(accessor["componentType"], 5121);
    const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    EXPECT_EQ(view["byteStride"], 4);
    for (std::size_t v = 0; v < stored.mesh.positions.size(); ++v)
      ASSERT_EQ(static_cast<unsigned char>(buffer[view["byteOffset"].get<std::size_t>() + 4 * v]),
                stored.attributes[2].values[v]);
  }
}

}  // namespace test_export

}  // namespace kiln
