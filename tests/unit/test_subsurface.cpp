// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <vector>

#include "bake/scene/vertex_receivers.h"
#include "bake/subsurface/kernel_tables.h"
#include "bake/subsurface/scattering.h"
#include "bake/subsurface/subsurface.h"
#include "bake/subsurface/surface_samples.h"
#include "base/parallel.h"
#include "shapes.h"

namespace kiln {
namespace test_subsurface {

using shapes::icosphere;

const ScatterProfile marble = ScatterProfile::dipole(2.19, 0.0021, 1.5);  // red; depths 0.46 and 2.9 mm
const ScatterProfile skin = ScatterProfile::dipole(0.88, 0.17, 1.3);      // green
const ScatterProfile spectralon = ScatterProfile::dipole(11.6, 0, 1.3);

/// Makes points of a square grid, `cells` a side and `spacing` mm apart, in the plane y = height, facing up or down.
void add_grid(SurfaceSamples& samples, int cells, float spacing, float height, float up) {
  const float middle = 0.5f * static_cast<float>(cells - 1);
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      samples.positions.emplace_back((static_cast<float>(i) - middle) * spacing, height,
                                     (static_cast<float>(j) - middle) * spacing);
      samples.normals.emplace_back(0.f, up, 0.f);
      samples.areas.push_back(spacing * spacing);
    }
}

/// Takes the vertices of a mesh; positions in mm.
SurfaceSamples vertices_of(const TriangleMesh& mesh, double area) {
  const ReceiverSet receivers = receivers_on_vertices(mesh).receivers;
  SurfaceSamples samples{receivers.positions, receivers.normals, vertex_areas(mesh, receivers)};
  const double sum = std::accumulate(samples.areas.begin(), samples.areas.end(), 0.0);
  for (float& a : samples.areas) a *= static_cast<float>(area / sum);
  return samples;
}

/// Makes transfer of one coefficient that is 1 everywhere.
std::vector<TransferVectors> even_light(const SurfaceSamples& samples) {
  TransferVectors light(samples.size(), 1);
  std::fill(light.values.begin(), light.values.end(), 1.f);
  return {light};
}

std::vector<float> scatter_even(const SurfaceSamples& samples, const ScatterProfile& profile) {
  return scatter_transfer(samples, even_light(samples), {{profile}}).transfer[0].values;
}

constexpr double pi = 3.14159265358979;

TEST(Subsurface, DiscMeansSumToTheIntegralOverTheDisc) {
  // Rings about the point of half a disc's radius each, from the tables, against the closed form.
  const std::vector<ScatterProfile> profiles = {marble, skin};
  for (const double radius : {0.01, 0.3, 10.0}) {
    const KernelTables tables(profiles, radius, 4 * radius, 1000 * radius);
    float mean[2];
    tables.disc_mean(static_cast<float>(radius), 0, mean);
    for (int c = 0; c < 2; ++c)
      EXPECT_NEAR(mean[c] * pi * radius * radius / profiles[c].within(radius), 1, 1e-4) << radius;
  }
}

TEST(Subsurface, TabulatedDensityIsTheProfile) {
  const std::vector<ScatterProfile> profiles = {marble, skin};
  const KernelTables tables(profiles, 0.1, 0.5, 100);
  for (double r = 0.01; r < 60; r *= 1.03) {
    float density[2];
    tables.density(static_cast<float>(r * r), density);
    // Linear between 128 places an octave: the second derivative over 8 * 128^2 is largest where skin has fallen to
    // a millionth of its peak.
    for (int c = 0; c < 2; ++c) {
      EXPECT_NEAR(density[c] / profiles[c].density(r), 1, c == 0 || r < 10 ? 2e-4 : 5e-3) << r;
    }
  }
}

TEST(Subsurface, HalfSpaceLitEvenlyHasTheTotalReflectance) {
  // Samples from far closer than the mean free path (0.46 mm) to far wider apart: one sum holds for all.
  for (const float spacing : {0.1f, 0.3f, 1.f, 3.f, 100.f, 1e5f}) {
    constexpr int cells = 161;
    SurfaceSamples samples;
    add_grid(samples, cells, spacing, 0, 1);
    const float centre = scatter_even(samples, marble)[cells * cells / 2];
    // The part of the plane beyond the square lies between that beyond the discs in and around it.
    const double inner = marble.within(0.5 * cells * spacing), outer = marble.within(0.7072 * cells * spacing);
    EXPECT_GT(centre, inner * 0.995) << spacing;
    EXPECT_LT(centre, outer * 1.005) << spacing;
    if (spacing >= 1) {
      EXPECT_NEAR(centre, marble.total(), 0.005 * marble.total()) << spacing;
    }
  }
}

TEST(Subsurface, ScatteredPointsHaveTheTotalReflectanceToo) {
  // A grid whose points are moved by up to 0.35 of its spacing stands for the irregular samples along seams. The mean
  // must hold; a point may be off by as much as its neighbours' discs miss the plane.
  constexpr int cells = 121;
  for (const float spacing : {0.2f, 0.8f, 4.f}) {
    SurfaceSamples samples;
    add_grid(samples, cells, spacing, 0, 1);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> shift(-0.35f * spacing, 0.35f * spacing);
    for (Eigen::Vector3f& p : samples.positions) p += Eigen::Vector3f(shift(random), 0, shift(random));
    const std::vector<float> even = scatter_even(samples, skin);
    double mean = 0, worst = 0;
    int count = 0;
    for (int j = cells / 2 - 10; j < cells / 2 + 10; ++j)
      for (int i = cells / 2 - 10; i < cells / 2 + 10; ++i, ++count) {
        const double off = even[static_cast<std::size_t>(j) * cells + i] / skin.total() - 1;
        mean += off;
        worst = std::max(worst, std::abs(off));
      }
    EXPECT_NEAR(mean / count, 0, 0.005) << spacing;
    EXPECT_LT(worst, 0.02) << spacing;
  }
}

TEST(Subsurface, SamplesThatStandTogetherCountOnce) {
  // Two charts that overlap: every sample twice, each with half the area.
  SurfaceSamples once, twice;
  add_grid(once, 61, 0.5f, 0, 1);
  twice = once;
  twice.positions.insert(twice.positions.end(), once.positions.begin(), once.positions.end());
  twice.normals.insert(twice.normals.end(), once.normals.begin(), once.normals.end());
  twice.areas.insert(twice.areas.end(), once.areas.begin(), once.areas.end());
  for (float& a : twice.areas) a *= 0.5f;
  for (const ScatterProfile& profile : {marble, ScatterProfile::dipole(1000, 1, 1.3)}) {
    const std::vector<float> a = scatter_even(once, profile), b = scatter_even(twice, profile);
    for (const std::size_t k : {61u * 30 + 30, 61u * 20 + 25}) EXPECT_NEAR(b[k], a[k], 0.01 * profile.total());
  }
}

TEST(Subsurface, SphereHasItsClosedForm) {
  // On a sphere the area within a chord d of a point is pi d^2, as in a plane. So every point gets R's integral over
  // a disc of the sphere's diameter, whatever the profile.
  for (const double radius : {0.5, 5.0, 50.0}) {
    const SurfaceSamples samples = vertices_of(icosphere(5, static_cast<float>(radius)), 4 * pi * radius * radius);
    for (const ScatterProfile& profile : {marble, skin, ScatterProfile::diffusion(0.8, 1)}) {
      const double expected = profile.within(2 * radius);
      for (const float value : scatter_even(samples, profile)) EXPECT_NEAR(value, expected, 0.01 * expected) << radius;
    }
  }
}

TEST(Subsurface, NoMeanFreePathIsDiffuse) {
  // Whatever falls on a sample leaves it there, times the total reflectance.
  const SurfaceSamples samples = vertices_of(icosphere(4, 10), 4 * pi * 100);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> level(0, 1);
  TransferVectors light(samples.size(), 4);
  for (float& value : light.values) value = level(random);
  const ScatterProfile chalk = ScatterProfile::dipole(9e5, 1e5, 1.3);  // a millionth of a millimetre
  const Scattering scattered = scatter_transfer(samples, {light}, {{chalk}});
  for (std::size_t k = 0; k < light.values.size(); ++k)
    EXPECT_NEAR(scattered.transfer[0].values[k], chalk.total() * light.values[k], 1e-3);
  EXPECT_NEAR(scattered.energy[0], chalk.total(), 1e-3);
}

TEST(Subsurface, AVeryLongMeanFreePathIsNearlyUniform) {
  // A ball of 10 mm, half of it lit, mean free path a metre.
  const SurfaceSamples samples = vertices_of(icosphere(4, 10), 4 * pi * 100);
  TransferVectors light(samples.size(), 1);
  for (std::size_t k = 0; k < samples.size(); ++k) light.values[k] = samples.positions[k].y() > 0 ? 1 : 0;
  const Scattering scattered = scatter_transfer(samples, {light}, {{ScatterProfile::dipole(1e-3, 0, 1.3)}});
  const auto [least, most] =
      std::minmax_element(scattered.transfer[0].values.begin(), scattered.transfer[0].values.end());
  EXPECT_GT(*least, 0);
  EXPECT_LT(*most, *least * 1.05);
}

TEST(Subsurface, ExtremesStayFinite) {
  SurfaceSamples samples = vertices_of(icosphere(3, 10), 4 * pi * 100);
  samples.areas[5] = 0;  // a vertex of slivers
  samples.areas[6] = 1e-30f;
  for (const double size : {1e-30, 1e-6, 1e6, 1e30})
    for (const double share : {0.0, 0.5, 1.0})
      for (const ScatterProfile& profile : {ScatterProfile::dipole(size * (1 - share), size * share, 1.5),
                                            ScatterProfile::diffusion(share, 1 / size)}) {
        const Scattering scattered = scatter_transfer(samples, even_light(samples), {{profile}});
        for (const float value : scattered.transfer[0].values) {
          ASSERT_TRUE(std::isfinite(value)) << size << " " << share;
          ASSERT_GE(value, 0);
          ASSERT_LE(value, profile.total() * 1.01 + 1e-12) << size << " " << share;
        }
      }
}

TEST(Subsurface, AThinSlabLetsLightThrough) {
  // Lit from behind alone. A point of the front gets the integral of R over a plane at the slab's thickness d:
  // 2 pi times the integral of R(sqrt(r^2 + d^2)) r dr, which is what of R is beyond d.
  constexpr int cells = 181;
  for (const float thickness : {0.3f, 1.f, 4.f, 60.f}) {
    SurfaceSamples samples;
    add_grid(samples, cells, 0.25f, 0, 1);
    add_grid(samples, cells, 0.25f, -thickness, -1);
    TransferVectors light(samples.size(), 1);
    std::fill(light.values.begin() + cells * cells, light.values.end(), 1.f);
    const float through = scatter_transfer(samples, {light}, {{skin}}).transfer[0].values[cells * cells / 2];
    const double expected = skin.total() - skin.within(thickness);
    // Besides 1 % of the value what the square of 45 mm lacks of a plane: skin's transport length is 1.4 mm.
    EXPECT_NEAR(through, expected, 0.01 * expected + 1e-6) << thickness;
    if (thickness == 1) {
      EXPECT_GT(through, 0.05);
    }
    if (thickness == 60) {
      EXPECT_LT(through, 1e-6);  // opaque
    }
  }
}

TEST(Subsurface, EnergyIsConserved) {
  // A sheet of 0.02 mm lit from both sides: a half space's profile sends all that it gets to either side.
  constexpr int cells = 81;
  SurfaceSamples samples;
  add_grid(samples, cells, 0.25f, 0, 1);
  add_grid(samples, cells, 0.25f, -0.02f, -1);
  const Scattering sheet = scatter_transfer(samples, even_light(samples), {{spectralon}});
  EXPECT_GT(sheet.largest_gain, 1.5);  // without the cap
  EXPECT_GT(sheet.capped_area, 0.8);
  EXPECT_LE(sheet.energy[0], 1.0001);
  EXPECT_GT(sheet.energy[0], 0.95);
  // One side of the sheet is lit; both send out.
  TransferVectors light(samples.size(), 1);
  std::fill(light.values.begin(), light.values.begin() + cells * cells, 1.f);
  EXPECT_LE(scatter_transfer(samples, {light}, {{spectralon}}).energy[0], 1.0001);
  // Convex bodies never come near.
  const Scattering ball = scatter_transfer(vertices_of(icosphere(4, 10), 4 * pi * 100),
                                           even_light(vertices_of(icosphere(4, 10), 1)), {{spectralon}});
  EXPECT_LE(ball.energy[0], 1.0001);
}

/// Makes random light of several coefficients on a bumpy ball.
struct Bumpy {
  SurfaceSamples samples;
  std::vector<TransferVectors> light;

