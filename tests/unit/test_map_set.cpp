// SPDX-License-Identifier: GPL-3.0-or-later
// Maps for materials, against surfaces whose heights, curvature, thickness and open sky are known.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "base/errors.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "mesh/curvature.h"
#include "normals/normals.h"
#include "raycast/surface_thickness.h"
#include "scratch.h"
#include "shapes.h"

namespace kiln {
namespace test_map_set {

constexpr double pi = 3.14159265358979323846;

TriangleMesh shaded(TriangleMesh mesh) {
  compute_vertex_normals(mesh);
  return mesh;
}

/// Makes maps of `high` in the atlas of `low`.
NormalsResult maps_of(const TriangleMesh& high, const TriangleMesh& low, const std::string& kinds, int size = 64,
                      const MaterialIds& materials = {}, SeamChoice seams = SeamChoice::equalise) {
  NormalsSettings settings;
  settings.size = size;
  settings.seams = seams;
  settings.maps.kinds = parse_map_kinds(kinds);
  settings.maps.directions = 4096;
  return make_normals(high, low, settings, {}, no_progress, {.ids = materials});
}

/// Calls visit(i, j, point of the high mesh) for the covered texels.
template <class Visit>
void for_each_covered(const NormalsResult& result, const Visit& visit) {
  for (int j = 0; j < result.coverage.height(); ++j)
    for (int i = 0; i < result.coverage.width(); ++i)
      if (result.coverage.at(i, j) != 0)
        visit(i, j, Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(result.position.pixel(i, j).data())));
}

TEST(Curvature, IsThatOfBallsTubesAndPlanes) {
  // Exact, but for the floats of positions: (x - y).x is half the square of x - y for all points of a unit ball.
  for (const float radius : {0.f, 0.3f})
    for (const float curvature : mean_curvature(shapes::icosphere(4, 2), radius)) EXPECT_NEAR(curvature, 0.5, 0.002);
  TriangleMesh hollow = shapes::icosphere(4, 2);
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  for (const float curvature : mean_curvature(hollow)) EXPECT_NEAR(curvature, -0.5, 0.002);

  const TriangleMesh torus = shapes::torus(120);  // radii 1 and .4
  const std::vector<float> of_torus = mean_curvature(torus);
  for (std::size_t v = 0; v < of_torus.size(); ++v) {
    // H = (1 / r + cos / (R + r cos)) / 2, at the angle about the tube whose cosine this is.
    const Eigen::Vector3f& p = torus.positions[v];
    const double cosine = (std::hypot(p.x(), p.z()) - 1) / 0.4;
    EXPECT_NEAR(of_torus[v], 0.5 * (1 / 0.4 + cosine / (1 + 0.4 * cosine)), 0.01) << v;
  }
  for (const float curvature : mean_curvature(shapes::plane(8), 0.1)) EXPECT_NEAR(curvature, 0, 1e-6);
}

TEST(Curvature, OfACubeIsAtItsEdges) {
  const TriangleMesh cube = shapes::cube(8);
  const std::vector<float> curvature = mean_curvature(cube);
  for (std::size_t v = 0; v < curvature.size(); ++v) {
    const Eigen::Array3f p = cube.positions[v].array().abs();
    const int faces = static_cast<int>((p > 0.499f).count());
    if (faces == 1) {
      EXPECT_NEAR(curvature[v], 0, 1e-4);
    } else {
      EXPECT_GT(curvature[v], 1) << v;  // 90 degrees over two halves of cells of 1 / 8
    }
  }
}

TEST(Thickness, IsThatOfBallsAndSlabs) {
  const TriangleMesh ball = shaded(shapes::icosphere(5, 3));
  const RayScene scene(ball);
  for (const float thickness : surface_thickness(scene, {ball.positions, ball.normals}, 256, 1e-5f))
    EXPECT_NEAR(thickness, 4, 0.02);  // 4/3 of the radius, of which facets take a thousandth

  TriangleMesh slab = shapes::cube(8);
  for (Eigen::Vector3f& p : slab.positions) p = p.cwiseProduct(Eigen::Vector3f(100, 0.5f, 100));
  const std::vector<Eigen::Vector3f> middle = {{0.1f, 0.25f, 0.2f}}, up = {Eigen::Vector3f::UnitY()};
  EXPECT_NEAR(surface_thickness(RayScene(slab), {middle, up}, 65536, 1e-5f)[0], 1, 0.01);

  // Beneath a sheet there is nothing.
  const TriangleMesh sheet = shapes::plane(2);
  const std::vector<Eigen::Vector3f> on_it = {{0.1f, 0, 0.2f}};
  EXPECT_EQ(surface_thickness(RayScene(sheet), {on_it, up}, 256, 1e-5f)[0], 0);
}

TEST(MapSet, HeightIsTheDisplacementOfAPlane) {
  TriangleMesh high = shapes::plane(128, 2);
  const auto wave = [](const Eigen::Vector3f& p) { return 0.05f * std::sin(5 * p.x()) * std::cos(4 * p.z()); };
  for (Eigen::Vector3f& p : high.positions) p.y() = wave(p);
  const NormalsResult result = maps_of(shaded(high), shapes::plane(4, 2), "height");
  ASSERT_EQ(result.maps.size(), 1u);
  const SurfaceMap& height = result.maps[0];
  EXPECT_EQ(height.unit, "length");
  EXPECT_EQ(height.lowest, -height.highest);
  EXPECT_NEAR(height.highest, 0.05, 0.001);
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& p) {
    EXPECT_NEAR(height.values.at(i, j), p.y(), 1e-6);
    EXPECT_NEAR(height.values.at(i, j), wave(p), 2e-4);  // triangles of the wave are chords
  });
}

