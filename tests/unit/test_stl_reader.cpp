// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>

#include "import/readers.h"
#include "import_files.h"

namespace kiln {
namespace test_stl_reader {

using Triangle3 = std::array<Eigen::Vector3f, 3>;

const std::vector<Triangle3> triangles = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                          {{{0.5f, 0, 0}, {0, 0, -2}, {0, 3, 0.25f}}},
                                          {{{1, 1, 1}, {2, 2, 2}, {3, -1, 3}}}};

std::string ascii(const std::string& first = "solid a box") {
  std::ostringstream text;
  text << first << "\n";
  for (const Triangle3& triangle : triangles) {
    text << " facet normal 0 0 1\n  outer loop\n";
    for (const Eigen::Vector3f& place : triangle)
      text << "   vertex " << place.x() << " " << place.y() << " " << place.z() << "\n";
    text << "  endloop\n endfacet\n";
  }
  text << "endsolid a box\n";
  return text.str();
}

std::string binary(std::uint32_t count, const std::vector<std::uint16_t>& attributes = {0, 0, 0},
                   std::string head = "made by a test") {
  head.resize(80, ' ');
  head += number_bytes(count);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) head += number_bytes(std::nanf(""));  // the normal, which nobody reads
    for (const Eigen::Vector3f& place : triangles[i])
      for (const float value : place) head += number_bytes(value);
    head += number_bytes(attributes[i]);
  }
  return head;
}

std::string replaced(std::string text, const std::string& old, const std::string& other) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += other.size())
    text.replace(at, old.size(), other);
  return text;
}

void expect_triangles(const SourceMesh& mesh) {
  ASSERT_EQ(mesh.faces.size(), triangles.size());
  EXPECT_TRUE(mesh.is_unwelded);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto corners = mesh.corners_of(mesh.faces[i]);
    ASSERT_EQ(corners.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh.places[corners[k].place], triangles[i][k].cast<double>());
  }
}

TEST(StlReader, TextsOfEveryKind) {
  const ImportFiles files(read_stl, "a.stl");
  const std::string plain = ascii();
  std::string upper = plain;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  for (const std::string& text :
       {plain, upper, ascii("Solid Thing"), ascii("solid\tthing"), ascii("solid"),
        ascii("; by hand\n# and more\nsolid x"),
        ascii("solid M\xfc"
              "hle \xe7\xbb\x84"),
        ascii("\xef\xbb\xbfsolid x"), ascii("\n\n  solid x"), replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"), replaced(plain, "\n", "\n\n\t"),
        replaced(plain, "normal 0 0 1", "normal -nan(ind) nan nan"),
        replaced(plain, "1\n  outer loop\n", "1 outer loop "),
        replaced(plain, " endfacet\n facet", " endfacet\nendsolid a\nsolid b\n facet"),
        replaced(plain, "0 0 1\n  ", "\n"), replaced(plain, "end", "end "), ascii("solid facets and a vertex")}) {
    SCOPED_TRACE(text.substr(0, 120));
    const SourceMesh mesh = files.read(text);
    expect_triangles(mesh);
    EXPECT_TRUE(mesh.warnings.empty());
  }
  EXPECT_EQ(files.read(plain).faces[1].line, 9u);
  EXPECT_DOUBLE_EQ(files.read(plain).precision, 1e-3) << "four digits of numbers up to 3";
  EXPECT_EQ(warnings_with(files.read(plain.substr(0, plain.find("endsolid"))), "no 'endsolid'"), 1);
  const std::string quad = replaced(plain, "   vertex 0 1 0\n", "   vertex 1 1 0\n   vertex 0 1 0\n");
  EXPECT_EQ(files.read(quad).faces[0].corner_count, 4u);
}

