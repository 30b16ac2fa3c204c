// SPDX-License-Identifier: MIT
#include "runtime/shadow/combined_shadows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/shadow/blocked_directions.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

using std::numbers::pi;
constexpr float endless = std::numeric_limits<float>::infinity();

/// Tests whether any ray from the receiver's ball to within a cone of directions can meet the occluder's ball: a ray
/// from its centre at the occluder grown by the receiver (Minkowski sum).
bool may_meet(const BoundingBall& receiver, const BoundingBall& occluder, const Eigen::Vector3d& axis,
              double half_angle) {
  const ViewCone grown = cone_of({occluder.centre, occluder.radius + receiver.radius}, receiver.centre);
  if (grown.half_angle >= pi) return true;
  return std::acos(std::clamp(grown.axis.dot(axis), -1.0, 1.0)) <= half_angle + grown.half_angle;
}

}  // namespace

bool is_far_below(const ShadowPoint& point, const BoundingBall& ball) {
  if (!point.normal) return false;
  const ViewCone cone = cone_of(ball, point.position);
  return std::acos(std::clamp(point.normal->dot(cone.axis), -1.0, 1.0)) >
         std::acos(far_below_horizon) + cone.half_angle;
}

// Tests whether the occluder's ball meets the convex hull of the other two: the union of balls whose centres and radii
// go evenly from one to the other; the distance to the nearest of these is a convex function of the place between them.
bool may_stand_between(const BoundingBall& receiver, const BoundingBall& occluder, const LightSpec& ball) {
  const Eigen::Vector3d along = Eigen::Vector3d(ball.position.data()) - receiver.centre,
                        towards = occluder.centre - receiver.centre;
  const double length = along.norm(), reach = std::max(0.0, receiver.radius), widens = ball.radius - reach;
  double place = 0;
  if (length > 0) {
    const double forward = towards.dot(along) / length,
                 aside = std::sqrt(std::max(0.0, towards.squaredNorm() - forward * forward)), slope = widens / length;
    // Where the hull's widening and the way to its axis balance; the larger end if one ball holds the other.
    place = std::abs(slope) < 1
                ? std::clamp((forward + aside * slope / std::sqrt(1 - slope * slope)) / length, 0.0, 1.0)
                : (slope > 0 ? 1.0 : 0.0);
  }
  return (receiver.centre + place * along - occluder.centre).norm() <= occluder.radius + reach + place * widens;
}

bool ConeView::may_cover(const BoundingBall& ball) const {
  const ViewCone cone = cone_of(ball, position);
  return cone.half_angle >= pi || (cone.distance - ball.radius < longest &&
                                   cone.axis.dot(axis) >= std::cos(std::min(pi, cone.half_angle + half_angle)));
}

bool is_seen_by_axis(const ShadowPoint& point, const Eigen::Vector3d& axis, double half_angle) {
  const double lowest = std::acos(far_below_horizon) + half_angle;
  return half_angle == 0 || (point.normal && lowest < pi && point.normal->dot(axis) < std::cos(lowest));
}

bool may_see(const ShadowPoint& point, const BoundingBall& ball, const LightSources& sources) {
  const BoundingBall grown{ball.centre, ball.radius * (1 + 1e-5)};  // more than rounding
  for (const ConeLight& cone : sources.cones)
    if (ConeView{point.position, cone.axis, cone.half_angle}.may_cover(grown)) return true;
  for (const LightSpec& light : sources.balls)
    if (may_stand_between({point.position, 0}, grown, light)) return true;
  return sources.has_sky() && !is_far_below(point, grown);
}

std::size_t layer_words(const ShadowStage& stage, const LightSources& sources) {
  std::size_t words = sources.skies.empty() ? 0 : BlockedDirections::words(stage.sky);
  for (const ConeLight& cone : sources.cones) words += BlockedDirections::words(cone.directions);
  return words;
}

std::size_t visibility_rows(const LightSources& sources) {
  return sources.cones.size() + sources.balls.size() + 3 * sources.skies.size();
}

