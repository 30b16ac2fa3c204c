// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "raycast/beam_kernels.h"
#include "raycast/beam_scene.h"
#include "raycast/known_rays.h"

namespace kiln {

/// Up to 32 directions that lie close together, and their four quarters, which lie closer still.
struct BeamBlock {
  float direction[beam_directions][3];  ///< unit vectors
  int count = 0;
  std::uint32_t quarter[4] = {};  ///< bit d: direction d belongs to the quarter

  explicit BeamBlock(std::span<const Eigen::Vector3f> directions);
};

/// Casts the parallel rays of a packet of receivers as one beam, one block of directions at a time. First the tree is
/// searched for the clusters that the block's beams can meet: boxes swept along the cone of directions, without what
/// lies below the tangent planes of all 16 receivers. Then each quarter of the block picks its clusters from these, and
/// each direction tests their triangles against 16 receivers at once. A search that finds too many clusters stops at
/// the nodes above them, and each part of the directions goes on from there. A triangle is tested in space sheared so
/// that the ray is an axis [Woop 2013]; two triangles compute the same bits, except for the sign, for an edge that they
/// share, so that no ray slips through between them. Each thread needs its own tracer.
class BeamTracer {
 public:
  /// Keeps a reference to `scene`, which must outlive the tracer.
  explicit BeamTracer(const BeamScene& scene);

  /// Sets the packet whose rays the following calls of trace() cast.
  void begin(const BeamPacket& packet);

  /// Casts the rays of a block of directions.
  void trace(const BeamBlock& block, BeamWeights& weights);

  /// What the tracer has done so far.
  const BeamWork& work() const { return work_; }

 private:
  /// A cluster without the triangles below the tangent planes of all receivers, and its box.
  struct LocalCluster {
    BeamScene::Cluster triangles;
    float lower[3], upper[3];
  };

  enum class Verdict : std::uint8_t { lit, hidden, mixed };

  /// Clusters and nodes that the beams of a part of the directions may meet.
  struct Front {
    /// Clusters, and their bounding boxes, each enlarged by the packet's box (Minkowski difference). A beam from any
    /// origin of the packet can meet a cluster only if a ray from (0,0,0) in the same direction meets its enlarged box.
    std::vector<const BeamScene::Cluster*> clusters;
    std::vector<BeamBoxes> boxes;
    /// a bit for each cluster, in groups of 16: clusters that stand clear of all receivers
    std::vector<std::uint32_t> may_be_sheets;
    /// Nodes whose triangles, with their neighbours, all face the beams, and their enlarged boxes.
    std::vector<std::uint32_t> sheets;
    std::vector<BeamBoxes> sheet_boxes;
    std::vector<std::uint32_t> nodes;  ///< nodes whose children have not been looked at yet

    void clear();
  };

  /// Finds the part of `from` that the beams of a shaft may meet, and whether all their rays are blocked or free alike.
  /// Nodes are opened until there are `most` nodes and clusters.
  ///
  /// Rays fare alike if everything that they meet is a sheet: triangles that face all of them, clear of the receivers,
  /// whose neighbours do so, too. Then no ray passes an edge of the union of these sheets, so that each ray crosses it
  /// as often as every other: one ray decides for all.
  Verdict search(const Front& from, const BeamShaft& shaft, std::size_t most, Front& found);
  /// Records a verdict for the directions whose bit is set.
  static void settle(Verdict verdict, std::uint32_t which, BeamWeights& weights);
  /// Keeps only the triangles of the quarter's clusters that its shaft can meet.
  void pack(const BeamShaft& shaft);
  void trace_quarter(const BeamBlock& block, std::uint32_t facing, const BeamShaft& of_block, BeamWeights& weights);
  std::size_t open(std::uint32_t node, const BeamShaft& shaft, Front& found);
  void open_sheets(const BeamShaft& shaft, Front& front);
  bool meets_sheet(const Front& front, const BeamShaft& shaft);
  /// Adds a cluster to `front`. `whole`: no triangle of it lies below the tangent planes of all receivers.
  bool add_cluster(const BeamScene::Node& node, int child, bool whole, bool may_be_sheet, Front& front);
  void set_box(const float* lower, const float* upper, const BeamBoxes& from, int i, std::size_t lane,
               BeamBoxes& to) const;
  /// Makes the shaft along the directions whose bit is set.
  BeamShaft shaft_along(const float (*direction)[3], std::uint32_t which) const;
  /// Makes the shaft, narrowed to a wider one if given, and decides whether backs are culled.
  BeamShaft shaft_within(const BeamShaft* wider, const float (*direction)[3], std::uint32_t which);
  /// Tests by winding numbers whether no receiver lies within the surface that triangles and lids form together.
  bool stands_outside();
  /// Tests whether only triangles that face the rays of the shaft count: each triangle that turns its back to a ray
  /// lies behind one that faces it.
  ///
  /// From a place whose winding number is not above 0, a ray enters the closed surface of triangles and lids at least
  /// as often as it leaves it. If it enters through no lid, it enters through at least as many triangles as it leaves
  /// through: if it meets any triangle, it meets one that faces it.
  bool culls_backs(const BeamShaft& shaft);

  const BeamScene& scene_;
  const BeamKernels& kernels_;
  BeamPacket packet_;
  BeamSpan span_;
  bool outside_ = false;                     ///< whether no receiver is within the surface that lids close
  std::vector<BeamPlaces> node_places_;      ///< by node: places of its children
  std::vector<std::int32_t> cluster_slots_;  ///< by cluster: its index in local_, or none, or unknown
  std::vector<std::uint32_t> known_nodes_, known_clusters_;
  std::deque<LocalCluster> local_;  ///< the first local_count_ belong to the packet
  std::size_t local_count_ = 0;
  std::vector<BeamScene::Cluster> packed_;  ///< clusters of the quarter
  std::vector<std::uint32_t> queue_;
  BeamWork work_;
  Front root_, of_block_, of_quarter_, of_direction_;
};

/// Finds the lanes of each direction that are blocked where some lane faces the direction; none for directions that are
/// `lit`.
BlockLanes blocked_lanes(const BeamWeights& weights);

/// Adds to sums[i][lane] the fixed-point number (to_fixed_point) of the sum over the directions d of `weights.facing`,
/// in order, of weight[d][lane] * basis[d * coefficients + i].
void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);

}  // namespace kiln