TEST(StlReader, BrokenTextsAreRefused) {
  const ImportFiles files(read_stl, "a.stl");
  const std::string plain = ascii();
  files.expect_refused("", {"is empty"});
  files.expect_refused(replaced(plain, "0.5 0 0", "0,5 0 0"), {"a.stl:11", "'0,5'", "decimal point"});
  files.expect_refused(replaced(plain, "vertex 0.5 0 0", "vertex 0.5 0"), {"a.stl:11", "fewer than three numbers"});
  files.expect_refused(replaced(plain, "   vertex 0.5 0 0\n", ""), {"a.stl:13", "2 vertices"});
  files.expect_refused(replaced(plain, "vertex 0.5", "vertexes 0.5"), {"a.stl:11", "'vertexes'"});
  files.expect_refused(replaced(plain, "vertex 0.5", "vertex nan"), {"facet in line 9", "finite"});
  files.expect_refused(replaced(plain, " endfacet\n", ""), {"a.stl:8", "a facet within a facet"});
  files.expect_refused(plain.substr(0, plain.find("0.5")), {"is truncated"});
  files.expect_refused(plain.substr(0, plain.find("0.5") + 5), {"is truncated"});
  files.expect_refused(plain.substr(0, plain.rfind("endfacet")), {"is truncated", "facet 3"});
  files.expect_refused(plain.substr(0, plain.rfind("endfacet") + 4), {"is truncated", "facet 3"});
  files.expect_refused(replaced(plain, "endfacet", "end"), {"a.stl:8", "'end'"});
  files.expect_refused("solid x\nendsolid x\n", {"has no facets"});
  files.expect_refused("<!DOCTYPE html>\n" + std::string(200, 'x'), {"begins with '<!DOCTYPE html>'"});
}

TEST(StlReader, BinaryOfEveryCount) {
  const ImportFiles files(read_stl, "a.stl");
  for (const std::string& bytes :
       {binary(3), binary(3, {0, 0, 0}, "solid facet vertex"), binary(3, {0, 0, 0}, "solid")}) {
    const SourceMesh mesh = files.read(bytes);
    expect_triangles(mesh);
    EXPECT_EQ(mesh.precision, std::ldexp(3.0, -23));
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_TRUE(mesh.materials.empty());
  }
  for (const std::uint32_t count : {0u, 2u, 4u, 4000000000u}) {
    const SourceMesh mesh = files.read(binary(count, {0, 0, 0}, "solid of another count"));
    expect_triangles(mesh);
    EXPECT_EQ(warnings_with(mesh, "counts " + std::to_string(count)), 1);
    EXPECT_EQ(warnings_with(mesh, "holds 3"), 1);
  }
  expect_triangles(files.read(binary(3) + "tail"));
  EXPECT_EQ(warnings_with(files.read(binary(3) + "tail"), "4 bytes follow"), 1);
  files.expect_refused(binary(3).substr(0, 84 + 120), {"is truncated", "counts 3", "holds 2 and 20 bytes"});
  files.expect_refused(binary(0) + "tail", {"counts 0", "holds 3 and 4 bytes"});
  files.expect_refused(binary(0).substr(0, 84), {"has no triangles"});
  files.expect_refused(std::string(60, '\0'), {"is truncated", "60 bytes"});
  std::string infinite = binary(3);
  infinite.replace(84 + 50 + 12, 4, number_bytes(HUGE_VALF));
  files.expect_refused(infinite, {"triangle 2 of 3", "finite"});
}

TEST(StlReader, ColorsOfAttributes) {
  const ImportFiles files(read_stl, "a.stl");
  constexpr std::uint16_t low = 31, high = 31 << 10, bit = 1 << 15;
  const SourceMesh viscam = files.read(binary(3, {bit | high, 0, bit | low}));
  ASSERT_EQ(viscam.materials.size(), 2u);
  EXPECT_EQ(viscam.materials[0].diffuse, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(viscam.materials[1].diffuse, Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(viscam.faces[1].material, -1);
  EXPECT_EQ(viscam.materials[0].place, "a.stl: colours of triangles");

  const std::string head = "a solid COLOR=" + std::string("\x33\x66\xff\xff", 4);
  const SourceMesh magics = files.read(binary(3, {low, bit, high}, head));
  ASSERT_EQ(magics.materials.size(), 3u);
  EXPECT_EQ(magics.materials[0].diffuse, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(magics.materials[1].diffuse, Eigen::Vector3f(0.2f, 0.4f, 1)) << "the solid's own";
  EXPECT_EQ(magics.materials[2].diffuse, Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(files.read(binary(3, {0, 0, 0}, head)).materials.size(), 1u) << "no triangle has a colour of its own";

  const SourceMesh other = files.read(binary(3, {1, 2, bit | 3}));
  EXPECT_TRUE(other.materials.empty());
  EXPECT_EQ(warnings_with(other, "attribute bytes"), 1);
}

TEST(StlReader, AnyBytesAreReadOrRefused) {
  const ImportFiles files(read_stl, "a.stl");
  EXPECT_GT(files.mutate(ascii(), 1500), 100);
  EXPECT_GT(files.mutate(binary(3, {0x8000, 0x801f, 0}), 1500), 100);
}

}  // namespace test_stl_reader
}  // namespace kiln
