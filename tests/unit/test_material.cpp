// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <sstream>

#include "base/errors.h"
#include "base/json.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "import/import_mesh.h"
#include "material/load_albedo.h"
#include "material/scene_mesh.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

class Material : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return scratch_.folder() / name; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  /// Makes a picture in which red is u and green v, exactly from half a texel inside the border on.
  fs::path write_ramp(const std::string& name) const {
    constexpr int side = 32;
    Image<float> ramp(side, side, 3, 0.25f);
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        ramp.at(i, j, 0) = (static_cast<float>(i) + 0.5f) / side;
        ramp.at(i, j, 1) = (static_cast<float>(j) + 0.5f) / side;
      }
    write_exr(path(name), ramp);
    return path(name);
  }

  static LoadedAlbedo load(const fs::path& file, const MaterialSettings& settings = {},
                           const ImportSettings& import = {}) {
    return load_albedo(import_mesh(file, import), settings);
  }

 private:
  Scratch scratch_;
};

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "no error";
}

/// Calls visit(triangle, u, v, point) for some points inside every triangle.
template <class Visit>
void for_points_of(const TriangleMesh& mesh, const Visit& visit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> part(0.02f, 0.98f);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 4; ++k) {
      float u = part(random), v = part(random);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const auto& [a, b, c] = mesh.triangles[t];
      visit(t, u, v, Eigen::Vector3f((1 - u - v) * mesh.positions[a] + u * mesh.positions[b] + v * mesh.positions[c]));
    }
}

/// Tolerance for the rounding of a texture and of a lookup: both are a few sums of floats below 1.
constexpr float rounding = 2e-6f;

#define EXPECT_COLOR(actual, expected, tolerance)                     \
  EXPECT_LE(((actual) - (expected)).cwiseAbs().maxCoeff(), tolerance) \
      << "found " << (actual).transpose() << ", expected " << (expected).transpose()

TEST(Srgb, DecodesByTheStandardAndBack) {
  // IEC 61966-2-1: 0.04045 is where its two branches meet; 0.5 and 188 / 255 by the formula in double precision.
  EXPECT_FLOAT_EQ(linear_from_srgb(0.04045f), 0.04045f / 12.92f);
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.21404114, 1e-7);
  EXPECT_NEAR(linear_from_srgb(188 / 255.f), 0.50288650, 1e-6);
  EXPECT_EQ(linear_from_srgb(-1), 0);
  EXPECT_EQ(linear_from_srgb(2), 1);
  for (int byte = 0; byte < 256; ++byte)
    EXPECT_EQ(byte_from_unit(srgb_from_linear(linear_from_srgb(static_cast<float>(byte) / 255))), byte);
}

TEST(MaterialOptions, ReadOneNumberOrThree) {
  MaterialSettings settings;
  OptionSet options;
  add_material_options(options, settings);
  const auto set = [&](const std::string& text) { options.find("albedo")->set(text); };
  EXPECT_FALSE(settings.albedo);
  set("0.8");
  EXPECT_EQ(*settings.albedo, (std::array<float, 3>{0.8f, 0.8f, 0.8f}));
  for (const char* text : {"0.1,0.2,0.3", "0.1; 0.2; 0.3", "0.1, 0.2 , 0.3"}) {
    set(text);
    EXPECT_EQ(*settings.albedo, (std::array<float, 3>{0.1f, 0.2f, 0.3f})) << text;
  }
  for (const char* text : {"", "grey", "1.01", "-0.1", "nan", "0.1,0.2", "0.1,0.2,0.3,0.4", "0.1,,0.3", "0.1,0.2,"})
    EXPECT_THROW(set(text), WrongUsage) << text;
  EXPECT_EQ(settings.albedo, (std::array<float, 3>{0.1f, 0.2f, 0.3f})) << "what is refused changes nothing";
  EXPECT_EQ(options.find("albedo")->get(), "0.1, 0.2 , 0.3") << "records have it as it was given";
  settings.albedo = {0.5f, 0.25f, 0.f};
  EXPECT_EQ(options.find("albedo")->get(), "0.5,0.25,0");
}

