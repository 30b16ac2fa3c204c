// SPDX-License-Identifier: GPL-3.0-or-later
#include "shadow_stands.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <numbers>
#include <random>

#include "base/parallel.h"
#include "import/import_mesh.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "simplify/simplify.h"

namespace kiln {

namespace {

constexpr double pi = std::numbers::pi;

Placement placed(const Eigen::Vector3d& place, double scale, double turn_degrees = 0) {
  Placement placement;
  placement.translation = place;
  placement.scale = scale;
  placement.rotation = turn_about_y(turn_degrees);
  return placement;
}

int add_node(SceneTree& tree, int parent, int asset) {
  SceneNode node;
  node.name = "node" + std::to_string(tree.count());
  node.parent = parent;
  node.asset = asset;
  tree.nodes.push_back(node);
  const int index = tree.count() - 1;
  if (parent >= 0) tree.nodes[static_cast<std::size_t>(parent)].children.push_back(index);
  return index;
}

SceneTree root_alone() {
  SceneTree tree;
  add_node(tree, -1, -1);
  return tree;
}

/// A scene of rays for one frame.
class TruthScene {
 public:
  explicit TruthScene(const TriangleMesh& mesh) : scene_(rtcNewScene(device())) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    if (!mesh.triangles.empty()) {
      RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
      for (const Eigen::Vector3f& position : mesh.positions) vertices = std::copy_n(position.data(), 3, vertices);
      auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
      for (const Triangle& triangle : mesh.triangles) corners = std::copy(triangle.begin(), triangle.end(), corners);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
  }
  ~TruthScene() { rtcReleaseScene(scene_); }
  TruthScene(const TruthScene&) = delete;
  TruthScene& operator=(const TruthScene&) = delete;

  bool blocks(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = {};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }

 private:
  static RTCDevice device() {
    static const RTCDevice device_of_all = rtcNewDevice(nullptr);
    return device_of_all;
  }
  RTCScene scene_;
};

void append_placed(TriangleMesh& whole, const TriangleMesh& mesh, const Placement& placement) {
  TriangleMesh moved;
  moved.triangles = mesh.triangles;
  for (const Eigen::Vector3f& position : mesh.positions)
    moved.positions.push_back(placement.to_scene(position.cast<double>()).cast<float>());
  append(whole, moved);
}

}  // namespace

StandObject stand_object(TriangleMesh mesh, bool convex, int samples) {
  StandObject object;
  object.mesh = std::move(mesh);
  if (object.mesh.normals.empty()) compute_vertex_normals(object.mesh);
  object.samples = place_incident_samples(object.mesh, samples);
  const float lift = 1e-4f * bounding_box(object.mesh).diagonal();
  for (const Triangle& triangle : object.mesh.triangles) {
    Eigen::Vector3f place = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
    for (const std::uint32_t corner : triangle) {
      place += object.mesh.positions[corner] / 3;
      normal += object.mesh.normals[corner];
    }
    object.places.push_back(place + lift * area_normal(object.mesh, triangle).normalized().cast<float>());
    object.normals.push_back(normal.normalized());
  }
  const ShBasis basis(stand_bands);
  if (convex) {
    for (const Eigen::Vector3f& normal : object.normals) object.transfer.push_back(unoccluded_transfer(basis, normal));
    return object;
  }
  // The transfer integral by independent rays: one set of directions for all places.
  const TruthScene own(object.mesh);
  const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 4096, 1);
  std::vector<std::vector<float>> rows(directions.size(), std::vector<float>(static_cast<std::size_t>(basis.size())));
  for (std::size_t d = 0; d < directions.size(); ++d) basis.evaluate<float>(directions[d], rows[d]);
  object.transfer.resize(object.places.size());
  parallel_for(std::size_t{0}, object.places.size(), [&](std::size_t p) {
    std::vector<double> sum(rows[0].size(), 0.0);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const float cosine = object.normals[p].dot(directions[d]);
      if (cosine <= 0 || own.blocks(object.places[p], directions[d])) continue;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(cosine * rows[d][i]);
    }
    for (const double value : sum)
      object.transfer[p].push_back(static_cast<float>(4 * value / static_cast<double>(directions.size())));
  });
  return object;
}

TriangleMesh load_body(const std::filesystem::path& file, int faces) {
  SimplifySettings settings;
  settings.faces = faces;
  TriangleMesh mesh = simplify(load_mesh(file), settings).mesh;
  const BoundingBox box = bounding_box(mesh);
  for (Eigen::Vector3f& position : mesh.positions) position = (position - box.centre()) / box.sides().y();
  mesh.frame = {};
  compute_vertex_normals(mesh);
  return mesh;
}

