#include "raycast/beam_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kiln {

namespace {

constexpr std::int32_t unknown = -1, none = -2;
constexpr std::uint32_t unknown_children = 0x10000;  // a box wholly above a plane also rises above it
constexpr std::uint32_t all_lanes = (1u << beam_lanes) - 1;
constexpr std::size_t most_of_block = 128, most_of_quarter = 128;
constexpr std::size_t all_of_them = std::numeric_limits<std::size_t>::max();

/// 1 / x, of a tiny number instead of 0; the number's sign is x's.
float inverse(float& x) {
  constexpr float tiny = 1e-12f;
  if (std::abs(x) < tiny) x = x > 0 ? tiny : -tiny;
  return 1 / x;
}

/// Halves the directions whose bit is set across the longest side of their box.
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
  std::stable_sort(sorted, sorted + count,
                   [&](int a, int b) { return direction[a][longest] < direction[b][longest]; });
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
  nodes.clear();
}

BeamTracer::BeamTracer(const BeamScene& scene)
    : scene_(scene),
      kernels_(beam_kernels()),
      node_children_(scene.nodes.size(), unknown_children),
      cluster_slots_(scene.clusters.size(), unknown) {
  if (!scene.nodes.empty()) root_.nodes.push_back(0);
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
  for (std::uint32_t node : known_nodes_) node_children_[node] = unknown_children;
  for (std::uint32_t cluster : known_clusters_) cluster_slots_[cluster] = unknown;
  known_nodes_.clear();
  known_clusters_.clear();
  local_count_ = 0;
  outside_ = stands_outside();
}

BeamShaft BeamTracer::shaft_along(const float (*direction)[3], std::uint32_t which) const {
  BeamShaft shaft;
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
    shaft.origin_lower[axis] = span_.centre[axis] - span_.half[axis] - span_.slack;
    shaft.origin_upper[axis] = span_.centre[axis] + span_.half[axis] + span_.slack;
    shaft.cone_axis[axis] = sum;
    squared_length += sum * sum;
  }
  shaft.cone_sine = 2;
  const float scale = squared_length > 0 ? 1 / std::sqrt(squared_length) : 0;
  for (float& along : shaft.cone_axis) along *= scale;
  if (!outside_) return shaft;
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
  if (!scene_.closed || scene_.nodes.empty()) return false;
  float direction[3];
  for (int axis = 0; axis < 3; ++axis) direction[axis] = packet_.normal[axis][0];
  const BeamShaft shaft = shaft_along(&direction, 1u);
  alignas(64) float winding[beam_lanes] = {}, doubt[beam_lanes] = {};
  queue_.assign(1, 0);
  while (!queue_.empty()) {
    const BeamScene::Node& node = scene_.nodes[queue_.back()];
    queue_.pop_back();
    std::uint32_t children = kernels_.boxes_in(shaft, node.boxes) & ((2u << (node.count - 1)) - 1);
    for (; children != 0; children &= children - 1) {
      const int i = __builtin_ctz(children);
      if ((node.is_cluster >> i & 1) == 0)
        queue_.push_back(node.child[i]);
      else
        kernels_.wind(packet_, span_, direction, scene_.clusters[node.child[i]], winding, doubt);
    }
  }
  for (int r = 0; r < beam_lanes; ++r)
    if (winding[r] != 0 || doubt[r] != 0) return false;
  return true;
}

void BeamTracer::search(const Front& from, const BeamShaft& shaft, std::size_t most, Front& found) {
  found.clear();
  // Step 1: the clusters.
  BeamShaft about_zero = shaft;
  for (int axis = 0; axis < 3; ++axis) about_zero.origin_lower[axis] = about_zero.origin_upper[axis] = 0;
  for (std::size_t group = 0; group < from.boxes.size(); ++group) {
    const BeamBoxes& boxes = from.boxes[group];
    std::uint32_t met = kernels_.boxes_in(about_zero, boxes);
    const std::size_t left = from.clusters.size() - group * beam_lanes;
    if (left < beam_lanes) met &= (1u << left) - 1;
    for (; met != 0; met &= met - 1) {
      const int i = __builtin_ctz(met);
      const std::size_t lane = found.clusters.size() % beam_lanes;
      found.clusters.push_back(from.clusters[group * beam_lanes + i]);
      if (lane == 0) found.boxes.emplace_back();
      BeamBoxes& kept = found.boxes.back();
      for (int axis = 0; axis < 3; ++axis) {
        kept.lower[axis][lane] = boxes.lower[axis][i];
        kept.upper[axis][lane] = boxes.upper[axis][i];
        kept.cone_axis[axis][lane] = boxes.cone_axis[axis][i];
      }
      kept.cone_sine[lane] = boxes.cone_sine[i];
    }
  }
  // Step 2: the nodes, level after level.
  found.nodes.assign(from.nodes.begin(), from.nodes.end());
  std::size_t next = 0;
  for (; next < found.nodes.size() && found.clusters.size() + found.nodes.size() - next < most; ++next)
    open(found.nodes[next], shaft, found);
  found.nodes.erase(found.nodes.begin(), found.nodes.begin() + static_cast<std::ptrdiff_t>(next));
}