namespace {

bool may_take_light(const BoundingBall& receiver, const BoundingBall& occluder, const LightSources& sources) {
  for (const ConeLight& cone : sources.cones)
    if (may_meet(receiver, occluder, cone.axis, cone.half_angle)) return true;
  return std::any_of(sources.balls.begin(), sources.balls.end(),
                     [&](const LightSpec& ball) { return may_stand_between(receiver, occluder, ball); });
}

/// Finds which directions of a set the meshes of a list block that `matter`. The first of them, which stand still, are
/// in the layer's bits, or come into them.
template <class Matters>
void block_by_meshes(const ShadowStage& stage, std::span<const int> meshes, const StillCounts& still,
                     const ShadowPoint& point, std::span<const float> farthest, std::span<std::uint64_t> bits,
                     bool is_valid, const Matters& matters, BlockedDirections& state) {
  std::size_t k = is_valid ? still.kept : 0;
  const auto block_until = [&](std::size_t end) {
    for (; k < end; ++k)
      if (matters(meshes[k]))
        state.block(stage.mesh_of(meshes[k]), stage.pose_of(meshes[k]), stage.place_of(meshes[k]).ball, point.position,
                    farthest);
  };
  if (!bits.empty()) {
    block_until(still.all);
    if (!is_valid || still.all > still.kept) state.store(bits);
  }
  block_until(meshes.size());
}

/// Adds a sum of coefficients times a light's window.
class RemovedLight {
 public:
  explicit RemovedLight(int bands) : coefficients_(static_cast<std::size_t>(coefficient_count(bands))) {}

  void add(std::size_t channel, std::span<const double> values, std::span<const double> window, double factor) {
    begin();
    for (std::size_t i = 0; i < coefficients_; ++i)
      (*sum_)[channel][i] += factor * window[static_cast<std::size_t>(band_of(static_cast<int>(i)))] * values[i];
  }
  /// Adds what has its windows already.
  void add(const LightSum& light) {
    begin();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < coefficients_; ++i) (*sum_)[c][i] += light[c][i];
  }
  std::optional<LightSum>& sum() { return sum_; }

 private:
  void begin() {
    if (sum_) return;
    sum_.emplace();
    for (std::vector<double>& own : *sum_) own.assign(coefficients_, 0.0);
  }

  std::size_t coefficients_;
  std::optional<LightSum> sum_;
};

/// How far rays go to a light: along its axis, by direction (empty: the same), and the longest.
struct LightReach {
  double axis = std::numeric_limits<double>::infinity(), longest = std::numeric_limits<double>::infinity();
  std::vector<float> by_direction = {};
};

/// What is known of a light at a point: how many of its directions are blocked, and their harmonics' sums.
struct KnownLight {
  std::uint32_t count, total;
  std::span<const float> sums;
};

/// Takes the share of a cone of light that is blocked.
void remove_cone(const ShadowStage& stage, const NodeOccluders& occluders, const ConeLight& light,
                 const LightReach& reach, const ShadowPoint& point, const std::optional<KnownLight>& known,
                 const PointLayer& layer, RemovedLight& removed) {
  const std::span<const int> meshes = occluders.meshes;
  const auto take = [&](std::span<const double> values) {
    for (std::size_t c = 0; c < 3; ++c) removed.add(c, values, light.window, static_cast<double>(light.spec.color[c]));
  };
  const ConeView view{point.position, light.axis, light.half_angle, reach.longest};
  const auto in_the_way = [&](int node) { return view.may_cover(stage.place_of(node).ball); };
  if (is_seen_by_axis(point, light.axis, light.half_angle)) {
    if (known) {
      if (known->count > 0) take(light.zonal);
      return;
    }
    for (const int node : meshes)
      if (in_the_way(node) &&
          stage.mesh_of(node).blocks(stage.pose_of(node), point.position, light.axis, static_cast<float>(reach.axis)))
        return take(light.zonal);
    return;
  }
  const auto take_share = [&](std::vector<double> values, std::uint32_t count, std::uint32_t total) {
    const double share = cone_bands(1, light.half_angle)[0] / total, blocked = static_cast<double>(count) / total;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = share * values[i] + blocked * light.closing[i];
    take(values);
  };
  if (known) {
    if (known->count == known->total) return take(light.zonal);
    if (known->count > 0) take_share({known->sums.begin(), known->sums.end()}, known->count, known->total);
    return;
  }
  thread_local BlockedDirections state;
  state.reset(light.directions, std::nullopt, 0, layer.is_valid ? layer.bits : std::span<std::uint64_t>());
  block_by_meshes(stage, meshes, occluders.still_meshes, point, reach.by_direction, layer.bits, layer.is_valid,
                  in_the_way, state);
  const std::uint32_t count = state.finish();
  if (count == 0) return;
  if (count == light.directions.count()) return take(light.zonal);
  std::vector<double> values(light.zonal.size(), 0.0);
  std::vector<float> own(values.size());
  if (!light.sums.empty()) {
    light.sums.add_up(state.blocked(), own);
    values.assign(own.begin(), own.end());
  } else {
    const ShBasis basis(band_of(static_cast<int>(values.size()) - 1) + 1);
    for (std::uint32_t d = 0; d < light.directions.count(); ++d) {
      if (state.blocked()[d] == 0) continue;
      basis.evaluate<float>(light.directions.direction(d), own);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += static_cast<double>(own[i]);
    }
  }
  take_share(std::move(values), count, light.directions.count());
}

