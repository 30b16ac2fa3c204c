// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <map>
#include <sstream>
#include <zlib.h>

#include "gltf_builder.h"
#include "import/readers.h"
#include "import_support.h"
#include "scratch.h"

namespace kiln {
namespace test_fbx_reader {

namespace fs = std::filesystem;
using import_support::append;
using import_support::signed_volume;
using import_support::warns;
using import_support::worst_normal;
using import_support::write;

/// Writes a cube from `low` to `low` + 2 of six squares, as an FBX 7.4 text file, whose parts tests change.
struct Cube {
  std::string settings;                 // lines of GlobalSettings
  std::string model, parent, material;  // lines of properties
  std::string layers;                   // records of the geometry
  std::string objects, links;           // further ones
  double low = -1;

  static std::string vector(const std::string& name, double x, double y, double z) {
    std::ostringstream text;
    text.precision(17);
    text << "P: \"" << name << "\", \"Vector3D\", \"Vector\", \"\"," << x << "," << y << "," << z << "\n";
    return text.str();
  }

  static std::string number(const std::string& name, double value) {
    std::ostringstream text;
    text << "P: \"" << name << "\", \"double\", \"Number\", \"\"," << value << "\n";
    return text.str();
  }

  static constexpr int corners[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

  /// Lists eight vertices: the lowest bit of a vertex's number is its x, the next its y, the highest its z.
  std::vector<double> vertices() const {
    std::vector<double> result;
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < 3; ++k) result.push_back(low + 2 * (i >> k & 1));
    return result;
  }
  static std::vector<int> indices() {
    std::vector<int> result;
    for (const auto& face : corners)
      for (int k = 0; k < 4; ++k) result.push_back(k == 3 ? -1 - face[k] : face[k]);
    return result;
  }

  std::string text() const {
    std::ostringstream out;
    out.precision(17);
    const auto array = [&out](const char* name, const auto& values) {
      out << name << ": *" << values.size() << " {\na: ";
      for (std::size_t i = 0; i < values.size(); ++i) out << (i > 0 ? "," : "") << values[i];
      out << "\n}\n";
    };
    out << "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\nFBXVersion: 7400\n}\nGlobalSettings:  {\nProperties70:  "
           "{\n"
        << settings << "}\n}\nObjects:  {\nGeometry: 10, \"Geometry::box\", \"Mesh\" {\n";
    array("Vertices", vertices());
    array("PolygonVertexIndex", indices());
    out << "LayerElementNormal: 0 {\nMappingInformationType: \"ByPolygon\"\nReferenceInformationType: \"Direct\"\n";
    array("Normals", std::vector<int>{0, 0, -1, 0, 0, 1, 0, -1, 0, 0, 1, 0, -1, 0, 0, 1, 0, 0});
    out << "}\n"
        << layers << "}\n"
        << "Model: 20, \"Model::cube\", \"Mesh\" {\nProperties70:  {\n"
        << model << "}\n}\n"
        << "Model: 21, \"Model::above\", \"Null\" {\nProperties70:  {\n"
        << parent << "}\n}\n"
        << "Material: 30, \"Material::paint\", \"\" {\nProperties70:  {\n"
        << material << "}\n}\n"
        << objects << "}\nConnections:  {\nC: \"OO\",21,0\nC: \"OO\",20,21\nC: \"OO\",10,20\nC: \"OO\",30,20\n"
        << links << "}\n";
    return out.str();
  }
};

/// Writes the records of a binary file.
class BinaryWriter {
 public:
  explicit BinaryWriter(std::uint32_t version) : wide_(version >= 7500), bytes_("Kaydara FBX Binary  \0\x1a\0", 23) {
    append(bytes_, version);
  }

  void open(const std::string& name, const std::vector<std::string>& values = {}) {
    begins_.push_back(bytes_.size());
    std::string all;
    for (const std::string& value : values) all += value;
    offset(0);
    offset(values.size());
    offset(all.size());
    bytes_ += static_cast<char>(name.size());
    bytes_ += name + all;
    has_children_.push_back(false);
  }
  void close() {
    if (has_children_.back()) bytes_ += std::string(wide_ ? 25 : 13, '\0');
    std::string end;
    append(end, static_cast<std::uint64_t>(bytes_.size()));
    bytes_.replace(begins_.back(), wide_ ? 8 : 4, end, 0, wide_ ? 8 : 4);
    begins_.pop_back();
    has_children_.pop_back();
    if (!has_children_.empty()) has_children_.back() = true;
  }
  void leaf(const std::string& name, const std::vector<std::string>& values) {
    open(name, values);
    close();
  }

