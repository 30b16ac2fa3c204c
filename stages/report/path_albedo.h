// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "material/surface_albedo.h"
#include "material/wavelength_albedo.h"

namespace kiln {

/// Shares of light, one for each colour or wavelength that a path carries, at most as many as an asset has channels.
using PathShares = Eigen::Array<float, Eigen::Dynamic, 1, 0, 64, 1>;

PathShares shares_of(const Eigen::Vector3f& color);

/// What surfaces reflect of the light that paths carry: red, green and blue, or some wavelengths. Of wavelengths a
/// measured surface reflects what was measured, and any other what its albedo there is lifted to.
class PathAlbedo {
 public:
  /// Makes the albedo of no surface, for paths that never bounce.
  PathAlbedo() = default;

  /// `surfaces` have an albedo each; without wavelengths paths carry red, green and blue. Throws MachineLacks.
  explicit PathAlbedo(std::vector<SurfaceAlbedo> surfaces, const std::vector<int>& wavelengths_nm = {});

  /// Returns how many shares paths carry.
  int channels() const { return lift_ ? static_cast<int>(lift_->size()) : 3; }

  bool is_spectral() const { return lift_.has_value(); }

  /// Returns what a surface reflects at a point of one of its triangles, as SurfaceAlbedo::at. Colours that differ from
  /// place to place are lifted by WavelengthAlbedo's table, for paths are many; lifted_at lifts each by itself.
  PathShares at(std::size_t surface, std::uint32_t triangle, float u, float v) const;
  PathShares lifted_at(std::size_t surface, std::uint32_t triangle, float u, float v) const;

  /// Prepares the table even where no surface needs it, for `of`.
  void prepare_table();

  /// Returns what an albedo reflects, by the table.
  PathShares of(const Eigen::Vector3f& albedo) const;

 private:
  /// Returns what was measured, or lifted before; nothing where that differs from place to place.
  const PathShares* known(std::size_t surface, std::uint32_t triangle) const;

  std::vector<SurfaceAlbedo> surfaces_;
  std::optional<WavelengthAlbedo> lift_;
  /// At wavelengths, by surface, and by material where it has materials; empty where it differs from place to place.
  std::vector<std::vector<PathShares>> constants_;
};

}  // namespace kiln
