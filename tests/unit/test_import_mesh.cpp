// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files.h"
#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "mesh/hard_edges.h"
#include "mesh/surface_point.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_import_mesh {

namespace fs = std::filesystem;

class MeshFile : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  const Scratch folder_;
};

template <class Value>
std::string bytes_of(Value value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::string point_text(const Eigen::Vector3f& p) {
  std::ostringstream text;
  text.precision(9);  // enough for any float
  text << p.x() << ' ' << p.y() << ' ' << p.z();
  return text.str();
}

std::string to_obj(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "# generated\n";
  for (const auto& p : mesh.positions) text << "v " << point_text(p) << "\n";
  for (const Triangle& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << "\n";
  return text.str();
}

std::string to_off(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "OFF\n" << mesh.positions.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const auto& p : mesh.positions) text << point_text(p) << "\n";
  for (const Triangle& t : mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << "\n";
  return text.str();
}

std::string ply_header(const TriangleMesh& mesh, const std::string& format) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string to_ply_ascii(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << ply_header(mesh, "ascii");
  for (const auto& p : mesh.positions) text << point_text(p) << "\n";
  for (const Triangle& t : mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << "\n";
  return text.str();
}

std::string to_ply_binary(const TriangleMesh& mesh) {
  std::string bytes = ply_header(mesh, "binary_little_endian");
  for (const auto& p : mesh.positions)
    for (int i = 0; i < 3; ++i) bytes += bytes_of(p[i]);
  for (const Triangle& t : mesh.triangles) {
    bytes += bytes_of(std::uint8_t{3});
    for (std::uint32_t vertex : t) bytes += bytes_of(vertex);
  }
  return bytes;
}

std::string to_stl_ascii(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "solid shape\n";
  for (const Triangle& t : mesh.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (std::uint32_t vertex : t) text << "vertex " << point_text(mesh.positions[vertex]) << "\n";
    text << "endloop\nendfacet\n";
  }
  text << "endsolid shape\n";
  return text.str();
}

std::string to_stl_binary(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  bytes += bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    bytes += std::string(12, '\0');
    for (std::uint32_t vertex : t)
      for (int i = 0; i < 3; ++i) bytes += bytes_of(mesh.positions[vertex][i]);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

/// Lists the triangles as corners' positions, the smallest first, sorted: the same for the same surface in any order.
std::vector<std::array<std::array<float, 3>, 3>> geometry(const TriangleMesh& mesh) {
  std::vector<std::array<std::array<float, 3>, 3>> triangles;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::array<float, 3>, 3> corners;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) corners[i][k] = mesh.positions[t[i]][k] + 0.f;  // no negative zero
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void expect_same(const TriangleMesh& loaded, const TriangleMesh& shape) {
  EXPECT_EQ(loaded.positions.size(), shape.positions.size());
  EXPECT_EQ(geometry(loaded), geometry(shape));
  ASSERT_EQ(loaded.normals.size(), loaded.positions.size());
}

TEST_F(MeshFile, EveryFormatGivesTheSameMesh) {
  const TriangleMesh shape = shapes::wavy_sheet(9);
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"a.obj", to_obj(shape)},
                                                        {"a.off", to_off(shape)},
                                                        {"ascii.ply", to_ply_ascii(shape)},
                                                        {"binary.ply", to_ply_binary(shape)},
                                                        {"ascii.stl", to_stl_ascii(shape)},
                                                        {"binary.STL", to_stl_binary(shape)}}) {
    SCOPED_TRACE(name);
    expect_same(load_mesh(write(name, text)), shape);
  }
}

TEST_F(MeshFile, MendsAndCounts) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nv 0 0 0\n"
      "f 1 2 3 4\n"  // a polygon: two triangles
      "f 6 3 4\n"    // one of them again, through a vertex at the place of the first
      "f 1 1 2\n"    // no area
      "f 1 4 2\n";   // one more, folded
  MeshRepairs repairs;
  const TriangleMesh mesh = load_mesh(write("a.obj", text), &repairs);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_TRUE(is_manifold(mesh));
  EXPECT_EQ(repairs.triangulated_polygons, 1);
  EXPECT_EQ(repairs.merged_vertices, 1);
  EXPECT_EQ(repairs.unused_vertices, 1);
  EXPECT_EQ(repairs.duplicate_triangles, 1);
  EXPECT_EQ(repairs.degenerate_triangles, 1);
}

