#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "raycast/beam_kernels.h"
#include "raycast/beam_scene.h"

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

 private:
  /// A cluster without the triangles under all receivers' tangent planes, and its box.
  struct LocalCluster {
    BeamScene::Cluster triangles;
    float lower[3], upper[3];
  };

  /// What some beams may meet: clusters with their boxes less that of the packet's origins (Minkowski: a beam meets
  /// theirs where a ray from zero meets these), and nodes whose children are not looked at yet.
  struct Front {
    std::vector<const BeamScene::Cluster*> clusters;
    std::vector<BeamBoxes> boxes;
    std::vector<std::uint32_t> nodes;

    bool empty() const { return clusters.empty() && nodes.empty(); }
    void clear();
  };

  /// What of `from` the beams of a shaft may meet. Nodes are opened until there are `most` of clusters and nodes.
  void search(const Front& from, const BeamShaft& shaft, std::size_t most, Front& found);
  void open(std::uint32_t node, const BeamShaft& shaft, Front& found);
  /// `whole`: no triangle of the cluster is under all receivers' tangent planes.
  void add_cluster(const BeamScene::Node& node, int child, bool whole, Front& front);
  /// The beam along the directions whose bit is set.
  BeamShaft shaft_along(const float (*direction)[3], std::uint32_t which) const;
  bool stands_outside();

  const BeamScene& scene_;
  const BeamKernels& kernels_;
  BeamPacket packet_;
  BeamSpan span_;
  bool outside_ = false;                      ///< only triangles that face the ray count
  std::vector<std::uint32_t> node_children_;  ///< by node, what boxes_above says
  std::vector<std::int32_t> cluster_slots_;   ///< by cluster: its index in local_, none or unknown
  std::vector<std::uint32_t> known_nodes_, known_clusters_;
  std::deque<LocalCluster> local_;  ///< the first local_count_ are the packet's
  std::size_t local_count_ = 0;
  std::vector<std::uint32_t> queue_;
  Front root_, of_block_, of_quarter_, of_direction_;
};

/// sums[i][lane] += to_fixed_point(the sum over the directions d of `weights.facing`, in order, of weight[d][lane] *
/// basis[d * coefficients + i]).
void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);

}  // namespace kiln
