// SPDX-License-Identifier: MIT
#include "sh/windows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

/// Function on the sphere whose bands can be weighted anew without evaluating the basis again.
class BandedFunction {
 public:
  explicit BandedFunction(std::span<const float> coefficients)
      : coefficients_(coefficients.begin(), coefficients.end()),
        basis_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size()))))) {
    // A dozen directions per coefficient: their spacing is a fifth of the shortest wave.
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
  /// Descends to a local minimum, by pattern search in the tangent plane.
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
  std::vector<std::vector<double>> bands_of_;  ///< per direction: what each band adds
  double spacing_ = 0, largest_ = 0;
};

std::vector<double> laplacian_window(int bands, double strength) {
  std::vector<double> window(bands);
  for (int l = 0; l < bands; ++l) window[l] = 1 / (1 + strength * l * l * (l + 1.0) * (l + 1.0));
  return window;
}

/// Finds the least strength, at least `weakest`, at which nothing rings, to a thousandth of it.
double least_strength(double weakest, const std::function<bool(double)>& rings) {
  if (!rings(weakest)) return weakest;
  double weak = weakest, strong = std::max(1e-3, weakest);
  while (rings(strong)) weak = std::exchange(strong, 2 * strong);
  while (strong - weak > 1e-3 * strong) {
    const double middle = 0.5 * (weak + strong);
    (rings(middle) ? weak : strong) = middle;
  }
  return strong;
}

/// Returns the sum over l of terms_l P_l(x).
double legendre_sum(std::span<const double> terms, double x) {
  double sum = 0, before = 0, p = 1;  // P_(l-1) and P_l
  for (std::size_t l = 0; l < terms.size(); ++l) {
    sum += terms[l] * p;
    const auto order = static_cast<double>(l);
    before = std::exchange(p, ((2 * order + 1) * x * p - order * before) / (order + 1));
  }
  return sum;
}

/// Finds the least value of a function around an axis: the least of many places on a meridian, refined between its
/// neighbours.
double least_on_meridian(std::span<const double> terms) {
  const auto places = 32 * terms.size() + 32;  // the shortest wave takes more than 32 places
  const double step = std::numbers::pi / static_cast<double>(places);
  const auto value = [&](double angle) { return legendre_sum(terms, std::cos(angle)); };
  double least = value(0), best = 0;
  for (std::size_t k = 1; k <= places; ++k)
    if (const double here = value(step * static_cast<double>(k)); here < least) {
      least = here;
      best = step * static_cast<double>(k);
    }
  double low = best - step, high = best + step;
  for (int round = 0; round < 40; ++round) {  // thirds, down to 1e-7 of a step
    const double third = (high - low) / 3;
    if (value(low + third) < value(high - third))
      high -= third;
    else
      low += third;
  }
  return std::min(least, value(0.5 * (low + high)));
}

/// Finds the deringing_window of a light around an axis.
std::vector<double> axial_deringing_window(std::span<const double> zonal) {
  const int bands = static_cast<int>(zonal.size());
  std::vector<double> terms(zonal.size());
  const auto least = [&](double strength) {
    const std::vector<double> window = laplacian_window(bands, strength);
    for (std::size_t l = 0; l < terms.size(); ++l) terms[l] = window[l] * zonal[l] * (2 * static_cast<double>(l) + 1);
    return least_on_meridian(terms);
  };
  const double tolerance = 1e-6 * zonal[0];
  return laplacian_window(bands, least_strength(0, [&](double strength) { return least(strength) < -tolerance; }));
}

/// Returns the window of a number of bands; `dering` computes the deringing one.
std::vector<double> chosen_window(LightWindow window, int bands, const std::function<std::vector<double>()>& dering) {
  switch (window) {
    case LightWindow::hann:
      return hann_window(bands);
    case LightWindow::lanczos:
      return lanczos_window(bands);
    case LightWindow::dering:
      return dering();
    case LightWindow::none:
      break;
  }
  return std::vector<double>(static_cast<std::size_t>(bands), 1.0);
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
    needed = least_strength(needed, rings);
  }
  return laplacian_window(light.bands, needed);
}

void apply_window(LightCoefficients& light, std::span<const double> window) {
  assert(static_cast<int>(window.size()) == light.bands);
  for (std::vector<float>& channel : light.channels)
    for (std::size_t i = 0; i < channel.size(); ++i)
      channel[i] = static_cast<float>(channel[i] * window[static_cast<std::size_t>(band_of(static_cast<int>(i)))]);
}

double facing_radiance(std::span<const double> zonal) {
  const std::vector<double> cosine = clamped_cosine_bands(static_cast<int>(zonal.size()));
  double sum = 0;
  for (std::size_t l = 0; l < zonal.size(); ++l) sum += zonal[l] * cosine[l] * (2 * static_cast<double>(l) + 1);
  return sum / (4 * std::numbers::pi * std::numbers::pi);
}

std::vector<double> axial_weights(std::span<const double> zonal, LightWindow window, double facing) {
  std::vector<double> weights =
      chosen_window(window, static_cast<int>(zonal.size()), [&] { return axial_deringing_window(zonal); });
  std::vector<double> left(zonal.begin(), zonal.end());
  for (std::size_t l = 0; l < left.size(); ++l) left[l] *= weights[l];
  const double scale = facing / facing_radiance(left);
  for (double& weight : weights) weight *= scale;
  return weights;
}

std::vector<double> window_weights(const LightCoefficients& light, LightWindow window) {
  return chosen_window(window, light.bands, [&] { return deringing_window(light); });
}

}  // namespace kiln
