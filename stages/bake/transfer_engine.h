#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/progress.h"
#include "sh/transfer.h"

namespace kiln {

/// What a bake integrates: receivers, occluders and directions in; transfer out.
struct TransferRequest {
  Receivers receivers;  ///< neighbours next to each other
  std::span<const Eigen::Vector3f> occluder_positions;
  std::span<const std::array<std::uint32_t, 3>> occluder_triangles;
  /// Points whose convex hull holds all occluders: the corners of their hull, or simply all positions.
  std::span<const Eigen::Vector3f> occluder_hull;
  /// Whether every edge of the occluders has one triangle on either side, so that their back faces need not be drawn.
  bool occluders_closed = false;
  std::span<const Eigen::Vector3f> directions;  ///< spread evenly over the sphere
  int bands = 5;
};

/// Evaluates t_i = 4/N sum over N directions of B_i(s) V(s) max(0, n.s) for every receiver.
class TransferEngine {
 public:
  virtual ~TransferEngine() = default;

  /// Same request, same bytes.
  virtual TransferVectors compute(const TransferRequest& request, const ProgressFunction& progress) = 0;

  /// What did the work, for the record: the GL renderer's name, or the ray library's.
  virtual std::string renderer() const = 0;

  /// Whether a CPU did it.
  virtual bool is_software() const = 0;
};

}  // namespace kiln
