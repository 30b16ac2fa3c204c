// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "obj_files.h"

namespace kiln {
namespace test_obj_reader {

namespace fs = std::filesystem;

const std::string square = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";

std::vector<std::uint32_t> places_of(const SourceMesh& mesh, std::size_t face) {
  std::vector<std::uint32_t> places;
  for (const SourceMesh::Corner& corner : mesh.corners_of(mesh.faces.at(face))) places.push_back(corner.place);
  return places;
}

using Places = std::vector<std::uint32_t>;

TEST_F(ObjFiles, CornersNamePlacesUvsAndNormals) {
  const SourceMesh mesh =
      read(square +
           "vt 0.5\nvt 0.25 0.75 9\nvn 0 0 2\nvn 0 1 0\n"
           "f 1 2 3 4\nf 1/2 2/1 3/2\nf 1//2 2//1 3//2\nf 1/1/2 2/2/1 3/1/1\nf -4/-1/-2 -3/-2 -2//-1\n"
           "f 1/ 2// 3/1/\n");
  constexpr std::uint32_t none = SourceMesh::none;
  ASSERT_EQ(mesh.faces.size(), 6u);
  EXPECT_EQ(places_of(mesh, 0), (Places{0, 1, 2, 3}));
  const auto corner = [&](std::size_t face, std::size_t k) {
    const SourceMesh::Corner c = mesh.corners_of(mesh.faces[face])[k];
    return std::vector<std::uint32_t>{c.place, c.uv, c.normal};
  };
  EXPECT_EQ(corner(0, 1), (Places{1, none, none}));
  EXPECT_EQ(corner(1, 0), (Places{0, 1, none}));
  EXPECT_EQ(corner(2, 0), (Places{0, none, 1}));
  EXPECT_EQ(corner(3, 1), (Places{1, 1, 0}));
  EXPECT_EQ(corner(4, 0), (Places{0, 1, 0}));
  EXPECT_EQ(corner(4, 1), (Places{1, 0, none}));
  EXPECT_EQ(corner(4, 2), (Places{2, none, 1}));
  EXPECT_EQ(corner(5, 1), (Places{1, none, none}));
  EXPECT_EQ(corner(5, 2), (Places{2, 0, none}));
  EXPECT_EQ(mesh.uvs[0], Eigen::Vector2f(0.5f, 0));
  EXPECT_EQ(mesh.uvs[1], Eigen::Vector2f(0.25f, 0.75f));
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(0, 0, 2));
  EXPECT_EQ(mesh.faces[3].line, 12u);
  EXPECT_FALSE(mesh.is_unwelded);
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(ObjFiles, LinesBlanksAndLettersAreReadAsExportersWriteThem) {
  const std::string expected = "v 0 0 0\nv 2.5 0 0\nv 0 -1e2 0\nf 1 2 3\n";
  const std::vector<std::string> variants = {
      expected,
      "\xef\xbb\xbf" + expected,
      "v 0 0 0\rv 2.5 0 0\rv 0 -1e2 0\rf 1 2 3\r",
      "v 0 0 0\r\nv 2.5 0 0\r\n\r\nv 0 -1e2 0\r\nf 1 2 3",
      "\n \t\nv\t0\t0 0\nv  2.5\t 0  0 \n\tv 0 -1e2 0\t\nf\t1\t2\t3\t\n",
      "V 0 0 0\nV +2.5 +0 0\nV 0 -1E+2 -0\nF +1 2 +3\n",
      "v 0 0 0 # origin\nv 2.5 0 0 #x\nv 0 -100 0#y\nf 1 2 3# side\n# end \\\n",
      "v 0 0 0\nv 2.5 \\\n0 0\nv 0 -1e2 0\nf \\\r\n1 2 \\ \n 3\\\n",
      "o box\ng a b\ns off\nmg 0\nlod 1\nbevel on\nvp 1 2\nv 0 0 0\nv 2.5 0 0\nv 0 -1e2 0\nl 1 2\np 3\nf 1 2 3\nend\n",
      "v 0 0 0\f\nv 2.5\v0 0\nv 0 -1e2 0\nfo 1 2 3\n",
      "f 1 2 3\nv 0 0 0\nv 2.5 0 0\nv 0 -1e2 0\n",
  };
  for (const std::string& text : variants) {
    const SourceMesh mesh = read(text);
    ASSERT_EQ(mesh.places.size(), 3u) << text;
    EXPECT_EQ(mesh.places[1], Eigen::Vector3d(2.5, 0, 0)) << text;
    EXPECT_EQ(mesh.places[2], Eigen::Vector3d(0, -100, 0)) << text;
    EXPECT_FALSE(std::signbit(mesh.places[2].z())) << "-0 would be another place";
    EXPECT_EQ(places_of(mesh, 0), (Places{0, 1, 2})) << text;
    EXPECT_TRUE(mesh.warnings.empty() && mesh.colors.empty()) << text;
  }
}

TEST_F(ObjFiles, ContinuedLinesKeepTheNumbersOfLines) {
  const SourceMesh mesh = read(square + "f 1 \\\n2 \\\n3\nf 1 3 4\n");
  EXPECT_EQ(mesh.faces[0].line, 5u);
  EXPECT_EQ(mesh.faces[1].line, 8u);
}

TEST_F(ObjFiles, IndicesThatNameNothingAreRefused) {
  EXPECT_TRUE(says(refusal(square + "f 0 1 2\n"), {"a.obj:5: ", "names vertex 0;", "OBJ counts from 1"}));
  EXPECT_TRUE(says(refusal(square + "\nf 1 2 9\n"), {"a.obj:6: ", "vertex 9 of 4;"}));
  EXPECT_TRUE(says(refusal(square + "f -1 -2 -5\n"), {"a.obj:5: ", "vertex -5 of 4 before it;"}));
  EXPECT_TRUE(says(refusal("f -1 -2 -3\n" + square), {"a.obj:1: ", "vertex -1 of 0 before it;"}));
  EXPECT_TRUE(says(refusal(square + "vt 0 0\nf 1/1 2/2 3/1\n"), {"a.obj:6: ", "texture coordinate 2 of 1;"}));
  EXPECT_TRUE(says(refusal(square + "vt 0 0\nf 1/0 2/1 3/1\n"), {"a.obj:6: ", "texture coordinate 0;"}));
  EXPECT_TRUE(says(refusal(square + "f 1//1 2//1 3//1\n"), {"a.obj:5: ", "normal 1 of 0;"}));
  EXPECT_TRUE(says(refusal(square + "f 1 2 99999999999999999999999\n"), {"a.obj:5: ", "of 4;"}));
  EXPECT_TRUE(says(refusal(square + "f 1 2 4294967296\n"), {"a.obj:5: ", "vertex 4294967296 of 4;"}));
  for (const char* word : {"a", "1.5", "1/2/3/4", "/1", "--1", "1/a", "1//a", "-", "1 /2"})
    EXPECT_TRUE(says(refusal(square + "vt 0 0\nf 1 2 " + word + "\n"), {"a.obj:6: ", "in a face", "VERTEX/UV"}))
        << word;
}

TEST_F(ObjFiles, FacesOfFewCornersAndFilesWithoutFacesAreRefused) {
  EXPECT_TRUE(says(refusal(square + "f 1 2\nf 1 2 3\n"), {"a.obj:5: ", "a face of 2 corners"}));
  EXPECT_TRUE(says(refusal(square + "f 1 2 3\nf 1 2"), {"a.obj:6: ", "truncated"}));
  EXPECT_TRUE(
      says(refusal(square + "l 1 2 3\nl 3 4\np 1\n"), {"a.obj: has no faces, but 4 vertices, 2 lines, 1 point"}));
  EXPECT_TRUE(says(refusal(""), {"a.obj: has no faces;"}));
  EXPECT_EQ(refusal(square + "f 1 1 2 3\n"), "no error") << "repair's business";
}

TEST_F(ObjFiles, CoordinatesAreNumbersAndThoseOfFacesFinite) {
  EXPECT_TRUE(says(refusal("v 0 0 0\nv 0,5 0 0\n"), {"a.obj:2: '0,5' for a coordinate", "decimal point"}));
  EXPECT_TRUE(says(refusal("v 0 0 1abc\n"), {"a.obj:1: '1abc' for a coordinate"}));
  EXPECT_TRUE(says(refusal("v 0 0\nf 1 2 3\n"), {"a.obj:1: ", "2 numbers"}));
  EXPECT_TRUE(says(refusal("v 0 0 0\nv 0 0"), {"a.obj:2: ", "truncated"}));
  EXPECT_TRUE(says(refusal("vt 0,5 0\n"), {"a.obj:1: '0,5' for a texture coordinate"}));
  for (const char* bad : {"nan", "-nan(ind)", "inf", "-INF", "1e999", "1.#QNAN", "-1.#IND00", "1.#INF"}) {
    const std::string line = "v 0 " + std::string(bad) + " 0\n";
    EXPECT_EQ(refusal(square + line + "f 1 2 3\n"), "no error") << "no face uses " << bad;
    EXPECT_TRUE(says(refusal(square + line + "f 1 2 3\nf 1 2 5\n"), {"a.obj:5: ", bad, "line 7", "finite"})) << bad;
  }
  const SourceMesh mesh = read(square + "v 1e300 -1e300 123456789.123456789\nv 1e-320 0 0\nf 1 5 6\n");
  EXPECT_EQ(mesh.places[4], Eigen::Vector3d(1e300, -1e300, 123456789.123456789));
}

TEST_F(ObjFiles, UvsAndNormalsThatAreNoNumbersAreTakenForAbsent) {
  const SourceMesh mesh = read(square +
                               "vt nan 0\nvt 0.5 0.5\nvt 1e200 0\nvn nan 0 0\nvn 0 0 1e200\nvn 0 1e-200 0\n"
                               "f 1/1/1 2/2/2 3/3/3\n");
  const auto corners = mesh.corners_of(mesh.faces[0]);
  EXPECT_EQ(corners[0].uv, SourceMesh::none);
  EXPECT_EQ(corners[1].uv, 1u);
  EXPECT_EQ(corners[2].uv, SourceMesh::none);
  EXPECT_EQ(corners[0].normal, SourceMesh::none);
  EXPECT_EQ(mesh.normals[1].normalized(), Eigen::Vector3f(0, 0, 1)) << "its length says nothing";
  EXPECT_EQ(mesh.normals[2].normalized(), Eigen::Vector3f(0, 1, 0));
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(says(mesh.warnings[0], {"2 corners", "texture coordinates"}));
  EXPECT_TRUE(says(mesh.warnings[1], {"1 corner ", "normal"}));
  EXPECT_TRUE(read(square + "vt nan nan\nvn inf 0 0\nf 1 2 3\n").warnings.empty()) << "no face uses them";
}

TEST_F(ObjFiles, WeightsDivide) {
  const SourceMesh mesh = read("v 2 4 6 2\nv 1 0 0 1\nv 0 -1 0 -0.5\nv 1 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.places[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(mesh.places[1], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.places[2], Eigen::Vector3d(0, 2, 0));
  EXPECT_TRUE(mesh.colors.empty());
  EXPECT_TRUE(warns_only(mesh, {"3 vertices", "weight"}));
  EXPECT_TRUE(
      says(refusal("v 1 1 1 0\nv 1 0 0\nv 0 1 0\nf 2 3 1\n"), {"a.obj:1: vertex '1 1 1 0'", "weight other than 0"}));
}

TEST_F(ObjFiles, ColorsOfUnitsAndBytes) {
  const std::string rest = "v 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
  SourceMesh mesh = read("v 0 0 0 0.25 0.5 1\n" + rest);
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(0.25f, 0.5f, 1));
  EXPECT_FALSE(mesh.linear_colors);
  EXPECT_TRUE(mesh.warnings.empty());

  mesh = read("v 0 0 0 255 51 0\n" + rest);
  EXPECT_TRUE(mesh.colors[0].isApprox(Eigen::Vector3f(1, 0.2f, 0)));
  EXPECT_FLOAT_EQ(mesh.colors[1].y(), 1 / 255.f) << "of the same file";
  EXPECT_TRUE(warns_only(mesh, {"bytes"}));

  mesh = read("v 0 0 0 2 -1 0.5\n" + rest);
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(1, 0, 0.5f));
  EXPECT_TRUE(warns_only(mesh, {"1 vertex colour", "clamped"}));
  EXPECT_TRUE(warns_only(read("v 0 0 0 256 0 0\n" + rest), {"clamped"}));

