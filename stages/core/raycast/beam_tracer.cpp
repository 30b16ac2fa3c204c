// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/beam_tracer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "raycast/vector_width.h"

namespace kiln {

namespace {

constexpr std::int32_t unknown = -1, none = -2;
constexpr BeamPlaces unknown_places = {0, 1, 0};  // a box wholly above a plane also rises above it
constexpr std::size_t most_of_block = 128, most_of_quarter = 128;
constexpr float direction_rounding = 1e-6f;  // of unit vectors in float32, with a margin
constexpr int few_clusters = 64;             // up to so many are tested without a search
constexpr int few_directions = 3;            // up to so many, triangles are not packed
constexpr std::size_t all_of_them = std::numeric_limits<std::size_t>::max();

/// Returns 1 / x; replaces x by a tiny number of its sign if it is 0.
float inverse(float& x) {
  constexpr float tiny = 1e-12f;
  if (std::abs(x) < tiny) x = x > 0 ? tiny : -tiny;
  return 1 / x;
}

/// Sets the first `count` bits, 1 to 32.
std::uint32_t first_bits(int count) { return (2u << (count - 1)) - 1; }

/// Sets the bits of group `group` of 16 that belong to `count` entries.
std::uint32_t own_lanes(std::size_t count, std::size_t group) {
  return first_bits(static_cast<int>(std::min<std::size_t>(beam_lanes, count - group * beam_lanes)));
}

Eigen::Vector3f at_lane(const float (&lanes)[3][beam_lanes], int lane) {
  return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
}

/// Moves the origins of a shaft to zero, for boxes that are enlarged by the packet's box.
BeamShaft from_zero(BeamShaft shaft) {
  for (int axis = 0; axis < 3; ++axis) shaft.origin_lower[axis] = shaft.origin_upper[axis] = 0;
  return shaft;
}

void copy_box(const BeamBoxes& from, int i, BeamBoxes& to, std::size_t lane) {
  for (int axis = 0; axis < 3; ++axis) {
    to.lower[axis][lane] = from.lower[axis][i];
    to.upper[axis][lane] = from.upper[axis][i];
    to.cone_axis[axis][lane] = from.cone_axis[axis][i];
  }
  to.cone_sine[lane] = from.cone_sine[i];
  to.sheet_sine[lane] = from.sheet_sine[i];
}

/// Halves the directions whose bit is set, across the longest side of their box.
std::array<std::uint32_t, 2> halves(const float (*direction)[3], std::uint32_t which) {
  int sorted[beam_directions], count = 0;
  float lower[3] = {1, 1, 1}, upper[3] = {-1, -1, -1};
  for (std::uint32_t left = which; left != 0; left &= left - 1) {
    const int d = sorted[count++] = __builtin_ctz(left);
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], direction[d][axis]);
      upper[axis] = std::max(upper[axis], direction[d][axis]);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (upper[axis] - lower[axis] > upper[longest] - lower[longest]) longest = axis;
  std::stable_sort(sorted, sorted + count, [&](int a, int b) { return direction[a][longest] < direction[b][longest]; });
  std::array<std::uint32_t, 2> two = {};
  for (int k = 0; k < count; ++k) two[k < count / 2 ? 0 : 1] |= 1u << sorted[k];
  return two;
}

}  // namespace

BeamBlock::BeamBlock(std::span<const Eigen::Vector3f> directions) : count(static_cast<int>(directions.size())) {
  for (int d = 0; d < count; ++d)
    for (int axis = 0; axis < 3; ++axis) direction[d][axis] = directions[d][axis];
  const std::array<std::uint32_t, 2> two = halves(direction, count > 0 ? (2u << (count - 1)) - 1 : 0);
  for (int half = 0; half < 2; ++half) {
    const std::array<std::uint32_t, 2> quarters = halves(direction, two[half]);
    quarter[2 * half] = quarters[0];
    quarter[2 * half + 1] = quarters[1];
  }
}

void BeamTracer::Front::clear() {
  clusters.clear();
  boxes.clear();
  may_be_sheets.clear();
  sheets.clear();
  sheet_boxes.clear();
  nodes.clear();
}

BeamTracer::BeamTracer(const BeamScene& scene)
    : scene_(scene),
      kernels_(beam_kernels()),
      node_places_(scene.nodes.size(), unknown_places),
      cluster_slots_(scene.clusters.size(), unknown),
      packed_(few_clusters) {
  if (scene.root != BeamScene::no_node) root_.nodes.push_back(scene.root);
}