  static std::string whole(std::int64_t value) {
    std::string bytes = "L";
    append(bytes, value);
    return bytes;
  }
  static std::string text(const std::string& value) {
    std::string bytes = "S";
    append(bytes, static_cast<std::uint32_t>(value.size()));
    return bytes + value;
  }
  template <class Value>
  static std::string array(char type, const std::vector<Value>& values, bool packed) {
    std::string raw, bytes(1, type);
    for (const Value value : values) append(raw, value);
    append(bytes, static_cast<std::uint32_t>(values.size()));
    append(bytes, static_cast<std::uint32_t>(packed));
    if (packed) {
      uLongf size = compressBound(raw.size());
      std::string deflated(size, '\0');
      compress(reinterpret_cast<Bytef*>(deflated.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
               raw.size());
      raw = deflated.substr(0, size);
    }
    append(bytes, static_cast<std::uint32_t>(raw.size()));
    return bytes + raw;
  }

  std::string finish() const { return bytes_ + std::string(wide_ ? 25 : 13, '\0') + "footer"; }

 private:
  void offset(std::size_t value) {
    if (wide_)
      append(bytes_, static_cast<std::uint64_t>(value));
    else
      append(bytes_, static_cast<std::uint32_t>(value));
  }
  bool wide_;
  std::string bytes_;
  std::vector<std::size_t> begins_;
  std::vector<bool> has_children_;
};

std::string binary_cube(std::uint32_t version, bool packed) {
  using W = BinaryWriter;
  const Cube cube;
  W out(version);
  out.open("Objects");
  out.open("Geometry", {W::whole(10), W::text(std::string("box\0\1Geometry", 13)), W::text("Mesh")});
  out.leaf("Vertices", {W::array('d', cube.vertices(), packed)});
  out.leaf("PolygonVertexIndex", {W::array('i', Cube::indices(), packed)});
  out.close();
  out.leaf("Model", {W::whole(20), W::text(std::string("cube\0\1Model", 11)), W::text("Mesh")});
  out.close();
  out.open("Connections");
  out.leaf("C", {W::text("OO"), W::whole(20), W::whole(0)});
  out.leaf("C", {W::text("OO"), W::whole(10), W::whole(20)});
  out.close();
  return out.finish();
}

class FbxReader : public testing::Test {
 protected:
  SourceMesh read(const Cube& cube) const { return read_fbx(write(path("cube.fbx"), cube.text())); }
  std::string refusal(const std::string& bytes) const {
    return import_support::refusal(read_fbx, write(path("bad.fbx"), bytes));
  }
  fs::path path(const std::string& name) const { return scratch_.folder() / name; }

