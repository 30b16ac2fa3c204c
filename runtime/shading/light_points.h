// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu/gl_objects.h"
#include "runtime/light/incident_samples.h"
#include "runtime/shading/shaded_scene.h"

namespace kiln {

/// Points at which the light of nodes with transfer is computed, on the GPU: of each triangle its vertices, and of each
/// vertex its place and, unless it is a point itself, the contributions of the points to it (shading_points.glsl).
struct LightPoints {
  struct Place {
    int first_triangle = 0, first_vertex = 0;
    int points = 1;
  };
  std::vector<Place> places;  ///< of each mesh
  GlBuffer triangles, vertices;
  GlTexture triangle_vertices, vertex_vectors;  ///< buffer textures; none where every mesh has one point
};

/// Places and uploads points of the meshes with transfer; `incident_samples` as for place_incident_samples. Throws
/// MachineLacks.
LightPoints upload_light_points(std::span<const ShadedMesh> meshes, int incident_samples);

/// Returns the points of a mesh, object space.
std::vector<Eigen::Vector3f> light_points(const ShadedMesh& mesh, int incident_samples);

}  // namespace kiln