void BeamTracer::begin(const BeamPacket& packet) {
  packet_ = packet;
  float& slack = span_.slack = scene_.slack;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = std::minmax_element(packet.origin[axis], packet.origin[axis] + beam_lanes);
    span_.centre[axis] = (*lower + *upper) / 2;
    span_.half[axis] = std::max(*upper - span_.centre[axis], span_.centre[axis] - *lower);
    slack = std::max(slack, 8 * std::numeric_limits<float>::epsilon() * std::max(std::abs(*lower), std::abs(*upper)));
  }
  for (int r = 0; r < beam_lanes; ++r) {
    span_.plane[r] = 0;
    for (int axis = 0; axis < 3; ++axis)
      span_.plane[r] += packet.normal[axis][r] * (packet.origin[axis][r] - span_.centre[axis]);
  }
  for (std::uint32_t node : known_nodes_) node_places_[node] = unknown_places;
  for (std::uint32_t cluster : known_clusters_) cluster_slots_[cluster] = unknown;
  known_nodes_.clear();
  known_clusters_.clear();
  local_count_ = 0;
  outside_ = stands_outside();
}

bool BeamTracer::culls_backs(const BeamShaft& shaft) {
  if (!outside_ || scene_.lids == BeamScene::no_node) return outside_;
  BeamShaft facing = shaft;
  facing.outside = true;
  queue_.assign(1, scene_.lids);
  while (!queue_.empty()) {
    const BeamScene::Node& node = scene_.nodes[queue_.back()];
    queue_.pop_back();
    ++work_.boxes;
    const std::uint32_t met = kernels_.meet(facing, node.boxes).met & first_bits(node.count);
    if ((met & node.is_cluster) != 0) return false;
    for (std::uint32_t left = met; left != 0; left &= left - 1) queue_.push_back(node.child[__builtin_ctz(left)]);
  }
  return true;
}

BeamShaft BeamTracer::shaft_along(const float (*direction)[3], std::uint32_t which) const {
  BeamShaft shaft;
  float squared_length = 0;
  for (int axis = 0; axis < 3; ++axis) {
    float lower = 1, upper = -1, sum = 0;
    for (std::uint32_t left = which; left != 0; left &= left - 1) {
      const float along = direction[__builtin_ctz(left)][axis];
      lower = std::min(lower, along);
      upper = std::max(upper, along);
      sum += along;
    }
    shaft.direction_lower[axis] = lower - direction_rounding;
    shaft.direction_upper[axis] = upper + direction_rounding;
    shaft.inverse_lower[axis] = inverse(shaft.direction_lower[axis]);
    shaft.inverse_upper[axis] = inverse(shaft.direction_upper[axis]);
    shaft.origin_lower[axis] = span_.centre[axis] - span_.half[axis] - span_.slack;
    shaft.origin_upper[axis] = span_.centre[axis] + span_.half[axis] + span_.slack;
    shaft.cone_axis[axis] = sum;
    squared_length += sum * sum;
  }
  shaft.cone_sine = 2;
  const float scale = squared_length > 0 ? 1 / std::sqrt(squared_length) : 0;
  for (float& along : shaft.cone_axis) along *= scale;
  shaft.outside = false;
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
  outside_ = false;
  if (scene_.root == BeamScene::no_node) return false;
  float direction[3];
  for (int axis = 0; axis < 3; ++axis) direction[axis] = packet_.normal[axis][0];
  const BeamShaft shaft = shaft_along(&direction, 1u);
  alignas(64) float winding[beam_lanes] = {}, doubt[beam_lanes] = {};
  queue_.assign(1, scene_.root);
  if (scene_.lids != BeamScene::no_node) queue_.push_back(scene_.lids);
  while (!queue_.empty()) {
    const BeamScene::Node& node = scene_.nodes[queue_.back()];
    queue_.pop_back();
    ++work_.boxes;
    std::uint32_t children = kernels_.meet(shaft, node.boxes).met & ((2u << (node.count - 1)) - 1);
    for (; children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      if ((node.is_cluster >> i & 1) == 0)
        queue_.push_back(node.child[i]);
      else
        kernels_.wind(packet_, span_, direction, scene_.clusters[node.child[i]], winding, doubt);
    }
  }
  for (int r = 0; r < beam_lanes; ++r)
    if (winding[r] > 0 || doubt[r] != 0) return false;
  return true;
}

