// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "import/readers.h"
#include "import_files.h"

namespace kiln {
namespace test_off_reader {

using Places = std::vector<std::uint32_t>;

const std::string places = "0 0 0\n4 0 0\n0 5 0\n0 0 6\n", faces = "3 0 2 1\n3 0 1 3\n4 0 3 2 1\n";

void expect_mesh(const SourceMesh& mesh) {
  ASSERT_EQ(mesh.places.size(), 4u);
  EXPECT_EQ(mesh.places[2], Eigen::Vector3d(0, 5, 0));
  EXPECT_EQ(mesh.places[3], Eigen::Vector3d(0, 0, 6));
  ASSERT_EQ(mesh.faces.size(), 3u);
  EXPECT_EQ(places_of(mesh, 0), (Places{0, 2, 1}));
  EXPECT_EQ(places_of(mesh, 2), (Places{0, 3, 2, 1}));
}

std::string with_line_ends(std::string text, const std::string& end) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) text.replace(at, 1, end);
  return text;
}

TEST(OffReader, HeadersOfEveryKind) {
  const ImportFiles files(read_off, "a.off");
  const std::string body = places + faces;
  for (const std::string& text :
       {"OFF\n4 3 6\n" + body, "OFF 4 3 0\n" + body, "OFF4 3 0\n" + body, "OFF\n4 3\n" + body, "4 3 0\n" + body,
        "\xef\xbb\xbfOFF\n4 3 0\n" + body, "# first\n\nOFF # here\n\n# there\n4 3 0 # counts\n\n" + body,
        "off\n4 3 0\n" + body, "OFF\n4\n3\n6\n" + body, "OFF\n4\n3\n" + body,
        with_line_ends("OFF\n4 3 6\n" + body, "\r\n"), with_line_ends("OFF\n4 3 6\n" + body, "\r"),
        with_line_ends("OFF\n4 3 6\n" + body, " # and so on\n\n \t"),
        std::string("OFF\n4 3 6\n0 0\n0 4 0 0\n0 5 0 0 0 6\n") + faces}) {
    SCOPED_TRACE(text);
    const SourceMesh mesh = files.read(text);
    expect_mesh(mesh);
    EXPECT_TRUE(mesh.warnings.empty());
    EXPECT_EQ(mesh.precision, 0);
  }
  EXPECT_EQ(files.read("OFF 4 3 0\n" + body).faces[1].line, 7u);

  files.expect_refused("", {"is empty"});
  files.expect_refused("ply\n4 3 0\n" + body, {"a.off:1", "begins with 'ply'"});
  files.expect_refused("nOFF\n4\n4 3 0\n" + body, {"a.off:1", "number of dimensions"});
  files.expect_refused("OFF\n4 three 0\n" + body, {"a.off:2", "the number of faces is 'three'"});
  files.expect_refused("OFF\n-4 3 0\n" + body, {"a.off:2", "the number of vertices is '-4'"});
  files.expect_refused("OFF\n4 3 0 0\n" + body, {"a.off:2", "more than three numbers"});
  files.expect_refused("OFF\n4", {"is truncated"});
}

