// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kiln/asset.h"

namespace kiln::runtime {

/// Computes the exit radiance of every point: albedo times the sum of L_i t_i; red, green and blue of a point one after
/// another, linear, not clamped, below 0 where truncated harmonics ring. `light` is a result of Light::coefficients for
/// the asset's bands; `albedo` replaces the asset's own. Throws Error for a light of another length, and for assets
/// with other than 1 or 3 channels.
KILN_RUNTIME_API std::vector<float> exit_radiance(const Asset& asset, std::span<const float> light,
                                                  const std::optional<Color>& albedo = {});

/// Computes the exit radiance of one point.
KILN_RUNTIME_API Color exit_radiance_at(const Asset& asset, std::span<const float> light, std::uint32_t point,
                                        const std::optional<Color>& albedo = {});

}  // namespace kiln::runtime
