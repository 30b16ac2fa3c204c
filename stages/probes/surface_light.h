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

/// Meshes as one, and what they reflect.
struct ProbeScene {
  TriangleMesh mesh;                           ///< positions and triangles
  std::vector<std::uint32_t> first_triangles;  ///< of each mesh
  std::vector<SurfaceAlbedo> albedos;          ///< of each mesh

  void add(const TriangleMesh& part, SurfaceAlbedo albedo = {});
  bool grey() const;
  Eigen::Vector3f albedo_at(std::uint32_t triangle, float u, float v) const;
};

/// What a surface sends on of the light far away, all bounces together: exit radiance of channel c at point p of the
/// cache = sum over j of L_j values[(p * channels + c) * bands^2 + j].
struct SurfaceLight {
  SurfaceCache cache;
  int channels = 1;           ///< 1 where all albedos are grey, else 3
  std::vector<float> values;  ///< empty: nothing
  int bounces = 0;            ///< that were taken
  double last_share = 0;      ///< what the last one added, relative L2 of all
};

/// Lights the scene's surface over `directions` and lets light bounce off it: r^1 = rho t^0, t^0 the transfer of light
/// far away, and r^b = rho / pi times the integral of max(0, n.s) r^(b-1)(q(s)) ds, q what is seen along s from the
/// front. The sum of r^1 to r^n, n of settings.bounces; with auto until a bounce adds less than a thousandth.
SurfaceLight light_surface(const ProbeScene& scene, const ProbesSettings& settings, int seed,
                           const ProgressFunction& progress = no_progress);

}  // namespace kiln