  Scratch scratch_;
};

TEST_F(FbxReader, KeepsPolygonsOfTextAndBinaryFiles) {
  const SourceMesh text = read({});
  EXPECT_EQ(text.faces.size(), 6u);
  EXPECT_EQ(text.places.size(), 8u);
  EXPECT_NEAR(signed_volume(text), 8, 1e-12);
  EXPECT_NEAR(worst_normal(text), 1, 1e-6);
  EXPECT_TRUE(warns(text, "--unit cm"));
  for (const auto& [version, packed] : {std::pair{7400u, false}, {7400u, true}, {7500u, false}, {7500u, true}}) {
    const SourceMesh mesh = read_fbx(write(path("binary.fbx"), binary_cube(version, packed)));
    EXPECT_EQ(mesh.places, text.places);
    EXPECT_EQ(mesh.faces.size(), 6u);
    EXPECT_NEAR(signed_volume(mesh), 8, 1e-12);
  }
}

TEST_F(FbxReader, ModelsNameParts) {
  Cube cube;
  cube.objects = "Model: 22, \"Model::bolt_low\", \"Mesh\" {\n}\n";
  cube.links = "C: \"OO\",22,0\nC: \"OO\",10,22\n";
  const SourceMesh mesh = read(cube);
  EXPECT_EQ(mesh.parts, (std::vector<std::string>{"cube", "bolt_low"}));
  ASSERT_EQ(mesh.faces.size(), 12u);
  for (std::size_t f = 0; f < 12; ++f) EXPECT_EQ(mesh.faces[f].part, f < 6 ? 0 : 1);
}

TEST_F(FbxReader, TurnsOtherAxesToYUp) {
  Cube cube;
  cube.settings = Cube::number("UpAxis", 2) + Cube::number("UpAxisSign", 1) + Cube::number("FrontAxis", 1) +
                  Cube::number("FrontAxisSign", -1) + Cube::number("CoordAxis", 0) + Cube::number("CoordAxisSign", 1) +
                  Cube::number("UnitScaleFactor", 2.54);
  cube.parent = Cube::vector("Lcl Translation", 10, 20, 30);
  const SourceMesh mesh = read(cube);
  EXPECT_EQ(mesh.places[0], Eigen::Vector3d(9, 29, -19));  // of (9, 19, 29)
  EXPECT_NEAR(signed_volume(mesh), 8, 1e-9);
  EXPECT_TRUE(warns(mesh, "+Z up"));
  EXPECT_TRUE(warns(mesh, "2.54 cm"));
}

TEST_F(FbxReader, ComposesTransformsInDouble) {
  Cube cube;
  cube.low = 1e7 + 0.125;  // floats have steps of 1 there
  cube.model = Cube::vector("Lcl Rotation", 0, 0, 90) + Cube::vector("Lcl Scaling", 2, 1, 1) +
               Cube::vector("RotationPivot", 1, 0, 0) + Cube::vector("Lcl Translation", 0, 0, 5);
  cube.parent = Cube::vector("GeometricTranslation", 100, 100, 100) + Cube::vector("Lcl Scaling", 1, 1, 3);
  const SourceMesh mesh = read(cube);
  // (x, y, z) is scaled to (2 x, y, z), turned about (1, 0, 0) to (1 - y, 2 x - 1, z), moved and scaled. What moves the
  // parent's own geometry moves nothing else.
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3d>(cube.vertices().data() + 3 * i);
    EXPECT_LT((mesh.places[i] - Eigen::Vector3d(1 - p.y(), 2 * p.x() - 1, 3 * (p.z() + 5))).norm(), 1e-7);
  }
  EXPECT_LT(mesh.precision, 1e-300);  // the numbers are no floats
}

TEST_F(FbxReader, HonoursRotationOrderAndRotationsBeforeAndBehind) {
  Cube cube;
  cube.model = Cube::number("RotationActive", 1) + Cube::number("RotationOrder", 5) +  // z, then y, then x
               Cube::vector("Lcl Rotation", 90, 0, 90) + Cube::vector("PreRotation", 0, 90, 0) +
               Cube::vector("PostRotation", 0, 0, 180) + Cube::vector("GeometricTranslation", 1, 2, 3);
  const SourceMesh mesh = read(cube);
  const auto turn = [](double degrees, int axis) {
    return Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
  };
  const Eigen::Matrix3d rotation = turn(90, 1) * (turn(90, 0) * turn(90, 2)) * turn(-180, 2);
  EXPECT_LT((mesh.places[7] - rotation * Eigen::Vector3d(2, 3, 4)).norm(), 1e-12);
}

TEST_F(FbxReader, TurnsTheWindingOfMirroredModels) {
  Cube cube;
  cube.parent = Cube::vector("Lcl Scaling", -1, 2, 1);
  const SourceMesh mesh = read(cube);
  EXPECT_NEAR(signed_volume(mesh), 16, 1e-9);
  EXPECT_NEAR(worst_normal(mesh), 1, 1e-6);
}

TEST_F(FbxReader, ReadsCoordinatesAndColorsOfCorners) {
  Cube cube;
  cube.layers =
      "LayerElementUV: 0 {\nMappingInformationType: \"ByPolygonVertex\"\nReferenceInformationType: \"IndexToDirect\"\n"
      "UV: *4 {\na: 0.25,0.5,1,0\n}\nUVIndex: *24 {\na: 0,1,1,1,1,1,1,1,1,1,1,1,\n1,1,1,1,1,1,1,1,1,1,1,-1\n}\n}\n"
      "LayerElementColor: 0 {\nMappingInformationType: \"ByPolygon\"\nReferenceInformationType: \"IndexToDirect\"\n"
      "Colors: *8 {\na: 1,0,0,1,0,0.5,0,1\n}\nColorIndex: *6 {\na: 0,1,1,1,1,1\n}\n}\n";
  const SourceMesh mesh = read(cube);
  EXPECT_EQ(mesh.uvs[mesh.corners[0].uv], Eigen::Vector2f(0.25f, 0.5f));
  EXPECT_EQ(mesh.corners[23].uv, SourceMesh::none);
  // The four vertices of the red square stand once more for its neighbours, which are green.
  EXPECT_EQ(mesh.places.size(), 12u);
  ASSERT_EQ(mesh.colors.size(), 12u);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i)
    EXPECT_EQ(mesh.colors[mesh.corners[i].place], i < 4 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0.5f, 0));
  EXPECT_TRUE(mesh.is_unwelded);
  EXPECT_NEAR(signed_volume(mesh), 8, 1e-12);
}