void BeamTracer::set_box(const float* lower, const float* upper, const BeamBoxes& from, int i, std::size_t lane,
                         BeamBoxes& to) const {
  for (int axis = 0; axis < 3; ++axis) {
    to.lower[axis][lane] = (lower[axis] - span_.centre[axis]) - (span_.half[axis] + span_.slack);
    to.upper[axis][lane] = (upper[axis] - span_.centre[axis]) + (span_.half[axis] + span_.slack);
    to.cone_axis[axis][lane] = from.cone_axis[axis][i];
  }
  to.cone_sine[lane] = from.cone_sine[i];
  to.sheet_sine[lane] = from.sheet_sine[i];
}

BeamTracer::Verdict BeamTracer::search(const Front& from, const BeamShaft& shaft, std::size_t most, Front& found) {
  found.clear();
  std::size_t edges = 0;
  // Step 1: test clusters and sheets.
  work_.boxes += from.boxes.size() + from.sheet_boxes.size();
  const BeamShaft about_zero = from_zero(shaft);
  for (std::size_t group = 0; group < from.boxes.size(); ++group) {
    const auto [met, sheets] = kernels_.meet(about_zero, from.boxes[group]);
    for (std::uint32_t left = met & own_lanes(from.clusters.size(), group); left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      const std::size_t lane = found.clusters.size() % beam_lanes;
      const std::uint32_t may_be_sheet = from.may_be_sheets[group] >> i & 1;
      found.clusters.push_back(from.clusters[group * beam_lanes + i]);
      if (lane == 0) found.boxes.emplace_back(), found.may_be_sheets.push_back(0);
      found.may_be_sheets.back() |= may_be_sheet << lane;
      copy_box(from.boxes[group], i, found.boxes.back(), lane);
      edges += 1 - (may_be_sheet & sheets >> i);
    }
  }
  for (std::size_t group = 0; group < from.sheet_boxes.size(); ++group)
    for (std::uint32_t left =
             kernels_.meet(about_zero, from.sheet_boxes[group]).met & own_lanes(from.sheets.size(), group);
         left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      const std::size_t lane = found.sheets.size() % beam_lanes;
      found.sheets.push_back(from.sheets[group * beam_lanes + i]);
      if (lane == 0) found.sheet_boxes.emplace_back();
      copy_box(from.sheet_boxes[group], i, found.sheet_boxes.back(), lane);
    }
  // Step 2: open nodes, level after level.
  found.nodes.assign(from.nodes.begin(), from.nodes.end());
  std::size_t next = 0;
  for (; next < found.nodes.size() && found.clusters.size() + found.nodes.size() - next < most; ++next)
    edges += open(found.nodes[next], shaft, found);
  found.nodes.erase(found.nodes.begin(), found.nodes.begin() + static_cast<std::ptrdiff_t>(next));
  edges += found.nodes.size();
  // Step 3: cast the one ray that stands for all.
  if (edges > 0) return Verdict::mixed;
  return meets_sheet(found, shaft) ? Verdict::hidden : Verdict::lit;
}

std::size_t BeamTracer::open(std::uint32_t index, const BeamShaft& shaft, Front& found) {
  const BeamScene::Node& node = scene_.nodes[index];
  BeamPlaces& places = node_places_[index];
  if (places.whole == unknown_places.whole && places.above == 0) {
    places = kernels_.places_of(packet_, span_, node.boxes, node.count);
    known_nodes_.push_back(index);
  }
  if (places.above == 0) return 0;
  ++work_.boxes;
  const auto [met, sheets] = kernels_.meet(shaft, node.boxes);
  const std::uint32_t may_be_sheets = places.whole & places.apart;
  std::size_t edges = 0;
  for (std::uint32_t left = met & places.above; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    const bool is_sheet = (may_be_sheets & sheets) >> i & 1;
    if ((node.is_cluster >> i & 1) != 0) {
      if (add_cluster(node, i, (places.whole >> i & 1) != 0, (may_be_sheets >> i & 1) != 0, found) && !is_sheet)
        ++edges;
    } else if (is_sheet) {
      const std::size_t lane = found.sheets.size() % beam_lanes;
      found.sheets.push_back(node.child[i]);
      if (lane == 0) found.sheet_boxes.emplace_back();
      const Eigen::Vector3f lower = at_lane(node.boxes.lower, i), upper = at_lane(node.boxes.upper, i);
      set_box(lower.data(), upper.data(), node.boxes, i, lane, found.sheet_boxes.back());
    } else {
      found.nodes.push_back(node.child[i]);
    }
  }
  return edges;
}

