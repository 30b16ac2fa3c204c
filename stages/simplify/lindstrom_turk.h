// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace kiln {

/// Plane of a triangle, scaled such that (normal.v - offset) / 6 is the volume of the tetrahedron that the triangle and
/// a point v span.
struct TrianglePlane {
  Eigen::Vector3d normal;  ///< as long as twice the triangle's area
  double offset = 0;       ///< normal.a for any corner a

  TrianglePlane() = default;
  TrianglePlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
};

/// Feature edge as a segment: of a border, a crease, or given.
struct FeatureEdge {
  Eigen::Vector3d from, to;
};

/// Neighbourhood of an edge, all in one frame.
struct EdgeSurroundings {
  std::span<const TrianglePlane> planes;  ///< of the triangles at either end, each once
  std::span<const FeatureEdge> features;  ///< feature edges at either end, each once
  double squared_length = 0;              ///< of the edge itself
};

/// Finds where the edge's vertex goes. That place keeps the volume, and the area beside a line of feature edges; with
/// the freedom left, it minimises the squares of the volumes and areas between before and after. In flat places it is
/// the middle of the vertices around the edge, which `link` is called for only there. Returns nothing where no place is
/// defined. From [Lindstrom 1998], sections 4.1 to 4.5, with the angle of 1 degree between constraints given there.
template <class Link>
std::optional<Eigen::Vector3d> lindstrom_turk_placement(const EdgeSurroundings& edge, const Link& link);

/// Computes the cost of moving the edge's vertex to `v`, volumes and feature edges weighted equally ([Lindstrom 1998],
/// section 4.6), in lengths to the power of 6.
double lindstrom_turk_cost(const EdgeSurroundings& edge, const Eigen::Vector3d& v);

/// Linear equations for a point, three at most.
class PlacementConstraints {
 public:
  int size() const { return size_; }
  /// Adds the equation row.v = value unless its row is nearly parallel to those that are there.
  void add(const Eigen::Vector3d& row, double value);
  /// Adds what H v = -c says in the directions that are still free.
  void add_minimum(const Eigen::Matrix3d& H, const Eigen::Vector3d& c);
  /// Solves the equations, of which there must be three.
  Eigen::Vector3d solve() const;

 private:
  int size_ = 0;
  Eigen::Vector3d rows_[3];
  double values_[3] = {};
};

/// Collects the equations of lindstrom_turk_placement, less those for flat places: fewer than three there.
PlacementConstraints lindstrom_turk_constraints(const EdgeSurroundings& edge);

template <class Link>
std::optional<Eigen::Vector3d> lindstrom_turk_placement(const EdgeSurroundings& edge, const Link& link) {
  PlacementConstraints constraints = lindstrom_turk_constraints(edge);
  if (constraints.size() < 3) {
    const Eigen::Vector3d middle = link();
    constraints.add_minimum(Eigen::Matrix3d::Identity(), -middle);
  }
  if (constraints.size() < 3) return {};
  return constraints.solve();
}

}  // namespace kiln