TEST_F(Material, TextureLookupsAreBilinearInLinearLightAndRepeat) {
  Image<std::uint8_t> bytes(2, 1, 3, 0);
  bytes.at(0, 0, 0) = 188;  // 0.503 linear
  bytes.at(1, 0, 0) = 64;
  write_png(path("two.png"), bytes);
  const float left = linear_from_srgb(188 / 255.f), right = linear_from_srgb(64 / 255.f);
  const ColorTexture texture(path("two.png"), ColorEncoding::srgb);
  const auto red = [&](float u, bool clamp = false) {
    using Wrap = ColorTexture::Wrap;
    return texture.at({u, 0.3f}, clamp ? Wrap::clamp : Wrap::repeat).x();
  };
  EXPECT_NEAR(red(0.25f), left, rounding);
  EXPECT_NEAR(red(0.75f), right, rounding);
  EXPECT_NEAR(red(0.5f), (left + right) / 2, rounding) << "the mean of light, not of stored bytes";
  EXPECT_NEAR(red(0), (left + right) / 2, rounding) << "repeated";
  EXPECT_NEAR(red(-0.75f), left, rounding);
  EXPECT_NEAR(red(1000.25f), left, 1e-3) << "a float of 1000 has steps of 6e-5";
  EXPECT_NEAR(red(0, true), left, rounding) << "clamped";
  EXPECT_NEAR(red(7, true), right, rounding);
  EXPECT_NEAR(ColorTexture(path("two.png"), ColorEncoding::linear).at({0.25f, 0}).x(), 188 / 255.f, rounding);
  EXPECT_FALSE(texture.is_grey());
}

TEST_F(Material, TexturesOfEveryKindGiveTheSameColors) {
  // A grey PNG of 16 bits, one with alpha, and an EXR that holds the linear values.
  Image<std::uint16_t> grey16(1, 2, 1);
  Image<std::uint8_t> rgba(1, 2, 4, 255);
  Image<float> linear(1, 2, 3);
  for (int j = 0; j < 2; ++j) {
    const std::uint8_t byte = j == 0 ? 51 : 204;
    grey16.at(0, j) = static_cast<std::uint16_t>(257 * byte);
    for (int c = 0; c < 3; ++c) {
      rgba.at(0, j, c) = byte;
      linear.at(0, j, c) = linear_from_srgb(static_cast<float>(byte) / 255);
    }
    rgba.at(0, j, 3) = 7;  // its colour is not scaled by it
  }
  write_png(path("a.png"), grey16);
  write_png(path("b.png"), rgba);
  write_exr(path("c.exr"), linear);
  for (const char* name : {"a.png", "b.png", "c.exr"}) {
    const ColorTexture texture(path(name), ColorEncoding::srgb);
    for (int j = 0; j < 2; ++j) {
      const Eigen::Vector3f expected = Eigen::Vector3f::Constant(linear.at(0, j, 0));
      EXPECT_COLOR(texture.at({0.5f, 0.25f + 0.5f * static_cast<float>(j)}), expected, rounding) << name << j;
    }
    EXPECT_TRUE(texture.is_grey()) << name;
  }
}

TEST_F(Material, VertexColorsAreDecodedThenInterpolated) {
  const fs::path file =
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n"
            "0 0 0 255 0 0\n1 0 0 0 188 0\n0 1 0 0 0 51\n3 0 1 2\n");
  const LoadedAlbedo loaded = load(file);
  EXPECT_EQ(loaded.albedo.source(), SurfaceAlbedo::Source::vertex_colors);
  EXPECT_FALSE(loaded.albedo.is_grey());
  const Eigen::Vector3f expected(0.25f, 0.5f * linear_from_srgb(188 / 255.f), 0.25f * linear_from_srgb(0.2f));
  EXPECT_COLOR(loaded.albedo.at(0, 0.5f, 0.25f), expected, rounding);
  const Eigen::Vector3f raw(0.25f, 0.5f * 188 / 255.f, 0.25f * 0.2f);
  EXPECT_COLOR(load(file, {.encoding = ColorEncoding::linear}).albedo.at(0, 0.5f, 0.25f), raw, rounding);

  const LoadedAlbedo given = load(file, {.albedo = {{0.5f, 0.5f, 0.5f}}});
  EXPECT_TRUE(given.albedo.is_constant() && given.albedo.is_grey()) << "a number comes before the file's colours";
  EXPECT_EQ(given.albedo.at(0, 0.5f, 0.25f), Eigen::Vector3f::Constant(0.5f));
}

