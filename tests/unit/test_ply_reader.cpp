// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include "import/readers.h"
#include "import_files.h"

namespace kiln {
namespace test_ply_reader {

using Places = std::vector<std::uint32_t>;

const std::vector<std::array<int, 3>> corners_of_tetrahedron = {{1, 2, 3}, {9, 2, 3}, {1, 7, 3}, {1, 2, 11}};
const std::vector<Places> faces_of_tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

/// Writes a header of x, y and z, then `more` lines of vertices, then triangles or polygons.
std::string header(int vertices, const std::string& more, int faces, const std::string& face_more = "",
                   const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more + "element face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\n" + face_more + "end_header\n";
}

const std::string two_triangles = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

/// Writes a number in the type that PLY calls `type`, as text or bytes.
std::string value_in(const std::string& type, double value, const std::string& format) {
  if (format == "ascii") return std::to_string(value).substr(0, std::to_string(value).find('.')) + " ";
  const bool big = format == "binary_big_endian";
  if (type == "char" || type == "int8") return number_bytes(static_cast<std::int8_t>(value), big);
  if (type == "uchar" || type == "uint8") return number_bytes(static_cast<std::uint8_t>(value), big);
  if (type == "short" || type == "int16") return number_bytes(static_cast<std::int16_t>(value), big);
  if (type == "ushort" || type == "uint16") return number_bytes(static_cast<std::uint16_t>(value), big);
  if (type == "int" || type == "int32") return number_bytes(static_cast<std::int32_t>(value), big);
  if (type == "uint" || type == "uint32") return number_bytes(static_cast<std::uint32_t>(value), big);
  if (type == "int64") return number_bytes(static_cast<std::int64_t>(value), big);
  if (type == "uint64") return number_bytes(static_cast<std::uint64_t>(value), big);
  if (type == "float" || type == "float32") return number_bytes(static_cast<float>(value), big);
  return number_bytes(value, big);
}

/// Writes a tetrahedron with `type` for all numbers, and unused properties and elements everywhere.
std::string tetrahedron(const std::string& type, const std::string& format, bool faces_first) {
  const std::string list = "property list " + type + " " + type + " ";
  const std::string vertex = "element vertex 4\nproperty double weight\nproperty " + type + " x\n" + list +
                             "neighbours\nproperty " + type + " y\nproperty " + type + " z\nproperty uchar flag\n";
  const std::string face = "element face 4\nproperty short flag\n" + list + "vertex_index\n" + list + "others\n";
  std::string vertices, faces;
  const auto put = [&](std::string& bytes, const std::string& of, double value) {
    bytes += value_in(of, value, format);
  };
  for (const auto& place : corners_of_tetrahedron) {
    put(vertices, "double", 5);
    put(vertices, type, place[0]);
    for (const double value : {2, 99, 98}) put(vertices, type, value);
    put(vertices, type, place[1]);
    put(vertices, type, place[2]);
    put(vertices, "uchar", 1);
    if (format == "ascii") vertices += "\n";
  }
  for (const Places& places : faces_of_tetrahedron) {
    put(faces, "short", -7);
    put(faces, type, 3);
    for (const std::uint32_t place : places) put(faces, type, place);
    put(faces, type, 0);
    if (format == "ascii") faces += "\n";
  }
  std::string edges = value_in("int", 4, format) + value_in("int", 5, format) + (format == "ascii" ? "\n" : "");
  const std::string edge = "element edge 1\nproperty int a\nproperty int b\n";
  return "ply\nformat " + format + " 1.0\n" + (faces_first ? face + edge + vertex : vertex + edge + face) +
         "end_header\n" + (faces_first ? faces + edges + vertices : vertices + edges + faces);
}

TEST(PlyReader, EveryTypeFormatAndOrderGivesTheSameMesh) {
  const ImportFiles files(read_ply, "a.ply");
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8",
                             "int16", "uint16", "int32", "uint32", "float32", "float64", "int64", "uint64"})
      for (const bool faces_first : {false, true}) {
        SCOPED_TRACE(std::string(format) + " " + type);
        const SourceMesh mesh = files.read(tetrahedron(type, format, faces_first));
        ASSERT_EQ(mesh.places.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i)
          for (int k = 0; k < 3; ++k)
            EXPECT_EQ(mesh.places[i][k], corners_of_tetrahedron[i][static_cast<std::size_t>(k)]);
        ASSERT_EQ(mesh.faces.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(places_of(mesh, i), faces_of_tetrahedron[i]);
        const bool is_float =
            std::string(type).starts_with("float") && std::string(format) != "ascii" && std::string(type) != "float64";
        EXPECT_EQ(mesh.precision, is_float ? std::ldexp(11.0, -23) : 0);
        ASSERT_EQ(mesh.warnings.size(), 1u);
        EXPECT_EQ(warnings_with(mesh, "1 row of the element 'edge'"), 1);
      }
}

TEST(PlyReader, HeadersOfEveryKind) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string plain = header(4, "", 2) + two_triangles;
  const auto with = [&](const std::string& old, const std::string& other) {
    std::string text = plain;
    for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += other.size())
      text.replace(at, old.size(), other);
    return text;
  };
  for (const std::string& text :
       {plain, with("\n", "\r\n"), with("\n", "\r"), "\xef\xbb\xbf" + plain, with("element", "\n \t\nelement"),
        with("format", "comment before\nobj_info x\n\nformat"), with(" ", "\t"), with("\n", " \n"), with("\n", "\n  "),
        with("ply\n", "ply \ncomment\n"), with("0 1 0\n", "0\n1 0\n")}) {
    SCOPED_TRACE(text);
    const SourceMesh mesh = files.read(text);
    EXPECT_EQ(mesh.places.size(), 4u);
    ASSERT_EQ(mesh.faces.size(), 2u);
    EXPECT_EQ(places_of(mesh, 1), (Places{0, 2, 3}));
    EXPECT_TRUE(mesh.warnings.empty());
  }
  EXPECT_EQ(files.read(plain).faces[1].line, 15u);
  EXPECT_EQ(files.read(with("\n", "\r\n")).faces[1].line, 15u);
  EXPECT_EQ(warnings_with(files.read(with("1.0", "1.1")), "line 2 has the format's version '1.1'"), 1);

  files.expect_refused("", {"is empty"});
  files.expect_refused("solid x\n", {"begins with 'solid'"});
  files.expect_refused(with("format ascii 1.0\n", ""), {"no line 'format'"});
  files.expect_refused(with("ascii", "utf8"), {"a.ply:2", "'utf8'"});
  files.expect_refused(with("property float z", "property real z"), {"a.ply:6", "'real'"});
  files.expect_refused(with("list uchar", "list byte"), {"a.ply:8", "'byte'"});
  files.expect_refused(with("vertex 4", "vertex -4"), {"a.ply:3", "'-4'"});
  files.expect_refused(with("vertex 4", "vertex four"), {"a.ply:3", "'four'"});
  files.expect_refused(with("element face", "elements face"), {"a.ply:7", "'elements'"});
  files.expect_refused(with("property float z\n", ""), {"a.ply:3", "the vertices have no z"});
  files.expect_refused(with("float y", "float x"), {"a.ply:5", "'x'"});
  files.expect_refused(with("vertex_indices", "corners"), {"a.ply:7", "no list of vertices"});
  files.expect_refused(with("element vertex 4\n", ""), {"a.ply:3", "before the first element"});
  files.expect_refused(plain.substr(0, 100), {"is truncated", "header"});
}