  EXPECT_TRUE(says(refusal("v 0 0 0 nan 0 0\n" + rest), {"a.obj:1: ", "colour", "finite"}));
  EXPECT_EQ(refusal("v 0 0 0 nan 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"), "no error") << "no face uses it";
  EXPECT_TRUE(says(refusal("v 0 0 0 0,5 0 0\n" + rest), {"a.obj:1: '0,5'"}));
}

TEST_F(ObjFiles, VerticesWithoutAColorAreWhiteAmongOthers) {
  const SourceMesh mesh = read("v 0 0 0\nv 1 0 0 102 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n");
  ASSERT_EQ(mesh.colors.size(), 4u);
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f::Ones());
  EXPECT_EQ(mesh.colors[1], Eigen::Vector3f(102 / 255.f, 0, 0));
  EXPECT_EQ(mesh.colors[2], Eigen::Vector3f::Ones());
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(says(mesh.warnings[1], {"2 vertices", "white"})) << "the third that has none is not used";
}

TEST_F(ObjFiles, SevenNumbersHaveAWeightOrAlpha) {
  const std::string face = "f 1 2 3\n";
  SourceMesh mesh = read("v 2 0 0 2 0.5 0.25 0\nv 0 2 0 2 0.5 0.25 0\nv 0 0 2 2 0.5 0.25 1\n" + face);
  EXPECT_EQ(mesh.places[0], Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(0.5f, 0.25f, 0));
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(says(mesh.warnings[0], {"x y z w r g b"}));

  mesh = read("v 2 0 0 1 0.5 0.25 0\nv 0 2 0 1 0.5 0.25 0\nv 0 0 2 1 0.5 0.25 0.5\n" + face);
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(0.5f, 0.25f, 0));

  mesh = read("v 2 0 0 0.5 0.25 0 1\nv 0 2 0 0.5 0.25 0 1\nv 0 0 2 0 0 0 1\n" + face);
  EXPECT_EQ(mesh.places[0], Eigen::Vector3d(2, 0, 0)) << "opaque colours";
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(0.5f, 0.25f, 0));
  EXPECT_TRUE(warns_only(mesh, {"3 vertices of 7 numbers", "r g b a"}));

  mesh = read("v 2 0 0 255 51 0 255\nv 0 2 0 0 51 0 255\nv 0 0 2 0 0 0 255\n" + face);
  EXPECT_EQ(mesh.places[0], Eigen::Vector3d(2, 0, 0)) << "opaque colours of bytes";
  EXPECT_TRUE(mesh.colors[0].isApprox(Eigen::Vector3f(1, 0.2f, 0)));

  for (const char* behind : {" 1 1", " 1 1 1 1 1", " 1 1 1 1 1 1", " 1 1 1 1 1 1 1 1 1 1 1 1 1 1"})
    EXPECT_TRUE(warns_only(read("v 2 0 0" + std::string(behind) + "\nv 0 2 0\nv 0 0 2\n" + face),
                           {"1 vertex ", "5, 8 or more"}));
}

