// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/beam_pilot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tbb/enumerable_thread_specific.h>
#include <utility>

#include "base/parallel.h"

namespace kiln {

namespace {

constexpr std::size_t group_packets = 16;     // a stream of rays holds as many receivers
constexpr std::size_t packets_apart = 4;      // every fourth packet is sampled, as beginning one costs by itself
constexpr std::size_t blocks_apart = 12;      // a sampled packet is cast along every twelfth block
constexpr std::size_t directions_apart = 16;  // in such a block every sixteenth direction gets a single ray
constexpr float loose = 2;                    // a packet this many times as wide as its neighbours stands apart

/// The diagonal of the box of a packet's origins.
float diagonal_of(const BeamPacket& packet) {
  float squared = 0;
  for (const auto& along : packet.origin) {
    const auto [lower, upper] = std::minmax_element(along, along + beam_lanes);
    squared += (*upper - *lower) * (*upper - *lower);
  }
  return std::sqrt(squared);
}

/// Packets in groups of up to 16 that will fare alike: neighbours, but those whose receivers stand apart from each
/// other, which cost many times as much, are in groups of their own.
std::vector<std::vector<std::uint32_t>> groups_of(std::span<const BeamPacket> packets) {
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> apart;
  for (std::size_t first = 0; first < packets.size(); first += group_packets) {
    const std::size_t count = std::min(group_packets, packets.size() - first);
    std::vector<float> diagonals(count);
    for (std::size_t k = 0; k < count; ++k) diagonals[k] = diagonal_of(packets[first + k]);
    std::vector<float> sorted = diagonals;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count / 2), sorted.end());
    groups.emplace_back();
    for (std::size_t k = 0; k < count; ++k)
      (diagonals[k] > loose * sorted[count / 2] ? apart : groups.back())
          .push_back(static_cast<std::uint32_t>(first + k));
  }
  for (std::size_t first = 0; first < apart.size(); first += group_packets)
    groups.emplace_back(apart.begin() + static_cast<std::ptrdiff_t>(first),
                        apart.begin() + static_cast<std::ptrdiff_t>(std::min(first + group_packets, apart.size())));
  return groups;
}

/// Counts the boxes that a ray is tested against until it is blocked or leaves the scene.
class RayCounter {
 public:
  explicit RayCounter(const BeamScene& scene) : scene_(scene), kernels_(beam_kernels()) {}

  void cast(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, RayWork& work) {
    ++work.rays;
    if (scene_.root == BeamScene::no_node) return;
    const BeamShaft ray = shaft_of(origin, direction);
    BeamSpan span{};
    std::copy_n(origin.data(), 3, span.centre);
    stack_.assign(1, scene_.root);
    while (!stack_.empty()) {
      const BeamScene::Node& node = scene_.nodes[stack_.back()];
      stack_.pop_back();
      ++work.boxes;
      std::uint32_t met = kernels_.meet(ray, node.boxes).met & ((2u << (node.count - 1)) - 1);
      for (; met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        if ((node.is_cluster >> i & 1) == 0)
          stack_.push_back(node.child[i]);
        else if (kernels_.hits(span, direction.data(), false, scene_.clusters[node.child[i]]))
          return;
      }
    }
  }

 private:
  static BeamShaft shaft_of(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
    constexpr float tiny = 1e-12f;
    BeamShaft ray{};
    ray.cone_sine = 2;
    for (int axis = 0; axis < 3; ++axis) {
      const float along = std::abs(direction[axis]) < tiny ? tiny : direction[axis];
      ray.origin_lower[axis] = ray.origin_upper[axis] = origin[axis];
      ray.direction_lower[axis] = ray.direction_upper[axis] = along;
      ray.inverse_lower[axis] = ray.inverse_upper[axis] = 1 / along;
      ray.cone_axis[axis] = along;
    }
    return ray;
  }

  const BeamScene& scene_;
  const BeamKernels& kernels_;
  std::vector<std::uint32_t> stack_;
};

/// Samples the packets of a scene, one after the other. One to a thread.
class Sampler {
 public:
  explicit Sampler(const BeamScene& scene) : tracer_(scene), counter_(scene) {}