/// Takes what caps block of skies, each less what is blocked already.
void remove_caps(const ShadowStage& stage, const NodeOccluders& occluders, std::span<const SkyLight> skies, int bands,
                 const ShadowPoint& point, RemovedLight& removed) {
  struct Cap {
    Eigen::Vector3d axis;
    double cosine;
  };
  std::vector<Cap> before;
  const ShBasis basis(bands);
  std::vector<double> values(static_cast<std::size_t>(basis.size()));
  for (const int node : occluders.sky_caps) {
    const PlacedNode& place = stage.place_of(node);
    const Eigen::Vector3d away = place.ball.centre - point.position;
    const double distance = away.norm(), half_angle = std::asin(std::min(1.0, place.silhouette / distance));
    const Eigen::Vector3d axis = away / distance;
    if (half_angle < 1e-9 || (point.normal && point.normal->dot(axis) < far_below_horizon)) continue;
    // Tests the centre and six directions around it, of equal shares.
    Eigen::Vector3d side, up;
    side = axis.unitOrthogonal();
    up = axis.cross(side);
    int free = 0;
    constexpr int probes = 7;
    for (int k = 0; k < probes; ++k) {
      const double radius = k == 0 ? 0 : std::sqrt(4.0 / 7) * std::tan(half_angle), azimuth = k * pi / 3;
      const Eigen::Vector3d direction =
          (axis + radius * (std::cos(azimuth) * side + std::sin(azimuth) * up)).normalized();
      const bool taken = std::any_of(before.begin(), before.end(),
                                     [&](const Cap& cap) { return cap.axis.dot(direction) >= cap.cosine; }) ||
                         std::any_of(occluders.sky_meshes.begin(), occluders.sky_meshes.end(), [&](int mesh) {
                           const ViewCone cone = cone_of(stage.place_of(mesh).ball, point.position);
                           return (cone.half_angle >= pi || cone.axis.dot(direction) >= std::cos(cone.half_angle)) &&
                                  stage.mesh_of(mesh).blocks(stage.pose_of(mesh), point.position, direction, endless);
                         });
      free += taken ? 0 : 1;
    }
    before.push_back({axis, std::cos(half_angle)});
    if (free == 0) continue;
    const double sine = std::sin(half_angle);
    const std::vector<double> zonal = cone_bands(bands, half_angle);  // of a radiance of 1 / sin^2
    basis.evaluate<double>(axis, values);
    const std::vector<double> there = values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] *= zonal[static_cast<std::size_t>(band_of(static_cast<int>(i)))] * sine * sine * free / probes;
    for (const SkyLight& sky : skies)
      for (std::size_t c = 0; c < 3; ++c) {
        double radiance = 0;
        for (std::size_t i = 0; i < there.size(); ++i)
          radiance += there[i] * static_cast<double>(sky.light.channels[c][i]);
        removed.add(c, values, sky.window, radiance);
      }
  }
}

/// Finds what is blocked of skies at a point, and how many directions; in `state`.
std::uint32_t block_sky(const ShadowStage& stage, const NodeOccluders& occluders, const ShadowPoint& point,
                        const PointLayer& layer, BlockedDirections& state) {
  state.reset(stage.sky, point.normal, static_cast<float>(far_below_horizon),
              layer.is_valid ? layer.bits : std::span<std::uint64_t>());
  block_by_meshes(
      stage, occluders.sky_meshes, occluders.still_sky_meshes, point, {}, layer.bits, layer.is_valid,
      [&](int node) { return !is_far_below(point, stage.place_of(node).ball); }, state);
  return state.finish();
}

