#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

inline constexpr int most_incident_samples = 8;

/// Points around a mesh at which the light that comes in is computed, and how much each counts at every vertex: lights
/// near a mesh are not the same all over it (Chapter 2010, 4.3.3 and 4.3.4).
struct IncidentSamples {
  std::vector<Eigen::Vector3f> points;  ///< object space
  std::vector<float> contributions;     ///< vertex * points.size() + point; those of a vertex add up to 1

  int count() const { return static_cast<int>(points.size()); }
};

/// `count` of 1 to most_incident_samples points. One: the centre of the box. More: first the vertices at both extremes
/// of x, y and z, then, as long as there are vertices, that which is farthest from all points so far.
///
/// The thesis writes a sample's contribution at a vertex as D_s / D_t, its distance over the sum of all distances. By
/// its own text near samples are to count more, so that the ratio is the wrong way round: here it is (D_t / D_s)^2,
/// made to add up to 1. The square is Shepard's ("A two-dimensional interpolation function for irregularly-spaced
/// data", 1968), without which the field has a spike at every sample. Distances are straight ones: light varies with
/// the place, not with the way along the surface.
IncidentSamples place_incident_samples(const TriangleMesh& mesh, int count);

}  // namespace kiln
