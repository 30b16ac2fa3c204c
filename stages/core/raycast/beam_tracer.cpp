#include "raycast/beam_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "raycast/exact_side.h"
#include "raycast/vector_width.h"
#include "sh/transfer_sums.h"

#define KILN_INLINE inline __attribute__((always_inline))

namespace kiln {

static_assert(beam_directions == block_directions);

struct BeamTracer::Shaft {
  float origin_lower[3], origin_upper[3];  // of the packet, with slack
  float direction_lower[3], direction_upper[3];
  float inverse_lower[3], inverse_upper[3];  // 1 / direction_lower and _upper
  float cone_axis[3];                        // a cone that holds the directions
  float cone_sine;                           // 2: leave out nothing for its normals
};

namespace {

using Floats = float __attribute__((vector_size(4 * beam_lanes)));
using Bits = std::int32_t __attribute__((vector_size(4 * beam_lanes)));  // 0 or -1 in each lane
using Longs = std::int64_t __attribute__((vector_size(8 * beam_lanes)));

using Shaft = BeamTracer::Shaft;

constexpr std::int32_t unknown = -1, none = -2;
constexpr std::uint32_t unknown_children = 0x10000;  // a box wholly above a plane also rises above it
constexpr std::uint32_t all_lanes = (1u << beam_lanes) - 1;
constexpr float looser = 1.00001f;  // some 80 roundings

KILN_INLINE Floats load(const float* lanes) {
  Floats v;
  std::memcpy(&v, lanes, sizeof v);
  return v;
}

KILN_INLINE void store(float* lanes, const Floats& v) { std::memcpy(lanes, &v, sizeof v); }

KILN_INLINE Floats least(const Floats& a, const Floats& b) { return a < b ? a : b; }
KILN_INLINE Floats greatest(const Floats& a, const Floats& b) { return a > b ? a : b; }

/// All lanes' bits together.
KILN_INLINE std::uint32_t bits_of(const Bits& bits) {
  std::uint64_t words[sizeof bits / 8];
  std::memcpy(words, &bits, sizeof bits);
  std::uint64_t all = 0;
  for (std::uint64_t word : words) all |= word;
  return static_cast<std::uint32_t>(all | all >> 32);
}

/// Bit i: a[i] <= b[i]. GCC 12 makes vector code of a comparison that chooses between two vectors, and of no other.
KILN_INLINE std::uint32_t mask_at_most(const Floats& a, const Floats& b) {
  constexpr Bits bit = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  return bits_of(a <= b ? bit : Bits{});
}

KILN_INLINE Eigen::Vector3f at_lane(const float (&lanes)[3][beam_lanes], int lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

/// 1 / x, of a tiny number instead of 0; the number's sign is x's.
KILN_INLINE float inverse(float& x) {
  constexpr float tiny = 1e-12f;
  if (std::abs(x) < tiny) x = x > 0 ? tiny : -tiny;
  return 1 / x;
}

/// The cosines of all directions, 0 for those behind a receiver; returns the bits of directions before one.
KILN_ANY_VECTOR_WIDTH std::uint32_t face(const BeamPacket& packet, const float (*direction)[3], int count,
                                         BeamWeights& weights) {
  const Floats x = load(packet.normal[0]), y = load(packet.normal[1]), z = load(packet.normal[2]);
  std::uint32_t facing = 0;
  for (int d = 0; d < count; ++d) {
    const Floats cosine = x * direction[d][0] + y * direction[d][1] + z * direction[d][2];
    const Floats weight = cosine > 0 ? cosine : Floats{};
    store(weights.weight[d], weight);
    if (mask_at_most(weight, Floats{}) != all_lanes) facing |= 1u << d;
  }
  return facing;
}

/// Bit i: box i rises above the plane of at least one receiver; bit 16 + i: it lies wholly above one. `plane` holds the
/// dot products of normals and origins about `centre`.
KILN_ANY_VECTOR_WIDTH std::uint32_t boxes_above(const BeamPacket& packet, const float* plane, const float* centre,
                                                float slack, const BeamBoxes& boxes, int count) {
  std::uint32_t above = 0;
  for (int i = 0; i < count; ++i) {
    Floats height = -load(plane), lowest = height;
    for (int axis = 0; axis < 3; ++axis) {
      const Floats normal = load(packet.normal[axis]);
      const Floats at_lower = normal * (boxes.lower[axis][i] - centre[axis]);
      const Floats at_upper = normal * (boxes.upper[axis][i] - centre[axis]);
      height += greatest(at_lower, at_upper);
      lowest += least(at_lower, at_upper);
    }
    if (mask_at_most(lowest, Floats{}) != all_lanes) above |= 0x10000u << i;
    if (mask_at_most(height, Floats{} - slack) != all_lanes) above |= 1u << i;
  }
  return above;
}

/// The cluster's triangles with a corner above the plane of at least one receiver; their number. `lower` and `upper`
/// become their box.
KILN_ANY_VECTOR_WIDTH int keep_above(const BeamPacket& packet, const float* plane, const float* centre, float slack,
                                     const BeamScene::Cluster& cluster, BeamScene::Cluster& local, float* lower,
                                     float* upper) {
  Floats corner[3][3];
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) corner[k][axis] = load(cluster.corner[k][axis]) - centre[axis];
  Floats highest = Floats{} - std::numeric_limits<float>::infinity();
  for (int r = 0; r < beam_lanes; ++r)
    for (int k = 0; k < 3; ++k)
      highest = greatest(highest, corner[k][0] * packet.normal[0][r] + corner[k][1] * packet.normal[1][r] +
                                      corner[k][2] * packet.normal[2][r] - plane[r]);
  std::uint32_t kept = ~mask_at_most(highest, Floats{} - slack) & ((2u << (cluster.count - 1)) - 1);
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = std::numeric_limits<float>::infinity();
    upper[axis] = -std::numeric_limits<float>::infinity();
  }
  for (; kept != 0; kept &= kept - 1) {
    const int i = __builtin_ctz(kept);
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const float at = cluster.corner[k][axis][i];
        local.corner[k][axis][count] = at;
        lower[axis] = std::min(lower[axis], at);
        upper[axis] = std::max(upper[axis], at);
      }
    ++count;
  }
  local.count = count;
  return count;
}

