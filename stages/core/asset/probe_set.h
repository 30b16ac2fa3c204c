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

/// Points at the corners of equal cells, the grid's border included. An axis with a single point has it in the middle.
struct ProbeGrid {
  std::array<int, 3> size = {1, 1, 1};
  Eigen::Vector3f lower = Eigen::Vector3f::Zero(), upper = Eigen::Vector3f::Zero();  ///< object units

  std::size_t count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  /// Returns the position of a point; x runs fastest, then y, then z.
  Eigen::Vector3f position(std::size_t index) const;
};

/// Transfer of distant light to points in space, past the meshes around them and reflected by them. Each point has a
/// matrix M per channel: L'_i = sum over j of M_ij L_j, where L are the coefficients of the distant light and L' those
/// of the light that arrives at the point.
struct ProbeSet {
  int bands = 0;
  int channels = 1;                        ///< 1: the same for all colours; 3: red, green and blue
  std::optional<ProbeGrid> grid;           ///< empty if the points are arbitrary
  std::vector<Eigen::Vector3f> positions;  ///< object units; those of a grid in its order
  std::vector<std::uint8_t> valid;         ///< 0: inside something solid, its matrices are meaningless
  std::vector<float> matrices;             ///< point after point, channel after channel, row after row

  int coefficients() const { return bands * bands; }
  std::size_t entries() const { return static_cast<std::size_t>(channels) * coefficients() * coefficients(); }

  std::span<const float> matrix(std::size_t probe, int channel) const {
    const std::size_t size = static_cast<std::size_t>(coefficients()) * coefficients();
    return {matrices.data() + probe * entries() + static_cast<std::size_t>(channel) * size, size};
  }
};

/// Writes matrices.json and matrices.png (docs/format.md). Each matrix entry is stored in 65,535 steps of its range
/// over all valid points.
void save_probes(OutputSet& outputs, const ProbeSet& probes);

/// Reads what save_probes wrote. Throws BadInput if a file is missing, damaged or of another format.
ProbeSet load_probes(const std::filesystem::path& folder);

/// Reads probes like load_probes, but reports all faults to `faults`. Returns the probes without their faulty parts,
/// and the version of the format, 0 if faulty.
std::pair<ProbeSet, int> read_probes(const std::filesystem::path& folder, Faults& faults);

/// Finds the probes that make up the light at `position`, with weights that add up to 1. On a grid these are the
/// corners of the cell around it, weighted trilinearly, with `position` clamped to the grid; otherwise the eight
/// nearest points, weighted by inverse squared distance [Shepard 1968]. Invalid points are left out; if all of these
/// are invalid, the nearest valid point counts alone. Empty if no point is valid.
std::vector<std::pair<std::size_t, float>> probe_weights(const ProbeSet& probes, const Eigen::Vector3f& position);

/// Computes the light at `position` from the distant light `source`, for drawing another asset there with its own
/// transfer. Has probes.bands bands (bands that `source` lacks are 0) and as many channels as the larger of `probes`
/// and `source`. Returns `source` if no probe is valid. Throws std::invalid_argument if the numbers of channels are
/// neither equal nor one of them 1.
LightCoefficients light_at(const ProbeSet& probes, const Eigen::Vector3f& position, const LightCoefficients& source);

}  // namespace kiln
