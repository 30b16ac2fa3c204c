#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

#include "base/errors.h"
#include "base/outputs.h"
#include "mesh/draco_file.h"
#include "import/import_mesh.h"
#include "shapes.h"

namespace kiln {
namespace {

namespace fs = std::filesystem;

class MeshFile : public testing::Test {
 protected:
  MeshFile() : folder_(fs::temp_directory_path() / ("kiln-mesh-file-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~MeshFile() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  fs::path path(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_;
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

/// The triangles as corners' positions, the smallest first, sorted: the same for the same surface in any order.
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

/// A colour that tells where a point of the unit sphere is; its values are whole 255ths.
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
    // A twentieth more for the rounding of floats.
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

}  // namespace
}  // namespace kiln