TEST(PlyReader, CarriageReturnsAloneEndAHeaderBeforeBinaryData) {
  const ImportFiles files(read_ply, "a.ply");
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty short y\n"
      "property short z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  const std::string data = std::string("\n\1\0\2\0\3\0\4\0\5\0\6\0\7\0\10\0\11\3\0\1\2", 22);
  std::string returns = text;
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  for (const std::string& head : {text, returns}) {
    const SourceMesh mesh = files.read(head + data);
    EXPECT_EQ(mesh.places[0], Eigen::Vector3d(2561, 2, 3)) << "the first byte is a line feed";
    EXPECT_EQ(mesh.places[2], Eigen::Vector3d(7, 8, 9));
  }
}

Eigen::Vector3f first_color(const SourceMesh& mesh) {
  return mesh.colors.empty() ? Eigen::Vector3f::Constant(-1) : mesh.colors[0];
}

TEST(PlyReader, ColorsOfVerticesOfEveryType) {
  const ImportFiles files(read_ply, "a.ply");
  struct Case {
    std::string type, names, color, other;
    Eigen::Vector3f expected;
    int warnings;
  };
  const std::vector<Case> cases = {
      {"uchar", "red green blue", "51 102 255", "0 0 0", {0.2f, 0.4f, 1}, 0},
      {"uint8", "diffuse_red diffuse_green diffuse_blue", "1 1 0", "0 0 0", {1 / 255.f, 1 / 255.f, 0}, 0},
      {"char", "red green blue", "51 -1 -128", "0 0 0", {0.2f, 1, 128 / 255.f}, 0},
      {"ushort", "r g b", "13107 26214 65535", "0 0 0", {0.2f, 0.4f, 1}, 0},
      {"uint16", "red green blue", "51 102 255", "0 0 0", {0.2f, 0.4f, 1}, 1},
      {"int", "red green blue", "51 102 255", "0 0 0", {0.2f, 0.4f, 1}, 0},
      {"int", "red green blue", "1 0 1", "0 0 0", {1, 0, 1}, 1},
      {"float", "red green blue", "0.2 0.4 1", "1 1 0.5", {0.2f, 0.4f, 1}, 0},
      {"double", "r g b", "0.2 0.4 1", "0 0 0", {0.2f, 0.4f, 1}, 0},
      {"float", "diffuse_red diffuse_green diffuse_blue", "51 102 255", "0.5 0 0", {0.2f, 0.4f, 1}, 1},
      {"float", "red green blue", "0.2 0.4 1.25", "0 -0.5 0", {0.2f, 0.4f, 1}, 1},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.type + " " + c.color);
    std::istringstream names(c.names);
    std::string more;
    for (std::string name; names >> name;) more += "property " + c.type + " " + name + "\n";
    const SourceMesh mesh = files.read(header(3, more, 1) + "0 0 0 " + c.color + "\n1 0 0 " + c.other + "\n0 1 0 " +
                                       c.other + "\n3 0 1 2\n");
    EXPECT_LT((first_color(mesh) - c.expected).cwiseAbs().maxCoeff(), 1e-6f) << first_color(mesh).transpose();
    EXPECT_EQ(mesh.warnings.size(), static_cast<std::size_t>(c.warnings));
  }
  const std::string rgba = "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  const std::string start = header(3, rgba, 1) + "0 0 0 51 51 51 ",
                    end = "\n1 0 0 9 9 9 255\n0 1 0 9 9 9 255\n3 0 1 2\n";
  EXPECT_TRUE(files.read(start + "255" + end).warnings.empty());
  EXPECT_EQ(warnings_with(files.read(start + "254" + end), "alpha"), 1);
  files.expect_refused(start.substr(0, start.size() - 1) + ".5 255" + end, {"a.ply:14", "'51.5'"});
}