TEST_F(ObjFiles, PolypaintIsInTheOrderOfVertices) {
  std::ostringstream text;
  constexpr int count = 150;
  for (int k = 0; k < count; ++k) text << "v " << k << " " << k * k << " 0\n";
  for (int k = 0; k < count; ++k) {
    if (k % 64 == 0) text << (k > 0 ? "\n" : "") << "#MRGB ";
    char digits[9];
    std::snprintf(digits, sizeof digits, "ff%02X%02x00", k, 255 - k);
    text << digits;
  }
  text << "\nf 1 2 3 150\n";
  const SourceMesh mesh = read(text.str());
  ASSERT_EQ(mesh.colors.size(), 150u);
  for (const int k : {0, 1, 63, 64, 149})
    EXPECT_TRUE(mesh.colors[static_cast<std::size_t>(k)].isApprox(
        Eigen::Vector3f(static_cast<float>(k) / 255, static_cast<float>(255 - k) / 255, 0)));
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(ObjFiles, PolypaintOfOneObjectAndDamagedPolypaint) {
  const Eigen::Vector3f red(1, 0, 0), white(1, 1, 1);
  SourceMesh mesh = read(square + "f 1 2 3\nv 5 0 0\nv 6 0 0\n#MRGB ffff0000ffff0000\nv 7 0 0\nf 5 6 7\nf 4 5 6\n");
  EXPECT_EQ(mesh.colors, (std::vector<Eigen::Vector3f>{white, white, white, white, red, red, white}));
  EXPECT_TRUE(warns_only(mesh, {"5 vertices", "white"}));

  mesh = read("v 0 0 0 0 1 0\nv 1 0 0 0 1 0\nv 0 1 0 0 1 0\n#MRGB ffff0000\nf 1 2 3\n");
  EXPECT_EQ(mesh.colors[0], Eigen::Vector3f(0, 1, 0));
  EXPECT_TRUE(warns_only(mesh, {"#MRGB", "not used"}));

  mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\n#MRGB ffff0000ffzz0000ffff0000ffff0000ff\nf 1 2 3\n");
  EXPECT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[2], red);
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(says(mesh.warnings[0], {"1 polypaint colour", "not used"}));
  EXPECT_TRUE(says(mesh.warnings[1], {"damaged"}));
  EXPECT_TRUE(read("#MRGB\n" + square + "f 1 2 3\n").colors.empty());
}

