// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "atlas/atlas.h"
#include "atlas/chart_bitmap.h"
#include "atlas/charts.h"
#include "atlas/drawing.h"
#include "atlas/pack.h"
#include "base/errors.h"
#include "base/extent.h"
#include "base/parallel.h"
#include "import/import_mesh.h"
#include "mesh/uv_raster.h"
#include "scratch.h"
#include "shapes.h"
#include "simplify/simplify.h"

namespace kiln {
namespace test_atlas {

namespace fs = std::filesystem;

WrittenAtlas written(const AtlasResult& result) {
  const Scratch scratch;
  return write_atlas(scratch / "atlas.drc", result);
}

const TriangleMesh& bunny() {
  static const TriangleMesh mesh = [] {
    SimplifySettings settings;
    settings.faces = 1000;
    return simplify(load_mesh("/usr/share/glmark2/models/bunny.obj"), settings).mesh;
  }();
  return mesh;
}

/// Makes settings with few angles, which packs quickly: most tests are not about packing.
AtlasSettings quick_settings(const Extent& size = 512, int gutter = 4) {
  AtlasSettings settings;
  settings.size = size;
  settings.gutter = gutter;
  settings.rotations = 2;
  return settings;
}

std::map<std::string, TriangleMesh> test_meshes() {
  std::map<std::string, TriangleMesh> meshes;
  meshes["sphere"] = shapes::icosphere(3);
  meshes["cube"] = shapes::cube(4);
  meshes["torus"] = shapes::torus(24);
  meshes["two spheres"] = shapes::joined(shapes::icosphere(2), shapes::icosphere(1), {3, 0, 0});
  meshes["sheet"] = shapes::wavy_sheet(12);
  meshes["half pipe"] = shapes::cylinder_patch(12, 2, 3);
  meshes["bunny"] = bunny();
  return meshes;
}

/// Checks the rules of every atlas: each triangle once, nothing flipped, no overlap, the gutter kept.
void expect_sound(const TriangleMesh& mesh, const AtlasResult& result, const AtlasSettings& settings) {
  // Triangles keep their places and corners.
  ASSERT_EQ(result.mesh.triangles.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(result.mesh.positions[result.mesh.triangles[i][k]], mesh.positions[mesh.triangles[i][k]]);

  const WrittenAtlas atlas = written(result);
  EXPECT_EQ(atlas.measures.triangles, static_cast<int>(mesh.triangles.size()));
  EXPECT_EQ(atlas.measures.flipped_triangles, 0);
  EXPECT_GE(atlas.measures.smallest_gap_texels, settings.gutter);
  const int side = settings.size.width;  // square
  for (const int size : {side / 2, side, 2 * side - 1, 1000})
    EXPECT_EQ(rasterise_uvs(atlas.mesh, size, size).overlapping_texels, 0) << size;
  for (const Eigen::Vector2f& uv : atlas.mesh.uvs) {
    ASSERT_GE(uv.minCoeff(), 0);
    ASSERT_LE(uv.maxCoeff(), 1);
  }

  // The gutter once more, by growing each chart by it.
  const UvRaster raster = rasterise_uvs(atlas.mesh, side, side);
  const std::vector<std::uint32_t> chart_of = charts_of_triangles(atlas.mesh);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      if (!raster.at(i, j).covered()) continue;
      ASSERT_GE(std::min({i, j, side - 1 - i, side - 1 - j}), settings.gutter);
      for (int y = j; y <= j + settings.gutter; ++y)
        for (int x = i - settings.gutter; x <= i + settings.gutter; ++x) {
          const TexelSource& other = raster.at(x, std::min(y, side - 1));
          const bool own = !other.covered() || chart_of[other.triangle] == chart_of[raster.at(i, j).triangle];
          ASSERT_TRUE(own) << i << " " << j;
        }
    }
}

TEST(Stretch, OfASquareStretchedTwofold) {
  TriangleMesh mesh = shapes::plane(1);
  mesh.uvs = {{0, 0}, {0.8f, 0}, {0, 0.4f}, {0.8f, 0.4f}};
  // Along the surface there is 1.25 per uv one way and 2.5 the other; at equal area sqrt(1/2) and sqrt(2).
  const Stretch stretch = measure_stretch(mesh);
  EXPECT_NEAR(stretch.l2, std::sqrt(1.25), 1e-6);
  EXPECT_NEAR(stretch.linf, std::sqrt(2.0), 1e-6);
}

TEST(Charts, AreDisksThatHoldEveryFaceOnce) {
  for (const auto& [name, mesh] : test_meshes()) {
    SCOPED_TRACE(name);
    const Surface surface = analyse_surface(mesh);
    const ChartSettings settings;
    const ChartSet cut = cut_into_charts(surface, settings);
    std::vector<int> times(mesh.triangles.size());
    for (const Chart& chart : cut.charts) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      std::map<std::uint32_t, int> border_edges_at;
      for (std::size_t i = 0; i < chart.faces.size(); ++i) {
        ++times[chart.faces[i]];
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t a = chart.triangles[i][k], b = chart.triangles[i][(k + 1) % 3];
          EXPECT_EQ(chart.vertices[a], mesh.triangles[chart.faces[i]][k]);
          EXPECT_TRUE(edges.insert({a, b}).second) << "an edge has two triangles on one side";
        }
      }
      int border = 0;
      for (const auto& [a, b] : edges)
        if (edges.count({b, a}) == 0) {
          ++border;
          ++border_edges_at[a];
          ++border_edges_at[b];
        }
      for (const auto& [vertex, count] : border_edges_at) EXPECT_EQ(count, 2) << "a pinched border";
      const int edge_count = (static_cast<int>(edges.size()) + border) / 2;
      EXPECT_EQ(static_cast<int>(chart.vertices.size()) - edge_count + static_cast<int>(chart.faces.size()), 1)
          << "Euler characteristic";
      EXPECT_TRUE(is_flip_free(chart) && has_simple_border(chart));
      EXPECT_LE(measure_stretch(surface, chart).l2, settings.largest_l2);
    }
    for (const int count : times) EXPECT_EQ(count, 1);
  }
}