TEST_F(Material, NothingKnownIsWhite) {
  const LoadedAlbedo loaded = load(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_EQ(loaded.albedo.source(), SurfaceAlbedo::Source::none);
  EXPECT_EQ(loaded.albedo.at(0, 0.3f, 0.3f), Eigen::Vector3f::Ones());
  EXPECT_TRUE(loaded.files.empty() && loaded.warnings().empty());
}

TEST_F(Material, ColorsOutsideAreCountedAndThoseThatAreNoNumbersRefused) {
  const std::string rest = "v 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n";
  const ImportedMesh imported = import_mesh(write("a.obj", "v 0 0 0 2 -1 0.5\n" + rest));
  const TriangleMesh& mesh = imported.mesh;
  ASSERT_EQ(imported.warnings.size(), 1u);
  EXPECT_NE(imported.warnings[0].find("1 vertex"), std::string::npos) << imported.warnings[0];
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(1, 0, 0.5f));
  // A stream does not read "nan"; a binary file can hold one.
  TriangleMesh holed = mesh;
  std::ofstream ply(path("nan.ply"), std::ios::binary);
  ply << "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
         "z\n"
         "property float red\nproperty float green\nproperty float blue\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n";
  for (int k = 0; k < 3; ++k) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float row[6] = {static_cast<float>(k == 1), static_cast<float>(k == 2), 0, k == 0 ? nan : 0.5f, 0.5f, 0.5f};
    ply.write(reinterpret_cast<const char*>(row), sizeof row);
  }
  const std::int32_t corners[3] = {0, 1, 2};
  ply.put(3).write(reinterpret_cast<const char*>(corners), sizeof corners);
  ply.close();
  EXPECT_NE(message_of([&] { load_mesh(path("nan.ply")); }).find("has a colour that is not a finite number"),
            std::string::npos);

  Image<float> texels(2, 2, 3, 0.5f);
  texels.at(0, 0, 1) = 3;
  texels.at(1, 1, 2) = -1;
  write_exr(path("bright.exr"), texels);
  const ColorTexture texture(path("bright.exr"), ColorEncoding::srgb);
  EXPECT_EQ(texture.clamped_pixels(), 2u);
  EXPECT_EQ(texture.at({0.25f, 0.25f}).y(), 1);
  texels.at(0, 0, 1) = std::numeric_limits<float>::infinity();
  write_exr(path("bright.exr"), texels);
  EXPECT_NE(message_of([&] { ColorTexture(path("bright.exr"), ColorEncoding::srgb); }).find("not a finite number"),
            std::string::npos);
}

/// Makes a unit cube whose six sides each have vertices, a material and a chart of their own; sides alternate between a
/// texture, with the chart turned individually, a colour, and both.
struct PaintedCube {
  std::string obj, mtl;

  static Eigen::Vector3f color(int side) {
    return Eigen::Vector3f(0.2f + 0.1f * static_cast<float>(side), 0.9f - 0.1f * static_cast<float>(side), 0.5f);
  }
  static bool has_color(int side) { return side % 3 != 0; }
  static bool has_texture(int side) { return side % 3 != 1; }
  static int axis(int side) { return side / 2; }

  /// Returns the place on a side, 0 to 1 each way.
  static Eigen::Vector2f place(int side, const Eigen::Vector3f& p) {
    return {p[(axis(side) + 1) % 3], p[(axis(side) + 2) % 3]};
  }
  static Eigen::Vector2f uv(int side, const Eigen::Vector2f& place) {
    const Eigen::Vector2f centred = 0.7f * (place - Eigen::Vector2f::Constant(0.5f));
    return Eigen::Rotation2Df(0.3f * static_cast<float>(side)) * centred * 0.8f + Eigen::Vector2f::Constant(0.5f);
  }

  static Eigen::Vector3f truth(const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
    int side = 0;
    while (std::abs(normal[axis(side)] - (side % 2 == 0 ? -1 : 1)) > 0.1f) ++side;
    Eigen::Vector3f result = Eigen::Vector3f::Ones();
    if (has_color(side)) result = color(side);
    const Eigen::Vector2f at = uv(side, place(side, p));
    if (has_texture(side)) result = result.cwiseProduct(Eigen::Vector3f(at.x(), at.y(), 0.25f));
    return result;
  }

