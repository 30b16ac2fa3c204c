// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "raycast/beam_scene.h"

namespace kiln {

/// Directions of a block: 32, as block_directions.
inline constexpr int beam_directions = 32;

/// 16 receivers that stand near each other.
struct alignas(64) BeamPacket {
  float origin[3][beam_lanes];  ///< starting points of their rays
  float normal[3][beam_lanes];
};

/// Weights max(0, n.s) of each receiver of a packet along each direction of a block; 0 if the ray is blocked.
struct alignas(64) BeamWeights {
  float weight[beam_directions][beam_lanes];
  std::uint32_t facing;  ///< bit d: direction d is in front of some receiver; `weight` of other directions is not set
  std::uint32_t lit;     ///< bit d: direction d of these has nothing in its way, so that no triangle was tested
};

/// Bounding box of a packet's origins, and the heights of the receivers' tangent planes relative to its centre.
struct alignas(64) BeamSpan {
  float plane[beam_lanes];  ///< dot products of normals and origins, relative to `centre`
  float centre[3], half[3];
  float slack;  ///< margin that makes all tests of boxes and planes conservative
};

/// All rays from a box of origins along a range of directions.
struct BeamShaft {
  float origin_lower[3], origin_upper[3];
  float direction_lower[3], direction_upper[3];
  float inverse_lower[3], inverse_upper[3];  ///< 1 / direction_lower and 1 / direction_upper
  float cone_axis[3];                        ///< axis of a cone that holds the directions
  float cone_sine;                           ///< sine of the cone's half-angle
  bool outside;                              ///< whether only triangles that face the rays count
};

/// Position of 16 boxes relative to a packet's tangent planes and its box, a bit for each.
struct BeamPlaces {
  std::uint16_t above;  ///< the box rises above the tangent plane of at least one receiver
  std::uint16_t whole;  ///< the box lies wholly above one such plane
  std::uint16_t apart;  ///< the box does not meet the box of the packet's origins
};

/// Position of 16 boxes of triangles relative to a shaft, a bit for each.
struct BeamMeetings {
  std::uint32_t met;  ///< some ray meets the box, whose triangles may face that ray
  /// of these, boxes whose triangles, and their neighbours, all face every ray or all turn away from every ray
  std::uint32_t sheets;
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

/// One direction, and the candidates: triangles that may block it.
struct BeamRay {
  const float* direction;
  const BeamScene::Cluster* const* candidates;
  int candidate_count;
  /// the candidates' boxes, each enlarged by the packet's box (Minkowski difference), 16 at a time
  const BeamBoxes* boxes;
  bool outside;    ///< whether only triangles that face the ray count
  float doubtful;  ///< distance below which is_before decides hits
  BeamWork* work;  ///< counts of boxes, clusters and triangles
};

/// Inner loops of the beam tracer, 16 lanes each.
struct BeamKernels {
  /// Computes the cosines of all directions, 0 for those behind a receiver; returns the bits of directions in front of
  /// one.
  std::uint32_t (*face)(const BeamPacket&, const float (*direction)[3], int count, BeamWeights&);

  BeamPlaces (*places_of)(const BeamPacket&, const BeamSpan&, const BeamBoxes&, int count);

  /// Keeps the cluster's triangles that have a corner above the tangent plane of at least one receiver; returns their
  /// number. `lower` and `upper` become their box.
  int (*keep_above)(const BeamPacket&, const BeamSpan&, const BeamScene::Cluster&, BeamScene::Cluster& local,
                    float* lower, float* upper);

  BeamMeetings (*meet)(const BeamShaft&, const BeamBoxes&);

  /// Packs the triangles of `count` clusters that a shaft can meet into new clusters, all full except the last, with
  /// boxes as in BeamRay; returns the number of new clusters.
  int (*pack)(const BeamShaft&, const BeamSpan&, const BeamScene::Cluster* const* clusters, int count,
              BeamScene::Cluster* packed, BeamBoxes* boxes);

  /// Tests whether the ray from the span's centre along `direction` hits a triangle of the cluster.
  bool (*hits)(const BeamSpan&, const float* direction, bool outside, const BeamScene::Cluster&);

  /// Clears the weights of the receivers that a candidate hides from one direction; returns whether any triangle was
  /// near enough to be tested. `first` is the candidate to begin with, and becomes the one that hid the last receivers.
  bool (*shade)(const BeamPacket&, const BeamSpan&, const BeamRay&, int& first, float* weight);
  /// Computes the same bits as `shade`, faster where triangles are small compared with the beam.
  bool (*shade_crowded)(const BeamPacket&, const BeamSpan&, const BeamRay&, int& first, float* weight);

  /// Adds to winding[r] how often the ray of receiver r leaves the cluster's triangles minus how often it enters them,
  /// and adds to doubt[r] where it meets an edge.
  void (*wind)(const BeamPacket&, const BeamSpan&, const float* direction, const BeamScene::Cluster&, float* winding,
               float* doubt);

  /// See add_products in beam_tracer.h.
  void (*add_products)(const BeamWeights&, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]);
};

/// Returns the kernels for the widest vectors of this machine. All give the same bits, since multiplications and
/// additions stay separate.
const BeamKernels& beam_kernels();

}  // namespace kiln
