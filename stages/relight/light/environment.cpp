#include "relight/light/environment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/errors.h"
#include "image/image_file.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

/// A width that is ample for 24 bands, whose finest waves are 1/23 of a turn long.
constexpr int ample_width = 1024;

/// Red, green and blue of a grey, RGB or RGBA picture.
Image<float> read_colours(const std::filesystem::path& file) {
  const Image<float> picture = read_float_image(file);
  const auto fail = [&](const std::string& found, const std::string& expected) {
    throw BadInput(file.string(), found, expected, "choose another environment");
  };
  if (picture.channels() < 1 || picture.channels() > 4)
    fail("has " + std::to_string(picture.channels()) + " channels", "a grey, RGB or RGBA picture");
  Image<float> colours(picture.width(), picture.height(), 3);
  for (int j = 0; j < picture.height(); ++j)
    for (int i = 0; i < picture.width(); ++i)
      for (int c = 0; c < 3; ++c) {
        const float value = picture.at(i, j, picture.channels() >= 3 ? c : 0);
        if (!std::isfinite(value)) fail("has a pixel that is no finite number", "finite radiance");
        colours.at(i, j, c) = value;
      }
  return colours;
}

/// Means over squares of `factor` x `factor` pixels, weighted by their solid angle, so that no light is lost or won.
Image<float> reduce(const Image<float>& fine, int factor) {
  Image<float> coarse(fine.width() / factor, fine.height() / factor, 3);
  const auto height_at = [&](int row) {
    return std::sin(std::numbers::pi * (static_cast<double>(row) / fine.height() - 0.5));
  };
  for (int j = 0; j < fine.height(); ++j) {
    const int first = j / factor * factor;
    const double share = (height_at(j + 1) - height_at(j)) / (height_at(first + factor) - height_at(first)) / factor;
    for (int i = 0; i < fine.width(); ++i)
      for (int c = 0; c < 3; ++c) coarse.at(i / factor, j / factor, c) += static_cast<float>(share) * fine.at(i, j, c);
  }
  return coarse;
}

/// Columns moved to the left by `turns` of the width, cyclically, linear between columns.
Image<float> turn(const Image<float>& image, double turns) {
  const double shift = (turns - std::floor(turns)) * image.width();
  const int whole = static_cast<int>(shift);
  const auto fraction = static_cast<float>(shift - whole);
  Image<float> turned(image.width(), image.height(), 3);
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i)
      for (int c = 0; c < 3; ++c)
        turned.at(i, j, c) = (1 - fraction) * image.at((i + whole) % image.width(), j, c) +
                             fraction * image.at((i + whole + 1) % image.width(), j, c);
  return turned;
}

/// The six faces of a folder, rows from the top, as OpenGL has them.
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
    const Image<float> face = read_colours(file);
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
  const LightCoefficients light = cube_map_light(bands, size, 3, views);
  const Eigen::AngleAxisd turn(rotation_degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY());
  return rotation_degrees == 0 ? light : ShRotation(bands, turn.toRotationMatrix())(light);
}

}  // namespace

LightCoefficients load_environment(const std::filesystem::path& file, int bands, double rotation_degrees) {
  if (std::filesystem::is_directory(file)) return load_cube_map(file, bands, rotation_degrees);
  Image<float> colours = read_colours(file);
  int factor = 1;
  while (colours.width() % (2 * factor) == 0 && colours.height() % (2 * factor) == 0 &&
         colours.width() / (2 * factor) >= ample_width)
    factor *= 2;
  if (factor > 1) colours = reduce(colours, factor);
  // The azimuth (0 is +Z, 90 is +X) runs to the left in the picture.
  if (rotation_degrees != 0) colours = turn(colours, rotation_degrees / 360);
  return latitude_longitude_light(bands, colours.width(), colours.height(), 3, colours.values());
}

}  // namespace kiln