TEST(PlyReader, ColorsOfFacesBecomeMaterials) {
  const ImportFiles files(read_ply, "scan.ply");
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string places = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n",
                    faces = "3 0 1 2 255 0 0\n3 0 2 3 0 51 0\n3 1 2 3 255 0 0\n";
  const SourceMesh mesh = files.read(header(4, "", 3, rgb) + places + faces);
  ASSERT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.faces[0].material, 0);
  EXPECT_EQ(mesh.faces[1].material, 1);
  EXPECT_EQ(mesh.faces[2].material, 0);
  EXPECT_TRUE(mesh.materials[1].has_diffuse);
  EXPECT_EQ(mesh.materials[1].diffuse, Eigen::Vector3f(0, 0.2f, 0));
  EXPECT_EQ(mesh.materials[1].place, "scan.ply: colours of faces");
  EXPECT_TRUE(mesh.warnings.empty());

  const std::string colored = "0 0 0 9 9 9\n1 0 0 9 9 9\n1 1 0 9 9 9\n0 1 0 9 9 9\n";
  const SourceMesh both = files.read(header(4, rgb, 3, rgb) + colored + faces);
  EXPECT_EQ(both.colors.size(), 4u);
  EXPECT_TRUE(both.materials.empty());
  EXPECT_EQ(warnings_with(both, "colours of faces are not used"), 1);
}