LightSpec stand_light(const ShadowStand& stand, double half_angle_degrees) {
  LightSpec light;
  light.kind = half_angle_degrees > 0 ? LightSpec::Kind::cone : LightSpec::Kind::directional;
  const Eigen::Vector3d axis = stand.towards_light.normalized();
  light.azimuth_degrees = std::atan2(axis.x(), axis.z()) * 180 / pi;
  light.elevation_degrees = std::asin(axis.y()) * 180 / pi;
  light.half_angle_degrees = half_angle_degrees;
  return light;
}

ShadowStand stand_a(const StandBodies& bodies) {
  ShadowStand stand;
  stand.name = "A";
  stand.tree = root_alone();
  const int still = add_node(stand.tree, 0, 0), moving = add_node(stand.tree, 0, 0);
  stand.objects = {&bodies.ball};
  stand.per_vertex = {bodies.ball.samples.are_vertices()};
  stand.towards_light = {8, 8, 8};
  // The large one is above the origin; the other goes round below it and passes its shadow.
  stand.poses = [](double share) {
    const double turn = 2 * pi * share;
    return ScenePoses{Placement{}, placed({0, 1.6, 0}, 1),
                      placed({2.4 * std::sin(turn), 0, 2.4 * std::cos(turn)}, 0.6)};
  };
  stand.receivers = {still, moving};
  return stand;
}

ShadowStand stand_b(const StandBodies& bodies) {
  ShadowStand stand;
  stand.name = "B";
  stand.tree = root_alone();
  const int pair = add_node(stand.tree, 0, -1), third = add_node(stand.tree, 0, 0),
            first = add_node(stand.tree, pair, 0), second = add_node(stand.tree, pair, 0);
  stand.objects = {&bodies.bunny};
  stand.per_vertex = {bodies.bunny.samples.are_vertices()};
  stand.towards_light = {0, 0, 1};
  stand.poses = [](double share) {
    const auto round = [&](double turns, double radius) {
      const double turn = 2 * pi * turns * share;
      return Eigen::Vector3d(radius * std::sin(turn), 0, radius * std::cos(turn));
    };
    return ScenePoses{Placement{}, Placement{}, placed(round(1, 2.8), 1.2, 360 * share),
                      placed({0, 0, 0}, 0.7, 720 * share), placed(round(2, 1.4), 1.0, -360 * share)};
  };
  stand.receivers = {third, first, second};
  return stand;
}

ShadowStand stand_c(const StandBodies& bodies, bool per_vertex) {
  ShadowStand stand;
  stand.name = per_vertex ? "C" : "C, 6 samples";
  stand.tree = root_alone();
  const int still = add_node(stand.tree, 0, 1);
  add_node(stand.tree, 0, 0);
  stand.objects = {&bodies.ball, &bodies.bunny};
  stand.per_vertex = {false, per_vertex};
  stand.towards_light = {0.2, 1, 0.3};
  stand.poses = [](double share) {
    return ScenePoses{Placement{}, Placement{}, placed({-0.7 + 1.4 * share, 0.42, 0.05}, 0.05)};
  };
  stand.receivers = {still};
  return stand;
}

ShadowStand stand_d(const StandBodies& bodies, int count) {
  ShadowStand stand;
  stand.name = "D, " + std::to_string(count);
  stand.tree = root_alone();
  const int ground = add_node(stand.tree, 0, 2);
  stand.receivers = {ground};
  std::vector<int> nodes;
  int group = 0;
  for (int k = 0; k < count; ++k) {
    if (k % 5 == 0) group = add_node(stand.tree, 0, -1);
    nodes.push_back(add_node(stand.tree, group, k % 2));
    stand.receivers.push_back(nodes.back());
  }
  stand.objects = {&bodies.ball, &bodies.bunny, &bodies.ground};
  stand.per_vertex = {false, false, true};
  stand.towards_light = {0.6, 1, 0.4};
  const auto total = stand.tree.nodes.size();
  stand.poses = [nodes, total, ground, count](double share) {
    ScenePoses poses(total);
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    poses[static_cast<std::size_t>(ground)] = placed({0, 0, 0}, side + 1.0);
    for (int k = 0; k < count; ++k) {
      const double bob = 0.15 * std::sin(2 * pi * (share + 0.37 * k));
      poses[static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)])] =
          placed({k % side - 0.5 * (side - 1) + bob, 0.65 + bob, k / side - 0.5 * (side - 1) + 0.2 * (k % 3)},
                 k % 2 == 0 ? 0.35 : 0.7, 360 * share + 40 * k);
    }
    return poses;
  };
  return stand;
}

MovingShadows shadows_of(const ShadowStand& stand, const ShadowSettings& settings,
                         std::shared_ptr<VisibilityEngine> engine) {
  std::vector<ShadowObject> objects;
  for (std::size_t k = 0; k < stand.objects.size(); ++k) {
    const StandObject& object = *stand.objects[k];
    objects.push_back({&object.mesh, object.samples.points, stand_bands, {}});
    if (!stand.per_vertex[k]) continue;
    objects.back().points = object.mesh.positions;
    objects.back().normals = object.mesh.normals;
  }
  return MovingShadows(stand.tree, std::move(objects), settings, std::move(engine));
}

