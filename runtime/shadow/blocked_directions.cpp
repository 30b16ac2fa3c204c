// SPDX-License-Identifier: MIT
#include "runtime/shadow/blocked_directions.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace kiln {

namespace {

constexpr std::uint8_t is_blocked = 1, follows = 2;
constexpr std::uint32_t together = 8;  ///< directions of which one stands for the others
/// Directions so near to the rim of a flat part are left to rays.
constexpr float rim = 1e-6f;

using BlockValues = std::array<float, DirectionSet::block_directions>;

/// Where a block of directions lies.
enum class Side { outside, across, inside };

Side side_of(const DirectionSet::Block& block, const ViewPyramid& pyramid) {
  Side side = Side::inside;
  constexpr float right = 0.5f * std::numbers::pi_v<float>;
  const float reach = block.half_angle < right ? block.sine : 2;
  for (const Eigen::Vector3f& plane : pyramid.planes) {
    const float sine = plane.dot(block.axis);
    if (sine < -reach - pyramid.margin) return Side::outside;
    if (sine < reach) side = Side::across;
  }
  return side;
}

/// Sets the least dot product of each direction with the planes, or leaves a larger value that is there.
void find_depths(const DirectionSet& set, std::uint32_t first, std::uint32_t count, const ViewPyramid& pyramid,
                 BlockValues& depths) {
  BlockValues least;
  least.fill(std::numeric_limits<float>::infinity());
  const float *x = &set.x[first], *y = &set.y[first], *z = &set.z[first];
  for (const Eigen::Vector3f& plane : pyramid.planes) {
    const float a = plane.x(), b = plane.y(), c = plane.z();
    for (std::uint32_t d = 0; d < count; ++d) {
      const float depth = a * x[d] + b * y[d] + c * z[d];
      least[d] = depth < least[d] ? depth : least[d];
    }
  }
  for (std::uint32_t d = 0; d < count; ++d) depths[d] = least[d] > depths[d] ? least[d] : depths[d];
}

}  // namespace

void BlockedDirections::reset(const DirectionSet& set, const std::optional<Eigen::Vector3d>& normal, float far_below,
                              std::span<const std::uint64_t> bits) {
  set_ = &set;
  blocked_.assign(set.count(), 0);
  for (std::size_t word = 0; word < bits.size(); ++word)
    for (std::uint64_t left = bits[word]; left != 0; left &= left - 1)
      blocked_[64 * word + static_cast<std::size_t>(std::countr_zero(left))] = is_blocked;
  followers_.clear();
  if (!normal) return;
  const Eigen::Vector3f up = normal->cast<float>();
  for (std::size_t b = 0; b < set.blocks.size(); ++b) {
    const DirectionSet::Block& block = set.blocks[b];
    // The cosine of the angle from the normal to the block's lowest direction.
    const float height = up.dot(block.axis), aside = std::sqrt(std::max(0.f, 1 - height * height));
    const float lowest = height * block.cosine - aside * block.sine;
    if (lowest > far_below && height > -block.cosine) continue;
    const auto begin = static_cast<std::uint32_t>(b) * DirectionSet::block_directions,
               end = std::min(begin + DirectionSet::block_directions, set.count());
    for (std::uint32_t first = begin; first < end; first += together) {
      std::uint32_t leader = set.count();
      for (std::uint32_t d = first; d < std::min(first + together, end); ++d) {
        if (up.x() * set.x[d] + up.y() * set.y[d] + up.z() * set.z[d] >= far_below) continue;
        if (leader == set.count()) {
          leader = d;
          continue;
        }
        blocked_[d] |= follows;
        followers_.push_back(d);
        followers_.push_back(leader);
      }
    }
  }
}

