// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/subsurface/sample_octree.h"

#include <algorithm>

#include "mesh/morton_order.h"

namespace kiln {

namespace {

constexpr std::uint32_t leaf_samples = 8;

class Builder {
 public:
  Builder(const SurfaceSamples& samples, SampleOctree& tree)
      : samples_(samples), tree_(tree), places_(morton_order(samples.positions)) {
    tree_.order.reserve(places_.size());
    for (const MortonPlace& place : places_) tree_.order.push_back(place.index);
    if (!places_.empty()) build(0, static_cast<std::uint32_t>(places_.size()), 0, 0);
  }

 private:
  std::uint32_t octant(std::uint32_t k, int level) const {
    return static_cast<std::uint32_t>(places_[k].code >> (3 * (morton_levels - 1 - level))) & 7u;
  }

  void build(std::uint32_t first, std::uint32_t last, int level, std::uint32_t parent) {
    // Step 1: go down to where the samples part.
    while (level < morton_levels && octant(first, level) == octant(last - 1, level)) ++level;
    const auto own = static_cast<std::uint32_t>(tree_.nodes.size());
    SampleOctree::Node node;
    node.first = first;
    node.last = last;
    node.parent = parent;
    node.is_leaf = level == morton_levels || last - first <= leaf_samples;
    measure(node);
    tree_.nodes.push_back(node);

    // Step 2: add children.
    if (!node.is_leaf)
      for (std::uint32_t begin = first; begin < last;) {
        std::uint32_t end = begin + 1;
        while (end < last && octant(end, level) == octant(begin, level)) ++end;
        build(begin, end, level + 1, own);
        begin = end;
      }
    tree_.nodes[own].next = static_cast<std::uint32_t>(tree_.nodes.size());
  }

  void measure(SampleOctree::Node& node) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), plain_sum = Eigen::Vector3d::Zero();
    double area = 0;
    node.lower = node.upper = samples_.positions[places_[node.first].index];
    for (std::uint32_t k = node.first; k < node.last; ++k) {
      const Eigen::Vector3f& p = samples_.positions[places_[k].index];
      const double weight = samples_.areas[places_[k].index];
      sum += weight * p.cast<double>();
      plain_sum += p.cast<double>();
      area += weight;
      node.lower = node.lower.cwiseMin(p);
      node.upper = node.upper.cwiseMax(p);
    }
    node.area = static_cast<float>(area);
    node.centre =
        (area > 0 ? Eigen::Vector3d(sum / area) : Eigen::Vector3d(plain_sum / (node.last - node.first))).cast<float>();
  }

  const SurfaceSamples& samples_;
  SampleOctree& tree_;
  std::vector<MortonPlace> places_;
};

}  // namespace

SampleOctree::SampleOctree(const SurfaceSamples& samples) { Builder(samples, *this); }

}  // namespace kiln