/// Computes a colour that identifies a point of the unit sphere; its values are whole 255ths.
Eigen::Vector3f color_of(const Eigen::Vector3f& p) { return (127.5f * (p.array() + 1)).round() / 255; }

TEST_F(MeshFile, EveryFormatGivesTheSameColors) {
  const TriangleMesh shape = shapes::icosphere(2);
  std::ostringstream obj, off, ply, float_ply;
  obj << "# with colours\n";
  off << "COFF\n" << shape.positions.size() << ' ' << shape.triangles.size() << " 0\n";
  const auto properties = [](const std::string& type) {
    return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\nelement face";
  };
  const auto header = [&](const std::string& format, const std::string& type) {
    std::string text = ply_header(shape, format);
    return text.replace(text.find("element face"), 12, properties(type));
  };
  ply << header("ascii", "uchar");
  float_ply << header("binary_little_endian", "float");
  for (const Eigen::Vector3f& p : shape.positions) {
    const Eigen::Vector3f color = color_of(p);
    const Eigen::Vector3i bytes = (255 * color).array().round().cast<int>();
    obj << "v " << point_text(p) << ' ' << point_text(color) << "\n";
    for (std::ostringstream* text : {&off, &ply})
      *text << point_text(p) << ' ' << bytes.x() << ' ' << bytes.y() << ' ' << bytes.z() << "\n";
    for (const Eigen::Vector3f& values : {p, color})
      for (int k = 0; k < 3; ++k) float_ply << bytes_of(values[k]);
  }
  for (const auto& [a, b, c] : shape.triangles) {
    obj << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << "\n";
    for (std::ostringstream* text : {&off, &ply}) *text << "3 " << a << ' ' << b << ' ' << c << "\n";
    float_ply << bytes_of(std::uint8_t{3}) << bytes_of(a) << bytes_of(b) << bytes_of(c);
  }
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.obj", obj.str()}, {"a.off", off.str()}, {"a.ply", ply.str()}, {"float.ply", float_ply.str()}}) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = load_mesh(write(name, text));
    expect_same(mesh, shape);
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.colors.size(); ++i)
      EXPECT_LT((mesh.colors[i] - color_of(mesh.positions[i])).cwiseAbs().maxCoeff(), 1e-6f) << "rounding of floats";
  }
  EXPECT_TRUE(load_mesh(write("plain.obj", to_obj(shape))).colors.empty());
}

TEST_F(MeshFile, DracoKeepsColorsOf8Bits) {
  TriangleMesh shape = shapes::icosphere(3);
  save_draco(path("plain.drc"), shape);
  for (const Eigen::Vector3f& p : shape.positions) shape.colors.push_back(color_of(p));
  save_draco(path("a.drc"), shape);
  EXPECT_TRUE(load_mesh(path("plain.drc")).colors.empty());
  const TriangleMesh decoded = load_mesh(path("a.drc"));
  ASSERT_EQ(decoded.positions.size(), shape.positions.size());
  ASSERT_EQ(decoded.colors.size(), shape.positions.size());
  for (std::size_t i = 0; i < decoded.colors.size(); ++i) {
    std::size_t nearest = 0;  // the order may change; vertices are 0.1 apart, positions are 1/65,535 off at most
    for (std::size_t j = 1; j < shape.positions.size(); ++j)
      if ((shape.positions[j] - decoded.positions[i]).norm() < (shape.positions[nearest] - decoded.positions[i]).norm())
        nearest = j;
    EXPECT_LT((decoded.colors[i] - shape.colors[nearest]).cwiseAbs().maxCoeff(), 1e-6f);
  }
}