TEST_F(ObjFiles, SmoothingGroups) {
  const SourceMesh mesh =
      read(square + "f 1 2 3\ns 7\nf 1 2 3\ns off\nf 1 2 3\nS on\nf 1 2 3\ns 0\nf 1 2 3\ns 4294967295\nf 1 2 3\n");
  std::vector<std::uint32_t> groups;
  for (const SourceMesh::Face& face : mesh.faces) groups.push_back(face.smoothing_group);
  EXPECT_EQ(groups, (Places{0, 7, 0, 1, 0, 4294967295u}));
  EXPECT_TRUE(mesh.has_smoothing_groups);
  EXPECT_FALSE(read(square + "s off\nf 1 2 3\n").has_smoothing_groups) << "the same as no word of them";
  EXPECT_FALSE(read(square + "f 1 2 3\n").has_smoothing_groups);
}

TEST_F(ObjFiles, ObjectsNamePartsElseGroupsDo) {
  using Names = std::vector<std::string>;
  using Parts = std::vector<std::int32_t>;
  const auto parts_of = [](const SourceMesh& mesh) {
    Parts parts;
    for (const SourceMesh::Face& face : mesh.faces) parts.push_back(face.part);
    return parts;
  };
  const std::string a = "f 1 2 3\n", b = "f 1 3 4\n";
  SourceMesh mesh = read(square + "o empty\n" + b + "o a bolt_low # seen\ng x\n" + a + "o plate_low\n" + b +
                         "o unused\no a bolt_low\n" + b + "o\n" + a);
  EXPECT_EQ(mesh.parts, (Names{"empty", "a bolt_low", "plate_low"}));
  EXPECT_EQ(parts_of(mesh), (Parts{0, 1, 2, 1, -1}));
  mesh = read(square + a + "g left_low\n" + b + a + "g right_low\n" + b + "g\n" + a);
  EXPECT_EQ(mesh.parts, (Names{"left_low", "right_low"}));
  EXPECT_EQ(parts_of(mesh), (Parts{-1, 0, 0, 1, -1}));
  mesh = read(square + "o\n" + a);
  EXPECT_TRUE(mesh.parts.empty());
  mesh = read(square + "o b\xe9\n" + a);  // not UTF-8
  EXPECT_EQ(mesh.parts, (Names{"b\\xe9"}));
}

