// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln::extremes {

/// Mesh in doubles, counter-clockwise seen from outside.
struct Shape {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector2d> uvs = {};  ///< one per corner, three to a triangle; may be empty

  /// Returns the longest side of its box.
  double size() const;
  /// Returns the shape multiplied with `factor`, component by component, and moved.
  Shape placed(const Eigen::Vector3d& factor, const Eigen::Vector3d& move = Eigen::Vector3d::Zero()) const;
  /// Returns both shapes as one.
  Shape with(const Shape& other) const;
};

/// Makes a torus about +Y with bumps, which shadows itself: 2 * around * across triangles.
Shape bumpy_torus(int around, int across);

/// Makes a box of slabs along x, `count` of them of `width`; each has 8 triangles, of the aspect 1 / width.
Shape slabs(int count, double width);

/// Makes a cube about the origin.
Shape cube(double half_side);

/// Makes a square in the plane y = 0, facing +Y.
Shape square(double side);

/// Writes an OBJ file with digits enough for doubles.
void write_obj(const std::filesystem::path& file, const Shape& shape);

/// Writes a binary PLY file of floats.
void write_ply(const std::filesystem::path& file, const Shape& shape);

/// Returns the triangles and uvs of an atlas as they are in its file; vertices at the same position are one.
Shape shape_of(const TriangleMesh& atlas);

/// Returns the mesh in floats, without normals.
TriangleMesh in_floats(const Shape& shape);

}  // namespace kiln::extremes