/// A floor about the origin, and along its edge at x = 1 a wall, 1 high and so long that it has no ends.
TriangleMesh floor_and_wall() {
  TriangleMesh wall = shapes::plane(4, 1);
  for (Eigen::Vector3f& p : wall.positions) p = Eigen::Vector3f(1, p.x() + 0.5f, -400 * p.z());
  for (Triangle& t : wall.triangles) std::swap(t[1], t[2]);
  return shaded(shapes::joined(shapes::plane(16, 2), wall, Eigen::Vector3f::Zero()));
}

TEST(MapSet, OpennessAndBentNormalsBesideAWallAreTheClosedForm) {
  const NormalsResult result = maps_of(floor_and_wall(), shapes::plane(4, 2), "ao,bent-normal");
  ASSERT_EQ(result.maps.size(), 2u);
  const SurfaceMap &open = result.maps[0], &bent = result.maps[1];
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& p) {
    // The wall fills (1 - cos a) / 2 of the cosine-weighted sky, up to the angle a of its top [Howell, form factors].
    const double top = std::atan2(1.0, 1.0 - static_cast<double>(p.x()));
    EXPECT_NEAR(open.values.at(i, j), 0.5 * (1 + std::cos(top)), 0.01) << p.transpose();

    // In the plane across the wall, s = (sin t, cos t) of the angle t off the normal, towards the wall: seen are t of
    // -90 degrees to 90 - a. Along the wall the mean is 0. Per unit of t, light from a slice counts with cos t times
    // 2 / 3 of pi... the same for all t but cos t, so the mean is the integral of (sin t, cos t) cos t.
    const double end = pi / 2 - top, begin = -pi / 2;
    const auto across = [](double t) { return 0.5 * std::sin(t) * std::sin(t); };
    const auto up = [](double t) { return 0.5 * t + 0.25 * std::sin(2 * t); };
    const Eigen::Vector3d mean = Eigen::Vector3d(across(end) - across(begin), up(end) - up(begin), 0).normalized();
    const Eigen::Vector3f shown = Eigen::Map<const Eigen::Vector3f>(bent.values.pixel(i, j).data());
    EXPECT_LT((shown.cast<double>() - mean).norm(), 0.02) << p.transpose();  // 4,096 directions: about a degree
  });
}

