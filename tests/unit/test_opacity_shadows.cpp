// SPDX-License-Identifier: GPL-3.0-or-later
// Shadows of surfaces that are not opaque everywhere, against closed forms, by every backend.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

#include "bake/bake.h"
#include "image/image_file.h"
#include "material/surroundings.h"
#include "scratch.h"

namespace kiln {
namespace test_opacity_shadows {

constexpr double unoccluded = 0.28209479;  // t_0 of a receiver under the open sky

class OpacityShadows : public testing::TestWithParam<BakeBackend> {
 protected:
  /// Writes a square card of half-size a in the plane y = 0, which looks down, with a round hole of radius r in its
  /// middle. The picture of the hole is seen `repeats` times along either side.
  std::string card(double a, double r, int repeats = 1) const {
    constexpr int side = 128;
    Image<std::uint8_t> picture(side, side, 1);
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double texels = std::hypot(i + 0.5 - side / 2, j + 0.5 - side / 2) - r / (2 * a) * side * repeats;
        picture.at(i, j) = static_cast<std::uint8_t>(std::lround(255 * std::clamp(0.5 + texels / 4, 0.0, 1.0)));
      }
    write_png(scratch_ / "hole.png", picture);
    std::ofstream(scratch_ / "card.mtl") << "newmtl m\nKd 0.5 0.5 0.5\nmap_d hole.png\n";
    const std::filesystem::path file = scratch_ / "card.obj";
    std::ofstream obj(file);
    obj << "mtllib card.mtl\nusemtl m\n";
    for (const auto& [x, z] : {std::pair(-a, -a), {a, -a}, {a, a}, {-a, a}})
      obj << "v " << x << " 0 " << z << "\nvt " << (0.5 + x / (2 * a)) * repeats << ' ' << (0.5 + z / (2 * a)) * repeats
          << '\n';
    obj << "f 1/1 2/2 3/3 4/4\n";
    return file.string();
  }

  /// Fewer for depth maps, of which software draws a hundred a second.
  static int directions() { return GetParam() == BakeBackend::egl ? 1024 : 16384; }

  /// Difference that is the quadrature's at a shadow's edge: some 1e-3 of the sky with 16,384 directions. It falls by
  /// about the power 3/4 of their number, as that of lattices does, so 1,024 have up to 8 times as much.
  static double tolerance() { return GetParam() == BakeBackend::egl ? 0.006 : 0.0015; }

  /// Bakes t_0 of a point at the origin that looks up.
  static double constant_term(const std::string& neighbour) {
    std::vector<TriangleMesh> meshes;
    for (PlacedMesh& placed : load_surroundings({.place = {}, .ground = {}, .neighbours = {neighbour}},
                                                {{-1, -1, -1}, {1, 1, 1}}, {}, false))
      meshes.push_back(std::move(placed.mesh));
    ReceiverSet receivers{1, 1, {0}, {Eigen::Vector3f::Zero()}, {Eigen::Vector3f::UnitY()}};
    BakeSettings settings;
    settings.bands = 1;
    settings.directions = directions();
    settings.backend = GetParam();
    const Occluders occluders = join_occluders(meshes);
    return bake({receivers, occluders, settings, 1, 2}).channels.front().plane(0)[0];
  }

  /// Share of the cosine-weighted sky behind a square of half-size a at height h (Howell, "A catalog of radiation heat
  /// transfer configuration factors", B-4, four times).
  static double square(double a, double h) {
    const double x = a / h, root = std::sqrt(1 + x * x);
    return 4 / (2 * std::numbers::pi) * 2 * x / root * std::atan(x / root);
  }

 private:
  Scratch scratch_;
};

/// Leaves out depth maps, for which software takes eight seconds and more.
class OpacityShadowsByRays : public OpacityShadows {};

TEST_P(OpacityShadows, AHoleLetsItsShareOfTheSkyThrough) {
  // A disc of radius r at height h is r^2 / (r^2 + h^2) of what a surface below its middle sees.
  for (const double h : GetParam() == BakeBackend::egl ? std::vector{0.5} : std::vector{0.5, 1.5}) {
    const double r = 0.6, hidden = square(2, h) - r * r / (r * r + h * h);
    const std::string place = ";place=0," + std::to_string(h) + ",0";
    EXPECT_NEAR(constant_term(card(2, r) + place), unoccluded * (1 - hidden), tolerance()) << h;
    EXPECT_NEAR(constant_term(card(2, r) + place + ";opacity=none"), unoccluded * (1 - square(2, h)), tolerance()) << h;
  }
}

TEST_P(OpacityShadowsByRays, ASieveLetsItsOpenShareThrough) {
  // 12 x 12 holes that are 40 % of the card, many of which the directions see: what the card hides scales with the
  // rest.
  const double a = 2, h = 1, r = a / 12 * std::sqrt(4 * 0.4 / std::numbers::pi);
  EXPECT_NEAR(constant_term(card(a, r, 12) + ";place=0," + std::to_string(h) + ",0"),
              unoccluded * (1 - 0.6 * square(a, h)), 2 * tolerance());
}

INSTANTIATE_TEST_SUITE_P(Backends, OpacityShadows,
                         testing::Values(BakeBackend::beams, BakeBackend::embree, BakeBackend::egl),
                         [](const auto& backend) { return backend_name(backend.param); });

INSTANTIATE_TEST_SUITE_P(Backends, OpacityShadowsByRays, testing::Values(BakeBackend::beams, BakeBackend::embree),
                         [](const auto& backend) { return backend_name(backend.param); });

}  // namespace test_opacity_shadows
}  // namespace kiln
