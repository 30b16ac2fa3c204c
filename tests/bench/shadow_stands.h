// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "runtime/light/incident_samples.h"
#include "runtime/scene/scene_tree.h"
#include "runtime/shadow/moving_shadows.h"
#include "sh/light_spec.h"

namespace kiln {

/// A mesh as an asset of the measurement: the middles of its triangles receive light, by transfer in `bands` bands that
/// Embree computed there, shadowed by the mesh itself.
struct StandObject {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> places, normals;  ///< of the triangles' middles; object space
  std::vector<std::vector<float>> transfer;      ///< by place
  IncidentSamples samples;
};

inline constexpr int stand_bands = 5;

/// Makes an object with so many samples of incident light, or samples_at_vertices; a convex one does not shadow itself.
StandObject stand_object(TriangleMesh mesh, bool convex, int samples = 6);

/// Loads a mesh and simplifies it to `faces` triangles, one unit in height, centred.
TriangleMesh load_body(const std::filesystem::path& file, int faces);

/// A scene of the measurement, with its motion.
struct ShadowStand {
  std::string name;
  SceneTree tree;
  std::vector<const StandObject*> objects;  ///< by asset
  std::vector<bool> per_vertex;             ///< by asset: light at all vertices, not at samples
  Eigen::Vector3d towards_light = {1, 1, 1};
  std::function<ScenePoses(double)> poses;  ///< at a share of the period, 0 to 1
  std::vector<int> receivers;               ///< nodes whose error is measured
};

/// Returns a cone of light of the stand, or a directional light for 0 degrees.
LightSpec stand_light(const ShadowStand& stand, double half_angle_degrees);

/// The meshes of all stands.
struct StandBodies {
  StandObject ball, bunny, ground;
};

/// Tests A and B of [Chapter 2010], 6.3.1; C: a ball of a tenth of the bunny's height passes close over its back, light
/// per vertex of the bunny; D: `count` balls and bunnies that bob and turn over a ground, in composite nodes of five.
ShadowStand stand_a(const StandBodies& bodies);
ShadowStand stand_b(const StandBodies& bodies);
ShadowStand stand_c(const StandBodies& bodies, bool per_vertex);
ShadowStand stand_d(const StandBodies& bodies, int count);

/// Makes the shadows of a stand, by rays where `engine` is null.
MovingShadows shadows_of(const ShadowStand& stand, const ShadowSettings& settings,
                         std::shared_ptr<VisibilityEngine> engine = nullptr);

/// Exit radiance of all places of all receivers in one frame.
using FrameRadiance = std::vector<float>;

/// Exit radiance of one frame, white surfaces, by independent rays: Embree's single rays at all meshes of the other
/// nodes as one scene, and at the node's own.
struct TrueFrame {
  FrameRadiance unshadowed;  ///< by the node's own mesh alone
  FrameRadiance exact;       ///< what arrives
  FrameRadiance bands;       ///< the same light projected to five bands at each place, times transfer
};

/// Casts about 256 rays, stratified at random, of a cone of light from each place.
TrueFrame true_frame(const ShadowStand& stand, const ScenePoses& poses, const LightSpec& light, unsigned seed);

/// Exit radiance by a method's light, at least 0: interpolated by the samples' contributions, or between the three
/// vertices around a place.
FrameRadiance frame_of(const ShadowStand& stand, const MovingShadows& shadows);

}  // namespace kiln
