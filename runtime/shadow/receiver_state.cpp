// SPDX-License-Identifier: MIT
#include "runtime/shadow/receiver_state.h"

#include <algorithm>
#include <map>
#include <utility>

namespace kiln {

namespace {

/// Most memory that the layers of a receiver take, in words: 64 MiB.
constexpr std::size_t most_words = std::size_t{1} << 23;

/// How an occluder is looked at; a node may be in both of the first two lists.
enum Sort { ray_mesh = 1, sky_mesh = 2, cap = 4 };

}  // namespace

const ReceiverState::Seen* ReceiverState::find(const std::vector<Seen>& all, int node, int sort) {
  const auto found = std::lower_bound(all.begin(), all.end(), std::pair(node, sort), [](const Seen& one, auto wanted) {
    return std::pair(one.node, one.sort) < wanted;
  });
  return found == all.end() || found->node != node || found->sort != sort ? nullptr : &*found;
}

std::vector<ReceiverState::Seen> ReceiverState::seen_now(const ShadowStage& stage, const Placement& pose, double unit,
                                                         const NodeOccluders& occluders) {
  std::map<int, int> sorts;  // of nodes that rays are cast at
  for (const int node : occluders.meshes) sorts[node] |= ray_mesh;
  for (const int node : occluders.sky_meshes) sorts[node] |= sky_mesh;
  std::vector<Seen> now;
  const auto add = [&](int node, int sort) -> StateKey& {
    const BoundingBall& ball = stage.place_of(node).ball;
    return now.emplace_back(node, sort, StateKey{}, BoundingBall{ball.centre - pose.translation, ball.radius}, false)
        .key;
  };
  for (const auto& [node, sort] : sorts)
    add_place(add(node, sort), stage.pose_of(node), stage.pose_of(node).translation - pose.translation, unit);
  for (const int node : occluders.sky_caps) {
    StateKey& key = add(node, cap);
    add_ball(key, 0, stage.place_of(node).ball, pose, unit);
    key.numbers.push_back(stage.place_of(node).silhouette / unit);
  }
  std::sort(now.begin(), now.end(),
            [](const Seen& a, const Seen& b) { return std::pair(a.node, a.sort) < std::pair(b.node, b.sort); });
  return now;
}

ReceiverState::Change ReceiverState::note(const ShadowStage& stage, int receiver, StateKey own, double unit,
                                          NodeOccluders& occluders) {
  const Placement& pose = stage.pose_of(receiver);
  std::vector<Seen> now = seen_now(stage, pose, unit, occluders);
  Change change;
  change.is_all = !is_noted_ || !own.is_same(own_);
  const auto add_change = [&](const BoundingBall& ball) {
    change.balls.push_back({ball.centre + pose.translation, ball.radius});
  };
  // A layer holds on while all that is in it stays where it was.
  std::size_t in_layer = 0, still_in_layer = 0, still = 0;
  for (const Seen& before : seen_) {
    in_layer += before.in_layer ? 1 : 0;
    if (find(now, before.node, before.sort) == nullptr) add_change(before.ball);
  }
  std::map<int, int> ranks;  // of nodes that rays are cast at: 0 in the layer, 1 standing still, 2 others
  for (Seen& one : now) {
    const Seen* before = change.is_all ? nullptr : find(seen_, one.node, one.sort);
    const bool is_still = before != nullptr && before->key.is_same(one.key);
    if (is_still) {
      one = *before;  // what the light was computed of, so that small steps do not add up
    } else {
      add_change(one.ball);
      if (before != nullptr) add_change(before->ball);
    }
    if (one.sort == cap) continue;
    ranks[one.node] = !is_still ? 2 : one.in_layer ? 0 : 1;
    still += is_still ? 1 : 0;
    still_in_layer += is_still && one.in_layer ? 1 : 0;
    one.in_layer = is_still;
  }
  if (!change.is_all && change.balls.empty()) return change;

  const bool holds = !change.is_all && still_in_layer == in_layer;
  valid_version_ = holds ? version_ : 0;
  if (!holds || still > still_in_layer) ++version_;
  const auto sort_list = [&](std::vector<int>& nodes) {
    std::stable_sort(nodes.begin(), nodes.end(), [&](int a, int b) { return ranks[a] < ranks[b]; });
    StillCounts counts;
    for (const int node : nodes) {
      counts.kept += holds && ranks[node] == 0 ? 1 : 0;
      counts.all += ranks[node] < 2 ? 1 : 0;
    }
    return counts;
  };
  occluders.still_meshes = sort_list(occluders.meshes);
  occluders.still_sky_meshes = sort_list(occluders.sky_meshes);
  seen_ = std::move(now);
  own_ = std::move(own);
  is_noted_ = true;
  return change;
}

void ReceiverState::keep_layers(std::size_t points, std::size_t words) {
  if (points * words > most_words) words = 0;
  if (words == words_ && versions_.size() == points) return;
  words_ = words;
  versions_.assign(points, 0);
  bits_.assign(points * words, 0);
}

PointLayer ReceiverState::layer(std::size_t point, const NodeOccluders& occluders) {
  if (words_ == 0 || occluders.still_meshes.all + occluders.still_sky_meshes.all == 0) return {};
  const bool is_valid = versions_[point] != 0 && versions_[point] == valid_version_;
  versions_[point] = version_;
  return {std::span(bits_).subspan(point * words_, words_), is_valid};
}

void ReceiverState::rename(std::span<const int> node_now) {
  // One that is no more keeps its entry, so that its shadow goes with the next update.
  for (Seen& one : seen_) one.node = one.node < 0 ? -1 : node_now[static_cast<std::size_t>(one.node)];
  std::sort(seen_.begin(), seen_.end(),
            [](const Seen& a, const Seen& b) { return std::pair(a.node, a.sort) < std::pair(b.node, b.sort); });
  if (own_.nodes.size() > 2) own_.nodes[2] = node_now[static_cast<std::size_t>(own_.nodes[2])];
}

}  // namespace kiln
