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

/// Up to 32 directions that lie close together, and their four quarters, which lie closer.
struct BeamBlock {
  float direction[beam_directions][3];  ///< unit vectors
  int count = 0;
  std::uint32_t quarter[4] = {};  ///< bit d: direction d is in it

  explicit BeamBlock(std::span<const Eigen::Vector3f> directions);
};

/// Casts the parallel rays of a packet of receivers as one beam. One block of directions at a time: the tree is
/// searched for the clusters that the beams of the block can meet (boxes swept along the cone of directions; what
/// lies under the tangent planes of all 16 receivers is left out), the beams of each quarter of the block can meet some
/// of these, and each direction tests their triangles, 16 receivers at once. Where a search finds many, it stops at the
/// nodes above them, and each part of the directions goes on from there. A triangle is tested in space sheared so that
/// the ray is an axis, as by Woop, Benthin and Wald, "Watertight ray/triangle intersection" (2013), and an edge shared
/// by two triangles has the same sign bit for bit in both, so that no ray slips through between them. One tracer to a
/// thread.
class BeamTracer {
 public:
  /// `scene` must outlive the tracer.
  explicit BeamTracer(const BeamScene& scene);

  /// From now on the rays of `packet`.
  void begin(const BeamPacket& packet);

  /// Casts the rays of a block.
  void trace(const BeamBlock& block, BeamWeights& weights);

  /// What the tracer has done so far.
  const BeamWork& work() const { return work_; }

 private:
  /// A cluster without the triangles under all receivers' tangent planes, and its box.
  struct LocalCluster {
    BeamScene::Cluster triangles;
    float lower[3], upper[3];
  };

  enum class Verdict : std::uint8_t { lit, hidden, mixed };

  /// What some beams may meet.
  struct Front {
    /// Clusters, and their boxes less that of the packet's origins (Minkowski): a beam meets theirs where a ray from
    /// zero meets these.
    std::vector<const BeamScene::Cluster*> clusters;
    std::vector<BeamBoxes> boxes;
    std::vector<std::uint32_t> may_be_sheets;  ///< by group of 16, a bit each: clusters that lie off all receivers
    /// Nodes all of whose triangles, and their neighbours, face the beams, and boxes as above.
    std::vector<std::uint32_t> sheets;
    std::vector<BeamBoxes> sheet_boxes;
    std::vector<std::uint32_t> nodes;  ///< whose children are not looked at yet

    void clear();
  };

  /// What of `from` the beams of a shaft may meet, and whether all their rays fare alike. Nodes are opened until there
  /// are `most` of them and clusters.
  ///
  /// Rays fare alike where all that they meet are sheets: triangles that face all of them, off the receivers, whose
  /// neighbours do so, too. Then no ray passes an edge of the union of these sheets, so that each crosses it as often
  /// as every other: one ray tells for all.
  Verdict search(const Front& from, const BeamShaft& shaft, std::size_t most, Front& found);
  /// Notes what a verdict says of the directions whose bit is set.
  static void settle(Verdict verdict, std::uint32_t which, BeamWeights& weights);
  /// Leaves only the triangles of the quarter's clusters that its shaft can meet.
  void pack(const BeamShaft& shaft);
  void trace_quarter(const BeamBlock& block, std::uint32_t facing, const BeamShaft& of_block, BeamWeights& weights);
  std::size_t open(std::uint32_t node, const BeamShaft& shaft, Front& found);
  void open_sheets(const BeamShaft& shaft, Front& front);
  bool meets_sheet(const Front& front, const BeamShaft& shaft);
  /// `whole`: no triangle of the cluster is under all receivers' tangent planes.
  bool add_cluster(const BeamScene::Node& node, int child, bool whole, bool may_be_sheet, Front& front);
  void set_box(const float* lower, const float* upper, const BeamBoxes& from, int i, std::size_t lane,
               BeamBoxes& to) const;
  /// The beam along the directions whose bit is set.
  BeamShaft shaft_along(const float (*direction)[3], std::uint32_t which) const;
  /// The same within a wider beam, none for nullptr, and whether backs are culled.
  BeamShaft shaft_within(const BeamShaft* wider, const float (*direction)[3], std::uint32_t which);
  /// Whether no receiver lies within the surface that triangles and lids make together, by winding numbers.
  bool stands_outside();
  /// Whether only triangles that face the rays of the shaft count, because what turns its back to a ray lies behind one
  /// that faces it.
  ///
  /// From a place whose winding number is not above 0, a ray enters the closed surface of triangles and lids at least
  /// as often as it leaves it. Where it enters through no lid, it enters through as many triangles as it leaves through
  /// or more: if it meets any triangle, it meets one that faces it.
  bool culls_backs(const BeamShaft& shaft);

  const BeamScene& scene_;
  const BeamKernels& kernels_;
  BeamPacket packet_;
  BeamSpan span_;
  bool outside_ = false;                     ///< no receiver is within the surface that lids close
  std::vector<BeamPlaces> node_places_;      ///< by node, of its children
  std::vector<std::int32_t> cluster_slots_;  ///< by cluster: its index in local_, none or unknown
  std::vector<std::uint32_t> known_nodes_, known_clusters_;
  std::deque<LocalCluster> local_;  ///< the first local_count_ are the packet's
  std::size_t local_count_ = 0;
  std::vector<BeamScene::Cluster> packed_;  ///< of the quarter
  std::vector<std::uint32_t> queue_;
  BeamWork work_;
  Front root_, of_block_, of_quarter_, of_direction_;
};

/// The lanes that do not see a direction which some lane faces; of directions that are `lit`, none.
BlockLanes blocked_lanes(const BeamWeights& weights);

/// sums[i][lane] += to_fixed_point(the sum over the directions d of `weights.facing`, in order, of weight[d][lane] *
/// basis[d * coefficients + i]).
void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);

}  // namespace kiln