  PaintedCube() {
    std::ostringstream faces, materials;
    faces << "mtllib the cube.mtl\nv 7 7 7\n";  // a vertex that no face uses
    for (int side = 0; side < 6; ++side) {
      materials << "newmtl side " << side << "\n";
      if (has_color(side)) materials << "Kd " << color(side).transpose() << "\n";
      if (side == 3) materials << "Kd 0 0 0\n";
      if (has_texture(side)) materials << "map_Kd -blendu off ramp.exr\n";
      faces << "usemtl side " << side << "\n";
      std::array<int, 4> order = {0, 1, 2, 3};
      if (side % 2 == 0) std::reverse(order.begin(), order.end());
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2f at(k == 1 || k == 2 ? 1 : 0, k > 1 ? 1 : 0);
        Eigen::Vector3f p;
        p[axis(side)] = static_cast<float>(side % 2);
        p[(axis(side) + 1) % 3] = at.x();
        p[(axis(side) + 2) % 3] = at.y();
        faces << "v " << p.transpose() << "\nvt " << uv(side, at).transpose() << "\n";
      }
      const auto corner = [&](int k) { return std::to_string(k - 4) + "/" + std::to_string(k - 4) + " "; };
      if (side == 4) std::reverse(order.begin(), order.end());  // wound against the others
      faces << "f ";
      for (const int k : order) faces << corner(k);
      faces << "\nf " << corner(0) << corner(0) << corner(1) << "\n";               // degenerate
      if (side == 5) faces << "f " << corner(2) << corner(0) << corner(1) << "\n";  // half of the quad once more
    }
    obj = faces.str();
    mtl = materials.str();
  }
};

TEST_F(Material, MaterialsAndUvsFollowTrianglesThroughRepair) {
  write_ramp("ramp.exr");
  const PaintedCube cube;
  write("the cube.mtl", cube.mtl);
  const fs::path file = write("cube.obj", cube.obj);
  const ImportedMesh imported = import_mesh(file);
  const TriangleMesh& mesh = imported.mesh;
  const MeshRepairs& repairs = imported.repairs;
  ASSERT_EQ(mesh.triangles.size(), 12u);
  ASSERT_TRUE(is_closed(mesh));
  EXPECT_GT(repairs.reversed_triangles, 0);
  EXPECT_GT(repairs.degenerate_triangles + repairs.duplicate_triangles, 6);

  const LoadedAlbedo loaded = load_albedo(imported, {.encoding = ColorEncoding::linear});
  EXPECT_EQ(loaded.albedo.source(), SurfaceAlbedo::Source::materials);
  EXPECT_EQ(loaded.files, (std::vector<fs::path>{path("the cube.mtl"), path("ramp.exr")}));
  for_points_of(mesh, [&](std::uint32_t t, float u, float v, const Eigen::Vector3f& p) {
    const Eigen::Vector3f a = mesh.positions[mesh.triangles[t][0]], b = mesh.positions[mesh.triangles[t][1]],
                          c = mesh.positions[mesh.triangles[t][2]];
    const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    EXPECT_COLOR(loaded.albedo.at(t, u, v), PaintedCube::truth(p, normal), rounding);
  });

  // One texture replaces all materials.
  const LoadedAlbedo ramp = load_albedo(imported, {.texture = path("ramp.exr").string()});
  EXPECT_EQ(ramp.albedo.source(), SurfaceAlbedo::Source::texture);
  const std::uint32_t t = 3;
  EXPECT_FLOAT_EQ(ramp.albedo.at(t, 0.2f, 0.3f).z(), 0.25f);
}

/// Colours a surface by its place: red is x, green is y, both from 0 to 1.
std::string vertex_and_uv(const Eigen::Vector3f& p) {
  std::ostringstream text;
  text.precision(9);
  text << "v " << p.transpose() << "\nvt " << p.x() << ' ' << p.y() << "\n";
  return text.str();
}

