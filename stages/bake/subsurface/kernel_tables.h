// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scatter/profile.h"

namespace kiln {

/// Scattering profiles of several channels, tabulated for the sums over surface samples. A sample is a disc on the
/// surface; distances and radii in mm, results in 1/mm^2.
class KernelTables {
 public:
  /// Tabulates for discs of `least_radius` to `most_radius` and distances up to `farthest`, all above 0.
  KernelTables(std::span<const ScatterProfile> profiles, double least_radius, double most_radius, double farthest);

  std::size_t channels() const { return channels_; }

  /// Returns R(r), within 1e-4 where R is not tiny.
  void density(float squared_distance, float* values) const;

  /// Returns the mean of R over a disc whose centre is `distance` away in its own plane. What a disc's own centre gets
  /// from it is so the integral over the disc, however much shorter than the disc the mean free path is.
  void disc_mean(float radius, float distance, float* values) const;

  /// Distance in radii beyond which a disc is as good as a point.
  static constexpr float disc_reach = 8;

  /// Returns the part of R that is summed as near: all of it up to near_flat of near_reach radii, which takes in the
  /// samples next to a disc's, then a smooth step to nothing at near_reach radii.
  static float near_share(float distance, float radius);
  static constexpr float near_reach = 8;
  static constexpr float near_flat = 0.4f;

  /// Returns the integral of near_share R over the plane, no unit.
  void near_total(float radius, float* values) const;

 private:
  struct Place {
    std::size_t index;
    float fraction;
  };
  Place radius_place(float radius) const;

  std::size_t channels_;
  std::vector<float> density_;  // by octave of the squared distance and part of it, channels together
  int lowest_octave_ = 0;
  std::size_t density_rows_ = 0;
  float least_log2_radius_ = 0;
  std::size_t radii_ = 0;
  std::vector<float> disc_means_;  // by radius, distance in radii, channel
  std::vector<float> near_totals_;
};

}  // namespace kiln
