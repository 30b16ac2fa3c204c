// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbours and the ground around an asset: where they stand in its object space, and what they shadow.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

#include "bake/bake.h"
#include "base/errors.h"
#include "material/surroundings.h"
#include "mesh/draco_file.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_surroundings {

namespace fs = std::filesystem;

constexpr double unoccluded = 0.28209479;  // t_0 of a receiver under the open sky

class SurroundingsTest : public testing::Test {
 protected:
  /// Writes a sphere of radius 1 about the origin, as an OBJ file.
  fs::path sphere() const {
    const fs::path file = scratch_.folder() / "sphere.obj";
    std::ofstream stream(file);
    const TriangleMesh mesh = shapes::icosphere(4);
    for (const Eigen::Vector3f& p : mesh.positions) stream << "v " << p.transpose() << "\n";
    for (const Triangle& t : mesh.triangles) stream << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << "\n";
    return file;
  }

  static std::vector<PlacedMesh> load(const Surroundings& surroundings, bool with_albedo = false,
                                      const MaterialSettings& material = {}) {
    return load_surroundings(surroundings, {{-1, -1, -1}, {1, 1, 1}}, material, with_albedo);
  }

  /// Computes t_0 of a point at the origin of the asset's space, by rays.
  static double constant_term(const Surroundings& surroundings, const Eigen::Vector3f& normal) {
    std::vector<TriangleMesh> meshes;
    for (PlacedMesh& placed : load(surroundings)) meshes.push_back(std::move(placed.mesh));
    ReceiverSet receivers{1, 1, {0}, {Eigen::Vector3f::Zero()}, {normal}};
    BakeSettings settings;
    settings.bands = 1;
    settings.directions = 20000;
    settings.backend = BakeBackend::embree;
    const Occluders occluders = join_occluders(meshes);
    return bake({receivers, occluders, settings, 1, 2}).channels.front().plane(0)[0];
  }

 private:
  Scratch scratch_;
};

TEST_F(SurroundingsTest, NeighboursAreReadFieldByField) {
  const Neighbour plain = parse_neighbour("a b.obj");
  EXPECT_EQ(plain.file, "a b.obj");
  EXPECT_FALSE(plain.material.albedo);
  const Neighbour full = parse_neighbour(
      "x.ply;place=1,2,3,90,2;albedo=0.5,0.25,0;albedo-texture=t.png;albedo-encoding=linear;fill-holes=8");
  EXPECT_TRUE(full.placement.to_scene({0, 0, 1}).isApprox(Eigen::Vector3d(3, 2, 3), 1e-12)) << "+Z turned to +X";
  EXPECT_EQ(full.material.albedo, (std::array<float, 3>{0.5f, 0.25f, 0.f}));
  EXPECT_EQ(full.material.texture, "t.png");
  EXPECT_EQ(full.material.encoding, ColorEncoding::linear);
  EXPECT_EQ(full.import.fill_hole_edges, 8);
  for (const char* text : {"", ";place=0,0,0", "a.obj;place=1,2", "a.obj;place=0,0,0,0,0", "a.obj;albedo=2",
                           "a.obj;colour=1", "a.obj;albedo", "a.obj;fill-holes=-1"})
    EXPECT_THROW(parse_neighbour(text), WrongUsage) << text;
}

TEST_F(SurroundingsTest, AreMovedIntoTheAssetsSpace) {
  // The asset is turned by 90 degrees, of twice its size, and at (10, 0, 0): a neighbour's place (12, 4, 6) in the
  // scene is (2, 4, 6) away, which the turn back makes (-6, 4, 2), halved.
  const std::string file = sphere().string();
  const std::vector<PlacedMesh> placed = load({.place = parse_scene_place("10,0,0,90,2"),
                                               .ground = GroundPlane{-3, 5},
                                               .neighbours = {file + ";place=12,4,6,0,0.5"}});
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0].name, file);
  const BoundingBox box = bounding_box(placed[0].mesh);
  EXPECT_LT((box.centre() - Eigen::Vector3f(-3, 2, 1)).norm(), 1e-5f);
  EXPECT_NEAR(box.highest.y() - box.lowest.y(), 0.5, 0.005) << "a diameter of 2, times 0.5, over 2; less its facets'";
  // The ground lies below the asset, wherever that stands, and faces up.
  const BoundingBox ground = bounding_box(placed[1].mesh);
  EXPECT_LT((ground.centre() - Eigen::Vector3f(0, -1.5f, 0)).norm(), 1e-5f);
  EXPECT_NEAR(ground.highest.x() - ground.lowest.x(), 2 * 5 / 2.0, 1e-5);
  for (const Eigen::Vector3f& normal : placed[1].mesh.normals) EXPECT_GT(normal.y(), 0.999f);
  // Without a size, the ground extends four diagonals of the asset each way.
  const BoundingBox wide = bounding_box(load({.place = {}, .ground = parse_ground("0"), .neighbours = {}})[0].mesh);
  EXPECT_NEAR(wide.highest.x(), 4 * std::sqrt(12), 1e-4);
}