TEST_F(MeshFile, PolygonsAreCutInsideThemselves) {
  // An arrowhead, whose shorter diagonal lies outside, and an L of six corners that a fan from the first would leave.
  const std::string arrowhead = "v 0 0 0\nv 4 1 0\nv 3 0 0\nv 4 -1 0\nf 1 4 3 2\n";
  const std::string corner = "v 0 1 0\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 2 0\nv 1 1 0\nf 1 2 3 4 5 6\n";
  EXPECT_NEAR(surface_area(load_mesh(write("a.obj", arrowhead))), 3, 1e-6);
  EXPECT_NEAR(surface_area(load_mesh(write("b.obj", corner))), 3, 1e-6);
  for (const char* name : {"a.obj", "b.obj"})
    for (const Eigen::Vector3f& normal : load_mesh(path(name)).normals) EXPECT_GT(normal.z(), 0.999f) << name;
}

TEST_F(MeshFile, DracoKeepsPositionsNormalsAndUvs) {
  const TriangleMesh shape = shapes::cube_sphere(8, 3);
  save_draco(path("a.drc"), shape);
  const TriangleMesh loaded = load_atlas(path("a.drc"));
  ASSERT_EQ(loaded.triangles.size(), shape.triangles.size());
  ASSERT_EQ(loaded.positions.size(), shape.positions.size()) << "vertices stay split at seams";

  // The order may change, the uvs tell which vertex is which: their steps of 1/65,535 are far below their spacing.
  const float position_half_step = 0.5f * 6 / 65535, uv_half_step = 0.5f / 65535;
  for (std::size_t i = 0; i < loaded.positions.size(); ++i) {
    std::size_t nearest = 0;
    for (std::size_t j = 1; j < shape.uvs.size(); ++j)
      if ((shape.uvs[j] - loaded.uvs[i]).norm() < (shape.uvs[nearest] - loaded.uvs[i]).norm()) nearest = j;
    // Add a twentieth for the rounding of floats.
    EXPECT_LE((shape.uvs[nearest] - loaded.uvs[i]).cwiseAbs().maxCoeff(), 1.05f * uv_half_step);
    EXPECT_LE((shape.positions[nearest] - loaded.positions[i]).cwiseAbs().maxCoeff(), 1.05f * position_half_step);
    // 12 bits over the octahedron's 2: steps of 1/2,048 and, where it is stretched most, sqrt(3) times that, in each of
    // two directions.
    EXPECT_LE((shape.normals[nearest] - loaded.normals[i]).norm(), std::sqrt(3.0f) / 2048);
  }
}

TEST_F(MeshFile, DracoMeshIsLoadedAsAHighMesh) {
  const TriangleMesh shape = shapes::icosphere(3);
  save_draco(path("a.drc"), shape);
  const TriangleMesh loaded = load_mesh(path("a.drc"));
  EXPECT_EQ(loaded.triangles.size(), shape.triangles.size());
  EXPECT_EQ(loaded.positions.size(), shape.positions.size());
  EXPECT_TRUE(is_closed(loaded));
}

TEST_F(MeshFile, BadInputIsRefused) {
  const TriangleMesh shape = shapes::wavy_sheet(4);
  save_draco(path("whole.drc"), shape);
  const std::string drc = read_text(path("whole.drc"));
  const auto half = [](const std::string& bytes) { return bytes.substr(0, bytes.size() / 2); };
  TriangleMesh not_a_number = shape, infinite = shape, no_faces = shape;
  not_a_number.positions[7].y() = std::nanf("");
  infinite.positions[7].y() = HUGE_VALF;
  no_faces.triangles.clear();
  TriangleMesh empty_triangles;
  empty_triangles.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  empty_triangles.triangles = {{0, 1, 2}};

  const std::vector<std::pair<std::string, std::string>> files = {
      {"empty.obj", ""},
      {"empty.off", ""},
      {"empty.ply", ""},
      {"empty.stl", ""},
      {"empty.drc", ""},
      {"nan.obj", to_obj(not_a_number)},
      {"nan.off", to_off(not_a_number)},
      {"nan-ascii.ply", to_ply_ascii(not_a_number)},
      {"nan-binary.ply", to_ply_binary(not_a_number)},
      {"nan-binary.stl", to_stl_binary(not_a_number)},
      {"infinite.obj", to_obj(infinite)},
      {"infinite-binary.ply", to_ply_binary(infinite)},
      {"no-faces.obj", to_obj(no_faces)},
      {"no-faces.off", to_off(no_faces)},
      {"no-faces.ply", to_ply_ascii(no_faces)},
      {"no-faces.stl", to_stl_ascii(no_faces)},
      {"no-area.obj", to_obj(empty_triangles)},
      {"out-of-range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
      {"two-corners.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n"},
      // Cut in the middle of a face line that then refers to too few vertices or to none.
      {"truncated.obj", to_obj(shape) + "f 1 2"},
      {"truncated.off", half(to_off(shape))},
      {"truncated-ascii.ply", half(to_ply_ascii(shape))},
      {"truncated-binary.ply", half(to_ply_binary(shape))},
      {"truncated-binary.stl", half(to_stl_binary(shape))},
      {"truncated.drc", half(drc)},
      {"text.drc", "this is no Draco file"},
      {"binary.obj", drc},
      {"mesh.xyz", to_obj(shape)},
      {"mesh", to_obj(shape)},
  };
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    const fs::path file = write(name, bytes);
    EXPECT_THROW(
        {
          try {
            load_mesh(file);
          } catch (const BadInput& error) {
            EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << "the message names the file";
            throw;
          }
        },
        BadInput);
  }
  EXPECT_THROW(load_mesh(path("missing.obj")), BadInput);
  EXPECT_THROW(load_atlas(path("whole.drc")), BadInput) << "it has no uvs";
}

