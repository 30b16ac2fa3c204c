// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "import/mtl_reader.h"
#include "obj_files.h"

namespace kiln {
namespace test_mtl_reader {

namespace fs = std::filesystem;

class MtlFiles : public ObjFiles {
 protected:
  static inline const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
  static inline const std::string face = "f 1/1 2/1 3/1\n";

  /// Reads a triangle of material `name` with this library.
  SourceMesh with(const std::string& mtl, const std::string& name = "m") const {
    write("a.mtl", mtl);
    return read("mtllib a.mtl\n" + triangle + "usemtl " + name + "\n" + face);
  }

  /// Returns the material of that triangle.
  SourceMaterial material(const std::string& mtl, const std::string& name = "m") const {
    const SourceMesh mesh = with(mtl, name);
    if (mesh.materials_fault) ADD_FAILURE() << mesh.materials_fault->what();
    if (mesh.materials_fault || mesh.faces.at(0).material != 0) return {};
    return mesh.materials.at(0);
  }

  std::string fault(const std::string& mtl, const std::string& name = "m") const {
    const SourceMesh mesh = with(mtl, name);
    if (!mesh.materials_fault) return "no fault";
    EXPECT_TRUE(mesh.materials.empty() && mesh.faces.at(0).material == -1);
    return mesh.materials_fault->what();
  }