TEST(Atlas, IsSoundForEveryMesh) {
  for (const auto& [name, mesh] : test_meshes())
    for (const int size : {128, 300}) {
      SCOPED_TRACE(name + " at " + std::to_string(size));
      const AtlasSettings settings = quick_settings(size, size == 128 ? 2 : 4);
      expect_sound(mesh, make_atlas(mesh, settings), settings);
    }
}

TEST(Atlas, KeepsEveryGutter) {
  for (const int gutter : {0, 1, 3, 9}) {
    SCOPED_TRACE(gutter);
    const AtlasSettings settings = quick_settings(160, gutter);
    expect_sound(shapes::torus(12), make_atlas(shapes::torus(12), settings), settings);
  }
}

TEST(Atlas, OfAFlatGridIsOneChartWithoutStretch) {
  const TriangleMesh mesh = shapes::plane(8);
  const AtlasMeasures measures = written(make_atlas(mesh, {})).measures;
  EXPECT_EQ(measures.charts, 1);
  EXPECT_NEAR(measures.stretch.l2, 1, 1e-3);
  EXPECT_NEAR(measures.stretch.linf, 1, 1e-3);
  EXPECT_EQ(measures.seam_length, 0);
  // A square of 512 texels less a gutter of 4 all around; it may stand askew to the last texel.
  EXPECT_NEAR(measures.texels_per_unit, 504, 5);
  EXPECT_GT(measures.utilisation, 0.95);
}

TEST(Atlas, OfADevelopableSurfaceHasNoStretch) {
  AtlasSettings settings;
  settings.max_stretch = 1.001;
  // Between two of 48 creases of 3.6 degrees a facetted cylinder is flat: it unrolls exactly, except that uvs have 16
  // bits.
  const AtlasMeasures measures = written(make_atlas(shapes::cylinder_patch(48, 3, 3), settings)).measures;
  EXPECT_EQ(measures.charts, 1);
  EXPECT_NEAR(measures.stretch.l2, 1, 1e-3);
  EXPECT_NEAR(measures.stretch.linf, 1, 2e-2);
}

