// SPDX-License-Identifier: MIT
#include "runtime/scene/cluster_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace kiln {

namespace {

constexpr std::array<double, 3> merge_below = {1, 2, 4};
constexpr double part_above = 1.25;  // times that

struct Group {
  NodeSphere sphere;
  std::vector<int> leaves;  ///< ascending
};

double distance_over_size(const NodeSphere& a, const NodeSphere& b) {
  return (a.centre - b.centre).norm() / std::max(a.radius + b.radius, std::numeric_limits<double>::min());
}

NodeSphere around(const NodeSphere& a, const NodeSphere& b) {
  const double distance = (b.centre - a.centre).norm();
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = (distance + a.radius + b.radius) / 2;
  return {a.centre + (radius - a.radius) / distance * (b.centre - a.centre), radius};
}

/// Merges the two nearest groups again and again, as long as they are nearer than `limit`.
std::vector<Group> merged(std::vector<Group> groups, double limit) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<double> nearest(groups.size(), far);  // to one behind it
  std::vector<std::size_t> partner(groups.size(), 0);
  const auto find_partner = [&](std::size_t k) {
    nearest[k] = far;
    for (std::size_t other = k + 1; other < groups.size(); ++other)
      if (const double distance = distance_over_size(groups[k].sphere, groups[other].sphere); distance < nearest[k])
        nearest[k] = distance, partner[k] = other;
  };
  for (std::size_t k = 0; k < groups.size(); ++k) find_partner(k);
  while (!groups.empty()) {
    const auto first = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
    if (!(nearest[first] < limit)) break;
    const std::size_t second = partner[first];
    Group& group = groups[first];
    group.sphere = around(group.sphere, groups[second].sphere);
    group.leaves.insert(group.leaves.end(), groups[second].leaves.begin(), groups[second].leaves.end());
    std::sort(group.leaves.begin(), group.leaves.end());
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(second));
    nearest.erase(nearest.begin() + static_cast<std::ptrdiff_t>(second));
    partner.erase(partner.begin() + static_cast<std::ptrdiff_t>(second));
    for (std::size_t k = 0; k < second; ++k) {
      if (k == first || partner[k] == second || partner[k] == first) {
        find_partner(k);
        continue;
      }
      if (partner[k] > second) --partner[k];
      // The group that has grown may be nearer now than the partner was.
      if (k < first)
        if (const double distance = distance_over_size(groups[k].sphere, groups[first].sphere); distance < nearest[k])
          nearest[k] = distance, partner[k] = first;
    }
    for (std::size_t k = second; k < groups.size(); ++k)
      if (partner[k] > second) --partner[k];
  }
  return groups;
}

/// Merges groups within those of an earlier time, by the wider limit.
std::vector<Group> kept_together(const std::vector<Group>& groups, const std::vector<int>& labels, double limit) {
  std::map<int, std::vector<Group>> within;
  std::vector<Group> result;
  for (const Group& group : groups) {
    const int label = labels[static_cast<std::size_t>(group.leaves.front())];
    const bool is_whole = std::all_of(group.leaves.begin(), group.leaves.end(),
                                      [&](int leaf) { return labels[static_cast<std::size_t>(leaf)] == label; });
    if (is_whole)
      within[label].push_back(group);
    else
      result.push_back(group);
  }
  for (auto& [label, some] : within)
    for (Group& group : merged(std::move(some), limit)) result.push_back(std::move(group));
  std::sort(result.begin(), result.end(),
            [](const Group& a, const Group& b) { return a.leaves.front() < b.leaves.front(); });
  return result;
}

}  // namespace

ClusterTree::ClusterTree(std::vector<SceneNode> leaves) : leaves_(std::move(leaves)) {
  labels_.resize(merge_below.size());
  for (std::vector<int>& labels : labels_)
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) labels.push_back(static_cast<int>(leaf));
  build();
}

bool ClusterTree::update(std::span<const NodeSphere> spheres) {
  std::vector<Group> groups;
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) groups.push_back({spheres[leaf], {static_cast<int>(leaf)}});
  std::vector<std::vector<int>> labels = labels_;
  for (std::size_t round = 0; round < merge_below.size(); ++round) {
    groups = merged(kept_together(groups, labels_[round], part_above * merge_below[round]), merge_below[round]);
    for (const Group& group : groups)
      for (const int leaf : group.leaves) labels[round][static_cast<std::size_t>(leaf)] = group.leaves.front();
  }
  if (labels == labels_) return false;
  labels_ = labels;
  build();
  return true;
}

void ClusterTree::build() {
  tree_.nodes.assign(1, {});
  tree_.nodes[0].name = "root";
  node_of_.assign(leaves_.size(), -1);
  std::vector<int> all;
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) all.push_back(static_cast<int>(leaf));
  add(0, labels_.size(), all);
}

/// Adds leaves, which are one group of round `level` - 1, beneath a node that stands for it.
void ClusterTree::add(int parent, std::size_t level, const std::vector<int>& leaves) {
  std::map<int, std::vector<int>> parts;
  for (const int leaf : leaves)
    parts[level == 0 ? leaf : labels_[level - 1][static_cast<std::size_t>(leaf)]].push_back(leaf);
  if (parts.size() == 1 && level > 0) {
    add(parent, level - 1, leaves);
    return;
  }
  for (const auto& [first, part] : parts) {
    const int index = tree_.count();
    SceneNode node;
    if (part.size() == 1) {
      node = leaves_[static_cast<std::size_t>(first)];
      node_of_[static_cast<std::size_t>(first)] = index;
    } else {
      node.name = "around " + leaves_[static_cast<std::size_t>(first)].name;
    }
    node.parent = parent;
    node.children.clear();
    tree_.nodes.push_back(node);
    tree_.nodes[static_cast<std::size_t>(parent)].children.push_back(index);
    if (part.size() > 1) add(index, level - 1, part);
  }
}

}  // namespace kiln