  /// Lists how a picture is looked up: file name, scale of u and v, offset of u and v.
  std::string lookup(const std::string& map) const {
    const SourceMaterial m = material("newmtl m\nmap_Kd " + map + "\n");
    if (!m.texture) return "no picture";
    std::ostringstream text;
    const auto& t = m.texture->transform;
    text << m.texture->picture.name << " " << t(0, 0) << " " << t(1, 1) << " " << t(0, 2) << " " << t(1, 2);
    EXPECT_EQ(t(0, 1), 0);
    EXPECT_EQ(t(1, 0), 0);
    return text.str();
  }
};

const Eigen::Vector3f red(0.75f, 0.125f, 0.25f);

TEST_F(MtlFiles, DiffuseColors) {
  const SourceMaterial m = material("newmtl m\nKd 0.75 0.125 0.25\n");
  EXPECT_EQ(m.diffuse, red);
  EXPECT_TRUE(m.has_diffuse && !m.linear_diffuse && !m.texture);
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.place, path("a.mtl").string() + ":1");
  for (const char* text :
       {"newmtl m\nkd 0.75 0.125 0.25\n", "NEWMTL m\nKD +0.75 .125 25e-2\n",
        "\xef\xbb\xbfnewmtl m\r\nKd\t0.75\t0.125 0.25\r\n", "newmtl m\rKd 0.75 0.125 0.25\r",
        "# c\nnewmtl  m \n\tKd 0.75 0.125 0.25 # red\n", "newmtl m\nKd 0.75 \\\n0.125 0.25",
        "newmtl \"m\"\nKd 0.75 0.125 0.25#r\n", "newmtl m # red\nKd 0.75 0.125 0.25\n",
        "Kd 9 9 9\nnewmtl o\nKd 1 1 1\nnewmtl m\nNs 5\nillum 2\nKa 0 0 0\nKd 0.75 0.125 0.25\nKs 1 1 1\n"})
    EXPECT_EQ(material(text).diffuse, red) << text;
  EXPECT_EQ(material("newmtl m\nKd 0.5\n").diffuse, Eigen::Vector3f::Constant(0.5f));
  EXPECT_FALSE(material("newmtl m\nKs 1 1 1\n").has_diffuse);
  EXPECT_EQ(with("newmtl m\nKd 0.5\n").further_files, (std::vector<fs::path>{path("a.mtl")}));
}

TEST_F(MtlFiles, ColorsThatAreNoneAreFaults) {
  EXPECT_TRUE(says(fault("newmtl m\nKd 1 red 1\n"), {"a.mtl:2: Kd '1 red 1'"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd 1 1\n"), {"a.mtl:2: Kd '1 1'", "three"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd 1 1 1 1\n"), {"a.mtl:2"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd\n"), {"a.mtl:2"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd 0,5 0,5 0,5\n"), {"a.mtl:2: Kd '0,5 0,5 0,5'"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd nan 0 0\n"), {"finite"}));
  EXPECT_TRUE(says(fault("newmtl m\n\nKd spectral red.rfl 1\n"), {"a.mtl:3: Kd 'spectral red.rfl 1'", "spectrum"}));
  EXPECT_TRUE(says(fault("newmtl m\nKd xyz 1 1 1\n"), {"XYZ"}));
  EXPECT_EQ(fault("newmtl o\nKd spectral a.rfl\nmap_Kd none.png\nnewmtl m\nKd 1 1 1\n"), "no fault")
      << "of a material that no face uses";
  const SourceMesh clamped = with("newmtl m\nKd 2 -1 0.5\n");
  EXPECT_EQ(clamped.materials[0].diffuse, Eigen::Vector3f(1, 0, 0.5f));
  EXPECT_TRUE(warns_only(clamped, {"1 material ", "Kd", "clamped"}));
}

TEST_F(MtlFiles, NamesOfMaterials) {
  const std::string library =
      "newmtl my red\nKd 0.75 0.125 0.25\nnewmtl M\nKd 0\nnewmtl Material #1\nKd 0.5\nnewmtl Material #2\nKd 1\n";
  EXPECT_EQ(material(library, "my red").diffuse, red);
  EXPECT_EQ(material(library, "\"my red\"").diffuse, red);
  EXPECT_EQ(material(library, " my red # of the roof").diffuse, red);
  EXPECT_EQ(material(library, "my red # of the roof").name, "my red");
  EXPECT_EQ(material(library, "Material #1").diffuse.x(), 0.5f) << "a # may be a part of a name";
  EXPECT_EQ(material(library, "Material #2").diffuse.x(), 1);
  EXPECT_TRUE(says(fault(library, "My Red"), {"a.obj", "the material 'My Red'"})) << "letters count";

  const SourceMesh twice = with("newmtl m\nKd 0.75 0.125 0.25\nnewmtl m\nKd 1 1 1\n");
  EXPECT_EQ(twice.materials.at(0).diffuse, red);
  EXPECT_TRUE(warns_only(twice, {"1 material ", "first"}));
}

TEST_F(MtlFiles, FacesHaveTheMaterialBeforeThem) {
  write("a.mtl", "newmtl r\nKd 1 0 0\nnewmtl g\nKd 0 1 0\nnewmtl unused\nKd 0 0 1\n");
  const SourceMesh mesh = read("mtllib a.mtl\n" + triangle + "usemtl unused\n" +
                               "f 1 2 3\nusemtl g\nf 1 2 3\nusemtl\nf 1 2 3\nUSEMTL r\nf 1 2 3\nusemtl \"g\"\n" +
                               "f 1 2 3\nusemtl nowhere\n");
  std::vector<std::string> names;
  for (const SourceMesh::Face& f : mesh.faces)
    names.push_back(f.material < 0 ? "" : mesh.materials.at(static_cast<std::size_t>(f.material)).name);
  EXPECT_EQ(names, (std::vector<std::string>{"unused", "g", "", "r", "g"}));
  EXPECT_EQ(mesh.materials.size(), 3u);
  EXPECT_TRUE(mesh.warnings.empty() && !mesh.materials_fault) << "no face uses the last";
}

TEST_F(MtlFiles, LibrariesThatAreMissing) {
  EXPECT_TRUE(says(fault("newmtl o\nKd 1 1 1\n"), {"a.obj: uses the material 'm'"}));
  SourceMesh mesh = read("\nmtllib none.mtl\n" + triangle + "usemtl m\n" + face);
  ASSERT_TRUE(mesh.materials_fault);
  EXPECT_TRUE(says(mesh.materials_fault->what(), {"a.obj:2: ", "material library", "none.mtl", "does not exist"}));
  EXPECT_EQ(mesh.faces.size(), 1u) << "shape needs no materials";
  mesh = read("mtllib none.mtl\n" + triangle + "f 1 2 3\n");
  EXPECT_TRUE(!mesh.materials_fault && mesh.warnings.empty()) << "materials that no face uses";
  mesh = read(triangle + "usemtl m\n" + face + "usemtl n\n" + face + "usemtl unused\n");
  EXPECT_TRUE(warns_only(mesh, {"2 materials", "mtllib"}));
  EXPECT_EQ(mesh.faces[0].material, -1);
  EXPECT_FALSE(mesh.materials_fault);
}

TEST_F(MtlFiles, NamesOfLibraries) {
  const auto found = [&](const std::string& statement) {
    const SourceMesh mesh = read(statement + "\n" + triangle + "usemtl m\n" + face);
    return mesh.materials_fault ? std::string(mesh.materials_fault->what()) : std::to_string(mesh.further_files.size());
  };
  write("the box.mtl", "newmtl m\nKd 1 1 1\n");
  write("sub/b.mtl", "newmtl n\nKd 1 1 1\n");
  for (const char* one :
       {"mtllib the box.mtl", "mtllib \"the box.mtl\"", "MTLLIB the box.mtl # comment", "mtllib ./the box.mtl",
        "mtllib C:\\models\\the box.mtl", "mtllib The Box.MTL", "mtllib the box.mtl\nmtllib the box.mtl"})
    EXPECT_EQ(found(one), "1") << one;
  for (const char* two : {"mtllib sub/b.mtl the box.mtl", "mtllib the box.mtl sub\\b.mtl",
                          "mtllib \"sub/b.mtl\" \"the box.mtl\"", "mtllib sub/b.mtl\nmtllib the box.mtl"})
    EXPECT_EQ(found(two), "2") << two;
  EXPECT_TRUE(says(found("mtllib the box.mtl other.mtl"), {"other.mtl", "does not exist"}));
}

TEST_F(MtlFiles, WhatMaterialsHaveAndIsNotUsedIsSaidOnce) {
  EXPECT_TRUE(with("newmtl m\nKd 1 1 1\nd 1\nTr 0\nKe 0 0 0\nTf 1 1 1\nmap_aat on\n").warnings.empty());
  EXPECT_TRUE(with("newmtl m\nKd 1 1 1\nTr 1\n").warnings.empty()) << "opaque, as some exporters write it";
  EXPECT_TRUE(warns_only(with("newmtl m\nmap_Bump -bm 1 a.png\nnorm b.png\nMAP_KS c.png\nmap_Bump d.png\nKe 0\n"),
                         {"maps that are not used: map_Bump, norm, MAP_KS"}));
  EXPECT_TRUE(warns_only(with("newmtl m\nmap_d none.png\n"), {"a.mtl:2", "none.png", "does not exist", "not used"}));
  write("a.mtl", "newmtl a\nKd 2 0 0\nnewmtl b\nKd 0 -1 0\nmap_Ks y\nnewmtl c\nKd 3 0 0\nmap_Ns x\n");
  const SourceMesh mesh = read("mtllib a.mtl\n" + triangle + "usemtl a\n" + face + "usemtl b\n" + face);
  ASSERT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(says(mesh.warnings[0], {"2 materials"})) << "the third is not used";
  EXPECT_TRUE(says(mesh.warnings[1], {"map_Ks"}));
}

TEST_F(MtlFiles, OpacityIsReadInAllItsForms) {
  const auto opacity = [this](const std::string& text) { return material("newmtl m\n" + text + "\n").opacity; };
  EXPECT_FALSE(opacity("Kd 1 1 1").is_given());
  EXPECT_FALSE(opacity("Tr 1").is_given()) << "opaque, as some exporters write it";
  for (const char* text : {"d 0.75", "D 0.75", "d -halo 0.75", "Tr 0.25", "d 0.75 # glass", "d 0.75\nTr 0.9"})
    EXPECT_EQ(opacity(text).factor, 0.75f) << text;
  EXPECT_EQ(opacity("d 7").factor, 1);
  write("t.png", "");
  const SourceShare leaf = opacity("map_d -clamp on t.png");
  EXPECT_FALSE(leaf.factor);
  EXPECT_EQ(leaf.channel, SourceShare::Channel::coverage);
  ASSERT_TRUE(leaf.texture);
  EXPECT_EQ(leaf.texture->picture.file, path("t.png"));
  EXPECT_EQ(leaf.texture->wrap_u, SourceTexture::Wrap::clamp);
}

TEST_F(MtlFiles, RoughnessMetalnessAndEmission) {
  write("t.png", "");
  const SourceMaterial m = material("newmtl m\nPr 0.25\nPm 2\nKe 0 4 1\nmap_Pr t.png\nmap_Ke t.png\n");
  EXPECT_EQ(m.roughness.factor, 0.25f);
  EXPECT_TRUE(m.roughness.texture);
  EXPECT_EQ(m.metalness.factor, 1) << "clamped";
  EXPECT_FALSE(m.metalness.texture);
  ASSERT_TRUE(m.emission);
  EXPECT_EQ(*m.emission, Eigen::Vector3f(0, 4, 1));
  EXPECT_TRUE(m.emission_texture);
}

TEST_F(MtlFiles, OptionsOfMaps) {
  for (const char* name : {"t.png", "2 t.png", "1.png", "-t.png", "my t.png", "a-b -c.png", "t #1.png", "7"})
    write(name, "");
  EXPECT_EQ(lookup("t.png"), "t.png 1 1 0 0");
  EXPECT_EQ(lookup("-s 2 3 4 -o 0.25 0.5 0.75 t.png"), "t.png 2 3 0.25 0.5");
  EXPECT_EQ(lookup("-s 2 -o 0.25 t.png"), "t.png 2 1 0.25 0");
  EXPECT_EQ(lookup("t.png -s 2 3 -o 0.25 0.5"), "t.png 2 3 0.25 0.5");
  EXPECT_EQ(lookup("-s 2 3 t.png -o 0.25 # moved"), "t.png 2 3 0.25 0");
  EXPECT_EQ(lookup("\"my t.png\" -s 2 3 1"), "my t.png 2 3 0 0");
  EXPECT_EQ(lookup("my t.png -s 2 3 1"), "my t.png 2 3 0 0");
  EXPECT_EQ(lookup("\t-s\t2\t3\tmy t.png\t-o\t0.5\t"), "my t.png 2 3 0.5 0");
  EXPECT_EQ(lookup("-s 4 4 2 t.png"), "t.png 4 4 0 0") << "three numbers, as there is such a picture";
  EXPECT_EQ(lookup("-s 4 \"2 t.png\""), "2 t.png 4 1 0 0");
  EXPECT_EQ(lookup("-s 4 4 1.png"), "1.png 4 4 0 0");
  EXPECT_EQ(lookup("-s 4 4 7"), "7 4 4 0 0") << "the picture's name is a number";
  EXPECT_EQ(lookup("\"-t.png\""), "-t.png 1 1 0 0");
  EXPECT_EQ(lookup("a-b -c.png"), "a-b -c.png 1 1 0 0");
  EXPECT_EQ(lookup("t #1.png"), "t #1.png 1 1 0 0");
  EXPECT_EQ(lookup("-t 0 0 0 -mm 0 1 -blendu on -blendv off -cc off -texres 512 -boost 1 -bm 0.5 -type sphere "
                   "-imfchan l -clamp off t.png"),
            "t.png 1 1 0 0");

  const SourceMaterial m = material("newmtl m\nMAP_KD -MM 0.25 2 -Clamp on t.png\n");
  EXPECT_EQ(m.texture->base, 0.25f);
  EXPECT_EQ(m.texture->gain, 2);
  EXPECT_EQ(m.texture->wrap_u, SourceTexture::Wrap::clamp);
  EXPECT_EQ(m.texture->wrap_v, SourceTexture::Wrap::clamp);
  EXPECT_EQ(m.texture->place, path("a.mtl").string() + ":2");
  EXPECT_EQ(m.texture->picture.file, path("t.png"));
  EXPECT_EQ(material("newmtl m\nmap_Kd t.png\n").texture->wrap_u, SourceTexture::Wrap::repeat);
}

TEST_F(MtlFiles, PicturesAreFoundAsOtherMachinesNameThem) {
  for (const char* name : {"maps/the red.png", "blue.png"}) write(name, "");
  for (const char* name : {"maps/the red.png", "maps\\the red.png", "./maps/the red.png", ".\\maps\\the red.png"})
    EXPECT_EQ(material("newmtl m\nmap_Kd " + std::string(name) + "\n").texture->picture.name, "the red.png") << name;
  EXPECT_EQ(material("newmtl m\nmap_Kd " + path("blue.png").string() + "\n").texture->picture.name, "blue.png");
  for (const char* name :
       {"C:\\textures\\blue.png", "/home/someone/blue.png", "\"D:/a b/blue.png\"", "Blue.PNG", "..\\..\\x\\BLUE.png"})
    EXPECT_EQ(material("newmtl m\nmap_Kd " + std::string(name) + "\n").texture->picture.file, path("blue.png")) << name;
}

TEST_F(MtlFiles, MapsThatCannotBeUsedAreFaults) {
  write("t.png", "");
  EXPECT_TRUE(says(fault("newmtl m\nKd 1 1 1\nmap_Kd none.png\n"),
                   {"a.mtl:3: names the picture", "none.png", "does not exist"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd\n"), {"a.mtl:2: map_Kd without a file"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -s 1 1 1\n"), {"map_Kd without a file"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -t 0.5 t.png\n"), {"a.mtl:2: ", "-t"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -mm 0.5 t.png\n"), {"a.mtl:2: ", "-mm 0.5 t.png"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -clamp t.png\n"), {"-clamp t.png"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -foo 1 t.png\n"), {"-foo"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd \"t.png\" junk\n"), {"'junk'"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd -colorspace linear t.png\n"), {"-colorspace linear"}));
  EXPECT_TRUE(says(fault("newmtl m\nmap_Kd " + std::string(5000, 'x') + "\n"), {"5000 characters"}));
}

TEST_F(MtlFiles, DamagedLibrariesAreReadOrFaults) {
  write("t.png", "");
  const std::string good =
      "newmtl m\nKd 0.5 0.25 1 # c\nd 0.5\nKe 1 0 0\nmap_Kd -s 1 2 3 -o 0.5 -mm 0 1 -clamp on \"t.png\" -t 0 0 0\n"
      "newmtl \"n o\"\nKd spectral a\nmap_Kd t.png -blendu off -texres 5\nmap_Bump -bm 1 t.png\n";
  const fs::path obj = write("b.obj", "mtllib a.mtl\n" + triangle + "usemtl m\n" + face + "usemtl n o\n" + face);
  std::mt19937 random(1);
  int read_count = 0, faults = 0;
  for (int k = 0; k < 1500; ++k) {
    write("a.mtl", mutated(good, random));
    const SourceMesh mesh = read_obj(obj);
    (mesh.materials_fault ? faults : read_count)++;
    for (const SourceMaterial& m : mesh.materials) {
      ASSERT_TRUE(m.diffuse.minCoeff() >= 0 && m.diffuse.maxCoeff() <= 1);
      ASSERT_TRUE(!m.texture || m.texture->picture.name == "t.png");
    }
  }
  EXPECT_GT(faults, 300) << "Kd spectral";
  EXPECT_GE(read_count, 10) << "those whose second Kd is damaged into another word";
}

}  // namespace test_mtl_reader
}  // namespace kiln