/// Bits of the boxes b for which origin + t direction meets b with some t >= 0, any origin and any direction of the
/// shaft: on each axis t * direction_lower <= upper end - origin_lower and t * direction_upper >= lower end -
/// origin_upper.
KILN_ANY_VECTOR_WIDTH std::uint32_t boxes_in(const Shaft& shaft, const BeamBoxes& boxes) {
  Floats nearest{}, farthest = Floats{} + std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const Floats at_lower = (load(boxes.upper[axis]) - shaft.origin_lower[axis]) * shaft.inverse_lower[axis];
    if (shaft.direction_lower[axis] > 0)
      farthest = least(farthest, at_lower);
    else
      nearest = greatest(nearest, at_lower);
    const Floats at_upper = (load(boxes.lower[axis]) - shaft.origin_upper[axis]) * shaft.inverse_upper[axis];
    if (shaft.direction_upper[axis] > 0)
      nearest = greatest(nearest, at_upper);
    else
      farthest = least(farthest, at_upper);
  }
  // All normals are less than a right angle from all directions: sin(a + b) <= sin a + sin b.
  const Floats cosine = load(boxes.cone_axis[0]) * shaft.cone_axis[0] + load(boxes.cone_axis[1]) * shaft.cone_axis[1] +
                        load(boxes.cone_axis[2]) * shaft.cone_axis[2];
  return mask_at_most(nearest, farthest * looser) & mask_at_most(cosine, load(boxes.cone_sine) + shaft.cone_sine);
}

/// Space sheared so that a direction becomes an axis, and a packet's origins in it. Mirrored where the ray goes down
/// the axis, so that triangles that face it are always run around the same way.
struct Sheared {
  int x, y, z;  // z: the direction's longest component
  float shear_x, shear_y, sign;
  Floats origin_x, origin_y, origin_w;
};

