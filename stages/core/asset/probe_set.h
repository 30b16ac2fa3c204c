// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "asset/faults.h"
#include "asset/format.h"
#include "base/outputs.h"
#include "sh/lights.h"

namespace kiln {

/// Points at the corners of equal cells, borders included. Along an axis of one point it lies in the middle.
struct ProbeGrid {
  std::array<int, 3> size = {1, 1, 1};
  Eigen::Vector3f lower = Eigen::Vector3f::Zero(), upper = Eigen::Vector3f::Zero();  ///< object units

  std::size_t count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  /// x runs fastest, then y, then z.
  Eigen::Vector3f position(std::size_t index) const;
};

/// What becomes of distant light on its way to points in space, past and off the meshes that stand there: of each point
/// a matrix M for each channel, L'_i = sum over j of M_ij L_j, L the coefficients of the light far away and L' those of
/// the light that comes in at the point.
struct ProbeSet {
  int bands = 0;
  int channels = 1;                        ///< 1: the same for all colours; 3: red, green and blue
  std::optional<ProbeGrid> grid;           ///< none: points anywhere
  std::vector<Eigen::Vector3f> positions;  ///< object units; of a grid in its order
  std::vector<std::uint8_t> valid;         ///< 0: inside of something solid, its matrices mean nothing
  std::vector<float> matrices;             ///< point after point, channel after channel, row after row

  int coefficients() const { return bands * bands; }
  std::size_t entries() const { return static_cast<std::size_t>(channels) * coefficients() * coefficients(); }

  std::span<const float> matrix(std::size_t probe, int channel) const {
    const std::size_t size = static_cast<std::size_t>(coefficients()) * coefficients();
    return {matrices.data() + probe * entries() + static_cast<std::size_t>(channel) * size, size};
  }
};

/// Writes matrices.json and matrices.png (docs/format.md). Values are rounded to 65,535 steps of the range that their
/// entry has over all valid points.
void save_probes(OutputSet& outputs, const ProbeSet& probes);

/// Reads what save_probes wrote. Throws BadInput where a file is missing, damaged or not of that format.
ProbeSet load_probes(const std::filesystem::path& folder);

/// The same with all faults told of, and the version of the format, 0 where that is at fault. What is at fault is left
/// out of the set.
std::pair<ProbeSet, int> read_probes(const std::filesystem::path& folder, Faults& faults);

/// Which probes make up the light at `position`, with weights that add up to 1. Of a grid the corners of the cell
/// around it, trilinear, `position` clamped to the grid; of other points the eight nearest, by the inverse of the
/// squared distance (Shepard 1968). Points that are not valid are left out, and where all of these are it is the
/// nearest that is. Empty where none is valid.
std::vector<std::pair<std::size_t, float>> probe_weights(const ProbeSet& probes, const Eigen::Vector3f& position);

/// The light at `position` when `source` is the light far away, for drawing any other asset there with its own
/// transfer: probes.bands bands (bands that `source` lacks are 0), as many channels as the one of both that has more.
/// With no valid probe it is the source's. Throws std::invalid_argument where the channels do not fit: neither the same
/// nor one.
LightCoefficients light_at(const ProbeSet& probes, const Eigen::Vector3f& position, const LightCoefficients& source);

}  // namespace kiln
