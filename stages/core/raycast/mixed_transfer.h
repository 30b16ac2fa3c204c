// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "raycast/beam_pilot.h"
#include "raycast/ray_scene.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// Transfer by beams for the receivers for which a pilot finds them cheaper, and by Embree's streams for all others, so
/// that no mesh is slower than rays by more than the pilot. Both find the same visibility, up to roundings of rays that
/// pass an edge.
class MixedTransfer {
 public:
  /// Copies the triangles. Rays start `ray_offset` (object units) off the receiver along its normal.
  MixedTransfer(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles, float ray_offset);

  /// Divides `receivers` (split_by_cost), which need not outlive this call; sums start at zero. `planned`: as many
  /// directions, as coherent, as will be added, though not the same ones.
  void set_receivers(const Receivers& receivers, int coefficients, std::span<const Eigen::Vector3f> planned);

  /// Adds the transfer over `directions`, coherent and in whole blocks for all calls but the last. `blocked` is used as
  /// by add_transfer_by_beams where all receivers are cast as beams, else left as it is.
  BeamSavings add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress,
                  BlockedRays* blocked = nullptr);

  /// What was added since set_receivers, in the order of its receivers.
  TransferSums sums() const;

  const BeamSplit& split() const { return split_; }

 private:
  BeamScene beam_scene_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Triangle> triangles_;
  std::unique_ptr<RayScene> ray_scene_;  ///< built when the first receiver needs it
  float ray_offset_;
  BeamSplit split_;
  std::vector<Eigen::Vector3f> ray_positions_, ray_normals_;  ///< of split_.rays
  TransferSums sums_, ray_sums_;
};

}  // namespace kiln