KILN_INLINE Sheared shear_along(const float* direction, const BeamPacket& packet, const float* centre) {
  Sheared s;
  s.z = std::abs(direction[0]) > std::abs(direction[1]) ? 0 : 1;
  if (std::abs(direction[2]) > std::abs(direction[s.z])) s.z = 2;
  s.x = (s.z + 1) % 3;
  s.y = (s.z + 2) % 3;
  s.shear_x = direction[s.x] / direction[s.z];
  s.shear_y = direction[s.y] / direction[s.z];
  s.sign = direction[s.z] > 0 ? 1.f : -1.f;
  const Floats origin_z = load(packet.origin[s.z]) - centre[s.z];
  s.origin_x = ((load(packet.origin[s.x]) - centre[s.x]) - origin_z * s.shear_x) * s.sign;
  s.origin_y = (load(packet.origin[s.y]) - centre[s.y]) - origin_z * s.shear_y;
  s.origin_w = origin_z * s.sign;
  return s;
}

/// A triangle and a direction, for all receivers of a packet.
struct TriangleHits {
  Floats inside;      ///< at least 0 where the ray meets the triangle
  Floats depth;       ///< its distance along the sheared axis times twice_area
  Floats twice_area;  ///< of the triangle as the direction sees it
};

KILN_INLINE TriangleHits hits_of(const Floats (&corner_x)[3], const Floats (&corner_y)[3], const Floats (&corner_w)[3],
                                 int i, const Floats& origin_x, const Floats& origin_y, const Floats& origin_w,
                                 bool outside) {
  const Floats ax = corner_x[0][i] - origin_x, ay = corner_y[0][i] - origin_y;
  const Floats bx = corner_x[1][i] - origin_x, by = corner_y[1][i] - origin_y;
  const Floats cx = corner_x[2][i] - origin_x, cy = corner_y[2][i] - origin_y;
  const Floats u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
  const Floats depth =
      u * (corner_w[0][i] - origin_w) + v * (corner_w[1][i] - origin_w) + w * (corner_w[2][i] - origin_w);
  // Inside all edges, whichever way around, and on the ray's side.
  const Floats one_way = least(least(u, v), w);
  const Floats other_way = outside ? Floats{} - 1 : -greatest(greatest(u, v), w);
  const Floats area = u + v + w;
  return {depth > 0 ? one_way : (depth < 0 ? other_way : Floats{} - 1), greatest(depth, -depth), greatest(area, -area)};
}