TrueFrame true_frame(const ShadowStand& stand, const ScenePoses& poses, const LightSpec& light, unsigned seed) {
  constexpr int side = 16;
  const double half_angle = light.half_angle_degrees * pi / 180, depth = 1 - std::cos(half_angle);
  const Eigen::Vector3d axis = stand.towards_light.normalized(), across = axis.unitOrthogonal(),
                        up = axis.cross(across);
  const double radiance = 1 / std::pow(std::sin(half_angle), 2), solid_angle = 2 * pi * depth / (side * side);
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Eigen::Vector3d> directions;
  for (int k = 0; k < side * side; ++k) {
    const double z = 1 - (k / side + uniform(generator)) / side * depth, radius = std::sqrt(1 - z * z),
                 azimuth = 2 * pi * (k % side + uniform(generator)) / side;
    directions.push_back(radius * std::cos(azimuth) * across + radius * std::sin(azimuth) * up + z * axis);
  }
  const ShBasis basis(stand_bands);
  TrueFrame frame;
  for (const int receiver : stand.receivers) {
    TriangleMesh others, own;
    for (int node = 0; node < stand.tree.count(); ++node) {
      const int asset = stand.tree.nodes[static_cast<std::size_t>(node)].asset;
      if (asset < 0) continue;
      append_placed(node == receiver ? own : others, stand.objects[static_cast<std::size_t>(asset)]->mesh,
                    poses[static_cast<std::size_t>(node)]);
    }
    const TruthScene of_others(others), of_own(own);
    const Placement& pose = poses[static_cast<std::size_t>(receiver)];
    const StandObject& object =
        *stand.objects[static_cast<std::size_t>(stand.tree.nodes[static_cast<std::size_t>(receiver)].asset)];
    std::vector<std::vector<float>> rows;  // of the basis in the node's space
    for (const Eigen::Vector3d& direction : directions) {
      rows.emplace_back(static_cast<std::size_t>(basis.size()));
      basis.evaluate<float>((pose.rotation.transpose() * direction).cast<float>().normalized(), rows.back());
    }
    const std::size_t first = frame.exact.size(), places = object.places.size();
    for (FrameRadiance* part : {&frame.unshadowed, &frame.exact, &frame.bands}) part->resize(first + places);
    parallel_for(std::size_t{0}, places, [&](std::size_t p) {
      const Eigen::Vector3f origin = pose.to_scene(object.places[p].cast<double>()).cast<float>();
      const Eigen::Vector3d normal = pose.rotation * object.normals[p].cast<double>();
      double unshadowed = 0, exact = 0;
      std::vector<double> arriving(rows[0].size(), 0.0);
      for (std::size_t d = 0; d < directions.size(); ++d) {
        const double cosine = normal.dot(directions[d]);
        const Eigen::Vector3f direction = directions[d].cast<float>();
        const bool shines = !of_others.blocks(origin, direction);
        if (shines)
          for (std::size_t i = 0; i < arriving.size(); ++i) arriving[i] += static_cast<double>(rows[d][i]);
        if (cosine <= 0 || of_own.blocks(origin, direction)) continue;
        unshadowed += cosine;
        exact += shines ? cosine : 0;
      }
      double banded = 0;
      for (std::size_t i = 0; i < arriving.size(); ++i)
        banded += arriving[i] * static_cast<double>(object.transfer[p][i]);
      frame.unshadowed[first + p] = static_cast<float>(unshadowed * radiance * solid_angle / pi);
      frame.exact[first + p] = static_cast<float>(exact * radiance * solid_angle / pi);
      frame.bands[first + p] = static_cast<float>(std::max(0.0, banded * radiance * solid_angle));
    });
  }
  return frame;
}

FrameRadiance frame_of(const ShadowStand& stand, const MovingShadows& shadows) {
  FrameRadiance frame;
  for (const int receiver : stand.receivers) {
    const auto asset = static_cast<std::size_t>(stand.tree.nodes[static_cast<std::size_t>(receiver)].asset);
    const StandObject& object = *stand.objects[asset];
    const std::span<const LightCoefficients> light = shadows.light_of(receiver);
    const auto samples = static_cast<std::size_t>(object.samples.count());
    for (std::size_t p = 0; p < object.places.size(); ++p) {
      double radiance = 0;
      for (const std::uint32_t corner : object.mesh.triangles[p]) {
        if (stand.per_vertex[asset]) {
          radiance += dot_product(light[corner].channels[0], object.transfer[p]) / 3;
          continue;
        }
        for (std::size_t s = 0; s < samples; ++s)
          radiance += static_cast<double>(object.samples.contributions[corner * samples + s]) *
                      dot_product(light[s].channels[0], object.transfer[p]) / 3;
      }
      frame.push_back(static_cast<float>(std::max(0.0, radiance)));
    }
  }
  return frame;
}

}  // namespace kiln
