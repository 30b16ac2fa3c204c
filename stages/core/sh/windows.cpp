#include "sh/windows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

/// A function on the sphere whose bands can be weighted anew without evaluating it anew.
class BandedFunction {
 public:
  explicit BandedFunction(std::span<const float> coefficients)
      : coefficients_(coefficients.begin(), coefficients.end()),
        basis_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size()))))) {
    // A dozen directions for each coefficient: the distance between them is a fifth of the shortest wave.
    const int count = 64 + 12 * basis_.size();
    for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, count, 1)) {
      directions_.push_back(direction.cast<double>().normalized());
      bands_of_.push_back(bands_at(directions_.back()));
    }
    spacing_ = std::sqrt(4 * std::numbers::pi / count);
    for (const double c : coefficients_) largest_ = std::max(largest_, std::abs(c));
  }

  double minimum(std::span<const double> window) const {
    std::vector<std::pair<double, std::size_t>> values;
    for (std::size_t s = 0; s < directions_.size(); ++s) values.emplace_back(weighted(bands_of_[s], window), s);
    const std::size_t starts = std::min<std::size_t>(8, values.size());
    std::partial_sort(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(starts), values.end());
    double least = values[0].first;
    for (std::size_t i = 0; i < starts; ++i)
      least = std::min(least, downhill(directions_[values[i].second], values[i].first, window));
    return least;
  }
  double largest_coefficient() const { return largest_; }

 private:
  std::vector<double> bands_at(const Eigen::Vector3d& direction) const {
    std::vector<double> values(basis_.size()), bands(basis_.bands(), 0.0);
    basis_.evaluate<double>(direction, values);
    for (int l = 0, i = 0; l < basis_.bands(); ++l)
      for (; i < (l + 1) * (l + 1); ++i) bands[l] += coefficients_[i] * values[i];
    return bands;
  }
  static double weighted(const std::vector<double>& bands, std::span<const double> window) {
    double sum = 0;
    for (std::size_t l = 0; l < bands.size(); ++l) sum += window[l] * bands[l];
    return sum;
  }
  /// Pattern search in the tangent plane.
  double downhill(Eigen::Vector3d at, double value, std::span<const double> window) const {
    for (double step = 0.5 * spacing_; step > 1e-4 * spacing_; step *= 0.5) {
      const Eigen::Vector3d u = at.unitOrthogonal(), v = at.cross(u);
      for (const Eigen::Vector3d& move : {u, Eigen::Vector3d(-u), v, Eigen::Vector3d(-v)}) {
        const Eigen::Vector3d trial = (at + step * move).normalized();
        const double there = weighted(bands_at(trial), window);
        if (there < value) {
          value = there;
          at = trial;
        }
      }
    }
    return value;
  }

  std::vector<double> coefficients_;
  ShBasis basis_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<std::vector<double>> bands_of_;  ///< of each direction: what each band adds
  double spacing_ = 0, largest_ = 0;
};

std::vector<double> laplacian_window(int bands, double strength) {
  std::vector<double> window(bands);
  for (int l = 0; l < bands; ++l) window[l] = 1 / (1 + strength * l * l * (l + 1.0) * (l + 1.0));
  return window;
}

}  // namespace

std::vector<double> hann_window(int bands) {
  std::vector<double> window(bands);
  for (int l = 0; l < bands; ++l) window[l] = 0.5 * (1 + std::cos(std::numbers::pi * l / bands));
  return window;
}

std::vector<double> lanczos_window(int bands) {
  std::vector<double> window(bands, 1.0);
  for (int l = 1; l < bands; ++l) window[l] = std::sin(std::numbers::pi * l / bands) / (std::numbers::pi * l / bands);
  return window;
}

double smallest_value(std::span<const float> coefficients) {
  const BandedFunction function(coefficients);
  const auto bands = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(coefficients.size()))));
  return function.minimum(std::vector<double>(bands, 1.0));
}

std::vector<double> deringing_window(const LightCoefficients& light) {
  double needed = 0;  // strength
  for (const std::vector<float>& channel : light.channels) {
    if (!(channel[0] > 0)) continue;
    const BandedFunction function(channel);
    const double tolerance = 1e-6 * function.largest_coefficient();
    const auto rings = [&](double strength) {
      return function.minimum(laplacian_window(light.bands, strength)) < -tolerance;
    };
    if (!rings(needed)) continue;
    double weak = needed, strong = std::max(1e-3, needed);
    while (rings(strong)) weak = std::exchange(strong, 2 * strong);
    while (strong - weak > 1e-3 * strong) {
      const double middle = 0.5 * (weak + strong);
      (rings(middle) ? weak : strong) = middle;
    }
    needed = strong;
  }
  return laplacian_window(light.bands, needed);
}

void apply_window(LightCoefficients& light, std::span<const double> window) {
  assert(static_cast<int>(window.size()) == light.bands);
  for (std::vector<float>& channel : light.channels)
    for (std::size_t i = 0; i < channel.size(); ++i)
      channel[i] = static_cast<float>(channel[i] * window[static_cast<std::size_t>(band_of(static_cast<int>(i)))]);
}

void apply_window(LightCoefficients& light, LightWindow window) {
  switch (window) {
    case LightWindow::none:
      return;
    case LightWindow::hann:
      return apply_window(light, hann_window(light.bands));
    case LightWindow::lanczos:
      return apply_window(light, lanczos_window(light.bands));
    case LightWindow::dering:
      return apply_window(light, deringing_window(light));
  }
}

}  // namespace kiln
