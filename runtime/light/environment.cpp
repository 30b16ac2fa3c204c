// SPDX-License-Identifier: MIT
#include "runtime/light/environment.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>

#include "base/errors.h"
#include "image/image_file.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

/// Reads red, green and blue of a grey, RGB or RGBA picture.
Image<float> read_colors(const std::filesystem::path& file) {
  const Image<float> picture = read_float_image(file);
  const auto fail = [&](const std::string& found, const std::string& expected) {
    throw BadInput(file.string(), found, expected, "choose another environment");
  };
  if (picture.channels() < 1 || picture.channels() > 4)
    fail("has " + std::to_string(picture.channels()) + " channels", "a grey, RGB or RGBA picture");
  Image<float> colors(picture.width(), picture.height(), 3);
  for (int j = 0; j < picture.height(); ++j)
    for (int i = 0; i < picture.width(); ++i)
      for (int c = 0; c < 3; ++c) {
        const float value = picture.at(i, j, picture.channels() >= 3 ? c : 0);
        if (!std::isfinite(value) || value < 0)
          throw BadInput(
              file.string(),
              fmt::format("has {:.6g} in channel {} of pixel ({}, {}), counted from 0 at the upper left", value,
                          picture.channels() >= 3 ? std::string(1, "RGB"[c]) : "Y", i, picture.height() - 1 - j),
              "radiance of 0 or more, finite",
              "clamp the picture, for instance `oiiotool " + file.filename().string() +
                  " --fixnan box3 --clamp:min=0 -o clamped.exr`, or choose another environment");
        colors.at(i, j, c) = value;
      }
  return colors;
}

/// Turns a light about +Y.
LightCoefficients turned(const LightCoefficients& light, double rotation_degrees) {
  if (rotation_degrees == 0) return light;
  const Eigen::AngleAxisd turn(rotation_degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY());
  return ShRotation(light.bands, turn.toRotationMatrix())(light);
}

/// Reads the six faces in a folder, rows from the top, as OpenGL orders them.
LightCoefficients load_cube_map(const std::filesystem::path& folder, int bands, double rotation_degrees) {
  std::array<std::vector<float>, 6> faces;
  std::array<std::span<const float>, 6> views;
  int size = 0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const std::string name = std::array{"px", "nx", "py", "ny", "pz", "nz"}[k];
    std::filesystem::path file = folder / (name + ".exr");
    if (!std::filesystem::exists(file)) file = folder / (name + ".hdr");
    if (!std::filesystem::exists(file))
      throw BadInput(folder.string(), "has no " + name + ".exr or " + name + ".hdr", "six faces of a cube map",
                     "add the face, or name a latitude-longitude picture");
    const Image<float> face = read_colors(file);
    if (k == 0) size = face.width();
    if (face.width() != size || face.height() != size)
      throw BadInput(file.string(), "is " + std::to_string(face.width()) + " x " + std::to_string(face.height()),
                     std::to_string(size) + " x " + std::to_string(size) + ", as all faces are",
                     "choose another cube map");
    for (int j = size - 1; j >= 0; --j)
      for (int i = 0; i < size; ++i)
        for (int c = 0; c < 3; ++c) faces[k].push_back(face.at(i, j, c));
    views[k] = faces[k];
  }
  return turned(cube_map_light(bands, size, 3, views), rotation_degrees);
}

}  // namespace

LightCoefficients load_environment(const std::filesystem::path& file, int bands, double rotation_degrees) {
  if (std::filesystem::is_directory(file)) return load_cube_map(file, bands, rotation_degrees);
  const Image<float> colors = read_colors(file);
  return turned(latitude_longitude_light(bands, colors.width(), colors.height(), 3, colors.values()), rotation_degrees);
}

}  // namespace kiln
