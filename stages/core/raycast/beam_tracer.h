#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "raycast/beam_scene.h"

namespace kiln {

/// Directions of a block, as block_directions.
inline constexpr int beam_directions = 32;

/// 16 receivers that stand near each other.
struct alignas(64) BeamPacket {
  float origin[3][beam_lanes];  ///< where their rays start
  float normal[3][beam_lanes];
};

/// max(0, n.s) of every receiver of a packet and direction of a block, 0 where something is in the way.
struct alignas(64) BeamWeights {
  float weight[beam_directions][beam_lanes];
  std::uint32_t facing;  ///< bit d: direction d is before some receiver; elsewhere `weight` is not set
  std::uint32_t lit;     ///< bit d: of these, nothing can stand in the way, so that no triangle was tested
};

/// Casts the parallel rays of a packet of receivers as one beam. One block of directions at a time: the tree is
/// searched once for all clusters that the beams of the block can meet (boxes swept along the cone of directions; what
/// lies under the tangent planes of all 16 receivers is left out), then each direction tests their triangles, 16
/// receivers at once. A triangle is tested as in Woop, Benthin and Wald, "Watertight ray/triangle intersection" (2013):
/// sheared so that the ray is an axis, and an edge shared by two triangles has the same sign bit for bit in both, so
/// that no ray slips through between them. One tracer to a thread; plain multiplications and additions, so that bits do
/// not depend on the width of the machine's vectors.
class BeamTracer {
 public:
  /// `scene` must outlive the tracer.
  explicit BeamTracer(const BeamScene& scene);

  /// From now on the rays of `packet`.
  void begin(const BeamPacket& packet);

  /// `count` up to 32 unit vectors, component after component.
  void trace(const float (*direction)[3], int count, BeamWeights& weights);

  /// A beam over a range of directions, and the clusters that it may meet.
  struct Shaft;

 private:
  /// A cluster without the triangles under all receivers' tangent planes, and its box.
  struct LocalCluster {
    BeamScene::Cluster triangles;
    float lower[3], upper[3];
  };

  void gather(const Shaft& shaft);
  /// `whole`: no triangle of the cluster is under all receivers' tangent planes.
  void add_candidate(const BeamScene::Node& node, int child, bool whole);
  /// The beam along the directions whose bit is set. `least_sine` of 2 leaves out nothing for its normals.
  Shaft shaft_along(const float (*direction)[3], std::uint32_t which, float least_sine) const;
  bool stands_outside();

  const BeamScene& scene_;
  BeamPacket packet_;
  alignas(64) float plane_[beam_lanes];
  float centre_[3], half_[3];  ///< of the box of the packet's origins
  float slack_ = 0;
  bool outside_ = false;                      ///< only triangles that face the ray count
  std::vector<std::uint32_t> node_children_;  ///< by node, what boxes_above says
  std::vector<std::int32_t> cluster_slots_;   ///< by cluster: its index in local_, none or unknown
  std::vector<std::uint32_t> known_nodes_, known_clusters_;
  std::deque<LocalCluster> local_;  ///< the first local_count_ are the packet's
  std::size_t local_count_ = 0;
  std::vector<std::uint32_t> stack_;
  std::vector<const BeamScene::Cluster*> candidates_;  ///< of the block
  /// Theirs, less the box of the packet's origins (Minkowski): a beam meets theirs where a ray from zero meets these.
  std::vector<BeamBoxes> boxes_;
};

/// sums[i][lane] += to_fixed_point(the sum over the directions d of `weights.facing`, in order, of weight[d][lane] *
/// basis[d * coefficients + i]).
void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);

}  // namespace kiln
