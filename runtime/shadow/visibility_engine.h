// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

struct DirectionSet;
struct LightSources;
struct NodeOccluders;
struct ShadowPoint;
struct ShadowStage;

/// Returns the number of rows of a VisibilityTable: one for each cone, then one for each ball, then three for each sky
/// (red, green, blue).
std::size_t visibility_rows(const LightSources& sources);

/// What is blocked of each light at one point. Without GL or rays: numbers alone.
struct PointVisibility {
  std::span<const std::uint32_t> counts;  ///< by row: how many directions of the light are blocked
  std::span<const float> sums;            ///< row * coefficients + i: sums of their harmonics, of skies times radiance

  std::span<const float> row(std::size_t r) const {
    const std::size_t coefficients = sums.size() / counts.size();
    return sums.subspan(r * coefficients, coefficients);
  }
};

/// PointVisibility of many points.
struct VisibilityTable {
  std::size_t rows = 0, coefficients = 0;
  std::vector<std::uint32_t> counts;  ///< point * rows + row
  std::vector<float> sums;            ///< (point * rows + row) * coefficients + i

  PointVisibility at(std::size_t point) const {
    return {std::span(counts).subspan(point * rows, rows),
            std::span(sums).subspan(point * rows * coefficients, rows * coefficients)};
  }
};

/// A point that receives light, and the nodes that may stand before it.
struct VisibilityTask {
  const ShadowPoint* point;
  const NodeOccluders* occluders;
};

/// Finds what nodes block of lights by other means than the rays of `combined`, for many points at once. What it finds
/// is the same quantity: over the same directions of each light, how many are blocked, and the sums of their harmonics.
class VisibilityEngine {
 public:
  virtual ~VisibilityEngine() = default;

  /// Names what does the work.
  virtual std::string renderer() const = 0;
  /// Takes the meshes of a scene's assets, in their order, and keeps no reference to them.
  virtual void set_meshes(std::span<const TriangleMesh* const> meshes) = 0;
  /// Takes lights without probes; `sky` are the directions of skies, harmonics have `bands` bands.
  virtual void set_lights(const LightSources& sources, const DirectionSet& sky, int bands) = 0;
  /// Finds what is blocked at each point, by the meshes and lights set last. `sources` are those lights.
  virtual VisibilityTable find(const ShadowStage& stage, const LightSources& sources,
                               std::span<const VisibilityTask> tasks) = 0;
};

}  // namespace kiln
