// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

inline constexpr int most_incident_samples = 8;
/// In place of a number of samples: one at every vertex, which a renderer interpolates over the triangles.
inline constexpr int samples_at_vertices = -1;

/// Incident-light samples: points around a mesh at which the arriving light is computed, and each one's contribution at
/// every vertex, for lights too near to be the same all over the mesh ([Chapter 2010], 4.3.3 and 4.3.4).
struct IncidentSamples {
  std::vector<Eigen::Vector3f> points;  ///< object space
  /// vertex * points.size() + point; those of a vertex add up to 1; empty if each vertex has a sample of its own
  std::vector<float> contributions;

  int count() const { return static_cast<int>(points.size()); }
  bool are_vertices() const { return contributions.empty() && !points.empty(); }
};

/// Places `count` points, 1 to most_incident_samples, or samples_at_vertices. A single one stands at the centre of the
/// box. Several stand 1 / sqrt(2) of the way from the surface's centre of mass to vertices: first both extremes along
/// x, y and z, then, while there are vertices, the one farthest from all so far.
///
/// [Chapter 2010] gives a sample's contribution at a vertex as D_s / D_t, its distance over the sum of all distances.
/// By its own text nearer samples should count more, so the ratio is inverted there. Here samples are weighted by
/// inverse squared distance [Shepard 1968], and moving least squares [Lancaster 1981] reproduce light that varies
/// linearly in space, so that contributions may be a little below 0. Distances are straight ones, since light varies in
/// space, not along the surface.
IncidentSamples place_incident_samples(const TriangleMesh& mesh, int count);

}  // namespace kiln