TEST_F(ObjFiles, PrecisionIsThatOfTheLastDigit) {
  const auto precision = [&](const std::string& coordinate) {
    return read("v " + coordinate + " 0 0\nv 0 0.25 0\nv 0 0 0.5\nv 1e30 0 0\nf 1 2 3\n").precision;
  };
  EXPECT_DOUBLE_EQ(precision("1.000000"), 1e-6);
  EXPECT_DOUBLE_EQ(precision("0.123456"), 1e-6);
  EXPECT_DOUBLE_EQ(precision("-123.456"), 1e-3);
  EXPECT_DOUBLE_EQ(precision("-1.23456e5"), 1);
  EXPECT_EQ(read(square + "f 1 2 3\n").precision, 0) << "whole numbers are not rounded";
}

TEST_F(ObjFiles, ShapeThatIsNotUsedIsCounted) {
  const SourceMesh mesh = read(
      square + "cstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 3 4\nSURF 0 1 0 1 1 2 3 4\ncurv 0 1 1 2\nend\nf 1 2 3\n");
  EXPECT_TRUE(warns_only(mesh, {"2 free-form surfaces"}));
  EXPECT_TRUE(says(refusal(square + "surf 0 1 0 1 1 2 3 4\n"), {"has no faces", "1 free-form surface"}));
}

