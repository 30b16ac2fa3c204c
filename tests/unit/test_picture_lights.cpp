// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "sh/basis.h"
#include "sh/lights.h"

namespace kiln {
namespace test_picture_lights {

constexpr std::array<float, 1> white = {1};
constexpr double half_turn = std::numbers::pi;

void expect_equal(const LightCoefficients& light, const LightCoefficients& expected) {
  ASSERT_EQ(light.bands, expected.bands);
  // Both are rounded to float; band 0 of a furnace is 3.5.
  for (std::size_t i = 0; i < expected.channels[0].size(); ++i)
    EXPECT_NEAR(light.channels[0][i], expected.channels[0][i], 2e-6) << i;
}

LightCoefficients picture(int bands, int width, int height, const std::vector<float>& pixels) {
  return latitude_longitude_light(bands, width, height, 1, pixels);
}

TEST(LatitudeLongitude, OnePixelIsAnEvenSky) {
  for (const int bands : {1, 2, 3, 5, 8, 10, 24, 65})
    expect_equal(picture(bands, 1, 1, {1}), constant_light(bands, white));
}

TEST(LatitudeLongitude, HalvesOfTheSkyAreCapsOfAQuarterTurn) {
  for (const int bands : {1, 3, 6, 24}) {
    const auto half = [&](const Eigen::Vector3f& axis) { return cone_light(bands, axis, half_turn / 2, white); };
    // Azimuths of the picture go from -Z over +X to +Z; rows from the bottom.
    expect_equal(picture(bands, 2, 1, {1, 0}), half(-Eigen::Vector3f::UnitZ()));
    expect_equal(picture(bands, 2, 1, {0, 1}), half(Eigen::Vector3f::UnitZ()));
    expect_equal(picture(bands, 1, 2, {1, 0}), half(-Eigen::Vector3f::UnitY()));
    expect_equal(picture(bands, 1, 2, {0, 1}), half(Eigen::Vector3f::UnitY()));
    expect_equal(picture(bands, 4, 1, {0, 1, 1, 0}), half(Eigen::Vector3f::UnitX()));
  }
}

TEST(LatitudeLongitude, RowsAreDifferencesOfCaps) {
  // Three rows: caps of 60 degrees around both poles, and what they leave.
  const double third = half_turn / 3;
  const double brightness = 1 / (std::sin(third) * std::sin(third));
  const auto cap = [&](float y) { return scale_light(cone_light(9, {0, y, 0}, third, white), 1 / brightness); };
  expect_equal(picture(9, 1, 3, {1, 0, 0}), cap(-1));
  expect_equal(picture(9, 1, 3, {0, 0, 1}), cap(1));
  expect_equal(picture(9, 1, 3, {0, 1, 0}),
               add_lights(constant_light(9, white), scale_light(add_lights(cap(-1), cap(1)), -1)));
}

TEST(LatitudeLongitude, OctantHasTheMomentsOfAnOctant) {
  // 4 x 2: the octant x > 0, y > 0, z > 0 is column 2 of the upper row. Its solid angle is pi / 2, the integrals of x,
  // y and z are pi / 4 each, of xy, yz and xz 1/3 each.
  std::vector<float> pixels(8, 0.f);
  pixels[4 + 2] = 1;
  const LightCoefficients light = picture(3, 4, 2, pixels);
  const double y1 = std::sqrt(3 / (4 * half_turn)) * half_turn / 4, y2 = std::sqrt(15 / (4 * half_turn)) / 3;
  const std::array<double, 9> expected = {std::sqrt(1 / (4 * half_turn)) * half_turn / 2, y1, y1, y1, y2, y2, 0, y2, 0};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(light.channels[0][i], expected[i], 1e-6) << i;
}

TEST(LatitudeLongitude, PixelsOfManyAreThoseOfFewCutUp) {
  const std::vector<float> few = {3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8};  // 4 x 3
  std::vector<float> many;
  for (int j = 0; j < 21; ++j)
    for (int i = 0; i < 20; ++i) many.push_back(few[static_cast<std::size_t>(j / 7 * 4 + i / 5)]);
  const LightCoefficients coarse = picture(8, 4, 3, few), fine = picture(8, 20, 21, many);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(coarse.channels[0][i], fine.channels[0][i], 1e-5) << i;
}

/// Makes a cube map that holds `value(face, i, j)`.
template <class Value>
LightCoefficients cube(int bands, int size, const Value& value) {
  std::array<std::vector<float>, 6> texels;
  std::array<std::span<const float>, 6> faces;
  for (int face = 0; face < 6; ++face) {
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) texels[face].push_back(value(face, i, j));
    faces[face] = texels[face];
  }
  return cube_map_light(bands, size, 1, faces);
}

TEST(CubeMap, EvenOneIsAnEvenSky) {
  for (const int bands : {1, 3, 5, 10, 24})
    for (const int size : {1, 2, 3, 16}) {
      const LightCoefficients light = cube(bands, size, [](int, int, int) { return 1.f; });
      const LightCoefficients expected = constant_light(bands, white);
      // The rules err by 1e-7 of a texel's radiance, and there are six faces of two steradians.
      for (std::size_t i = 0; i < expected.channels[0].size(); ++i)
        EXPECT_NEAR(light.channels[0][i], expected.channels[0][i], 3e-6) << bands << ", " << size << ", " << i;
    }
}

TEST(CubeMap, HalfTheSkyIsACapOfAQuarterTurn) {
  // x > 0: all of +X, and of the faces around it the half that lies there.
  const LightCoefficients light = cube(10, 2, [](int face, int i, int) {
    return face == 0 || (face != 1 && (face == 5 ? i == 0 : i == 1)) ? 1.f : 0.f;
  });
  expect_equal(light, cone_light(10, Eigen::Vector3f::UnitX(), half_turn / 2, white));
}

TEST(CubeMap, TexelsOfManyAreThoseOfFewCutUp) {
  const auto value = [](int face, int i, int j) { return static_cast<float>((7 * face + 3 * i + 5 * j) % 11); };
  const LightCoefficients coarse = cube(8, 3, value),
                          fine = cube(8, 12, [&](int face, int i, int j) { return value(face, i / 4, j / 4); });
  for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(coarse.channels[0][i], fine.channels[0][i], 3e-5) << i;
}

}  // namespace test_picture_lights
}  // namespace kiln