TEST_F(Material, UvsFollowPolygonsFlatTrianglesAndFilledHoles) {
  const MaterialSettings settings{.texture = write_ramp("ramp.exr").string()};
  const auto expect_places = [&](const fs::path& file, const ImportSettings& import, std::size_t triangles) {
    const ImportedMesh imported = import_mesh(file, import);
    const TriangleMesh& mesh = imported.mesh;
    ASSERT_EQ(mesh.triangles.size(), triangles);
    const LoadedAlbedo loaded = load_albedo(imported, settings);
    for_points_of(mesh, [&](std::uint32_t t, float u, float v, const Eigen::Vector3f& p) {
      const Eigen::Vector3f expected(p.x(), p.y(), 0.25f);
      EXPECT_COLOR(loaded.albedo.at(t, u, v), expected, rounding);
    });
  };
  const auto vertices = [&](const std::vector<Eigen::Vector3f>& places) {
    std::string text;
    for (const Eigen::Vector3f& p : places) text += vertex_and_uv(p);
    return text;
  };

  // An L of six corners, and a quad beside it that shares an edge.
  const std::string l_shape = vertices({{0.1f, 0.5f, 0},
                                        {0.1f, 0.1f, 0},
                                        {0.9f, 0.1f, 0},
                                        {0.9f, 0.9f, 0},
                                        {0.5f, 0.9f, 0},
                                        {0.5f, 0.5f, 0},
                                        {0.1f, 0.9f, 0}}) +
                              "f 1/1 2/2 3/3 4/4 5/5 6/6\nf 1/1 6/6 5/5 7/7\n";
  expect_places(write("l.obj", l_shape), {}, 6);

  // A triangle without area between two others, which repair takes out and cuts the neighbour in its place.
  const std::string t_junction =
      vertices({{0.1f, 0.1f, 0}, {0.5f, 0.1f, 0}, {0.9f, 0.1f, 0}, {0.5f, 0.9f, 0}, {0.5f, 0.05f, 0.4f}}) +
      "f 1/1 3/3 4/4\nf 1/1 2/2 3/3\nf 2/2 1/1 5/5\nf 3/3 2/2 5/5\n";
  expect_places(write("t.obj", t_junction), {}, 4);

  // A flat ring of eight quads whose hole of eight edges is closed: corners have the ring's colours.
  std::vector<Eigen::Vector3f> ring;
  std::ostringstream faces;
  for (int k = 0; k < 8; ++k) {
    const float angle = static_cast<float>(k) * 0.785398f;
    for (const float radius : {0.2f, 0.4f})
      ring.emplace_back(0.5f + radius * std::cos(angle), 0.5f + radius * std::sin(angle), 0.f);
    const int a = 2 * k + 1, b = a + 1, c = (2 * k + 3) % 16 + 1, d = (2 * k + 2) % 16 + 1;
    faces << "f " << a << '/' << a << ' ' << b << '/' << b << ' ' << c << '/' << c << ' ' << d << '/' << d << "\n";
  }
  const std::string text = vertices(ring) + faces.str();
  const fs::path file = write("ring.obj", text);
  const ImportedMesh imported = import_mesh(file, {.fill_hole_edges = 8});
  const TriangleMesh& mesh = imported.mesh;
  ASSERT_EQ(mesh.triangles.size(), 16u + 6u);
  const LoadedAlbedo loaded = load_albedo(imported, settings);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    // A filling triangle spans the hole; each corner that its face lacks has that of the face's nearest point, which
    // lies at most the hole's width of 0.4 away.
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f p = mesh.positions[mesh.triangles[t][static_cast<std::size_t>(k)]];
      const Eigen::Vector3f found = loaded.albedo.at(t, k == 1 ? 1.f : 0.f, k == 2 ? 1.f : 0.f);
      EXPECT_COLOR(found, Eigen::Vector3f(p.x(), p.y(), 0.25f), t < 16 ? rounding : 0.4f);
    }
  }
}

TEST_F(Material, DracoFilesWithUvsTakeATexture) {
  TriangleMesh sheet = shapes::plane(4);
  save_draco(path("sheet.drc"), sheet);
  const fs::path ramp = write_ramp("ramp.exr");
  const ImportedMesh imported = import_mesh(path("sheet.drc"));
  const LoadedAlbedo loaded = load_albedo(imported, {.texture = ramp.string()});
  for_points_of(imported.mesh, [&](std::uint32_t t, float u, float v, const Eigen::Vector3f& p) {
    // shapes::plane's chart; uvs have 16 bits.
    const Eigen::Vector3f expected(0.1f + 0.8f * (p.x() + 0.5f), 0.1f + 0.8f * (0.5f - p.z()), 0.25f);
    EXPECT_COLOR(loaded.albedo.at(t, u, v), expected, 1e-4f);
  });
}

