#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace kiln {

/// What a triangle adds to the volume under a point v: (normal.v - offset) / 6 is the volume of the tetrahedron that
/// they span.
struct TrianglePlane {
  Eigen::Vector3d normal;  ///< twice the area long
  double offset = 0;       ///< normal.a of a corner a

  TrianglePlane() = default;
  TrianglePlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
};

/// An edge of a border or crease.
struct FeatureEdge {
  Eigen::Vector3d from, to;
};

/// The neighbourhood of an edge, all in one frame.
struct EdgeSurroundings {
  std::span<const TrianglePlane> planes;  ///< of each triangle at either end
  std::span<const FeatureEdge> lines;     ///< at either end
  double squared_length = 0;              ///< of the edge
};

/// Where the edge's vertex goes: keeps the volume and a line's area, and of what is left minimises the squares of the
/// volumes and areas between before and after; in flat places, goes to the middle of `link`, the vertices around the
/// edge. `link` is called only there. Nothing where that is not defined. Lindstrom and Turk, "Fast and memory efficient
/// polygonal simplification" (1998), sections 4.1 to 4.5, with their angle of 1 degree between constraints.
template <class Link>
std::optional<Eigen::Vector3d> lindstrom_turk_placement(const EdgeSurroundings& edge, const Link& link);

/// Cost of moving the edge's vertex to `v`, volume and lines weighted equally (section 4.6); length to the power of 6.
double lindstrom_turk_cost(const EdgeSurroundings& edge, const Eigen::Vector3d& v);

/// Up to three linear equations for a point.
class PlacementConstraints {
 public:
  int size() const { return size_; }
  /// Adds row.v = value unless that is nearly parallel to what is there.
  void add(const Eigen::Vector3d& row, double value);
  /// Adds what H v = -c says about the directions that are still free.
  void add_minimum(const Eigen::Matrix3d& H, const Eigen::Vector3d& c);
  /// Needs three.
  Eigen::Vector3d solve() const;

 private:
  int size_ = 0;
  Eigen::Vector3d rows_[3];
  double values_[3] = {};
};

/// All but the last step.
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
