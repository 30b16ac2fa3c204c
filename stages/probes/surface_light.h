// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "probes/probes_settings.h"
#include "raycast/surface_cache.h"

namespace kiln {

/// Meshes joined into one, and their albedos.
struct ProbeScene {
  TriangleMesh mesh;                           ///< positions and triangles
  std::vector<std::uint32_t> first_triangles;  ///< first triangle of each mesh
  std::vector<SurfaceAlbedo> albedos;          ///< albedo of each mesh

  void add(const TriangleMesh& part, SurfaceAlbedo albedo = {});
  bool grey() const;
  Eigen::Vector3f albedo_at(std::uint32_t triangle, float u, float v) const;
};

/// Light that a surface sends out of the distant light, all bounces together: exit radiance of channel c at point p of
/// the cache is the sum over j of L_j values[(p * channels + c) * bands^2 + j].
struct SurfaceLight {
  SurfaceCache cache;
  int channels = 1;           ///< 1 where all albedos are grey, else 3
  std::vector<float> values;  ///< empty: the surface sends nothing
  int bounces = 0;            ///< bounces taken
  double last_share = 0;      ///< share of the last bounce in all light, relative L2
};

/// Lights the scene's surface over `directions` and lets light bounce off it: r^1 = rho t^0, where t^0 is the transfer
/// of distant light, and r^b = rho / pi times the integral of max(0, n.s) r^(b-1)(q(s)) ds, where q is the surface
/// point seen along s from the front. Returns the sum of r^1 to r^n, n being settings.bounces; with auto, n is reached
/// when a bounce adds less than a thousandth.
SurfaceLight light_surface(const ProbeScene& scene, const ProbesSettings& settings, int seed,
                           const ProgressFunction& progress = no_progress);

}  // namespace kiln