  explicit Bumpy(int coefficients, std::size_t channels = 1) {
    TriangleMesh mesh = icosphere(5, 20);
    for (Eigen::Vector3f& p : mesh.positions)
      p *= 1 + 0.2f * std::sin(0.2f * p.x()) * std::cos(0.25f * p.y()) * std::sin(0.15f * p.z());
    compute_vertex_normals(mesh);
    samples = vertices_of(mesh, surface_area(mesh));
    for (std::size_t c = 0; c < channels; ++c) {
      TransferVectors channel(samples.size(), coefficients);
      for (int i = 0; i < coefficients; ++i)
        for (std::size_t k = 0; k < samples.size(); ++k)
          channel.plane(i)[k] =
              (i == 0 ? 0.3f : 0.f) + 0.2f * std::sin(0.1f * static_cast<float>(i + 1) * samples.positions[k].x()) *
                                          std::max(0.f, samples.normals[k].y()) * static_cast<float>(c + 1);
      light.push_back(std::move(channel));
    }
  }
};

TEST(Subsurface, TheHierarchyIsWithinOnePercentOfEverySample) {
  const Bumpy bumpy(4);
  const std::vector<ScatterProfile> profiles = {marble, skin, ScatterProfile::diffusion(0.8, 2)};
  ScatteringSettings settings, every_sample;
  settings.error_points = 500;
  every_sample.solid_angle = 0;
  const Scattering fast = scatter_transfer(bumpy.samples, bumpy.light, profiles, settings);
  const Scattering exact = scatter_transfer(bumpy.samples, bumpy.light, profiles, every_sample);
  EXPECT_LT(relative_l2(fast.transfer, exact.transfer), 0.01);
  EXPECT_GT(relative_l2(fast.transfer, exact.transfer), 0);
  EXPECT_EQ(exact.hierarchy_error, 0);
  // The result's own estimate, from 500 of 10,242 points, is right within a third.
  EXPECT_NEAR(fast.hierarchy_error / relative_l2(fast.transfer, exact.transfer), 1, 0.33);
}

TEST(Subsurface, SumsOverEverySampleAreTheirDefinition) {
  // A mean free path of several spacings, so that R itself, point by point, is the integrand: written out.
  const Bumpy bumpy(2);
  const ScatterProfile wide = ScatterProfile::dipole(0.15, 0.015, 1.3);
  ScatteringSettings every_sample;
  every_sample.solid_angle = 0;
  const Scattering exact = scatter_transfer(bumpy.samples, bumpy.light, {{wide}}, every_sample);
  const SurfaceSamples& samples = bumpy.samples;
  for (std::size_t p = 0; p < samples.size(); p += 1000)
    for (int i = 0; i < 2; ++i) {
      double sum = 0;
      for (std::size_t q = 0; q < samples.size(); ++q)
        sum += wide.density((samples.positions[p] - samples.positions[q]).norm()) * samples.areas[q] *
               bumpy.light[0].plane(i)[q];
      EXPECT_NEAR(exact.transfer[0].plane(i)[p], sum, 0.005 * std::abs(sum) + 5e-4);
    }
}

TEST(Subsurface, ChannelsAreTheirOwn) {
  const Bumpy bumpy(3, 3);
  const std::vector<ScatterProfile> profiles = {marble, skin, spectralon};
  const Scattering all = scatter_transfer(bumpy.samples, bumpy.light, profiles);
  for (std::size_t c = 0; c < 3; ++c) {
    const Scattering one = scatter_transfer(bumpy.samples, {bumpy.light[c]}, {{profiles[c]}});
    // Tables are the same, so only the order of a few roundings may differ.
    EXPECT_LT(relative_l2(all.transfer[c], one.transfer[0]), 1e-6);
  }
}

TEST(Subsurface, ManyCoefficientsInChunksAreTheSame) {
  const Bumpy many(40);
  TransferVectors few(many.samples.size(), 3);
  for (int i = 0; i < 3; ++i)
    std::copy_n(many.light[0].plane(37 + i).begin(), many.samples.size(), few.plane(i).begin());
  const Scattering all = scatter_transfer(many.samples, many.light, {{marble}});
  const Scattering last = scatter_transfer(many.samples, {few}, {{marble}});
  for (int i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < many.samples.size(); ++k)
      ASSERT_EQ(all.transfer[0].plane(37 + i)[k], last.transfer[0].plane(i)[k]);
}

TEST(Subsurface, AnyNumberOfThreadsGivesTheSameBits) {
  const Bumpy bumpy(4);
  const std::vector<ScatterProfile> profiles = {marble, skin};
  const Scattering many = scatter_transfer(bumpy.samples, bumpy.light, profiles);
  const ThreadLimit one(1);
  const Scattering single = scatter_transfer(bumpy.samples, bumpy.light, profiles);
  for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(many.transfer[c].values, single.transfer[c].values);
  EXPECT_EQ(many.hierarchy_error, single.hierarchy_error);
}

TEST(Subsurface, TexelsHaveTheAtlasAreaWholly) {
  // 37 texels for a chart that ends within texels: what hangs over goes to covered neighbours.
  const TriangleMesh mesh = shapes::plane(5, 3);
  const ReceiverSet receivers = receivers_on_low(mesh, 37, 37, nullptr);
  const std::vector<float> areas = texel_areas(mesh, receivers);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 9, 1e-5);
  // The area of a texel amid the chart is (3 / (0.8 * 37))^2.
  for (std::size_t r = 0; r < areas.size(); ++r) {
    const std::uint32_t i = receivers.slots[r] % 37, j = receivers.slots[r] / 37;
    if (i == 18 && j == 18) {
      EXPECT_NEAR(areas[r], std::pow(3 / (0.8 * 37), 2), 1e-6);
    }
    EXPECT_GT(areas[r], 0);
  }
}