TEST_F(Material, MapsAreScaledMovedAndNamedAsWindowsDoes) {
  fs::create_directories(path("maps"));
  fs::rename(write_ramp("ramp.exr"), path("maps") / "the ramp.exr");
  write("a.mtl", "newmtl m\nKd 0 0 0\nmap_Kd -s 0.5 0.25 1 -o 0.125 0.5 -texres 512 maps\\the ramp.exr\n");
  const fs::path file =
      write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
  const Eigen::Vector3f expected(0.5f * 0.5f + 0.125f, 0.25f * 0.25f + 0.5f, 0.25f);
  EXPECT_COLOR(load(file).albedo.at(0, 0.5f, 0.25f), expected, rounding);
}

TEST_F(Material, BadFilesAreNamed) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
  const fs::path file = write("a.obj", "mtllib a.mtl\n" + triangle + "usemtl m\nf 1/1 2/2 3/3\n");
  const auto message = [&](const MaterialSettings& settings = {}) { return message_of([&] { load(file, settings); }); };
  const auto says = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      if (text.find(part) == std::string::npos) return testing::AssertionFailure() << text << " lacks " << part;
    return testing::AssertionSuccess();
  };
  EXPECT_TRUE(says(message(), {"a.obj", "material library", "a.mtl", "does not exist"}));
  write("a.mtl", "newmtl other\nKd 1 1 1\n");
  EXPECT_TRUE(says(message(), {"a.obj", "the material 'm'"}));
  write("a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd none.png\n");
  EXPECT_TRUE(says(message(), {"a.mtl:3", "none.png", "does not exist"}));
  write("none.png", "\x89PNG\r\n\x1a\n");
  EXPECT_TRUE(says(message(), {"none.png", "truncated"}));
  write("a.mtl", "newmtl m\nKd 1 red 1\n");
  EXPECT_TRUE(says(message(), {"a.mtl:2", "Kd '1 red 1'"}));
  EXPECT_EQ(message({.albedo = {{0.5f, 0.5f, 0.5f}}}), "no error") << "a number needs none of these";
  EXPECT_TRUE(says(message({.texture = path("nothing.png").string()}), {"nothing.png", "does not exist"}));
  EXPECT_THROW(load(file, {.albedo = {{0.5f, 0.5f, 0.5f}}, .texture = "a.png"}), WrongUsage);

  write("a.mtl", "newmtl m\nmap_Kd ramp.exr\n");
  write_ramp("ramp.exr");
  write("a.obj", "mtllib a.mtl\n" + triangle + "usemtl m\nf 1 2 3\n");
  EXPECT_TRUE(says(message(), {"a.obj:9", "without texture coordinates", "'m'"}));
  EXPECT_TRUE(says(message({.texture = path("ramp.exr").string()}), {"a.obj:9", "without texture coordinates"}));
  const fs::path stl = write("a.stl",
                             "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                             "endloop\nendfacet\nendsolid\n");
  EXPECT_TRUE(says(message_of([&] { load(stl, {.texture = path("ramp.exr").string()}); }),
                   {"a.stl", "no texture coordinates"}));
  // Materials that no face uses are nobody's business.
  write("a.obj", "mtllib missing.mtl\n" + triangle + "f 1 2 3\n");
  EXPECT_EQ(message(), "no error");
}

TEST(SceneMesh, TrianglesKeepTheAlbedoOfTheirMesh) {
  const Eigen::Vector3f red(0.8f, 0.1f, 0.1f);
  SceneMesh scene;
  scene.add(shapes::icosphere(0), SurfaceAlbedo::constant(Eigen::Vector3f::Constant(0.5f)));
  EXPECT_TRUE(scene.is_grey());
  scene.add(shapes::plane(1), SurfaceAlbedo::constant(red));
  EXPECT_FALSE(scene.is_grey());
  ASSERT_EQ(scene.mesh.triangles.size(), 22u);
  EXPECT_EQ(scene.first_triangles, (std::vector<std::uint32_t>{0, 20}));
  EXPECT_EQ(scene.albedo_at(0, 0.2f, 0.2f), Eigen::Vector3f::Constant(0.5f));
  EXPECT_EQ(scene.albedo_at(19, 0.2f, 0.2f), Eigen::Vector3f::Constant(0.5f));
  EXPECT_EQ(scene.albedo_at(20, 0.2f, 0.2f), red);
  EXPECT_EQ(scene.albedo_at(21, 0.2f, 0.2f), red);
  // Triangles of the second mesh are of its own vertices, which stand behind the 12 of the first.
  for (const std::uint32_t vertex : scene.mesh.triangles[20]) EXPECT_GE(vertex, 12u);
}

}  // namespace
}  // namespace kiln