/// Takes the blocked share of skies that were made for the point.
void remove_skies(const ShadowStage& stage, const NodeOccluders& occluders, std::span<const SkyLight> skies, int bands,
                  const ShadowPoint& point, RemovedLight& removed) {
  thread_local BlockedDirections state;
  const std::uint32_t count = block_sky(stage, occluders, point, {}, state);
  const double blocked = static_cast<double>(count) / stage.sky.count();
  for (const SkyLight& sky : skies)
    for (std::size_t c = 0; c < 3 && count > 0; ++c) {
      std::vector<double> values(sky.light.channels[c].begin(), sky.light.channels[c].end());
      if (count < stage.sky.count()) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = blocked * sky.closing[c][i];
        for (std::uint32_t d = 0; d < stage.sky.count(); ++d) {
          if (state.blocked()[d] == 0) continue;
          const auto radiance = static_cast<double>(sky.radiance[c][d]);
          const std::span<const float> row = stage.sky.row(d);
          for (std::size_t i = 0; i < values.size(); ++i) values[i] += radiance * static_cast<double>(row[i]);
        }
      }
      removed.add(c, values, sky.window, 1);
    }
  if (count < stage.sky.count()) remove_caps(stage, occluders, skies, bands, point, removed);
}

/// Takes the blocked share of the scene's skies.
void remove_skies(const ShadowStage& stage, const NodeOccluders& occluders, const LightSources& sources, int bands,
                  const ShadowPoint& point, const PointLayer& layer, RemovedLight& removed) {
  thread_local BlockedDirections state;
  const std::uint32_t count = block_sky(stage, occluders, point, layer, state);
  if (count > 0) removed.add(sources.sky_sums.taken(state.blocked(), count));
  if (count < stage.sky.count()) remove_caps(stage, occluders, sources.skies, bands, point, removed);
}

/// Takes what an engine found; it has three rows for each sky, from `row` on.
void remove_known_skies(const ShadowStage& stage, const NodeOccluders& occluders, const LightSources& sources,
                        int bands, const ShadowPoint& point, const PointVisibility& known, std::size_t row,
                        RemovedLight& removed) {
  const std::uint32_t count = known.counts[row];
  const double blocked = static_cast<double>(count) / stage.sky.count();
  for (const SkyLight& sky : sources.skies)
    for (std::size_t c = 0; c < 3 && count > 0; ++c, ++row) {
      std::vector<double> values(sky.light.channels[c].begin(), sky.light.channels[c].end());
      if (count < stage.sky.count())
        for (std::size_t i = 0; i < values.size(); ++i)
          values[i] = static_cast<double>(known.row(row)[i]) + blocked * sky.closing[c][i];
      removed.add(c, values, sky.window, 1);
    }
  if (count < stage.sky.count()) remove_caps(stage, occluders, sources.skies, bands, point, removed);
}

}  // namespace

NodeOccluders find_occluders(const ShadowStage& stage, int receiver, const LightSources& sources, double cap) {
  NodeOccluders found;
  const BoundingBall& own = stage.place_of(receiver).ball;
  const bool is_static = stage.tree.nodes[static_cast<std::size_t>(receiver)].is_static;
  // Looks at a node; `capped`: a cap stands for it before the sky already.
  const auto look = [&](const auto& self, int node, bool capped) -> void {
    const PlacedNode& place = stage.place_of(node);
    const SceneNode& of_node = stage.tree.nodes[static_cast<std::size_t>(node)];
    if (node == receiver || place.ball.radius < 0 || (of_node.asset >= 0 && !may_shadow(stage.tree, node, receiver)))
      return;
    const bool holds_receiver = is_under(stage.tree, receiver, node);
    if (sources.has_sky() && !capped && !holds_receiver && !(is_static && place.has_static)) {
      const double nearest = (place.ball.centre - own.centre).norm() - own.radius;
      if (nearest > place.ball.radius && std::asin(place.ball.radius / nearest) < cap) {
        found.sky_caps.push_back(node);
        capped = true;
      }
    }
    const bool sky_meets = sources.has_sky() && !capped;
    const bool takes = holds_receiver || may_take_light(own, place.ball, sources);
    if (!sky_meets && !takes) return;
    if (of_node.asset < 0) {
      for (const int child : of_node.children) self(self, child, capped);
      return;
    }
    if (takes) found.meshes.push_back(node);
    if (sky_meets) found.sky_meshes.push_back(node);
  };
  look(look, 0, false);
  std::stable_sort(found.sky_caps.begin(), found.sky_caps.end(), [&](int a, int b) {
    return (stage.place_of(a).ball.centre - own.centre).squaredNorm() <
           (stage.place_of(b).ball.centre - own.centre).squaredNorm();
  });
  return found;
}