TEST(Subsurface, TexelsProjectedAtAnAngleStandForMore) {
  const TriangleMesh mesh = shapes::plane(5, 3);
  ReceiverSet receivers = receivers_on_low(mesh, 40, 40, nullptr);
  const Eigen::Vector3f tilted = Eigen::Vector3f(std::sqrt(0.75f), 0.5f, 0);
  std::fill(receivers.normals.begin(), receivers.normals.end(), tilted);
  const std::vector<float> areas = texel_areas(mesh, receivers);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), 18, 1e-4);
}

TEST(Subsurface, VerticesHaveTheMeshsArea) {
  const TriangleMesh mesh = icosphere(3, 2);
  const std::vector<float> areas = vertex_areas(mesh, receivers_on_vertices(mesh).receivers);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.0), surface_area(mesh), 1e-4);
}

TEST(Subsurface, NamedMaterialsHaveTheirProfiles) {
  SubsurfaceSettings settings;
  EXPECT_TRUE(subsurface_profiles(settings).empty());
  settings.material = "marble";
  const std::vector<ScatterProfile> dipole = subsurface_profiles(settings);
  ASSERT_EQ(dipole.size(), 3u);
  EXPECT_EQ(dipole[0], marble);
  settings.model = SubsurfaceModel::diffusion;
  const std::vector<ScatterProfile> diffusion = subsurface_profiles(settings);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(diffusion[c].total(), dipole[c].total(), 1e-12);
  EXPECT_EQ(diffusion[0], ScatterProfile::diffusion(marble.total(), 1 / 2.1921));
  settings = {
      .material = "custom", .scattering = {{2.19, 2.19, 2.19}}, .absorption = {{0.0021, 0.0021, 0.0021}}, .eta = 1.5};
  EXPECT_EQ(subsurface_profiles(settings), std::vector<ScatterProfile>{marble});
}