TEST(Atlas, CutsACubeAlongItsEdges) {
  const AtlasMeasures measures = written(make_atlas(shapes::cube(4), {})).measures;
  EXPECT_EQ(measures.charts, 6);
  EXPECT_NEAR(measures.stretch.linf, 1, 1e-3);
  EXPECT_NEAR(measures.seam_length, 12, 1e-3);
}

TEST(Atlas, OfTheBunnyIsDecent) {
  const AtlasResult result = make_atlas(bunny(), {});
  const AtlasMeasures measures = written(result).measures;
  // Measured, with some 15 % of room; of utilisation, 0.638, with less.
  EXPECT_GE(measures.utilisation, 0.61);
  EXPECT_LE(measures.charts, 15);
  EXPECT_LE(measures.stretch.l2, 1.01);
  EXPECT_LE(measures.stretch.linf, 1.4);
  EXPECT_EQ(result.lscm_charts + result.arap_charts + result.mean_value_charts + result.unfolded_charts,
            measures.charts);
}

TEST(Atlas, GivesEveryChartTheSameDensity) {
  AtlasSettings settings = quick_settings();
  settings.density = AtlasDensity::even;
  const AtlasResult result = make_atlas(shapes::torus(24), settings);
  const std::vector<std::uint32_t> chart_of = charts_of_triangles(result.mesh);
  std::map<std::uint32_t, std::pair<double, double>> areas;
  for (std::size_t i = 0; i < chart_of.size(); ++i) {
    const Triangle& t = result.mesh.triangles[i];
    const auto p = [&](int k) { return Eigen::Vector3d(result.mesh.positions[t[k]].cast<double>()); };
    const auto uv = [&](int k) { return Eigen::Vector2d(result.mesh.uvs[t[k]].cast<double>()); };
    areas[chart_of[i]].first += (p(1) - p(0)).cross(p(2) - p(0)).norm();
    areas[chart_of[i]].second += cross(uv(0), uv(1), uv(2));
  }
  const double first = areas.begin()->second.second / areas.begin()->second.first;
  for (const auto& [chart, area] : areas) EXPECT_NEAR(area.second / area.first / first, 1, 1e-4);  // float uvs
}

TEST(Atlas, IsTheSameWithOneThreadAndMany) {
  for (const AtlasQuality quality : {AtlasQuality::standard, AtlasQuality::best}) {
    SCOPED_TRACE(static_cast<int>(quality));
    const auto with_threads = [&](std::size_t threads) {
      const ThreadLimit limit(threads);
      AtlasSettings settings = quick_settings(96, 2);
      settings.quality = quality;
      return make_atlas(shapes::torus(8), settings).mesh;
    };
    const TriangleMesh one = with_threads(1), many = with_threads(8);
    EXPECT_EQ(one.uvs, many.uvs);
    EXPECT_EQ(one.triangles, many.triangles);
  }
}

TEST(Atlas, TakesOddTriangles) {
  TriangleMesh mesh = shapes::plane(3);
  mesh.normals.clear();
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.emplace_back(0, 1, 0);
  mesh.triangles.push_back({0, 0, 1});          // a corner twice
  mesh.triangles.push_back({0, 1, 2});          // on a line
  mesh.triangles.push_back({0, 1, vertices});   // a third triangle at an edge
  mesh.triangles.push_back({5, 4, vertices});   // and another
  mesh.triangles.push_back(mesh.triangles[0]);  // twice the same
  const AtlasSettings settings = quick_settings();
  const AtlasResult result = make_atlas(mesh, settings);
  EXPECT_EQ(result.degenerate_triangles, 2);
  expect_sound(mesh, result, settings);
}

TEST(Atlas, OfASingleTriangle) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  AtlasSettings settings;
  settings.size = 64;
  const AtlasResult result = make_atlas(mesh, settings);
  expect_sound(mesh, result, settings);
  EXPECT_GT(written(result).measures.utilisation, 0.19);  // lying flat it would be 56 texels wide and 28 high
}

TEST(Atlas, RefusesWhatCannotBe) {
  AtlasSettings settings;
  settings.size = 16;
  EXPECT_THROW(make_atlas(bunny(), settings), WrongUsage);
  TriangleMesh nothing;
  nothing.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  nothing.triangles = {{0, 1, 2}};
  EXPECT_THROW(make_atlas(nothing, {}), BadInput);
}