void BeamTracer::open(std::uint32_t index, const BeamShaft& shaft, Front& found) {
  const BeamScene::Node& node = scene_.nodes[index];
  if (node_children_[index] == unknown_children) {
    node_children_[index] = kernels_.boxes_above(packet_, span_, node.boxes, node.count);
    known_nodes_.push_back(index);
  }
  const std::uint32_t above = node_children_[index];
  std::uint32_t children = above & all_lanes;
  if (children != 0) children &= kernels_.boxes_in(shaft, node.boxes);
  for (; children != 0; children &= children - 1) {
    const int i = __builtin_ctz(children);
    if ((node.is_cluster >> i & 1) == 0)
      found.nodes.push_back(node.child[i]);
    else
      add_cluster(node, i, (above >> (16 + i) & 1) != 0, found);
  }
}

void BeamTracer::add_cluster(const BeamScene::Node& node, int child, bool whole, Front& front) {
  const std::uint32_t cluster = node.child[child];
  const LocalCluster* local = nullptr;
  if (!whole) {
    std::int32_t& slot = cluster_slots_[cluster];
    if (slot == none) return;
    if (slot == unknown) {
      known_clusters_.push_back(cluster);
      if (local_count_ == local_.size()) local_.emplace_back();
      LocalCluster& fresh = local_[local_count_];
      if (kernels_.keep_above(packet_, span_, scene_.clusters[cluster], fresh.triangles, fresh.lower, fresh.upper) ==
          0) {
        slot = none;
        return;
      }
      slot = static_cast<std::int32_t>(local_count_++);
    }
    local = &local_[slot];
  }
  front.clusters.push_back(local != nullptr ? &local->triangles : &scene_.clusters[cluster]);
  const std::size_t lane = (front.clusters.size() - 1) % beam_lanes;
  if (lane == 0) front.boxes.emplace_back();
  BeamBoxes& boxes = front.boxes.back();
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = local != nullptr ? local->lower[axis] : node.boxes.lower[axis][child];
    const float upper = local != nullptr ? local->upper[axis] : node.boxes.upper[axis][child];
    boxes.lower[axis][lane] = (lower - span_.centre[axis]) - (span_.half[axis] + span_.slack);
    boxes.upper[axis][lane] = (upper - span_.centre[axis]) + (span_.half[axis] + span_.slack);
    boxes.cone_axis[axis][lane] = node.boxes.cone_axis[axis][child];
  }
  boxes.cone_sine[lane] = node.boxes.cone_sine[child];
}

void BeamTracer::trace(const BeamBlock& block, BeamWeights& weights) {
  weights.facing = kernels_.face(packet_, block.direction, block.count, weights);
  weights.lit = 0;
  if (weights.facing == 0) return;

  search(root_, shaft_along(block.direction, weights.facing), most_of_block, of_block_);
  if (of_block_.empty()) {
    weights.lit = weights.facing;
    return;
  }
  for (const std::uint32_t quarter : block.quarter) {
    const std::uint32_t facing = weights.facing & quarter;
    if (facing == 0) continue;
    search(of_block_, shaft_along(block.direction, facing), most_of_quarter, of_quarter_);
    if (of_quarter_.empty()) {
      weights.lit |= facing;
      continue;
    }
    int first = 0;
    for (std::uint32_t left = facing; left != 0; left &= left - 1) {
      const int d = __builtin_ctz(left);
      const Front* front = &of_quarter_;
      if (!of_quarter_.nodes.empty()) {
        search(of_quarter_, shaft_along(block.direction, 1u << d), all_of_them, of_direction_);
        front = &of_direction_;
      }
      const BeamRay ray{block.direction[d],  front->clusters.data(), static_cast<int>(front->clusters.size()),
                        front->boxes.data(), outside_,               scene_.doubtful};
      if (!kernels_.shade(packet_, span_, ray, first, weights.weight[d])) weights.lit |= 1u << d;
    }
  }
}

void add_products(const BeamWeights& weights, const float* basis, int coefficients, std::int64_t (*sums)[beam_lanes]) {
  beam_kernels().add_products(weights, basis, coefficients, sums);
}

}  // namespace kiln