// ---- Frames.

std::string to_obj_at(const TriangleMesh& mesh, const Eigen::Vector3d& offset, double scale) {
  std::ostringstream text;
  text.precision(17);
  for (const Eigen::Vector3f& p : mesh.positions)
    text << "v " << (scale * p.cast<double>() + offset).transpose() << "\n";
  for (const Triangle& t : mesh.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << "\n";
  return text.str();
}

TEST_F(MeshFile, MeshesFarAwayAreMovedAndLoseNothing) {
  const TriangleMesh ball = shapes::icosphere(4);
  const Eigen::Vector3d far(448262.25, 120, -5411932.5);
  const ImportedMesh near = import_mesh(write("near.obj", to_obj_at(ball, {1, 2, 3}, 1)));
  EXPECT_EQ(near.mesh.frame, MeshFrame()) << "what floats hold stays where it is";
  const ImportedMesh moved = import_mesh(write("far.obj", to_obj_at(ball, far, 1)));
  EXPECT_LT((moved.mesh.frame.origin - far).norm(), 8) << "a round number near the mesh";
  ASSERT_EQ(moved.mesh.triangles, near.mesh.triangles);
  EXPECT_TRUE(moved.repairs.is_clean()) << moved.repairs.text();
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d truth = ball.positions[ball.triangles[t][k]].cast<double>() + far;
      const Eigen::Vector3f& found = moved.mesh.positions[moved.mesh.triangles[t][k]];
      // The error is half a step of a float no larger than 4, and of a double of that size.
      EXPECT_LT((moved.mesh.frame.to_file(found.cast<double>()) - truth).cwiseAbs().maxCoeff(), 3e-7);
    }
  // The frame goes through a Draco file, and a mesh is read into the frame of another.
  save_draco(path("far.drc"), moved.mesh);
  EXPECT_EQ(load_draco(path("far.drc")).frame, moved.mesh.frame);
  const ImportedMesh again = import_mesh(path("far.drc"), {}, moved.mesh.frame);
  EXPECT_EQ(again.mesh.frame, moved.mesh.frame);
  EXPECT_LT((bounding_box(again.mesh).lowest - bounding_box(moved.mesh).lowest).norm(), 1e-4f);
}