/// Lists the texels whose centre lies in a triangle of the turned and scaled chart.
std::set<std::pair<int, int>> covered_centres(const Chart& chart, double angle, double scale,
                                              const Eigen::Vector2d& origin) {
  std::set<std::pair<int, int>> result;
  for (const Triangle& t : chart.triangles) {
    std::array<Eigen::Vector2d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = turned(chart.uvs[t[k]], angle) * scale - origin;
    const Eigen::Vector2d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (int y = static_cast<int>(std::floor(low.y())); y <= static_cast<int>(high.y()); ++y)
      for (int x = static_cast<int>(std::floor(low.x())); x <= static_cast<int>(high.x()); ++x) {
        const Eigen::Vector2d c(x + 0.5, y + 0.5);
        if (cross(p[0], p[1], c) >= 0 && cross(p[1], p[2], c) >= 0 && cross(p[2], p[0], c) >= 0) result.insert({x, y});
      }
  }
  return result;
}

TEST(ChartBitmap, HasEveryTexelOfTheTrianglesAndFewMore) {
  const ChartSet cut = cut_into_charts(analyse_surface(bunny()), {});
  for (const Chart& chart : cut.charts)
    for (const double angle : {0.0, 0.7, 3.0}) {
      BitmapSettings settings;
      settings.texels_per_unit = 150;
      settings.angle = angle;
      const ChartBitmap bitmap = rasterise_chart(chart_outline(chart), settings);
      std::set<std::pair<int, int>> needed;
      for (int y = 0; y < bitmap.height; ++y)
        for (const TexelRun& run : bitmap.rows[y])
          for (int x = run.first; x <= run.last; ++x) needed.insert({x, y});
      EXPECT_EQ(static_cast<std::int64_t>(needed.size()), bitmap.texels);
      const auto covered = covered_centres(chart, angle, settings.texels_per_unit, bitmap.origin);
      for (const auto& texel : covered) ASSERT_TRUE(needed.count(texel)) << texel.first << " " << texel.second;
      // The margin of 0.02 adds a fiftieth of a texel along the border, slivers a texel here and there.
      EXPECT_LE(needed.size(), covered.size() + 0.1 * bitmap.height + 0.1 * bitmap.width + 8);
    }
}

/// Makes a strip 1 wide, bent to a C in space, whose uvs leave `gap` between its ends, and its flat twin.
Chart c_shape(TriangleMesh& mesh, double gap, bool apart_in_space) {
  Chart chart;
  const int cells = 24;
  for (int i = 0; i <= cells; ++i)
    for (const double radius : {1.0, 2.0}) {
      const double angle = (2 * std::acos(-1.0) - gap / 1.5) * i / cells;
      chart.uvs.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
      chart.vertices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      const Eigen::Vector2f uv = chart.uvs.back().cast<float>();
      mesh.positions.emplace_back(uv.x(), uv.y(), apart_in_space ? 0.2f * static_cast<float>(i) : 0.0f);
    }
  for (std::uint32_t i = 0; i < 2 * cells; i += 2) {
    chart.triangles.push_back({i, i + 1, i + 2});
    chart.triangles.push_back({i + 2, i + 1, i + 3});
  }
  mesh.triangles = chart.triangles;
  for (std::uint32_t i = 0; i < chart.triangles.size(); ++i) chart.faces.push_back(i);
  return chart;
}

TEST(Charts, KeepClearOfThemselvesUnlessTheSurfaceDoesNotEither) {
  for (const bool apart_in_space : {false, true}) {
    TriangleMesh mesh;
    const Chart chart = c_shape(mesh, 0.1, apart_in_space);
    const Surface surface = analyse_surface(mesh);
    EXPECT_TRUE(has_simple_border(chart));
    EXPECT_TRUE(keeps_clear(surface, chart, 0.05));
    EXPECT_EQ(keeps_clear(surface, chart, 0.2), !apart_in_space);
  }
}

TEST(Atlas, TakesSurfacesOfAnyGenusAndManyComponents) {
  TriangleMesh rings = shapes::torus(12), spheres;
  rings = shapes::joined(rings, shapes::torus(12), {0, 5, 0});
  for (int i = 0; i < 40; ++i)
    spheres = shapes::joined(spheres, shapes::icosphere(1), {3.0f * static_cast<float>(i), 0, 0});
  for (const TriangleMesh& mesh : {rings, spheres}) {
    const AtlasSettings settings = quick_settings(400, 2);
    expect_sound(mesh, make_atlas(mesh, settings), settings);
  }
}