/// Clears the weights of the receivers that a candidate hides from one direction; returns whether any triangle was
/// near enough to be tested. `first` is the candidate to begin with, and becomes the one that hid the last receivers.
KILN_ANY_VECTOR_WIDTH bool shade(const BeamPacket& packet, const float* centre, const float* half, float slack,
                                 const float* direction, const BeamScene::Cluster* const* candidates,
                                 int candidate_count, const BeamBoxes* boxes, bool outside, float doubtful, int& first,
                                 float* weight) {
  // Step 1: the candidates whose box the beam meets.
  constexpr int most = 256;
  std::uint16_t met[most];
  bool tested = false;
  Floats weights = load(weight);

  float along[3] = {direction[0], direction[1], direction[2]};
  float inverses[3];
  for (int axis = 0; axis < 3; ++axis) inverses[axis] = inverse(along[axis]);

  const auto [x, y, z, shear_x, shear_y, sign, origin_x, origin_y, origin_w] = shear_along(direction, packet, centre);
  const float beam_x = (half[x] + std::abs(shear_x) * half[z]) * looser + slack;
  const float beam_y = (half[y] + std::abs(shear_y) * half[z]) * looser + slack;
  const float beam_w = half[z] * looser + slack;

  for (int begin = 0; begin < candidate_count; begin += most) {
    int met_count = 0;
    for (int group = begin; group < std::min(candidate_count, begin + most); group += beam_lanes) {
      const BeamBoxes& box = boxes[group / beam_lanes];
      Floats nearest{}, farthest = Floats{} + std::numeric_limits<float>::max();
      for (int axis = 0; axis < 3; ++axis) {
        const Floats a = load(box.lower[axis]) * inverses[axis], b = load(box.upper[axis]) * inverses[axis];
        nearest = greatest(nearest, least(a, b));
        farthest = least(farthest, greatest(a, b));
      }
      const Floats cosine = load(box.cone_axis[0]) * direction[0] + load(box.cone_axis[1]) * direction[1] +
                            load(box.cone_axis[2]) * direction[2];
      std::uint32_t meets =
          mask_at_most(nearest, farthest * looser) & mask_at_most(cosine, load(box.cone_sine) + (outside ? 0.f : 2.f));
      for (; meets != 0; meets &= meets - 1) {
        const int k = group + __builtin_ctz(meets);
        if (k < candidate_count) met[met_count++] = static_cast<std::uint16_t>(k - begin);
      }
    }
    // What hid the neighbouring direction comes first.
    for (int k = 1; k < met_count; ++k)
      if (met[k] + begin == first) std::swap(met[0], met[k]);

    for (int k = 0; k < met_count; ++k) {
      // Step 2: its triangles that the beam meets.
      const BeamScene::Cluster& cluster = *candidates[begin + met[k]];
      Floats corner_x[3], corner_y[3], corner_w[3];
      for (int c = 0; c < 3; ++c) {
        const Floats corner_z = load(cluster.corner[c][z]) - centre[z];
        corner_x[c] = ((load(cluster.corner[c][x]) - centre[x]) - corner_z * shear_x) * sign;
        corner_y[c] = (load(cluster.corner[c][y]) - centre[y]) - corner_z * shear_y;
        corner_w[c] = corner_z * sign;
      }
      const Floats inside_x = least(beam_x - least(least(corner_x[0], corner_x[1]), corner_x[2]),
                                    beam_x + greatest(greatest(corner_x[0], corner_x[1]), corner_x[2]));
      const Floats inside_y = least(beam_y - least(least(corner_y[0], corner_y[1]), corner_y[2]),
                                    beam_y + greatest(greatest(corner_y[0], corner_y[1]), corner_y[2]));
      const Floats before = beam_w + greatest(greatest(corner_w[0], corner_w[1]), corner_w[2]);
      const Floats area_1 = (corner_x[1] - corner_x[0]) * (corner_y[2] - corner_y[0]);
      const Floats area_2 = (corner_y[1] - corner_y[0]) * (corner_x[2] - corner_x[0]);
      const Floats rounding = 1e-6f * (greatest(area_1, -area_1) + greatest(area_2, -area_2));
      const std::uint32_t facing = outside ? mask_at_most(area_1 - area_2, rounding) : all_lanes;
      std::uint32_t triangles =
          facing & mask_at_most(Floats{}, least(least(inside_x, inside_y), before)) & ((2u << (cluster.count - 1)) - 1);
      if (triangles == 0) continue;
      tested = true;

      // Step 3: all receivers against each of these triangles, those beside the receivers last: there float32 may take
      // what lies behind a receiver for a hit, so that hits are decided in float64.
      const std::uint32_t beside = triangles & mask_at_most(least(least(corner_w[0], corner_w[1]), corner_w[2]),
                                                            Floats{} + (half[z] + doubtful));
      for (triangles &= ~beside; triangles != 0; triangles &= triangles - 1) {
        const TriangleHits hits =
            hits_of(corner_x, corner_y, corner_w, __builtin_ctz(triangles), origin_x, origin_y, origin_w, outside);
        weights = hits.inside >= 0 ? Floats{} : weights;
      }
      for (triangles = beside; triangles != 0; triangles &= triangles - 1) {
        const int i = __builtin_ctz(triangles);
        TriangleHits hits = hits_of(corner_x, corner_y, corner_w, i, origin_x, origin_y, origin_w, outside);
        std::uint32_t doubts = mask_at_most(Floats{}, hits.inside) & ~mask_at_most(weights, Floats{});
        if (doubts == 0) continue;
        doubts &= mask_at_most(hits.depth, hits.twice_area * doubtful);
        for (; doubts != 0; doubts &= doubts - 1) {
          const int r = __builtin_ctz(doubts);
          if (!is_before(at_lane(packet.origin, r), Eigen::Vector3f(direction[0], direction[1], direction[2]),
                         at_lane(cluster.corner[0], i), at_lane(cluster.corner[1], i), at_lane(cluster.corner[2], i)))
            hits.inside[r] = -1;
        }
        weights = hits.inside >= 0 ? Floats{} : weights;
      }
      if (mask_at_most(weights, Floats{}) == all_lanes) {
        store(weight, Floats{});
        first = begin + met[k];
        return true;
      }
    }
  }
  store(weight, weights);
  return tested;
}