TEST_F(SurroundingsTest, ASphereHidesItsShareOfTheSky) {
  // A sphere of radius 1 at a distance of 2.5, 40 degrees off the normal, wholly above the horizon: it covers
  // cos(40 degrees) / 2.5^2 of what a surface sees, weighed by its cosine (the form factor of a sphere).
  const double off = 40 * std::numbers::pi / 180, distance = 2.5;
  const double hidden = std::cos(off) / (distance * distance);
  const auto place = [&](double scale, double azimuth) {
    const double turn = azimuth * std::numbers::pi / 180, away = scale * distance * std::sin(off);
    return std::to_string(away * std::sin(turn)) + "," + std::to_string(scale * distance * std::cos(off)) + "," +
           std::to_string(away * std::cos(turn)) + ",0," + std::to_string(scale);
  };
  const Surroundings alone{.place = {}, .ground = {}, .neighbours = {sphere().string() + ";place=" + place(1, 0)}};
  // 20,000 directions: the quadrature's error at a shadow's edge is some 1e-3 of the sky; the facets of 5,120 triangles
  // lie inside the sphere by 0.2 % of its radius.
  EXPECT_NEAR(constant_term(alone, Eigen::Vector3f::UnitY()), unoccluded * (1 - hidden), 0.0015);
  // The same scene, seen by an asset that is three times as large in it and turned.
  const Surroundings turned{.place = {.azimuth_degrees = 70, .scale = 3},
                            .ground = {},
                            .neighbours = {sphere().string() + ";place=" + place(3, 110)}};
  EXPECT_NEAR(constant_term(turned, Eigen::Vector3f::UnitY()), unoccluded * (1 - hidden), 0.0015);
  // A normal that looks away from it sees the open sky.
  EXPECT_NEAR(constant_term(alone, Eigen::Vector3f(0, -1, 0)), unoccluded, 0.0005);
}

TEST_F(SurroundingsTest, TheGroundHidesItsShareOfWhatLooksDown) {
  // A square of half-size a at the distance h: four corners, each with the configuration factor of a rectangle parallel
  // to an element below its corner (Howell, "A catalog of radiation heat transfer configuration factors", B-4).
  const double x = 3.0 / 1.5, root = std::sqrt(1 + x * x);
  const double hidden = 4 / (2 * std::numbers::pi) * 2 * x / root * std::atan(x / root);
  const Surroundings ground{.place = {}, .ground = GroundPlane{-1.5, 3}, .neighbours = {}};
  EXPECT_NEAR(constant_term(ground, Eigen::Vector3f(0, -1, 0)), unoccluded * (1 - hidden), 0.0015);
  EXPECT_NEAR(constant_term(ground, Eigen::Vector3f::UnitY()), unoccluded, 0.0005);
}

TEST_F(SurroundingsTest, HaveAnAlbedoOfTheirOwn) {
  const std::string file = sphere().string();
  const Surroundings around{.place = {}, .ground = parse_ground("-2"), .neighbours = {file + ";albedo=0.25", file}};
  const std::vector<PlacedMesh> placed = load(around, true, {.albedo = {{0.75f, 0.75f, 0.75f}}});
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].material.albedo.at(0, 0, 0), Eigen::Vector3f::Constant(0.25f));
  EXPECT_EQ(placed[1].material.albedo.source(), SurfaceAlbedo::Source::none);
  EXPECT_EQ(placed[2].material.albedo.at(0, 0, 0), Eigen::Vector3f::Constant(0.75f));
}

TEST_F(SurroundingsTest, WhatCannotBeIsSaid) {
  EXPECT_THROW(load({.place = {}, .ground = {}, .neighbours = {"missing.obj"}}), BadInput);
  EXPECT_THROW(parse_ground("0,-1"), WrongUsage);
  Surroundings surroundings;
  OptionSet options;
  add_surroundings_options(options, surroundings);
  for (const char* text : {"0,0", "a", "1,2,3,4,5,6"}) EXPECT_THROW(options.find("place")->set(text), WrongUsage);
  for (const char* text : {"low", "0,1,2"}) EXPECT_THROW(options.find("ground")->set(text), WrongUsage);
}

}  // namespace test_surroundings
}  // namespace kiln