TEST_F(FbxReader, ReadsMaterials) {
  Cube cube;
  cube.material = Cube::vector("DiffuseColor", 0.5, 1, 0.25) + Cube::number("DiffuseFactor", 0.5);
  const SourceMesh plain = read(cube);
  EXPECT_EQ(plain.materials.at(0).name, "paint");
  EXPECT_EQ(plain.materials[0].diffuse, Eigen::Vector3f(0.25f, 0.5f, 0.125f));
  EXPECT_FALSE(plain.materials[0].linear_diffuse);
  EXPECT_EQ(plain.faces[5].material, 0);

  cube.objects =
      "Texture: 40, \"Texture::bark\", \"\" {\nFileName: \"C:\\work\\bark.png\"\n"
      "RelativeFilename: \"..\\maps\\bark.png\"\nProperties70:  {\n" +
      Cube::vector("Scaling", 2, 3, 1) + Cube::number("WrapModeU", 1) + "}\n}\n";
  cube.links = "C: \"OP\",40,30, \"DiffuseColor\"\n";
  write(path("bark.png"), "picture");  // beside the mesh, not where the file says
  const SourceMesh beside = read(cube);
  EXPECT_EQ(beside.materials[0].texture->picture.file, path("bark.png"));
  EXPECT_EQ(beside.materials[0].texture->wrap_u, SourceTexture::Wrap::clamp);
  EXPECT_EQ(beside.materials[0].texture->transform(1, 1), 3);

  cube.objects += "Video: 50, \"Video::bark\", \"Clip\" {\nContent: ,\n\"" + base64("embedded picture") + "\"\n}\n";
  cube.links += "C: \"OO\",50,40\n";
  const SourceMesh within = read(cube);
  const auto& bytes = *within.materials[0].texture->picture.bytes;
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "embedded picture");
}

TEST_F(FbxReader, SaysWhatItPassesBy) {
  Cube cube;
  cube.objects =
      "Deformer: 60, \"Deformer::s\", \"Skin\" {\n}\nDeformer: 61, \"Deformer::b\", \"BlendShape\" {\n}\n"
      "AnimationStack: 62, \"AnimStack::walk\", \"\" {\n}\nAnimationCurve: 63, \"AnimCurve::\", \"\" {\n}\n"
      "Geometry: 64, \"Geometry::c\", \"NurbsCurve\" {\n}\n";
  const SourceMesh mesh = read(cube);
  for (const char* part : {"1 skin", "1 blend shape", "1 animation", "curves"}) EXPECT_TRUE(warns(mesh, part)) << part;
}

TEST_F(FbxReader, RefusesWhatItCannotRead) {
  const auto expect = [this](const std::string& part, const std::string& bytes) {
    const std::string message = refusal(bytes);
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' not in: " << message;
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string good = Cube().text();
  expect("is empty", "");
  expect("is no FBX file", "solid cube\nfacet normal 0 0 1\n");
  expect("version 6100", replaced(good, "7400", "6100"));
  expect("truncated", good.substr(0, good.size() / 2));
  expect("truncated", binary_cube(7400, true).substr(0, 150));
  expect("names vertex 9 in corner 1", replaced(good, "a: 0,2,3", "a: 0,9,3"));
  expect("a last polygon without an end", replaced(good, ",-6\n", ",5\n"));
  expect("does not hold the 24 numbers", replaced(good, "a: -1,-1,-1,", "a: -1,-1,"));
  expect("is not finite", replaced(good, "a: -1,", "a: nan,"));
  expect("beneath itself", replaced(good, "C: \"OO\",21,0", "C: \"OO\",21,20"));
  expect("two objects of the number 20", replaced(good, "Model: 21", "Model: 20"));
  expect("no polygons that a model places", replaced(good, "C: \"OO\",10,20", ""));
}

TEST_F(FbxReader, ReadsOrRefusesDamagedFiles) {
  const auto damaged = [this](const std::string& good) {
    return import_support::read_damaged(read_fbx, path("damaged.fbx"), good, 1500);
  };
  EXPECT_GT(damaged(Cube().text()), 300);
  EXPECT_GT(damaged(binary_cube(7400, true)), 300);
  EXPECT_GT(damaged(binary_cube(7500, false)), 300);
}

}  // namespace test_fbx_reader
}  // namespace kiln