TEST_F(MeshFile, EverySizeGivesTheSameMesh) {
  const TriangleMesh ball = shapes::icosphere(2);
  const ImportedMesh plain = import_mesh(write("plain.obj", to_obj_at(ball, {0, 0, 0}, 1)));
  for (const int exponent : {-100, -60, -21, 21, 60, 83}) {  // 8e-31 to 1e25
    SCOPED_TRACE(exponent);
    const ImportedMesh sized = import_mesh(write("sized.obj", to_obj_at(ball, {0, 0, 0}, std::ldexp(1.0, exponent))));
    EXPECT_EQ(sized.mesh.triangles, plain.mesh.triangles);
    // Powers of two round nothing; the ball is 2 across, so that its frame's unit is a power of two besides.
    const float unit = std::ldexp(1.f, sized.mesh.frame.exponent - exponent);
    for (std::size_t v = 0; v < ball.positions.size(); ++v)
      EXPECT_EQ(unit * sized.mesh.positions[v], plain.mesh.positions[v]);
    EXPECT_EQ(sized.mesh.normals, plain.mesh.normals);
    save_draco(path("sized.drc"), sized.mesh);
    const TriangleMesh written = load_draco(path("sized.drc"));
    EXPECT_EQ(written.frame.exponent, sized.mesh.frame.exponent);
    EXPECT_NEAR(bounding_box(written).diagonal(), bounding_box(sized.mesh).diagonal(), 1e-4f);
  }
}

TEST_F(MeshFile, AxesAndUnitsBecomeOurs) {
  const fs::path file = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto top = [&](const ImportSettings& settings, float height) {  // the corner at the end of the axis that is up
    const TriangleMesh mesh = load_mesh(file, nullptr, settings);
    EXPECT_TRUE(is_closed(mesh));
    double volume = 0;
    for (const Triangle& t : mesh.triangles)
      volume += mesh.positions[t[0]].cast<double>().dot(
                    mesh.positions[t[1]].cast<double>().cross(mesh.positions[t[2]].cast<double>())) /
                6;
    EXPECT_GT(volume, 0) << "turned, not mirrored";
    float nearest = 1e9f;
    for (const Eigen::Vector3f& p : mesh.positions)
      nearest = std::min(nearest, (p - Eigen::Vector3f(0, height, 0)).norm());
    return nearest;
  };
  EXPECT_LT(top({.up = UpAxis::plus_y}, 2), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::minus_y}, -2), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::plus_x}, 1), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::minus_x}, -1), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::plus_z}, 3), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::minus_z}, -3), 1e-6f);
  EXPECT_LT(top({.up = UpAxis::plus_z, .unit = LengthUnit::centimetres}, 0.03f), 1e-6f);
  EXPECT_LT(top({.unit = LengthUnit::inches, .scale = 10}, 0.508f), 1e-6f);
}

// ---- Normals.