TEST(MapSet, ABallsMapsAreFlat) {
  const TriangleMesh ball = shaded(shapes::icosphere(5, 2));
  const TriangleMesh low = shapes::cube_sphere(8, 2);
  const MaterialIds one = {std::vector<std::uint32_t>(ball.triangles.size()), {"x"}};
  const NormalsResult result = maps_of(ball, low, "all", 96, one, SeamChoice::keep);
  ASSERT_EQ(result.maps.size(), static_cast<std::size_t>(map_kinds));
  std::set<std::array<float, 3>> colors;
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& p) {
    const auto value = [&](MapKind kind) { return result.maps[static_cast<std::size_t>(kind)].values.at(i, j); };
    const auto vector = [&](MapKind kind) {
      return Eigen::Vector3f(
          Eigen::Map<const Eigen::Vector3f>(result.maps[static_cast<std::size_t>(kind)].values.pixel(i, j).data()));
    };
    EXPECT_NEAR(value(MapKind::ambient_occlusion), 1, 0.01);
    EXPECT_NEAR(value(MapKind::thickness), 8.0 / 3, 0.02);
    EXPECT_NEAR(value(MapKind::curvature), 0.5, 0.03);
    EXPECT_LT((vector(MapKind::bent_normal) - p.normalized()).norm(), 0.01);
    EXPECT_LT((vector(MapKind::position) - (p / 4 + Eigen::Vector3f::Constant(0.5f))).norm(), 1e-5f);
    const Eigen::Vector3f color = vector(MapKind::material);
    colors.insert({color.x(), color.y(), color.z()});
  });
  EXPECT_EQ(colors.size(), 1u);

  // Both sides of seams are made equal where that is asked for.
  const NormalsResult equal = maps_of(ball, low, "position", 96);
  const Seams seams(low, 96, 96);
  const Image<float>& kept = result.maps[static_cast<std::size_t>(MapKind::position)].values;
  EXPECT_LT(seams.mismatch(equal.maps[0].values).mean, 0.1 * seams.mismatch(kept).mean);
}

TEST(MapSet, MaterialsAreFlatColorsUpToTheGutters) {
  const TriangleMesh sheet = shapes::plane(8, 2);
  MaterialIds halves{{}, {"left", "right"}};
  for (const Triangle& t : sheet.triangles)
    halves.of_triangle.push_back((sheet.positions[t[0]] + sheet.positions[t[1]] + sheet.positions[t[2]]).x() > 0 ? 1u
                                                                                                                 : 0u);
  const NormalsResult result = maps_of(sheet, sheet, "material", 64, halves);
  std::set<std::array<float, 3>> colors;
  const Image<float>& picture = result.maps[0].values;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) {
      colors.insert({picture.at(i, j, 0), picture.at(i, j, 1), picture.at(i, j, 2)});
      EXPECT_EQ(picture.at(i, j, 0), picture.at(i < 32 ? 0 : 63, 5, 0));
    }
  EXPECT_EQ(colors.size(), 2u);
}

TEST(MapSet, TexelsInsideOtherPartsTakeTheirNeighboursValues) {
  // A ball half sunk into a box: the texels of its lower half see nothing, and would be black.
  TriangleMesh box = shapes::cube(4);
  for (Eigen::Vector3f& p : box.positions) p = 4 * p - 2 * Eigen::Vector3f::UnitY();
  const TriangleMesh ball = shapes::cube_sphere(8, 1);
  const NormalsResult result = maps_of(shaded(shapes::joined(ball, box, Eigen::Vector3f::Zero())), ball, "ao", 96);
  EXPECT_GT(result.buried_texels, 1000u);
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f&) {
    EXPECT_GT(result.maps[0].values.at(i, j), 0.4f);  // at the waterline half of the sky is open
  });
}