TEST(Subsurface, TexelsScatterInMillimetres) {
  // A square of two units as a chart of 80 texels a side, of which the high mesh has 1.2 times the area.
  const TriangleMesh mesh = shapes::plane(4, 2);
  const ReceiverSet receivers = receivers_on_low(mesh, 100, 100, nullptr);
  std::vector<TransferVectors> even = {TransferVectors(receivers.slots.size(), 1)};
  std::fill(even[0].values.begin(), even[0].values.end(), 0.5f);
  SubsurfaceSettings settings = {.material = "custom", .scattering = {{8, 4, 2}}, .absorption = {{0.4, 0.2, 0.1}}};
  settings.mm_per_unit = 50;  // 100 mm, mean free paths under a millimetre
  std::vector<TransferVectors> channels = even;
  const SubsurfaceReport report = scatter_beneath({receivers, mesh, false, 4.8}, settings, channels);
  EXPECT_NEAR(report.area_correction, 1.2, 1e-4);
  EXPECT_NEAR(report.area_mm2, 4.8 * 50 * 50, 1);
  ASSERT_EQ(channels.size(), 3u);
  // The same albedo in all three, so the same reflectance; texels that a fifth too much area stands on matter little,
  // because what is near is scaled to a plane's.
  const auto middle = static_cast<std::size_t>(
      std::find(receivers.slots.begin(), receivers.slots.end(), 50u * 100 + 50) - receivers.slots.begin());
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(report.reflectance[c], report.reflectance[0], 1e-12);
    EXPECT_NEAR(channels[c].plane(0)[middle], 0.5 * report.reflectance[c], 0.1 * report.reflectance[c]);
  }
  // Another mesh's area is not this surface's.
  channels = even;
  EXPECT_EQ(scatter_beneath({receivers, mesh, false, 40}, settings, channels).area_correction, 1);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(channels[c].plane(0)[middle], 0.5 * report.reflectance[c], 0.01 * report.reflectance[c]);
}

}  // namespace test_subsurface
}  // namespace kiln