TEST(Atlas, LargeChartsAreRelaxedAroundTheirSeams) {
  // Few charts of many triangles: beyond the size up to which merged charts are relaxed as a whole.
  const TriangleMesh mesh = shapes::cylinder_patch(64, 3, 3);
  const Surface surface = analyse_surface(mesh);
  const ChartSettings settings;
  const ChartSet cut = cut_into_charts(surface, settings);
  std::size_t faces = 0, largest = 0;
  for (const Chart& chart : cut.charts) {
    EXPECT_TRUE(is_flip_free(chart) && has_simple_border(chart));
    EXPECT_LE(measure_stretch(surface, chart).l2, settings.largest_l2);
    faces += chart.faces.size();
    largest = std::max(largest, chart.faces.size());
  }
  EXPECT_EQ(faces, mesh.triangles.size());
  EXPECT_LT(cut.charts.size(), 10u);
  EXPECT_GT(largest, 4000u);
}

TEST(Surface, WeighsSeamsByOpennessAtAnUnchangedTotal) {
  const TriangleMesh mesh = shapes::plane(4);
  Surface surface = analyse_surface(mesh);
  std::vector<float> openness(mesh.positions.size(), 0.2f);
  openness[0] = 1;
  weigh_seams(surface, openness);
  double costs = 0, lengths = 0;
  for (std::uint32_t h = 0; h < surface.half_edge_count(); ++h) {
    costs += surface.seam_costs[h];
    lengths += surface.edge_lengths[h];
    const bool open = surface.origin(h) == 0 || surface.target(h) == 0;
    EXPECT_EQ(surface.seam_costs[h] > surface.edge_lengths[h], open) << h;
  }
  EXPECT_NEAR(costs / lengths, 1, 1e-9);
}

TEST(Packing, AtAGivenScaleTakesTheLeastHeightOrSquare) {
  const ChartSet cut = cut_into_charts(analyse_surface(shapes::torus(16)), {});
  double area = 0;
  for (const Chart& chart : cut.charts)
    for (const Triangle& t : chart.triangles) area += 0.5 * cross(chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]);
  PackSettings settings;
  settings.texels_per_unit = 40;
  settings.rotations = 8;
  for (const int width : {0, 200, 1000}) {
    settings.width = width;
    settings.height = 0;
    const Packing packing = pack_charts(cut.charts, settings);
    EXPECT_EQ(packing.texels_per_unit, 40);
    EXPECT_EQ(packing.height % 4, 0);
    EXPECT_EQ(packing.width, width == 0 ? packing.height : width);
    // About half of the atlas is covered even where one chart more would not have fitted beside the others. The widest
    // has a single row of charts, and is as high as the highest of them.
    EXPECT_GT(area * 40 * 40 / packing.width / packing.height, width == 1000 ? 0.25 : 0.45);
    for (std::size_t c = 0; c < cut.charts.size(); ++c)
      for (const Eigen::Vector2d& uv : cut.charts[c].uvs) {
        const Eigen::Vector2d texel = turned(uv, packing.placements[c].angle) * 40 + packing.placements[c].offset;
        EXPECT_TRUE(texel.minCoeff() > 3 && texel.x() < packing.width - 3 && texel.y() < packing.height - 3);
      }
  }
  settings.width = settings.height = 100;
  EXPECT_THROW(pack_charts(cut.charts, settings), WrongUsage);
}

/// Regression: a search that takes the height found for lower than itself, by a rounding, never ends.
TEST(Packing, EndsAtAnyScale) {
  const ChartSet cut = cut_into_charts(analyse_surface(shapes::torus(8)), {});
  PackSettings settings;
  settings.rotations = 2;
  settings.height = 0;
  for (int step = 0; step < 40; ++step) {
    settings.texels_per_unit = 100 + 3.7 * step;
    settings.width = 450 + 11 * step;
    EXPECT_GT(pack_charts(cut.charts, settings).height, 0);
  }
}