/// Adds to winding[r] how often the ray of receiver r leaves the cluster's triangles less how often it enters them, and
/// to doubt[r] where it meets an edge.
KILN_ANY_VECTOR_WIDTH void wind(const BeamPacket& packet, const float* centre, const float* direction,
                                const BeamScene::Cluster& cluster, float* winding, float* doubt) {
  const auto [x, y, z, shear_x, shear_y, sign, origin_x, origin_y, origin_w] = shear_along(direction, packet, centre);
  const Floats one = Floats{} + 1.f;
  Floats sum = load(winding), doubtful = load(doubt);
  for (int i = 0; i < cluster.count; ++i) {
    Floats corner_x[3], corner_y[3], corner_w[3];
    for (int c = 0; c < 3; ++c) {
      const float corner_z = cluster.corner[c][z][i] - centre[z];
      corner_x[c] = ((cluster.corner[c][x][i] - centre[x]) - corner_z * shear_x) * sign - origin_x;
      corner_y[c] = ((cluster.corner[c][y][i] - centre[y]) - corner_z * shear_y) - origin_y;
      corner_w[c] = corner_z * sign - origin_w;
    }
    const Floats u = corner_x[2] * corner_y[1] - corner_y[2] * corner_x[1];
    const Floats v = corner_x[0] * corner_y[2] - corner_y[0] * corner_x[2];
    const Floats w = corner_x[1] * corner_y[0] - corner_y[1] * corner_x[0];
    const Floats depth = u * corner_w[0] + v * corner_w[1] + w * corner_w[2];
    const Floats smallest = least(least(u, v), w), largest = greatest(greatest(u, v), w);
    const Floats enters = smallest > 0 ? (depth > 0 ? one : Floats{}) : Floats{};
    const Floats leaves = largest < 0 ? (depth < 0 ? one : Floats{}) : Floats{};
    sum += leaves - enters;
    doubtful += smallest == 0 ? one : Floats{};
    doubtful += largest == 0 ? one : Floats{};
  }
  store(winding, sum);
  store(doubt, doubtful);
}

/// Nearest integers, as to_fixed_point; |v| < 2^31.
KILN_INLINE Bits round_to_integers(const Floats& v) {
  const Floats positive = v < 0 ? -v : v;
  const Floats whole = positive < 8388608.f ? (positive + 8388608.f) - 8388608.f : positive;
  return __builtin_convertvector(v < 0 ? -whole : whole, Bits);
}

KILN_INLINE void add_fixed_point(const Floats& sum, std::int64_t* totals) {
  Longs total;
  std::memcpy(&total, totals, sizeof total);
  total += __builtin_convertvector(round_to_integers(sum * fixed_point_one), Longs);
  std::memcpy(totals, &total, sizeof total);
}

}  // namespace

KILN_ANY_VECTOR_WIDTH void add_products(const BeamWeights& weights, const float* basis, int coefficients,
                                        std::int64_t (*sums)[beam_lanes]) {
  int i = 0;
  for (; i + 4 < coefficients; i += 5) {
    Floats s0{}, s1{}, s2{}, s3{}, s4{};
    for (std::uint32_t left = weights.facing; left != 0; left &= left - 1) {
      const int d = __builtin_ctz(left);
      const Floats weight = load(weights.weight[d]);
      const float* row = basis + static_cast<std::size_t>(d) * coefficients + i;
      s0 += weight * row[0];
      s1 += weight * row[1];
      s2 += weight * row[2];
      s3 += weight * row[3];
      s4 += weight * row[4];
    }
    add_fixed_point(s0, sums[i]);
    add_fixed_point(s1, sums[i + 1]);
    add_fixed_point(s2, sums[i + 2]);
    add_fixed_point(s3, sums[i + 3]);
    add_fixed_point(s4, sums[i + 4]);
  }
  for (; i < coefficients; ++i) {
    Floats s{};
    for (std::uint32_t left = weights.facing; left != 0; left &= left - 1) {
      const int d = __builtin_ctz(left);
      s += load(weights.weight[d]) * basis[static_cast<std::size_t>(d) * coefficients + i];
    }
    add_fixed_point(s, sums[i]);
  }
}