TEST(PlyReader, MoreColorsOfFacesThanMaterialsAreRounded) {
  const ImportFiles files(read_ply, "scan.ply");
  constexpr int count = 70000;
  std::string text =
      header(3, "", count, "property uchar red\nproperty uchar green\nproperty uchar blue\n") + "0 0 0\n1 0 0\n0 1 0\n";
  for (int i = 0; i < count; ++i)
    text += "3 0 1 2 " + std::to_string(i % 256) + " " + std::to_string(i / 256 % 256) + " " +
            std::to_string(i / 65536) + "\n";
  const SourceMesh mesh = files.read(text);
  EXPECT_LE(mesh.materials.size(), 32768u);
  EXPECT_EQ(warnings_with(mesh, "more than 65536 colours"), 1);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f color = Eigen::Vector3f(float(i % 256), float(i / 256 % 256), float(i / 65536)) / 255;
    const SourceMaterial& material =
        mesh.materials[static_cast<std::size_t>(mesh.faces[static_cast<std::size_t>(i)].material)];
    ASSERT_LE((material.diffuse - color).cwiseAbs().maxCoeff(), 0.5f / 31 + 1e-6f);
  }
}

TEST(PlyReader, NormalsAndUvsOfVertices) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string normal = "property float nx\nproperty float ny\nproperty float nz\n";
  for (const auto& [u, v] : std::map<std::string, std::string>{
           {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const SourceMesh mesh = files.read(header(3, normal + "property float " + u + "\nproperty float " + v + "\n", 1) +
                                       "0 0 0 0 0 1 0.25 0.75\n1 0 0 0 1 0 2 0\n0 1 0 nan 0 0 0 nan\n3 0 1 2\n");
    EXPECT_EQ(mesh.normals[1], Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(mesh.corners[1].normal, 1u);
    EXPECT_EQ(mesh.corners[2].normal, SourceMesh::none) << "it is not finite";
    EXPECT_EQ(mesh.uvs[0], Eigen::Vector2f(0.25f, 0.75f));
    EXPECT_EQ(mesh.corners[0].uv, 0u);
    EXPECT_EQ(mesh.corners[2].uv, SourceMesh::none) << "it is not finite";
    EXPECT_TRUE(mesh.materials.empty());
    EXPECT_EQ(mesh.warnings.size(), 2u);
  }
}

TEST(PlyReader, TexturesOfComments) {
  const ImportFiles files(read_ply, "a.ply");
  const auto textured = [](const std::string& names, const std::string& more, int vertices_uvs) {
    std::string text = header(4, vertices_uvs ? "property float s\nproperty float t\n" : "", 2, more);
    return text.replace(text.find("element vertex"), 0, names);
  };
  const std::string uvs = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n";
  const SourceMesh one =
      files.read(textured("comment TextureFile my picture.png \n", "", 1) + uvs + "3 0 1 2\n3 0 2 3\n");
  ASSERT_EQ(one.materials.size(), 1u);
  ASSERT_TRUE(one.materials[0].texture);
  const std::filesystem::path folder = files.write("").parent_path();
  EXPECT_EQ(one.materials[0].texture->picture.file, folder / "my picture.png");
  EXPECT_NE(one.materials[0].texture->place.find("a.ply:3"), std::string::npos);
  EXPECT_EQ(one.faces[1].material, 0);
  EXPECT_TRUE(one.warnings.empty());

  const std::string wedges = "property list uchar float texcoord\nproperty int texnumber\n";
  const std::string names = "comment TextureFile a.png\ncomment TextureFile tex\\b.png\n";
  const SourceMesh two = files.read(textured(names, wedges, 0) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" +
                                    "3 0 1 2 6 0 0 0.5 0 0.5 0.5 1\n3 0 2 3 6 0 0 1 1 0 1 0\n");
  ASSERT_EQ(two.materials.size(), 2u);
  EXPECT_EQ(two.materials[1].texture->picture.file, folder / "tex/b.png");
  EXPECT_EQ(two.faces[0].material, 1);
  EXPECT_EQ(two.faces[1].material, 0);
  EXPECT_EQ(two.uvs[two.corners[2].uv], Eigen::Vector2f(0.5f, 0.5f));
  EXPECT_EQ(two.uvs[two.corners[3].uv], Eigen::Vector2f(0, 0));
  EXPECT_TRUE(two.warnings.empty());

  const SourceMesh odd =
      files.read(textured(names, wedges, 0) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + "3 0 1 2 4 0 0 0.5 0 7\n3 0 2 3 0 -1\n");
  EXPECT_EQ(odd.faces[0].material, -1);
  EXPECT_EQ(odd.faces[1].material, -1);
  EXPECT_EQ(warnings_with(odd, "no texture coordinates"), 1);

  const SourceMesh none = files.read(textured("comment TextureFile a.png\n", "", 0) + two_triangles);
  EXPECT_TRUE(none.materials.empty());
  EXPECT_EQ(warnings_with(none, "'a.png' is not used"), 1);
}

TEST(PlyReader, StripsOfTriangles) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string start =
      "ply\nformat ascii 1.0\nelement tristrips 2\nproperty list int int vertex_indices\n"
      "element vertex 6\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const std::string places = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";
  const SourceMesh mesh = files.read(start + "9 0 2 1 3 3 5 -1 4 5\n4 4 5 2 3\n" + places);
  const std::vector<Places> expected = {{0, 2, 1}, {1, 2, 3}, {4, 5, 2}, {2, 5, 3}};
  ASSERT_EQ(mesh.faces.size(), expected.size()) << "those of two equal corners are left out";
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(places_of(mesh, i), expected[i]);
  files.expect_refused(start + "3 0 1 2\n3 0 1 6\n" + places, {"a.ply:11", "strip 2 of 2", "index 6"});
}

TEST(PlyReader, UnusedPlacesMayBeAnything) {
  const ImportFiles files(read_ply, "a.ply");
  const SourceMesh mesh = files.read(header(5, "", 1) + "0.5 0 0\n1 0 0\n0 1 0\nnan -1.#IND inf\n1e300 0 0\n3 0 1 2\n");
  EXPECT_EQ(mesh.places.size(), 5u);
  EXPECT_DOUBLE_EQ(mesh.precision, 1e-4) << "four digits of numbers up to 1";
  files.expect_refused(header(4, "", 1) + "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n3 0 1 3\n", {"vertex 4 of 4", "finite"});
}

TEST(PlyReader, PrecisionOfTexts) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string data = "-52.12345678 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  std::string doubles = header(3, "", 1) + data;
  for (std::size_t at; (at = doubles.find("float")) != std::string::npos;) doubles.replace(at, 5, "double");
  EXPECT_DOUBLE_EQ(files.read(doubles).precision, 1e-8);
  EXPECT_DOUBLE_EQ(files.read(header(3, "", 1) + data).precision, std::ldexp(52.12345678, -23)) << "they are floats";
}

