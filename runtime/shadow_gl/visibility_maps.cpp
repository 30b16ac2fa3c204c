// SPDX-License-Identifier: MIT
#include "runtime/shadow_gl/visibility_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/errors.h"
#include "runtime/shadow/combined_shadows.h"
#include "runtime/shadow_gl/kept_gl_state.h"
#include "runtime/shadow_gl/map_passes.h"
#include "sh/basis.h"

namespace kiln {

namespace {

using std::numbers::pi;

constexpr std::size_t fewest_maps = 6, most_maps = 2048;  // a cube's; what every OpenGL 4.5 has
constexpr int fewest_texels = 8, most_texels = 1024;

int layers_of(const VisibilityMapSettings& settings) {
  if (settings.texels < fewest_texels || settings.texels > most_texels)
    throw WrongUsage("visibility maps: found " + std::to_string(settings.texels) + " texels; expected " +
                     std::to_string(fewest_texels) + " to " + std::to_string(most_texels));
  const auto side = static_cast<std::size_t>(settings.texels);
  return static_cast<int>(std::clamp(settings.most_bytes / (side * side * sizeof(float)), fewest_maps, most_maps));
}

/// Throws MachineLacks unless the context that is current can draw visibility maps.
void require_gl() {
  const std::string purpose = "shadow backend gpu: ", remedy = "; use --shadow-backend rays";
  if (epoxy_gl_version() < 45)
    throw MachineLacks(purpose + "found OpenGL " + std::to_string(epoxy_gl_version() / 10) + "." +
                       std::to_string(epoxy_gl_version() % 10) + "; expected 4.5" + remedy);
  if (!epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array"))
    throw MachineLacks(purpose + "found no GL_ARB_shader_viewport_layer_array in " +
                       reinterpret_cast<const char*>(glGetString(GL_RENDERER)) +
                       "; expected it, which draws many maps at once" + remedy);
}

std::array<float, 4> packed(const Eigen::Vector3d& vector, double last) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()), static_cast<float>(vector.z()),
          static_cast<float>(last)};
}

}  // namespace

struct VisibilityMaps::Implementation {
  VisibilityMapSettings settings;
  MapPasses passes;
  std::size_t coefficients = 0;
  std::uint32_t sky_directions = 0, cone_directions = 0;
  VisibilityMapWork work;

  // A pass that is put together.
  std::vector<std::vector<MapInstance>> instances;  ///< by mesh
  std::vector<MapJob> jobs;
  std::vector<std::size_t> rows;  ///< of the table, by job
  int layers = 0;
  std::vector<std::uint32_t> counts;
  std::vector<float> sums;

  explicit Implementation(const VisibilityMapSettings& of_settings)
      : settings(of_settings), passes(of_settings.texels, layers_of(of_settings)) {}

  /// Runs what is put together, and takes what was found over into the table.
  void flush(float depth_unit, VisibilityTable& table) {
    if (!jobs.empty()) {
      passes.run(instances, jobs, depth_unit, layers, counts, sums);
      for (std::size_t j = 0; j < jobs.size(); ++j) {
        table.counts[rows[j]] = counts[j];
        if (counts[j] > 0)
          std::copy_n(sums.begin() + static_cast<std::ptrdiff_t>(j * coefficients), coefficients,
                      table.sums.begin() + static_cast<std::ptrdiff_t>(rows[j] * coefficients));
      }
      ++work.passes;
      work.jobs += jobs.size();
      work.maps += static_cast<std::size_t>(layers);
    }
    for (std::vector<MapInstance>& of_mesh : instances) of_mesh.clear();
    jobs.clear();
    rows.clear();
    layers = 0;
  }

  /// Puts nodes into a map; returns its layer, or -1 if it would be empty.
  int add_map(const ShadowStage& stage, const Eigen::Vector3d& point, const MapView& view, std::span<const int> nodes) {
    bool is_drawn = false;
    for (const int node : nodes) {
      const BoundingBall& ball = stage.place_of(node).ball;
      if (!view.may_see({ball.centre - point, ball.radius})) continue;
      is_drawn = true;
      instances[static_cast<std::size_t>(stage.tree.nodes[static_cast<std::size_t>(node)].asset)].push_back(
          {rows_of(view, stage.pose_of(node), point), layers, static_cast<float>(touching_share * ball.radius), {}});
      ++work.drawn_nodes;
    }
    return is_drawn ? layers++ : -1;
  }

  /// Puts nodes into the maps of a cube; tells whether any has something in it.
  bool add_cube(const ShadowStage& stage, const Eigen::Vector3d& point, std::span<const int> nodes, MapJob& job) {
    bool is_drawn = false;
    for (int face = 0; face < 6; ++face) {
      const int layer = add_map(stage, point, view_of_face(face), nodes);
      (face < 4 ? job.layers[static_cast<std::size_t>(face)] : job.more_layers[static_cast<std::size_t>(face) - 4]) =
          layer;
      is_drawn |= layer >= 0;
    }
    return is_drawn;
  }

  bool has_room(std::size_t more_jobs) const {
    return layers + static_cast<int>(fewest_maps) <= passes.layers() && jobs.size() + more_jobs <= most_jobs;
  }