  /// Casts a packet along every twelfth of `blocks`, from block `first` on.
  void sample(const BeamPacket& packet, std::span<const BeamBlock> blocks, std::size_t first, BeamPilot& pilot) {
    if (first >= blocks.size()) return;
    const BeamWork before = tracer_.work();
    tracer_.begin(packet);
    for (std::size_t b = first; b < blocks.size(); b += blocks_apart) {
      BeamWeights weights;
      tracer_.trace(blocks[b], weights);
      for (std::size_t d = 0; d < static_cast<std::size_t>(blocks[b].count); ++d)
        cast_singly(packet, blocks[b].direction[d], d % directions_apart == 0, pilot);
    }
    pilot.beams += tracer_.work() - before;
  }

 private:
  /// Counts the receivers that a direction is before, and, if asked to, casts the ray of the first of them.
  void cast_singly(const BeamPacket& packet, const float* along, bool casts, BeamPilot& pilot) {
    const Eigen::Vector3f direction(along[0], along[1], along[2]);
    for (int r = 0; r < beam_lanes; ++r) {
      const Eigen::Vector3f normal(packet.normal[0][r], packet.normal[1][r], packet.normal[2][r]);
      if (normal.dot(direction) <= 0) continue;
      ++pilot.beam_rays;
      if (std::exchange(casts, false))
        counter_.cast({packet.origin[0][r], packet.origin[1][r], packet.origin[2][r]}, direction, pilot.rays);
    }
  }

  BeamTracer tracer_;
  RayCounter counter_;
};

}  // namespace

BeamPilot& BeamPilot::operator+=(const BeamPilot& more) {
  beams += more.beams;
  beam_rays += more.beam_rays;
  rays.rays += more.rays.rays;
  rays.boxes += more.rays.boxes;
  return *this;
}

double BeamPilot::beam_cost() const {
  if (beam_rays == 0) return 0;
  const auto count = [](std::uint64_t number) { return static_cast<double>(number); };
  const double nanoseconds = 1080 * count(beams.blocks) + 42 * count(beams.boxes) + 34 * count(beams.packed) +
                             47 * count(beams.clusters) + count(beams.triangles);
  return nanoseconds / count(beam_rays);
}

double BeamPilot::ray_cost() const {
  if (rays.rays == 0) return std::numeric_limits<double>::infinity();  // nothing speaks against beams
  return 23 * static_cast<double>(rays.boxes) / static_cast<double>(rays.rays);
}

double BeamSplit::beam_share() const {
  const std::size_t all = beams.order.size() + rays.size();
  return all == 0 ? 1 : static_cast<double>(beams.order.size()) / static_cast<double>(all);
}

BeamSplit split_by_cost(const BeamScene& scene, BeamReceivers receivers, std::span<const Eigen::Vector3f> directions) {
  std::vector<BeamBlock> blocks;
  for (std::size_t d = 0; d < directions.size(); d += block_directions)
    blocks.emplace_back(directions.subspan(d, std::min<std::size_t>(block_directions, directions.size() - d)));
  // Step 1: the pilots of all groups. Their packets are cast along different blocks.
  const std::vector<std::vector<std::uint32_t>> groups = groups_of(receivers.packets);
  std::vector<BeamPilot> pilots(groups.size());
  tbb::enumerable_thread_specific<Sampler> samplers([&] { return Sampler(scene); });
  parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    Sampler& sampler = samplers.local();
    for (std::size_t k = g % packets_apart % groups[g].size(); k < groups[g].size(); k += packets_apart)
      sampler.sample(receivers.packets[groups[g][k]], blocks, (g + k * blocks_apart / group_packets) % blocks_apart,
                     pilots[g]);
  });

  // Step 2: each group goes where it is cheaper.
  BeamSplit split;
  std::vector<std::uint32_t> as_beams;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    split.pilot += pilots[g];
    const bool by_rays = pilots[g].beam_cost() > pilots[g].ray_cost();
    for (std::uint32_t packet : groups[g]) {
      if (!by_rays) as_beams.push_back(packet);
      for (std::size_t k = std::size_t{packet} * beam_lanes;
           by_rays && k < std::min(receivers.order.size(), (packet + std::size_t{1}) * beam_lanes); ++k)
        split.rays.push_back(receivers.order[k]);
    }
  }

  // Step 3: the packets of beams, in their old order: the last of all may lack receivers.
  std::sort(as_beams.begin(), as_beams.end());
  for (std::uint32_t packet : as_beams) {
    split.beams.packets.push_back(receivers.packets[packet]);
    for (std::size_t k = std::size_t{packet} * beam_lanes;
         k < std::min(receivers.order.size(), (packet + std::size_t{1}) * beam_lanes); ++k)
      split.beams.order.push_back(receivers.order[k]);
  }
  return split;
}

}  // namespace kiln
