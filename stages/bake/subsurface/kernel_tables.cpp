// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/subsurface/kernel_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace kiln {

namespace {

constexpr int mantissa_bits = 23;
constexpr int part_bits = 7;  // parts of an octave of the squared distance
constexpr int parts = 1 << part_bits;
constexpr int radii_per_octave = 4;
constexpr int distances_per_radius = 16;
constexpr std::size_t distance_rows = static_cast<std::size_t>(KernelTables::disc_reach) * distances_per_radius + 2;
constexpr int steps = 48;  // number of steps of the integrals below

/// Returns a number as a float, clamped to what arithmetic may go on with.
float tame(double value) { return static_cast<float>(std::min(value, 1e30)); }

/// Returns the share of a circle that lies in a disc: the circle of radius `rho` about a point at `distance` from the
/// disc's centre.
double arc_share(double rho, double distance, double radius) {
  if (rho <= radius - distance) return 1;
  if (rho >= radius + distance || rho <= distance - radius) return 0;
  const double cosine = (rho * rho + distance * distance - radius * radius) / (2 * rho * distance);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) / std::numbers::pi;
}

/// Returns what a disc sends to a point of its plane: the integral of arc_share over the energy within rho.
double disc_share(const ScatterProfile& profile, double distance, double radius) {
  const double from = std::abs(distance - radius), to = distance + radius;
  double below = profile.within(from);
  double sum = distance < radius ? below : 0;
  double lower = from;
  for (int k = 1; k <= steps && distance > 0; ++k) {
    // Sample denser at both ends, where the share has its kinks.
    const double upper = from + (to - from) * 0.5 * (1 - std::cos(std::numbers::pi * k / steps));
    const double above = profile.within(upper);
    sum += std::max(0.0, above - below) * arc_share(0.5 * (lower + upper), distance, radius);
    lower = upper;
    below = above;
  }
  return sum;
}

double near_integral(const ScatterProfile& profile, double radius) {
  const double reach = KernelTables::near_reach * radius;
  double sum = 0, below = 0;
  constexpr int fine_steps = 16 * steps;
  for (int k = 1; k <= fine_steps; ++k) {
    // Space samples by the cube: dense at the centre, where R is steep.
    const auto place = [&](double at) { return reach * std::pow(at / fine_steps, 3); };
    const double above = profile.within(place(k));
    sum += std::max(0.0, above - below) *
           KernelTables::near_share(static_cast<float>(place(k - 0.5)), static_cast<float>(radius));
    below = above;
  }
  return sum;
}

}  // namespace

float KernelTables::near_share(float distance, float radius) {
  const float t = std::clamp((distance / (near_reach * radius) - near_flat) / (1 - near_flat), 0.f, 1.f);
  return 1 - t * t * (3 - 2 * t);
}

KernelTables::KernelTables(std::span<const ScatterProfile> profiles, double least_radius, double most_radius,
                           double farthest)
    : channels_(profiles.size()) {
  // Step 1: tabulate R over octaves of the squared distance, from a small part of the least disc on.
  const double nearest = least_radius / 16;
  lowest_octave_ = std::ilogb(std::max(nearest * nearest, 1e-37));
  const int highest_octave = std::ilogb(std::min(farthest * farthest, 1e37)) + 1;
  density_rows_ = static_cast<std::size_t>(highest_octave - lowest_octave_ + 1) * parts;
  density_.resize((density_rows_ + 1) * channels_);
  for (std::size_t row = 0; row <= density_rows_; ++row) {
    const double octave = std::ldexp(1.0, lowest_octave_ + static_cast<int>(row / parts));
    const double r = std::sqrt(octave * (1 + static_cast<double>(row % parts) / parts));
    for (std::size_t c = 0; c < channels_; ++c) density_[row * channels_ + c] = tame(profiles[c].density(r));
  }

  // Step 2: tabulate means over discs, and the near parts.
  least_log2_radius_ = static_cast<float>(std::log2(least_radius));
  radii_ =
      2 + static_cast<std::size_t>(std::ceil(radii_per_octave * std::log2(std::max(1.0, most_radius / least_radius))));
  disc_means_.resize(radii_ * distance_rows * channels_);
  near_totals_.resize(radii_ * channels_);
  for (std::size_t k = 0; k < radii_; ++k) {
    const double radius = least_radius * std::exp2(static_cast<double>(k) / radii_per_octave);
    for (std::size_t c = 0; c < channels_; ++c) {
      near_totals_[k * channels_ + c] = tame(near_integral(profiles[c], radius));
      for (std::size_t row = 0; row < distance_rows; ++row)
        disc_means_[(k * distance_rows + row) * channels_ + c] =
            tame(disc_share(profiles[c], radius * static_cast<double>(row) / distances_per_radius, radius) /
                 (std::numbers::pi * radius * radius));
    }
  }
}

void KernelTables::density(float squared_distance, float* values) const {
  const auto bits = std::bit_cast<std::uint32_t>(squared_distance);
  const std::int64_t octave = static_cast<std::int64_t>(bits >> mantissa_bits) - 127 - lowest_octave_;
  const std::int64_t row = octave * parts + ((bits >> (mantissa_bits - part_bits)) & (parts - 1));
  float fraction = static_cast<float>(bits & ((1u << (mantissa_bits - part_bits)) - 1)) /
                   static_cast<float>(1u << (mantissa_bits - part_bits));
  auto at = static_cast<std::size_t>(row);
  if (row < 0) {
    at = 0;
    fraction = 0;
  } else if (at >= density_rows_) {
    at = density_rows_ - 1;
    fraction = 1;
  }
  const float* const lower = density_.data() + at * channels_;
  for (std::size_t c = 0; c < channels_; ++c) values[c] = lower[c] + fraction * (lower[c + channels_] - lower[c]);
}

KernelTables::Place KernelTables::radius_place(float radius) const {
  const float at =
      std::clamp((std::log2(radius) - least_log2_radius_) * radii_per_octave, 0.f, static_cast<float>(radii_ - 1));
  const std::size_t index = std::min(static_cast<std::size_t>(at), radii_ - 2);
  return {index, at - static_cast<float>(index)};
}

void KernelTables::disc_mean(float radius, float distance, float* values) const {
  if (distance >= disc_reach * radius) return density(distance * distance, values);
  const Place place = radius_place(radius);
  const float along = distance / radius * distances_per_radius;
  const std::size_t row = std::min(static_cast<std::size_t>(along), distance_rows - 2);
  const float fraction = along - static_cast<float>(row);
  const float* const lower = disc_means_.data() + (place.index * distance_rows + row) * channels_;
  const float* const upper = lower + distance_rows * channels_;
  for (std::size_t c = 0; c < channels_; ++c) {
    const float small = lower[c] + fraction * (lower[c + channels_] - lower[c]);
    const float large = upper[c] + fraction * (upper[c + channels_] - upper[c]);
    values[c] = small + place.fraction * (large - small);
  }
}

void KernelTables::near_total(float radius, float* values) const {
  const Place place = radius_place(radius);
  const float* const lower = near_totals_.data() + place.index * channels_;
  for (std::size_t c = 0; c < channels_; ++c) values[c] = lower[c] + place.fraction * (lower[c + channels_] - lower[c]);
}

}  // namespace kiln