void BeamTracer::open_sheets(const BeamShaft& shaft, Front& front) {
  queue_.assign(front.sheets.begin(), front.sheets.end());
  front.sheets.clear();
  front.sheet_boxes.clear();
  while (!queue_.empty()) {
    const BeamScene::Node& node = scene_.nodes[queue_.back()];
    queue_.pop_back();
    ++work_.boxes;
    for (std::uint32_t left = kernels_.meet(shaft, node.boxes).met & first_bits(node.count); left != 0;
         left &= left - 1) {
      const int i = __builtin_ctz(left);
      if ((node.is_cluster >> i & 1) != 0)
        add_cluster(node, i, true, true, front);
      else
        queue_.push_back(node.child[i]);
    }
  }
}

bool BeamTracer::meets_sheet(const Front& front, const BeamShaft& shaft) {
  if (front.clusters.empty() && front.sheets.empty()) return false;
  // Takes some ray of the shaft: from its middle, along the mean of its directions.
  BeamShaft ray = shaft;
  float direction[3];
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin_lower[axis] = span_.centre[axis] - span_.slack;
    ray.origin_upper[axis] = span_.centre[axis] + span_.slack;
    direction[axis] = shaft.cone_axis[axis];
    ray.direction_lower[axis] = direction[axis] - direction_rounding;
    ray.direction_upper[axis] = direction[axis] + direction_rounding;
    ray.inverse_lower[axis] = inverse(ray.direction_lower[axis]);
    ray.inverse_upper[axis] = inverse(ray.direction_upper[axis]);
  }
  const BeamShaft about_zero = from_zero(ray);
  for (std::size_t group = 0; group < front.boxes.size(); ++group)
    for (std::uint32_t left =
             kernels_.meet(about_zero, front.boxes[group]).met & own_lanes(front.clusters.size(), group);
         left != 0; left &= left - 1)
      if (kernels_.hits(span_, direction, shaft.outside, *front.clusters[group * beam_lanes + __builtin_ctz(left)]))
        return true;
  queue_.assign(front.sheets.begin(), front.sheets.end());
  while (!queue_.empty()) {
    const BeamScene::Node& node = scene_.nodes[queue_.back()];
    queue_.pop_back();
    ++work_.boxes;
    for (std::uint32_t left = kernels_.meet(ray, node.boxes).met & first_bits(node.count); left != 0;
         left &= left - 1) {
      const int i = __builtin_ctz(left);
      if ((node.is_cluster >> i & 1) == 0)
        queue_.push_back(node.child[i]);
      else if (kernels_.hits(span_, direction, shaft.outside, scene_.clusters[node.child[i]]))
        return true;
    }
  }
  return false;
}

bool BeamTracer::add_cluster(const BeamScene::Node& node, int child, bool whole, bool may_be_sheet, Front& front) {
  const std::uint32_t cluster = node.child[child];
  const LocalCluster* local = nullptr;
  if (!whole) {
    std::int32_t& slot = cluster_slots_[cluster];
    if (slot == none) return false;
    if (slot == unknown) {
      known_clusters_.push_back(cluster);
      ++work_.packed;
      if (local_count_ == local_.size()) local_.emplace_back();
      LocalCluster& fresh = local_[local_count_];
      if (kernels_.keep_above(packet_, span_, scene_.clusters[cluster], fresh.triangles, fresh.lower, fresh.upper) ==
          0) {
        slot = none;
        return false;
      }
      slot = static_cast<std::int32_t>(local_count_++);
    }
    local = &local_[slot];
  }
  const std::size_t lane = front.clusters.size() % beam_lanes;
  front.clusters.push_back(local != nullptr ? &local->triangles : &scene_.clusters[cluster]);
  if (lane == 0) front.boxes.emplace_back(), front.may_be_sheets.push_back(0);
  front.may_be_sheets.back() |= (may_be_sheet ? 1u : 0u) << lane;
  const Eigen::Vector3f lower = at_lane(node.boxes.lower, child), upper = at_lane(node.boxes.upper, child);
  set_box(local != nullptr ? local->lower : lower.data(), local != nullptr ? local->upper : upper.data(), node.boxes,
          child, lane, front.boxes.back());
  return true;
}