std::optional<LightSum> removed_light(const ShadowStage& stage, const NodeOccluders& occluders,
                                      const SceneLights& lights, const LightSources& sources, int bands,
                                      const ShadowPoint& point, const PointVisibility* known, const PointLayer& layer) {
  RemovedLight removed(bands);
  const auto known_light = [&](std::size_t row) -> std::optional<KnownLight> {
    if (known == nullptr) return std::nullopt;
    return KnownLight{known->counts[row], static_cast<std::uint32_t>(sources.pattern.share.size()), known->row(row)};
  };
  std::span<std::uint64_t> bits = layer.bits;
  if (!layer.is_valid) std::fill(bits.begin(), bits.end(), 0);
  const auto take_bits = [&](std::size_t words) {
    const std::span<std::uint64_t> taken = bits.first(words);
    bits = bits.subspan(words);
    return taken;
  };
  if (!occluders.meshes.empty()) {
    std::size_t row = 0;
    for (const ConeLight& cone : sources.cones) {
      const std::size_t words = layer.bits.empty() ? 0 : BlockedDirections::words(cone.directions);
      remove_cone(stage, occluders, cone, {}, point, known_light(row++), {take_bits(words), layer.is_valid}, removed);
    }
    for (const LightSpec& ball : sources.balls) {
      const std::optional<KnownLight> of_ball = known_light(row++);
      const BoundingBall light{Eigen::Vector3d(ball.position.data()), ball.radius};
      const ViewCone seen = cone_of(light, point.position);
      const auto stands_between = [&](int node) {
        return may_stand_between({point.position, 0}, stage.place_of(node).ball, ball);
      };
      if (seen.half_angle >= pi || std::none_of(occluders.meshes.begin(), occluders.meshes.end(), stands_between))
        continue;  // from inside a ball of light nothing stands in front of it
      if (of_ball && of_ball->count == 0) continue;
      const DiscPattern none;  // what is known needs no directions
      const ConeLight cone = ball_at(ball, bands, lights.window, point.position, of_ball ? none : sources.pattern);
      // Rays end where they reach the ball; the longest touch it.
      LightReach reach{seen.distance - ball.radius,
                       std::sqrt(std::max(0.0, seen.distance * seen.distance - ball.radius * ball.radius)),
                       std::vector<float>(cone.directions.count())};
      for (std::uint32_t d = 0; d < cone.directions.count(); ++d) {
        const double along = cone.directions.direction(d).cast<double>().dot(light.centre - point.position);
        const double inside = ball.radius * ball.radius - (seen.distance * seen.distance - along * along);
        reach.by_direction[d] = static_cast<float>(along - std::sqrt(std::max(0.0, inside)));
      }
      remove_cone(stage, occluders, cone, reach, point, of_ball, {}, removed);
    }
  }
  if (!occluders.sky_meshes.empty() || !occluders.sky_caps.empty()) {
    if (sources.has_probes)
      remove_skies(stage, occluders, probed_skies(lights, bands, stage.sky, point.position), bands, point, removed);
    else if (known != nullptr)
      remove_known_skies(stage, occluders, sources, bands, point, *known, sources.cones.size() + sources.balls.size(),
                         removed);
    else if (!sources.skies.empty())
      remove_skies(
          stage, occluders, sources, bands, point,
          {layer.bits.empty() ? layer.bits : layer.bits.last(BlockedDirections::words(stage.sky)), layer.is_valid},
          removed);
  }
  return removed.sum();
}

}  // namespace kiln