/// Makes a cube from -1 to 1, of quads; `of_side` gives each corner's normal.
std::string cube_with_normals(const std::function<Eigen::Vector3d(int side)>& of_side,
                              const std::string& between = "") {
  std::string text = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
  const char* faces[] = {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
  for (int side = 0; side < 6; ++side) {
    std::ostringstream normal;
    normal << of_side(side).transpose();
    text += "vn " + normal.str() + "\n" + between;
    std::istringstream corners(faces[side]);
    text += "f";
    for (std::string corner; corners >> corner;) text += " " + corner + "//" + std::to_string(side + 1);
    text += "\n";
  }
  return text;
}

const Eigen::Vector3d side_normals[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};

float largest_corner_deviation(const TriangleMesh& mesh) {
  float largest = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      largest = std::max(largest, (corner_normal(mesh, t, k) - face_normal(mesh, t)).norm());
  return largest;
}

TEST_F(MeshFile, HardNormalsOfTheFileStayHard) {
  const fs::path file = write("hard.obj", cube_with_normals([](int side) { return side_normals[side]; }));
  const TriangleMesh hard = load_mesh(file);
  ASSERT_EQ(hard.positions.size(), 8u) << "one vertex a place";
  EXPECT_TRUE(is_closed(hard));
  ASSERT_EQ(hard.corner_normals.size(), 12u);
  EXPECT_LT(largest_corner_deviation(hard), 1e-6f);
  EXPECT_EQ(hard_edges_of_normals(hard).size(), 12u) << "no diagonal";

  const TriangleMesh split = split_at_hard_edges(hard);
  EXPECT_EQ(split.positions.size(), 24u);
  save_draco(path("hard.drc"), split);
  const TriangleMesh again = load_mesh(path("hard.drc"));
  EXPECT_EQ(again.positions.size(), 8u);
  EXPECT_EQ(hard_edges_of_normals(again).size(), 12u);

  const TriangleMesh smooth = load_mesh(file, nullptr, {.normals = parse_normal_choice("smooth")});
  EXPECT_TRUE(smooth.corner_normals.empty());
  EXPECT_GT(largest_corner_deviation(smooth), 0.5f);
  const fs::path plain = write("plain.obj", to_obj(shapes::cube(3)));
  EXPECT_LT(largest_corner_deviation(load_mesh(plain, nullptr, {.normals = parse_normal_choice("angle:40")})), 1e-6f);
  EXPECT_TRUE(load_mesh(plain, nullptr, {.normals = parse_normal_choice("angle:91")}).corner_normals.empty());
  EXPECT_THROW(load_mesh(plain, nullptr, {.normals = parse_normal_choice("file")}), BadInput);
  EXPECT_THROW(parse_normal_choice("angle:0"), WrongUsage);
  EXPECT_THROW(parse_normal_choice("flat"), WrongUsage);
}

TEST_F(MeshFile, NormalsThatFaceAwayAreTurnedOrReplacedAndSaid) {
  const ImportedMesh inwards =
      import_mesh(write("in.obj", cube_with_normals([](int side) { return Eigen::Vector3d(-side_normals[side]); })));
  EXPECT_LT(largest_corner_deviation(inwards.mesh), 1e-6f);
  ASSERT_EQ(inwards.warnings.size(), 1u);
  EXPECT_NE(inwards.warnings[0].find("12 triangles of closed parts"), std::string::npos) << inwards.warnings[0];

  const ImportedMesh one_bad =
      import_mesh(write("bad.obj", cube_with_normals([](int side) {
                          return Eigen::Vector3d(side == 2 ? 0.0 * side_normals[2] : side_normals[side]);
                        })));
  ASSERT_EQ(one_bad.warnings.size(), 1u);
  EXPECT_NE(one_bad.warnings[0].find("6 corner"), std::string::npos) << one_bad.warnings[0];
  for (const auto& corners : one_bad.mesh.corner_normals)
    for (const Eigen::Vector3f& normal : corners) EXPECT_NEAR(normal.norm(), 1, 1e-5f);

  // An open sheet that winds against its normals is turned.
  const ImportedMesh sheet =
      import_mesh(write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n"));
  EXPECT_LT((face_normal(sheet.mesh, 0) - Eigen::Vector3f(0, 0, -1)).norm(), 1e-6f);
  EXPECT_EQ(sheet.warnings.size(), 1u);
}

TEST_F(MeshFile, SmoothingGroupsPartNormals) {
  // A ridge of four quads: the two left ones are one group, the two right ones another; each pair bends within itself.
  const std::string strip =
      "v 0 0 0\nv 1 1 0\nv 2 1.5 0\nv 3 1 0\nv 4 0 0\nv 0 0 1\nv 1 1 1\nv 2 1.5 1\nv 3 1 1\nv 4 0 1\n";
  const auto hard_edges = [&](const std::string& left, const std::string& right) {
    return hard_edges_of_normals(
        load_mesh(write("strip.obj", strip + left + "f 1 6 7 2\nf 2 7 8 3\n" + right + "f 3 8 9 4\nf 4 9 10 5\n")));
  };
  EXPECT_TRUE(hard_edges("s off\n", "").empty()) << "said of every face, it says nothing";
  EXPECT_TRUE(hard_edges("s 1\n", "").empty());
  EXPECT_EQ(hard_edges("s 1\n", "s 2\n").size(), 1u) << "between the groups";
  // Each quad's own diagonal lies in a plane, and is no edge to the eye.
  EXPECT_EQ(hard_edges("s 1\n", "s off\n").size(), 2u) << "and within the right";
}

// ---- Shapes that need a word.

TEST_F(MeshFile, CornersThatDifferInTheLastDigitAreOne) {
  // A ball as a soup of triangles whose corners are written with six decimals, the last of which is noise.
  const TriangleMesh ball = shapes::icosphere(3);
  std::mt19937 random(1);
  std::uniform_int_distribution<int> last(-1, 1);
  std::string text;
  char line[100];
  for (const Triangle& t : ball.triangles) {
    for (const std::uint32_t vertex : t) {
      const Eigen::Vector3d p = (ball.positions[vertex].cast<double>() * 1e6).array().round();
      std::snprintf(line, sizeof line, "v %.6f %.6f %.6f\n", (p.x() + last(random)) * 1e-6,
                    (p.y() + last(random)) * 1e-6, (p.z() + last(random)) * 1e-6);
      text += line;
    }
    text += "f -3 -2 -1\n";
  }
  const fs::path file = write("soup.obj", text);
  const ImportedMesh welded = import_mesh(file, {.weld = parse_weld_choice("4e-6")});
  EXPECT_EQ(welded.repairs.components, 1);
  EXPECT_TRUE(is_closed(welded.mesh));
  EXPECT_EQ(welded.mesh.positions.size(), ball.positions.size());
  EXPECT_GT(welded.repairs.welded_vertices, 1000);
  EXPECT_FALSE(welded.warnings.empty());
  EXPECT_GT(import_mesh(file, {.weld = parse_weld_choice("off")}).repairs.components, 300);
  EXPECT_THROW(parse_weld_choice("-1"), WrongUsage);

  // Small gaps that are meant stay: two squares 1e-3 apart, whose other edges are as short.
  const std::string gap =
      "v 0 0 0\nv 1e-3 0 0\nv 1e-3 1e-3 0\nv 0 1e-3 0\nv 2e-3 0 0\nv 3e-3 0 0\nv 3e-3 1e-3 0\nv 2e-3 1e-3 0\n"
      "f 1 2 3 4\nf 5 6 7 8\n";
  EXPECT_EQ(import_mesh(write("gap.obj", gap), {.weld = parse_weld_choice("0.01")}).repairs.components, 2);
}

TEST_F(MeshFile, BacksAndRoomsAreSaidAndMayBeKept) {
  const fs::path sheet = write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n");
  const ImportedMesh dropped = import_mesh(sheet);
  EXPECT_EQ(dropped.mesh.triangles.size(), 2u) << "a quad and its back are cut alike";
  EXPECT_EQ(dropped.repairs.dropped_backs, 2);
  ASSERT_EQ(dropped.warnings.size(), 1u);
  EXPECT_NE(dropped.warnings[0].find("--backs keep"), std::string::npos);
  const ImportedMesh kept = import_mesh(sheet, {.keeps_backs = true});
  EXPECT_EQ(kept.mesh.triangles.size(), 4u);
  EXPECT_TRUE(is_manifold(kept.mesh));
  EXPECT_TRUE(kept.warnings.empty());

  TriangleMesh inside_out = shapes::cube(2);
  for (Triangle& t : inside_out.triangles) std::swap(t[1], t[2]);
  const fs::path room = write("room.obj", to_obj(inside_out));
  EXPECT_EQ(import_mesh(room).warnings.size(), 1u);
  const ImportedMesh as_it_is = import_mesh(room, {.keeps_orientation = true});
  EXPECT_TRUE(as_it_is.warnings.empty());
  EXPECT_EQ(geometry(as_it_is.mesh), geometry(inside_out));
}

TEST_F(MeshFile, CoarseNumbersAreSaid) {
  // A ball of 2 m whose file counts from the corner of a continent, in centimetres.
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(2);
  const TriangleMesh ball = shapes::icosphere(2);
  for (const Eigen::Vector3f& p : ball.positions)
    text << "v " << (p.cast<double>() + Eigen::Vector3d(448262, 120, 5411932)).transpose() << "\n";
  for (const Triangle& t : ball.triangles) text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << "\n";
  const ImportedMesh coarse = import_mesh(write("coarse.obj", text.str()));
  ASSERT_FALSE(coarse.warnings.empty());
  EXPECT_NE(coarse.warnings[0].find("0.01"), std::string::npos) << coarse.warnings[0];
}

TEST_F(MeshFile, TrianglesOnALineAreNoMesh) {
  // Far apart in one direction and all but nothing in the others.
  EXPECT_THROW(load_mesh(write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 1e-20 0\nv 3 0 1e-20\nf 1 2 3\nf 2 3 4\n")),
               BadInput);
}

}  // namespace test_import_mesh
}  // namespace kiln
