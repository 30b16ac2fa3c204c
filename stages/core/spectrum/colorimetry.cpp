// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/colorimetry.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace kiln {

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Returns the angle of a hue in degrees, 0 to 360; 0 for grey.
double hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double degrees = std::atan2(b, a) * 180 / std::numbers::pi;
  return degrees < 0 ? degrees + 360 : degrees;
}

/// Returns the matrix to linear colours of primaries with these chromaticities, in which the white is 1, 1, 1.
Eigen::Matrix3d rgb_from_xyz(const Eigen::Vector2d& red, const Eigen::Vector2d& green, const Eigen::Vector2d& blue,
                             const Xyz& white) {
  Eigen::Matrix3d primaries;
  primaries << red.x(), green.x(), blue.x(), red.y(), green.y(), blue.y(), 1 - red.sum(), 1 - green.sum(),
      1 - blue.sum();
  const Eigen::Vector3d scale = primaries.inverse() * white;
  return (primaries * scale.asDiagonal()).inverse();
}

}  // namespace

Xyz xyz_of(const Spectrum& light, const SpectrumMatrix& observer) { return observer.transpose() * light.matrix(); }

Lab lab_of(const Xyz& color, const Xyz& white) {
  const auto f = [](double t) {
    constexpr double knee = 6.0 / 29;
    return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
  };
  const double x = f(color.x() / white.x()), y = f(color.y() / white.y()), z = f(color.z() / white.z());
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double ciede2000(const Lab& first, const Lab& second) {
  const auto rises = [](double chroma) {
    const double seventh = std::pow(chroma, 7);
    return std::sqrt(seventh / (seventh + std::pow(25.0, 7)));
  };
  const double mean_given_chroma = (std::hypot(first.y(), first.z()) + std::hypot(second.y(), second.z())) / 2;
  const double stretch = 1 + (1 - rises(mean_given_chroma)) / 2;
  const double a1 = first.y() * stretch, a2 = second.y() * stretch;
  const double c1 = std::hypot(a1, first.z()), c2 = std::hypot(a2, second.z());
  const double h1 = hue(a1, first.z()), h2 = hue(a2, second.z());
  const bool is_grey = c1 * c2 == 0;

  double turn = is_grey ? 0 : h2 - h1;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  const double lightness = second.x() - first.x();
  const double chroma = c2 - c1;
  const double hue_difference = 2 * std::sqrt(c1 * c2) * std::sin(radians(turn / 2));

  const double l = (first.x() + second.x()) / 2, c = (c1 + c2) / 2;
  double h = h1 + h2;
  if (!is_grey) {
    if (std::abs(h1 - h2) > 180) h += h < 360 ? 360 : -360;
    h /= 2;
  }
  const double t = 1 - 0.17 * std::cos(radians(h - 30)) + 0.24 * std::cos(radians(2 * h)) +
                   0.32 * std::cos(radians(3 * h + 6)) - 0.20 * std::cos(radians(4 * h - 63));
  const double middle = (l - 50) * (l - 50);
  const double sl = 1 + 0.015 * middle / std::sqrt(20 + middle), sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  const double rotation = -2 * rises(c) * std::sin(radians(60 * std::exp(-std::pow((h - 275) / 25, 2))));
  const double dl = lightness / sl, dc = chroma / sc, dh = hue_difference / sh;
  return std::sqrt(std::max(0.0, dl * dl + dc * dc + dh * dh + rotation * dc * dh));
}

Eigen::Matrix3d srgb_from_xyz(const Xyz& white) {
  return rgb_from_xyz({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, white);
}

Eigen::Matrix3d bt2020_from_xyz(const Xyz& white) {
  return rgb_from_xyz({0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, white);
}

}  // namespace kiln