  /// Looks for what stands before a cone or a ball of light; a ball is `distance` away, of that `sine`; 0 where light
  /// is endlessly far.
  void add_cone(const ShadowStage& stage, const ShadowPoint& point, const ConeView& cone, double distance, double sine,
                std::span<const int> nodes, std::size_t row) {
    ConeView seen = cone;
    const bool is_single = is_seen_by_axis(point, cone.axis, cone.half_angle);
    if (is_single) seen.half_angle = 0;
    std::vector<int> in_the_way;
    for (const int node : nodes)
      if (seen.may_cover(stage.place_of(node).ball)) in_the_way.push_back(node);
    if (in_the_way.empty()) return;
    const MapView view = view_of_cone(cone.axis, std::min(seen.half_angle, widest_map));
    const bool is_cube = seen.half_angle > widest_map;
    MapJob job = {packed(view.right, is_cube ? 0 : 1 / view.half_width),
                  packed(view.up, 2 * std::pow(std::sin(0.5 * cone.half_angle), 2)),
                  packed(view.axis, distance),
                  packed({sine, 0, 0}, 0),
                  {-1, -1, -1, -1},
                  {-1, -1, -1, -1},
                  {is_single ? 1 : static_cast<std::int32_t>(cone_directions), -1, 0, 0}};
    if (is_cube) {
      if (!add_cube(stage, point.position, in_the_way, job)) return;
    } else {
      job.layers[0] = add_map(stage, point.position, view, in_the_way);
      if (job.layers[0] < 0) return;
    }
    jobs.push_back(job);
    rows.push_back(row);
  }

  /// Looks for what stands before skies, whose rows follow each other from `row` on. What is far below the point's
  /// horizon is left out or grouped as rays do it.
  void add_skies(const ShadowStage& stage, const ShadowPoint& point, std::span<const int> nodes, std::size_t skies,
                 std::size_t row) {
    std::vector<int> seen;
    for (const int node : nodes)
      if (!is_far_below(point, stage.place_of(node).ball)) seen.push_back(node);
    MapJob job = {packed(point.normal.value_or(Eigen::Vector3d::Zero()), 0),
                  packed({far_below_horizon, 0, 0}, -1),
                  packed(Eigen::Vector3d::Zero(), 0),
                  packed(Eigen::Vector3d::Zero(), 0),
                  {-1, -1, -1, -1},
                  {-1, -1, -1, -1},
                  {static_cast<std::int32_t>(sky_directions), -1, 0, 0}};
    if (!add_cube(stage, point.position, seen, job)) return;
    for (std::size_t k = 0; k < 3 * skies; ++k) {
      job.numbers[1] = static_cast<std::int32_t>(k * sky_directions);
      jobs.push_back(job);
      rows.push_back(row + k);
    }
  }
};

VisibilityMaps::VisibilityMaps(const VisibilityMapSettings& settings) {
  require_gl();
  implementation_ = std::make_unique<Implementation>(settings);
}

VisibilityMaps::~VisibilityMaps() = default;

std::string VisibilityMaps::renderer() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

const VisibilityMapWork& VisibilityMaps::work() const { return implementation_->work; }

void VisibilityMaps::set_meshes(std::span<const TriangleMesh* const> meshes) {
  implementation_->instances.assign(meshes.size(), {});
  implementation_->passes.set_meshes(meshes);
}

void VisibilityMaps::set_lights(const LightSources& sources, const DirectionSet& sky, int bands) {
  implementation_->coefficients = static_cast<std::size_t>(coefficient_count(bands));
  implementation_->sky_directions = sky.count();
  implementation_->cone_directions = static_cast<std::uint32_t>(sources.pattern.share.size());
  implementation_->passes.set_lights(sources, sky, bands);
}

VisibilityTable VisibilityMaps::find(const ShadowStage& stage, const LightSources& sources,
                                     std::span<const VisibilityTask> tasks) {
  Implementation& own = *implementation_;
  VisibilityTable table{visibility_rows(sources), own.coefficients, {}, {}};
  table.counts.resize(tasks.size() * table.rows);
  table.sums.resize(table.counts.size() * table.coefficients);
  const KeptGlState kept(own.settings.texels);
  const auto depth_unit = static_cast<float>(std::max(1e-6 * stage.placed.front().ball.radius, 1e-30));
  const auto make_room = [&](std::size_t more_jobs) {
    if (!own.has_room(more_jobs)) own.flush(depth_unit, table);
  };
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const ShadowPoint& point = *tasks[t].point;
    const NodeOccluders& occluders = *tasks[t].occluders;
    std::size_t row = t * table.rows;
    for (const ConeLight& cone : sources.cones) {
      make_room(1);
      own.add_cone(stage, point, {point.position, cone.axis, cone.half_angle}, 0, 0, occluders.meshes, row++);
    }
    for (const LightSpec& ball : sources.balls) {
      const Eigen::Vector3d away = Eigen::Vector3d(ball.position.data()) - point.position;
      const double distance = away.norm();
      const std::size_t own_row = row++;
      if (distance <= ball.radius) continue;  // from inside a ball of light nothing stands in front of it
      make_room(1);
      const double half_angle = std::asin(ball.radius / distance);
      own.add_cone(stage, point,
                   {point.position, away / distance, is_single_direction(half_angle) ? 0 : half_angle,
                    std::sqrt(std::max(0.0, distance * distance - ball.radius * ball.radius))},
                   distance, ball.radius / distance, occluders.meshes, own_row);
    }
    if (sources.skies.empty() || occluders.sky_meshes.empty()) continue;
    make_room(3 * sources.skies.size());
    own.add_skies(stage, point, occluders.sky_meshes, sources.skies.size(), row);
  }
  own.flush(depth_unit, table);
  return table;
}

}  // namespace kiln
