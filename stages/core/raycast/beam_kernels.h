// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

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

/// The box of a packet's origins, and the heights of the receivers' tangent planes about its centre.
struct alignas(64) BeamSpan {
  float plane[beam_lanes];  ///< dot products of normals and origins, about `centre`
  float centre[3], half[3];
  float slack;  ///< makes all tests on boxes and planes conservative
};

/// All rays from a box of origins along a range of directions.
struct BeamShaft {
  float origin_lower[3], origin_upper[3];
  float direction_lower[3], direction_upper[3];
  float inverse_lower[3], inverse_upper[3];  ///< 1 / direction_lower and _upper
  float cone_axis[3];                        ///< a cone that holds the directions
  float cone_sine;                           ///< of its half-angle
  bool outside;                              ///< only triangles that face the rays count
};

/// What a packet's tangent planes and box say of 16 boxes, a bit for each.
struct BeamPlaces {
  std::uint16_t above;  ///< rises above the plane of at least one receiver
  std::uint16_t whole;  ///< lies wholly above one
  std::uint16_t apart;  ///< does not meet the box of the packet's origins
};

/// What a shaft says of 16 boxes of triangles, a bit for each.
struct BeamMeetings {
  std::uint32_t met;     ///< some ray meets it, and its triangles may face that ray
  std::uint32_t sheets;  ///< of these, all its triangles and their neighbours face all rays, or turn away from all
};

/// Work done, counted: the same on every machine and for any number of threads.
struct BeamWork {
  std::uint64_t blocks = 0;     ///< packets times blocks of directions
  std::uint64_t facing = 0;     ///< of their directions, those before some receiver
  std::uint64_t boxes = 0;      ///< tests of a shaft against 16 boxes
  std::uint64_t packed = 0;     ///< clusters whose triangles a quarter's shaft was tested against
  std::uint64_t clusters = 0;   ///< clusters sheared along a direction
  std::uint64_t triangles = 0;  ///< triangles tested against 16 receivers

  BeamWork& operator+=(const BeamWork& more);
  BeamWork operator-(const BeamWork& earlier) const;
};

/// One direction, and what may stand before it.
struct BeamRay {
  const float* direction;
  const BeamScene::Cluster* const* candidates;
  int candidate_count;
  const BeamBoxes* boxes;  ///< theirs, less the box of the packet's origins (Minkowski), 16 at a time
  bool outside;            ///< only triangles that face the ray count
  float doubtful;          ///< hits nearer than this are decided by is_before
  BeamWork* work;          ///< counts boxes, clusters and triangles
};

/// The inner loops of the beam tracer, 16 lanes each.
struct BeamKernels {
  /// The cosines of all directions, 0 for those behind a receiver; returns the bits of directions before one.
  std::uint32_t (*face)(const BeamPacket&, const float (*direction)[3], int count, BeamWeights&);

  BeamPlaces (*places_of)(const BeamPacket&, const BeamSpan&, const BeamBoxes&, int count);

  /// The cluster's triangles with a corner above the plane of at least one receiver; their number. `lower` and `upper`
  /// become their box.
  int (*keep_above)(const BeamPacket&, const BeamSpan&, const BeamScene::Cluster&, BeamScene::Cluster& local,
                    float* lower, float* upper);

  BeamMeetings (*meet)(const BeamShaft&, const BeamBoxes&);

  /// The triangles of `count` clusters that a shaft can meet, in clusters that are full but for the last, and their
  /// boxes as BeamRay has them; how many clusters these are.
  int (*pack)(const BeamShaft&, const BeamSpan&, const BeamScene::Cluster* const* clusters, int count,
              BeamScene::Cluster* packed, BeamBoxes* boxes);

  /// Whether the ray from the span's centre along `direction` hits a triangle of the cluster.
  bool (*hits)(const BeamSpan&, const float* direction, bool outside, const BeamScene::Cluster&);

  /// Clears the weights of the receivers that a candidate hides from one direction; returns whether any triangle was
  /// near enough to be tested. `first` is the candidate to begin with, and becomes the one that hid the last receivers.
  bool (*shade)(const BeamPacket&, const BeamSpan&, const BeamRay&, int& first, float* weight);
  /// The same bits, faster where triangles are small beside the beam.
  bool (*shade_crowded)(const BeamPacket&, const BeamSpan&, const BeamRay&, int& first, float* weight);

  /// Adds to winding[r] how often the ray of receiver r leaves the cluster's triangles less how often it enters them,
  /// and to doubt[r] where it meets an edge.
  void (*wind)(const BeamPacket&, const BeamSpan&, const float* direction, const BeamScene::Cluster&, float* winding,
               float* doubt);

  /// add_products (beam_tracer.h).
  void (*add_products)(const BeamWeights&, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);
};

/// Kernels for the widest vectors that this machine has. All give the same bits: multiplications and additions stay
/// apart.
const BeamKernels& beam_kernels();

}  // namespace kiln