TEST(Packing, PutsACrowdDownOnceAndWell) {
  // 300 right triangles in three sizes, legs to the axes: two make a square, of which five by thirty fit.
  std::vector<Chart> charts(300);
  double area = 0;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const double side = 1 + 0.5 * static_cast<double>(i % 3);
    charts[i].faces = {static_cast<std::uint32_t>(i)};
    charts[i].triangles = {{0, 1, 2}};
    charts[i].vertices = {0, 1, 2};
    charts[i].uvs = {{0, 0}, {side, 0}, {0, side}};
    area += 0.5 * side * side;
  }
  PackSettings settings;
  settings.width = 512;
  settings.height = 256;
  settings.gutter = 2;
  const Packing packing = pack_charts(charts, settings);
  const double share = area * packing.texels_per_unit * packing.texels_per_unit / (512 * 256);
  EXPECT_GT(share, 0.5);  // of some 0.65: triangles of 22 texels lose a sixth to a gutter of 2

  // No two charts need the same texel, gutters included, and none sticks out.
  std::vector<int> owner(512 * 256, -1);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    BitmapSettings bitmap;
    bitmap.texels_per_unit = packing.texels_per_unit;
    bitmap.angle = packing.placements[c].angle;
    for (const auto& [x, y] :
         covered_centres(charts[c], bitmap.angle, bitmap.texels_per_unit, -packing.placements[c].offset)) {
      ASSERT_TRUE(x >= 2 && y >= 2 && x < 510 && y < 254);
      for (int j = y - 2; j <= y + 2; ++j)
        for (int i = x - 2; i <= x + 2; ++i)
          ASSERT_TRUE(owner[j * 512 + i] < 0 || owner[j * 512 + i] == static_cast<int>(c));
      owner[y * 512 + x] = static_cast<int>(c);
    }
  }

  settings.gutter = 30;
  EXPECT_THROW(pack_charts(charts, settings), WrongUsage);
}

TEST(Packing, TellsProgressThroughoutAndLetsInterruptsThrough) {
  const ChartSet cut = cut_into_charts(analyse_surface(shapes::torus(12)), {});
  PackSettings settings;
  settings.rotations = 2;
  std::vector<double> told;
  pack_charts(cut.charts, settings, [&](double fraction) { told.push_back(fraction); });
  EXPECT_GE(told.size(), 20u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
  EXPECT_THROW(pack_charts(cut.charts, settings,
                           [](double fraction) {
                             if (fraction > 0.2) throw Interrupted();
                           }),
               Interrupted);
}

TEST(Atlas, PacksNonSquareAtlases) {
  const TriangleMesh mesh = shapes::torus(16);
  const ChartSet cut = cut_into_charts(analyse_surface(mesh), {});
  PackSettings settings;
  settings.width = 300;
  settings.height = 120;
  settings.rotations = 4;
  const Packing packing = pack_charts(cut.charts, settings);
  for (std::size_t c = 0; c < cut.charts.size(); ++c)
    for (const Eigen::Vector2d& uv : cut.charts[c].uvs) {
      const Eigen::Vector2d texel =
          turned(uv, packing.placements[c].angle) * packing.texels_per_unit + packing.placements[c].offset;
      // A covered texel's centre is half a texel inside, and the chart ends less than a texel after it.
      EXPECT_GT(texel.minCoeff(), 3);
      EXPECT_LT(texel.x(), 297);
      EXPECT_LT(texel.y(), 117);
    }
}

TEST(Drawing, ShowsChartsGutterAndFreeRoom) {
  const TriangleMesh mesh = shapes::plane(2, 1, 0, 0.25f);
  const Image<std::uint8_t> picture = draw_atlas(mesh, 512, 4);
  ASSERT_EQ(picture.width(), 1024);
  ASSERT_EQ(picture.height(), 1024);
  std::set<std::array<int, 3>> colors;
  for (const int i : {10, 252, 330}) {  // free room, 4 pixels from the chart, inside it
    const auto pixel = picture.pixel(i, 400);
    colors.insert({pixel[0], pixel[1], pixel[2]});
  }
  EXPECT_EQ(colors.size(), 3u);
}

}  // namespace test_atlas
}  // namespace kiln