BeamTracer::BeamTracer(const BeamScene& scene)
    : scene_(scene),
      node_children_(scene.nodes.size(), unknown_children),
      cluster_slots_(scene.clusters.size(), unknown) {}

void BeamTracer::begin(const BeamPacket& packet) {
  packet_ = packet;
  slack_ = scene_.slack;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = std::minmax_element(packet.origin[axis], packet.origin[axis] + beam_lanes);
    centre_[axis] = (*lower + *upper) / 2;
    half_[axis] = std::max(*upper - centre_[axis], centre_[axis] - *lower);
    slack_ = std::max(slack_, 8 * std::numeric_limits<float>::epsilon() * std::max(std::abs(*lower), std::abs(*upper)));
  }
  for (int r = 0; r < beam_lanes; ++r) {
    plane_[r] = 0;
    for (int axis = 0; axis < 3; ++axis) plane_[r] += packet.normal[axis][r] * (packet.origin[axis][r] - centre_[axis]);
  }
  for (std::uint32_t node : known_nodes_) node_children_[node] = unknown_children;
  for (std::uint32_t cluster : known_clusters_) cluster_slots_[cluster] = unknown;
  known_nodes_.clear();
  known_clusters_.clear();
  local_count_ = 0;
  outside_ = stands_outside();
}

BeamTracer::Shaft BeamTracer::shaft_along(const float (*direction)[3], std::uint32_t which, float least_sine) const {
  Shaft shaft;
  constexpr float spread = 1e-6f;  // of unit vectors in float32, with room
  float squared_length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    float lower = 1, upper = -1, sum = 0;
    for (std::uint32_t left = which; left != 0; left &= left - 1) {
      const float along = direction[__builtin_ctz(left)][axis];
      lower = std::min(lower, along);
      upper = std::max(upper, along);
      sum += along;
    }
    shaft.direction_lower[axis] = lower - spread;
    shaft.direction_upper[axis] = upper + spread;
    shaft.inverse_lower[axis] = inverse(shaft.direction_lower[axis]);
    shaft.inverse_upper[axis] = inverse(shaft.direction_upper[axis]);
    shaft.origin_lower[axis] = centre_[axis] - half_[axis] - slack_;
    shaft.origin_upper[axis] = centre_[axis] + half_[axis] + slack_;
    shaft.cone_axis[axis] = sum;
    squared_length += sum * sum;
  }
  shaft.cone_sine = 2;
  const float scale = squared_length > 0 ? 1 / std::sqrt(squared_length) : 0;
  for (float& along : shaft.cone_axis) along *= scale;
  if (least_sine > 1) return shaft;
  float least_cosine = 1;
  for (std::uint32_t left = which; left != 0; left &= left - 1) {
    const float* along = direction[__builtin_ctz(left)];
    least_cosine = std::min(
        least_cosine, along[0] * shaft.cone_axis[0] + along[1] * shaft.cone_axis[1] + along[2] * shaft.cone_axis[2]);
  }
  if (least_cosine > 0) shaft.cone_sine = std::sqrt(std::max(0.f, 1 - least_cosine * least_cosine)) + 1e-5f;
  return shaft;
}