TEST(PlyReader, BrokenDataIsRefused) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string text = header(4, "", 2), places = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  files.expect_refused(text + "0 0 0\n1 0,5 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
                       {"a.ply:11", "'0,5'", "decimal point"});
  files.expect_refused(text + places + "3 0 1 2\n3 0 2 4\n", {"a.ply:15", "face 2 of 2", "index 4"});
  files.expect_refused(text + places + "3 0 1 2\n3 0 -2 3\n", {"face 2 of 2", "index -2"});
  files.expect_refused(text + places + "3 0 1 2\n3 0 1.5 3\n", {"a.ply:15", "'1.5'"});
  files.expect_refused(text + places + "3 0 1 2\n2 0 1\n", {"a.ply:15", "face 2 of 2", "fewer than three"});
  files.expect_refused(text + places + "3 0 1\n3 0 1 2\n", {"a.ply:14", "face 1 of 2", "too few values"});
  files.expect_refused(text + places + "3 0 1 2\n3 0 1", {"is truncated", "face 2 of 2"});
  files.expect_refused(text + "0 0 0\n1 0 0\n", {"is truncated", "vertex 3 of 4"});
  files.expect_refused(text + places + "3 0 1 2\n99999999999 0 1 2\n", {"face 2 of 2", "99999999999 values"});
  files.expect_refused(text + places + "3 0 1 2\n-3 0 1 2\n", {"face 2 of 2", "negative"});
  files.expect_refused(header(9999999, "", 2) + places, {"is truncated", "vertex 5 of 9999999"});
  files.expect_refused(header(4, "", 0) + places, {"has points and no faces"});
  files.expect_refused(header(0, "", 0), {"has no faces"});

  const SourceMesh longer = files.read(text + "0 0 0 7\n1 0 0 7\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3 255 0 0\n");
  EXPECT_EQ(longer.faces.size(), 2u);
  EXPECT_EQ(warnings_with(longer, "3 lines have more values"), 1);
  EXPECT_EQ(warnings_with(files.read(text + two_triangles + "more of it\n"), "11 bytes follow"), 1);

  const std::string binary = header(3, "", 1, "", "binary_little_endian") + std::string(36, '\0');
  const std::string triangle = number_bytes(std::uint8_t{3}) + number_bytes(0) + number_bytes(1) + number_bytes(2);
  EXPECT_TRUE(files.read(binary + triangle).warnings.empty());
  EXPECT_EQ(warnings_with(files.read(binary + triangle + "abc"), "3 bytes follow"), 1);
  files.expect_refused(binary + triangle.substr(0, 9), {"is truncated", "face 1 of 1"});
  files.expect_refused(binary.substr(0, binary.size() - 13), {"is truncated", "vertex 2 of 3"});
  files.expect_refused(header(2000000000, "", 1, "", "binary_big_endian") + triangle, {"is truncated", "2000000000"});
  EXPECT_THROW(read_ply("missing.ply"), BadInput);
}

TEST(PlyReader, AnyBytesAreReadOrRefused) {
  const ImportFiles files(read_ply, "a.ply");
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string wedges = "property list uchar float texcoord\nproperty int texnumber\n" + rgb;
  std::string textured = header(4, "property float nx\nproperty float ny\nproperty float nz\n", 2, wedges) +
                         "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n"
                         "3 0 1 2 6 0 0 1 0 1 1 0 255 0 0\n3 0 2 3 6 0 0 1 1 0 1 0 0 255 0\n";
  textured.replace(textured.find("element"), 0, "comment TextureFile a.png\n");
  for (const std::string& good : {textured, tetrahedron("int", "binary_little_endian", true),
                                  tetrahedron("ushort", "ascii", false), header(4, "", 2) + two_triangles})
    EXPECT_GT(files.mutate(good, 800), 100);
}

}  // namespace test_ply_reader
}  // namespace kiln