TEST(OffReader, PartsOfVertices) {
  const ImportFiles files(read_off, "a.off");
  const SourceMesh all = files.read(
      "STCN4OFF\n3 1 0\n"
      "0 0 0 1   0 0 1  1.0 0.5 0.25 1.0  0.1 0.2\n"
      "8 0 0 2   0 1 0  1.0 0.5 0.25 1.0  0.3 0.4\n"
      "0 8 0 4   1 0 0  0.2 0.5 0.25 1.0  0.5 0.6\n"
      "3 0 1 2\n");
  EXPECT_EQ(all.places[1], Eigen::Vector3d(4, 0, 0)) << "divided by the weight";
  EXPECT_EQ(all.places[2], Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(all.normals[1], Eigen::Vector3f(0, 1, 0));
  EXPECT_EQ(all.corners[1].normal, 1u);
  EXPECT_EQ(all.colors[2], Eigen::Vector3f(0.2f, 0.5f, 0.25f));
  EXPECT_EQ(all.uvs[2], Eigen::Vector2f(0.5f, 0.6f));
  EXPECT_EQ(all.corners[2].uv, 2u);
  EXPECT_TRUE(all.warnings.empty());

  const SourceMesh plain = files.read("OFF\n3 1 0\n0 0 0 255 51 0\n1 0 0 255 51 0\n0 1 0 255 51 0\n3 0 1 2\n");
  ASSERT_EQ(plain.colors.size(), 3u);
  EXPECT_EQ(plain.colors[0], Eigen::Vector3f(1, 0.2f, 0));

  const SourceMesh normals = files.read("OFF\n3 1 0\n0 0 0 0 0 -1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
  EXPECT_TRUE(normals.colors.empty());
  EXPECT_EQ(warnings_with(normals, "no colours"), 1);
  const SourceMesh some = files.read("OFF\n3 1 0\n0 0 0 9 9 9\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(some.colors.empty());
  EXPECT_EQ(warnings_with(some, "1 of 3 alone"), 1);
  files.expect_refused("COFF\n3 1 0\n0 0 0 9 9 9\n1 0 0\n0 1 0\n3 0 1 2\n", {"a.off:4", "3 numbers"});
}

TEST(OffReader, WhatColorsMean) {
  const ImportFiles files(read_off, "a.off");
  const auto colors = [&](const std::string& first, const std::string& others) {
    return files.read("COFF\n3 1 0\n0 0 0 " + first + "\n1 0 0 " + others + "\n0 1 0 " + others + "\n3 0 1 2\n");
  };
  const auto expect = [&](const SourceMesh& mesh, const Eigen::Vector3f& first, const Eigen::Vector3f& second,
                          std::size_t warnings) {
    ASSERT_EQ(mesh.colors.size(), 3u);
    EXPECT_LT((mesh.colors[0] - first).cwiseAbs().maxCoeff(), 1e-6f) << mesh.colors[0].transpose();
    EXPECT_LT((mesh.colors[1] - second).cwiseAbs().maxCoeff(), 1e-6f) << mesh.colors[1].transpose();
    EXPECT_EQ(mesh.warnings.size(), warnings);
  };
  expect(colors("255 0 51 255", "1 0 0 255"), {1, 0, 0.2f}, {1 / 255.f, 0, 0}, 0);
  expect(colors("1.0 0.0 0.0 1.0", "0.0 1.0 0.0 1.0"), {1, 0, 0}, {0, 1, 0}, 0);
  expect(colors("1 0 0 1", "0 1 0 1"), {1, 0, 0}, {0, 1, 0}, 1);
  expect(colors("1 0 0 255", "0 1 0 255"), {1 / 255.f, 0, 0}, {0, 1 / 255.f, 0}, 0);
  expect(colors("0.5 0.5 0.5 1", "1 1 1 1"), {0.5f, 0.5f, 0.5f}, {1, 1, 1}, 0);
  expect(colors("0.5 0.5 0.5 1", "255 0 51 255"), {0.5f, 0.5f, 0.5f}, {1, 0, 0.2f}, 0);
  expect(colors("51.0 102.5 255.0", "1.0 1.0 1.0"), {0.2f, 102.5f / 255, 1}, {1 / 255.f, 1 / 255.f, 1 / 255.f}, 1);
  expect(colors("0 0 0", "0 0 0"), {0, 0, 0}, {0, 0, 0}, 0);
  expect(colors("255 0 0 128", "0 0 0 255"), {1, 0, 0}, {0, 0, 0}, 1);
}

TEST(OffReader, ColorsOfFacesBecomeMaterials) {
  const ImportFiles files(read_off, "a.off");
  const SourceMesh mesh =
      files.read("OFF\n4 4 0\n" + places + "3 0 2 1 255 0 0\n3 0 1 3 0 51 0 255\n3 1 2 3 255 0 0\n3 2 1 3\n");
  ASSERT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.materials[0].diffuse, Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(mesh.materials[1].diffuse, Eigen::Vector3f(0, 0.2f, 0));
  EXPECT_EQ(mesh.materials[1].place, "a.off: colours of faces");
  EXPECT_EQ(mesh.faces[2].material, 0);
  EXPECT_EQ(mesh.faces[3].material, -1);
  EXPECT_TRUE(mesh.warnings.empty());
  const SourceMesh mapped = files.read("OFF\n4 3 0\n" + places + "3 0 2 1 7\n3 0 1 3 7 8\n3 1 2 3\n");
  EXPECT_TRUE(mapped.materials.empty());
  EXPECT_EQ(warnings_with(mapped, "map of colours"), 1);
  EXPECT_EQ(warnings_with(mapped, "1 vertex or face has numbers"), 1);
}

std::string binary(bool is_big, const std::string& keyword = "OFF BINARY\n") {
  std::string bytes = keyword;
  for (const std::int32_t count : {4, 3, 0}) bytes += number_bytes(count, is_big);
  for (const float value : {0.f, 0.f, 0.f, 4.f, 0.f, 0.f, 0.f, 5.f, 0.f, 0.f, 0.f, 6.f})
    bytes += number_bytes(value, is_big);
  for (const std::int32_t value : {3, 0, 2, 1, 0, 3, 0, 1, 3, 1, 9, 4, 0, 3, 2, 1, 3})
    bytes += number_bytes(value, is_big);
  for (const float value : {1.f, 0.5f, 0.f}) bytes += number_bytes(value, is_big);
  return bytes;
}

TEST(OffReader, BinaryFiles) {
  const ImportFiles files(read_off, "a.off");
  for (const char* keyword : {"OFF BINARY\n", "OFF BINARY\r\n", "# made\nOFF  binary # so\n"}) {
    const SourceMesh mesh = files.read(binary(true, keyword));
    expect_mesh(mesh);
    EXPECT_EQ(mesh.precision, std::ldexp(6.0, -23));
    ASSERT_EQ(mesh.materials.size(), 1u);
    EXPECT_EQ(mesh.materials[0].diffuse, Eigen::Vector3f(1, 0.5f, 0));
    EXPECT_EQ(mesh.faces[2].material, 0);
    EXPECT_EQ(mesh.warnings.size(), 1u);
    EXPECT_EQ(warnings_with(mesh, "map of colours"), 1);
  }
  expect_mesh(files.read(binary(false)));
  EXPECT_EQ(warnings_with(files.read(binary(false)), "little-endian"), 1);
  EXPECT_EQ(warnings_with(files.read(binary(true) + "abc"), "3 bytes follow"), 1);
  const std::string whole = binary(true);
  files.expect_refused(whole.substr(0, whole.size() - 5), {"is truncated", "face 3 of 3"});
  files.expect_refused(whole.substr(0, 60), {"is truncated", "vertex 4 of 4"});
  files.expect_refused(whole.substr(0, 20), {"is truncated"});
}

TEST(OffReader, BrokenDataIsRefused) {
  const ImportFiles files(read_off, "a.off");
  files.expect_refused("OFF\n4 3 0\n0 0 0\n4 0,5 0\n0 5 0\n0 0 6\n" + faces, {"a.off:4", "'0,5'", "decimal point"});
  files.expect_refused("OFF\n4 3 0\n0 0 0\n4 0\n0 5 0\n0 0 6\n" + faces, {"a.off:4", "vertex 2 of 4", "2 numbers"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n3 0 1 4\n3 0 1 2\n", {"a.off:8", "face 2 of 3", "index 4"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n3 0 1 -1\n3 0 1 2\n",
                       {"a.off:8", "face 2 of 3", "index -1"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n2 0 1\n3 0 1 2\n",
                       {"a.off:8", "face 2 of 3", "fewer than three"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n3 0 1\n3 0 1 2\n", {"a.off:8", "face 2 of 3", "too few"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n3 0 1 3\n", {"is truncated", "face 3 of 3"});
  files.expect_refused("OFF\n4 3 0\n" + places + "3 0 2 1\n3 0 1 3\n4 0 1", {"is truncated", "face 3 of 3"});
  files.expect_refused("OFF\n4 3 0\n0 0 0\n4 0 0\n", {"is truncated", "vertex 3 of 4"});
  files.expect_refused("OFF\n4000000000 3 0\n0 0 0\n", {"is truncated", "vertex 2 of 4000000000"});
  files.expect_refused("OFF\n4 3 0\n0 0 0\n4 nan 0\n0 5 0\n0 0 6\n" + faces, {"vertex 2 of 4", "finite"});
  files.expect_refused("OFF\n4 0 0\n" + places, {"has points and no faces"});
  files.expect_refused("OFF\n0 0 0\n", {"has no faces"});
  EXPECT_EQ(files.read("OFF\n5 3 0\n" + places + "nan inf nan\n" + faces).faces.size(), 3u) << "no face uses it";
  EXPECT_EQ(warnings_with(files.read("OFF\n4 3 0\n" + places + faces + "3 0 1 2\n"), "8 bytes follow"), 1);
}

TEST(OffReader, AnyBytesAreReadOrRefused) {
  const ImportFiles files(read_off, "a.off");
  const std::string colored =
      "COFF\n3 2 0\n0 0 0.5 0 1 0 1\n1 0 0 1 0 0 1\n0 1 0 0.5 0.5 0 1\n3 0 1 2 1 0 0\n3 0 2 1 9\n";
  for (const std::string& good : {colored, "OFF\n4 3 0\n" + places + faces, binary(true)})
    EXPECT_GT(files.mutate(good, 1000), 100);
}

}  // namespace test_off_reader
}  // namespace kiln