TEST(MapSet, SharesAndEmissionAreWhatMaterialsSay) {
  const TriangleMesh high = shaded(shapes::plane(4));
  SurfaceShare::Materials shares;
  shares.all = {{.factor = 0.25f}, {.factor = 0.75f}};
  SurfaceAlbedo::Textured light;
  light.materials = {{.color = {0, 0, 0}, .texture = nullptr}, {.color = {4, 2, 0}, .texture = nullptr}};
  for (const Triangle& t : high.triangles) {
    const float x = (high.positions[t[0]] + high.positions[t[1]] + high.positions[t[2]]).x();
    shares.of_triangle.push_back(x < 0 ? 0 : 1);
    light.material_of.push_back(x < 0 ? 0 : 1);
  }
  HighMaterials materials;
  materials.roughness = SurfaceShare(shares);
  materials.emission = SurfaceAlbedo::of_materials(light, SurfaceAlbedo::Source::materials);
  NormalsSettings settings;
  settings.size = 64;
  settings.maps.kinds = parse_map_kinds("roughness,metalness,emission,orm");
  settings.maps.directions = 64;
  const NormalsResult result = make_normals(high, high, settings, {}, no_progress, materials);
  ASSERT_EQ(result.maps.size(), 4u);
  EXPECT_EQ(result.maps[2].highest, 4);
  constexpr float texel = 1.f / 48;  // about: a margin is left free
  for_each_covered(result, [&](int i, int j, const Eigen::Vector3f& p) {
    if (std::abs(p.x()) < 2 * texel) return;
    const bool right = p.x() > 0;
    const float roughness = right ? 0.75f : 0.25f;
    EXPECT_NEAR(result.maps[0].values.at(i, j), roughness, 1e-5f);
    EXPECT_NEAR(result.maps[1].values.at(i, j), 0, 1e-5f);
    EXPECT_NEAR(result.maps[2].values.at(i, j, 1), right ? 2 : 0, 1e-4f);
    EXPECT_NEAR(result.maps[3].values.at(i, j, 0), 1, 1e-4f);
    EXPECT_NEAR(result.maps[3].values.at(i, j, 1), roughness, 1e-5f);
    EXPECT_NEAR(result.maps[3].values.at(i, j, 2), 0, 1e-5f);
  });
}

TEST(MapSet, FilesHoldTheValues) {
  const Scratch folder;
  TriangleMesh high = shapes::plane(32, 2);
  for (Eigen::Vector3f& p : high.positions) p.y() = 0.1f * std::sin(3 * p.x());
  const NormalsResult result = maps_of(shaded(high), shapes::plane(4, 2), "height,position");
  const Image<float>& height = result.maps[0].values;
  MapSettings settings;
  settings.kinds = parse_map_kinds("height,position");
  const auto write = [&](MapFormat format) {
    settings.format = format;
    OutputSet outputs(folder / "maps");
    const Json described = write_maps(outputs, result.maps, settings, {});
    outputs.commit();
    return described;
  };
  const Json sixteen = write(MapFormat::png16);
  EXPECT_EQ(sixteen["height"]["file"], "height.png");
  EXPECT_EQ(sixteen["height"]["unit"], "length");
  const double lowest = sixteen["height"]["min"], range = sixteen["height"]["max"].get<double>() - lowest;
  const Image<std::uint16_t> stored = read_png16(folder / "maps/height.png");
  for (std::size_t k = 0; k < height.values().size(); ++k)
    EXPECT_NEAR(lowest + stored.values()[k] / 65535.0 * range, height.values()[k], range / 65535);

  write(MapFormat::png8);
  EXPECT_EQ(read_png8(folder / "maps/height.png").width(), 64);

  const Json floats = write(MapFormat::exr);
  EXPECT_FALSE(floats["height"].contains("min"));
  EXPECT_EQ(floats["position"]["file"], "position.exr");  // which kiln-normals writes in any case
  EXPECT_EQ(read_float_image(folder / "maps/height.exr").values(), height.values());
  EXPECT_FALSE(std::filesystem::exists(folder / "maps/height.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "maps/position.png"));
}

TEST(MapSet, NamesAreRead) {
  EXPECT_TRUE(parse_map_kinds("none").empty());
  EXPECT_EQ(parse_map_kinds("all").size(), static_cast<std::size_t>(map_kinds));
  const std::vector<MapKind> two = {MapKind::ambient_occlusion, MapKind::height};
  EXPECT_EQ(parse_map_kinds("height,ao,height"), two);
  EXPECT_EQ(text_of(two), "ao,height");
  for (const char* bad : {"", "ao,", "heights", "ao height"}) EXPECT_THROW(parse_map_kinds(bad), WrongUsage) << bad;
}

}  // namespace test_map_set
}  // namespace kiln