void BlockedDirections::look_at_block(std::size_t block, const ViewedCone& cone, bool has_flats) {
  const DirectionSet::Block& own = set_->blocks[block];
  const auto first = static_cast<std::uint32_t>(block) * DirectionSet::block_directions,
             count = std::min(DirectionSet::block_directions, set_->count() - first);
  std::uint8_t* blocked = &blocked_[first];
  std::array<std::int32_t, DirectionSet::block_directions> free;
  std::int32_t any = 0;
  for (std::uint32_t d = 0; d < count; ++d) any |= free[d] = blocked[d] == 0 ? 1 : 0;
  if (any == 0) return;
  // What is within the boxes may be blocked.
  BlockValues depths;
  depths.fill(-1);
  Side side = Side::outside;
  for (std::size_t k = 0; k < view_.box_count && side != Side::inside; ++k) {
    const Side of_box = side_of(own, view_.boxes[k]);
    if (of_box == Side::outside) continue;
    side = of_box;
    if (side == Side::across) find_depths(*set_, first, count, view_.boxes[k], depths);
  }
  std::array<std::int32_t, DirectionSet::block_directions> maybe;
  for (std::uint32_t d = 0; d < count; ++d) maybe[d] = side == Side::inside || depths[d] >= 0 ? 1 : 0;
  // What goes through flat parts is blocked, unless the light is nearer; along their rims it may be.
  for (std::size_t k = 0; k < view_.flat_count; ++k) {
    const ViewPyramid& flat = view_.flats[k];
    const Side of_flat = side_of(own, flat);
    if (of_flat == Side::outside) continue;
    side = of_flat;
    depths.fill(of_flat == Side::inside ? 1.f : -2.f);
    if (of_flat == Side::across) find_depths(*set_, first, count, flat, depths);
    for (std::uint32_t d = 0; d < count; ++d) {
      const std::int32_t within = has_flats && depths[d] > rim ? 1 : 0;
      blocked[d] = static_cast<std::uint8_t>(blocked[d] | within);
      free[d] &= 1 - within;
      maybe[d] |= depths[d] > -flat.margin ? 1 : 0;
    }
    if (of_flat == Side::inside && has_flats) return;
  }
  if (side == Side::outside) return;
  for (std::uint32_t d = 0; d < count; ++d) free[d] &= maybe[d];
  if (!cone.is_all_around) {
    const float a = cone.axis.x(), b = cone.axis.y(), c = cone.axis.z();
    const float *x = &set_->x[first], *y = &set_->y[first], *z = &set_->z[first];
    for (std::uint32_t d = 0; d < count; ++d) free[d] &= a * x[d] + b * y[d] + c * z[d] >= cone.cosine ? 1 : 0;
  }
  for (std::uint32_t d = 0; d < count; ++d) {
    tested_[tested_count_] = first + d;
    tested_count_ += static_cast<std::size_t>(free[d]);
  }
}

void BlockedDirections::block(const RayOccluder& mesh, const Placement& placement, const BoundingBall& ball,
                              const Eigen::Vector3d& position, std::span<const float> farthest) {
  const ViewCone view = cone_of(ball, position);
  const auto half_angle = static_cast<float>(view.half_angle) + 1e-4f;
  const ViewedCone cone{view.axis.cast<float>(), std::cos(half_angle), std::sin(half_angle),
                        view.half_angle >= std::numbers::pi};
  tested_.resize(set_->count() + 1);
  tested_count_ = 0;
  bool looked = false;
  for (std::size_t b = 0; b < set_->blocks.size(); ++b) {
    const DirectionSet::Block& own = set_->blocks[b];
    // By the cosine of the sum of both half-angles; cones of more than half a turn together meet.
    if (!cone.is_all_around && cone.cosine * own.cosine - cone.sine * own.sine > cone.axis.dot(own.axis) &&
        half_angle + own.half_angle < std::numbers::pi_v<float>)
      continue;
    if (!looked) look_at_outline(mesh.outline(), placement, position, view_);
    looked = true;
    look_at_block(b, cone, farthest.empty());
  }
  if (tested_count_ > 0)
    mesh.block(placement, position, *set_, std::span(tested_).first(tested_count_), farthest, blocked_);
}

void BlockedDirections::store(std::span<std::uint64_t> bits) const {
  std::fill(bits.begin(), bits.end(), 0);
  for (std::uint32_t d = 0; d < set_->count(); ++d)
    bits[d / 64] |= static_cast<std::uint64_t>(blocked_[d] & is_blocked) << (d % 64);
}

std::uint32_t BlockedDirections::finish() {
  for (std::size_t k = 0; k < followers_.size(); k += 2) blocked_[followers_[k]] = blocked_[followers_[k + 1]];
  std::uint32_t count = 0;
  for (const std::uint8_t value : blocked_) count += value;
  return count;
}

}  // namespace kiln