BeamShaft BeamTracer::shaft_within(const BeamShaft* wider, const float (*direction)[3], std::uint32_t which) {
  BeamShaft shaft = shaft_along(direction, which);
  shaft.outside = (wider != nullptr && wider->outside) || culls_backs(shaft);
  return shaft;
}

void BeamTracer::settle(Verdict verdict, std::uint32_t which, BeamWeights& weights) {
  if (verdict == Verdict::lit) weights.lit |= which;
  if (verdict == Verdict::hidden)
    for (; which != 0; which &= which - 1) std::fill_n(weights.weight[__builtin_ctz(which)], beam_lanes, 0.f);
}

void BeamTracer::trace(const BeamBlock& block, BeamWeights& weights) {
  weights.facing = kernels_.face(packet_, block.direction, block.count, weights);
  weights.lit = 0;
  ++work_.blocks;
  work_.facing += static_cast<std::uint64_t>(std::popcount(weights.facing));
  if (weights.facing == 0) return;
  const BeamShaft shaft = shaft_within(nullptr, block.direction, weights.facing);
  const Verdict verdict = search(root_, shaft, most_of_block, of_block_);
  settle(verdict, weights.facing, weights);
  if (verdict != Verdict::mixed) return;
  for (const std::uint32_t quarter : block.quarter)
    if ((weights.facing & quarter) != 0) trace_quarter(block, weights.facing & quarter, shaft, weights);
}

void BeamTracer::pack(const BeamShaft& shaft) {
  Front& front = of_quarter_;
  work_.packed += front.clusters.size();
  const auto count = static_cast<std::size_t>(kernels_.pack(shaft, span_, front.clusters.data(),
                                                            static_cast<int>(front.clusters.size()), packed_.data(),
                                                            front.boxes.data()));
  front.clusters.resize(count);
  for (std::size_t k = 0; k < count; ++k) front.clusters[k] = &packed_[k];
}

void BeamTracer::trace_quarter(const BeamBlock& block, std::uint32_t facing, const BeamShaft& of_block,
                               BeamWeights& weights) {
  const BeamShaft of_quarter = shaft_within(&of_block, block.direction, facing);
  const Verdict verdict = search(of_block_, of_quarter, most_of_quarter, of_quarter_);
  settle(verdict, facing, weights);
  if (verdict != Verdict::mixed) return;
  const bool is_small = of_quarter_.nodes.empty() && of_quarter_.sheets.empty() &&
                        static_cast<int>(of_quarter_.clusters.size()) <= few_clusters;
  if (is_small && std::popcount(facing) >= few_directions) pack(of_quarter);
  const bool knows_culling = of_quarter.outside || !outside_ || scene_.lids == BeamScene::no_node;
  int first = 0;
  for (; facing != 0; facing &= facing - 1) {
    const int d = __builtin_ctz(facing);
    const Front* front = &of_quarter_;
    bool outside = of_quarter.outside;
    if (!is_small || !knows_culling) {
      const BeamShaft along = shaft_within(&of_quarter, block.direction, 1u << d);
      outside = along.outside;
      if (!is_small) {
        front = &of_direction_;
        const Verdict alone = search(of_quarter_, along, all_of_them, of_direction_);
        settle(alone, 1u << d, weights);
        if (alone != Verdict::mixed) continue;
        open_sheets(along, of_direction_);
      }
    }
    const BeamRay ray{block.direction[d],
                      front->clusters.data(),
                      static_cast<int>(front->clusters.size()),
                      front->boxes.data(),
                      outside,
                      scene_.doubtful,
                      &work_};
    const auto shade = ray.candidate_count > few_clusters ? kernels_.shade_crowded : kernels_.shade;
    if (!shade(packet_, span_, ray, first, weights.weight[d])) weights.lit |= 1u << d;
  }
}

KILN_ANY_VECTOR_WIDTH BlockLanes blocked_lanes(const BeamWeights& weights) {
  BlockLanes blocked = {};
  for (std::uint32_t left = weights.facing & ~weights.lit; left != 0; left &= left - 1) {
    const int d = __builtin_ctz(left);
    std::uint32_t lanes = 0;
    for (int r = beam_lanes - 1; r >= 0; --r) lanes = 2 * lanes + (weights.weight[d][r] > 0 ? 0u : 1u);
    blocked[d] = static_cast<std::uint16_t>(lanes);
  }
  return blocked;
}

void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]) {
  beam_kernels().add_products(weights, basis, coefficients, sums);
}

}  // namespace kiln