bool BeamTracer::stands_outside() {
  if (!scene_.closed || scene_.nodes.empty()) return false;
  float direction[3];
  for (int axis = 0; axis < 3; ++axis) direction[axis] = packet_.normal[axis][0];
  const Shaft shaft = shaft_along(&direction, 1u, 2.f);
  alignas(64) float winding[beam_lanes] = {}, doubt[beam_lanes] = {};
  stack_.assign(1, 0);
  while (!stack_.empty()) {
    const BeamScene::Node& node = scene_.nodes[stack_.back()];
    stack_.pop_back();
    std::uint32_t children = boxes_in(shaft, node.boxes) & ((2u << (node.count - 1)) - 1);
    for (; children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      if ((node.is_cluster >> i & 1) == 0)
        stack_.push_back(node.child[i]);
      else
        wind(packet_, centre_, direction, scene_.clusters[node.child[i]], winding, doubt);
    }
  }
  for (int r = 0; r < beam_lanes; ++r)
    if (winding[r] != 0 || doubt[r] != 0) return false;
  return true;
}

void BeamTracer::gather(const Shaft& shaft) {
  candidates_.clear();
  boxes_.clear();
  stack_.clear();
  if (!scene_.nodes.empty()) stack_.push_back(0);
  while (!stack_.empty()) {
    const std::uint32_t index = stack_.back();
    stack_.pop_back();
    const BeamScene::Node& node = scene_.nodes[index];
    if (node_children_[index] == unknown_children) {
      node_children_[index] = boxes_above(packet_, plane_, centre_, slack_, node.boxes, node.count);
      known_nodes_.push_back(index);
    }
    const std::uint32_t above = node_children_[index];
    std::uint32_t children = above & all_lanes;
    if (children != 0) children &= boxes_in(shaft, node.boxes);
    for (; children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      const std::uint32_t child = node.child[i];
      if ((node.is_cluster >> i & 1) == 0)
        stack_.push_back(child);
      else
        add_candidate(node, i, (above >> (16 + i) & 1) != 0);
    }
  }
}

void BeamTracer::add_candidate(const BeamScene::Node& node, int child, bool whole) {
  const std::uint32_t cluster = node.child[child];
  const LocalCluster* local = nullptr;
  if (!whole) {
    std::int32_t& slot = cluster_slots_[cluster];
    if (slot == none) return;
    if (slot == unknown) {
      known_clusters_.push_back(cluster);
      if (local_count_ == local_.size()) local_.emplace_back();
      LocalCluster& fresh = local_[local_count_];
      if (keep_above(packet_, plane_, centre_, slack_, scene_.clusters[cluster], fresh.triangles, fresh.lower,
                     fresh.upper) == 0) {
        slot = none;
        return;
      }
      slot = static_cast<std::int32_t>(local_count_++);
    }
    local = &local_[slot];
  }
  candidates_.push_back(local != nullptr ? &local->triangles : &scene_.clusters[cluster]);
  const std::size_t lane = (candidates_.size() - 1) % beam_lanes;
  if (lane == 0) boxes_.emplace_back();
  BeamBoxes& boxes = boxes_.back();
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = local != nullptr ? local->lower[axis] : node.boxes.lower[axis][child];
    const float upper = local != nullptr ? local->upper[axis] : node.boxes.upper[axis][child];
    boxes.lower[axis][lane] = (lower - centre_[axis]) - (half_[axis] + slack_);
    boxes.upper[axis][lane] = (upper - centre_[axis]) + (half_[axis] + slack_);
    boxes.cone_axis[axis][lane] = node.boxes.cone_axis[axis][child];
  }
  boxes.cone_sine[lane] = node.boxes.cone_sine[child];
}

void BeamTracer::trace(const float (*direction)[3], int count, BeamWeights& weights) {
  weights.facing = face(packet_, direction, count, weights);
  weights.lit = 0;
  if (weights.facing == 0) return;

  const Shaft shaft = shaft_along(direction, weights.facing, outside_ ? 0.f : 2.f);
  gather(shaft);
  if (candidates_.empty()) {
    weights.lit = weights.facing;
    return;
  }
  int first = 0;
  for (std::uint32_t left = weights.facing; left != 0; left &= left - 1) {
    const int d = __builtin_ctz(left);
    if (!shade(packet_, centre_, half_, slack_, direction[d], candidates_.data(), static_cast<int>(candidates_.size()),
               boxes_.data(), outside_, scene_.doubtful, first, weights.weight[d]))
      weights.lit |= 1u << d;
  }
}

}  // namespace kiln