TEST_F(ObjFiles, FilesThatCannotBeRead) {
  EXPECT_THROW(read_obj(path("none.obj")), BadInput);
  fs::create_directories(path("folder.obj"));
  EXPECT_THROW(read_obj(path("folder.obj")), BadInput);
  EXPECT_TRUE(says(refusal(std::string("\0\0\0\0\0\0\0\0", 8)), {"has no faces"}));
}

TEST_F(ObjFiles, LongLinesAndManyReturnsTakeNoTime) {
  std::string polygon = "f", carriage;
  for (int k = 0; k < 200000; ++k) {
    carriage += "v 0 0 " + std::to_string(k) + "\r";
    polygon += k % 2 == 0 ? " 1" : " \\\n2";
  }
  const SourceMesh mesh = read(carriage + polygon);
  EXPECT_EQ(mesh.places.size(), 200000u);
  EXPECT_EQ(mesh.faces[0].corner_count, 200000u);
}

TEST_F(ObjFiles, DamagedFilesAreReadOrRefused) {
  const std::string good =
      "mtllib a.mtl\nv 0 0 0 1 0.5 0.25\nv 1.5 0 0 1 0 0 1\nv 0 1 0 0.5\nv -1 -2e3 0\n#MRGB "
      "ffff0000ff00ff00ff0000ffffffffff\n"
      "vt 0 0\nvt 1 0.5\nvn 0 0 1\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/1/1\nusemtl \"blue\"\nf -1//1 -2//1 \\\n-3//1 "
      "1//1\ns off\nf 1 2 3 4\n";
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  std::mt19937 random(1);
  int read_count = 0, refused = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::string text = mutated(good, random);
    try {
      const SourceMesh mesh = read(text);
      ++read_count;
      ASSERT_FALSE(mesh.faces.empty());
      ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.places.size());
      for (const SourceMesh::Face& face : mesh.faces) {
        ASSERT_GE(face.corner_count, 3u);
        ASSERT_LT(face.material, static_cast<int>(mesh.materials.size()));
        for (const SourceMesh::Corner& corner : mesh.corners_of(face)) {
          ASSERT_TRUE(mesh.places.at(corner.place).allFinite()) << text;
          ASSERT_TRUE(corner.uv == SourceMesh::none || mesh.uvs.at(corner.uv).allFinite());
          ASSERT_TRUE(corner.normal == SourceMesh::none || mesh.normals.at(corner.normal).allFinite());
          if (!mesh.colors.empty()) {
            const Eigen::Vector3f color = mesh.colors[corner.place];
            ASSERT_TRUE(color.minCoeff() >= 0 && color.maxCoeff() <= 1) << text;
          }
        }
      }
    } catch (const BadInput&) {
      ++refused;
    }
  }
  EXPECT_GT(read_count, 500);
  EXPECT_GT(refused, 500);
}

}  // namespace test_obj_reader
}  // namespace kiln
