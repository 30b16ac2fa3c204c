#include "simplify/low_file.h"

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/draco_file.h"

namespace kiln {

namespace {

/// Bits of position from 16 on that leave every triangle its area and winding when each corner moves by the rounding.
int sufficient_position_bits(const TriangleMesh& mesh) {
  constexpr int most_bits = 24;  // about what a float holds
  const BoundingBox box = bounding_box(mesh);
  const double side = (box.highest - box.lowest).cast<double>().maxCoeff();
  int bits = DracoQuantisation().position_bits;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
    const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
    const double height = (b - a).cross(c - a).norm() / std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(height > 0)) continue;  // nothing to keep
    // Each corner moves by sqrt(3)/2 steps at most, the height by that of its tip and of its foot.
    while (bits < most_bits && height < std::sqrt(3.0) * side / (std::exp2(bits) - 1)) ++bits;
  }
  return bits;
}

}  // namespace

TriangleMesh LowFile::write(const TriangleMesh& mesh) {
  DracoQuantisation quantisation;
  quantisation.position_bits = position_bits_ = sufficient_position_bits(mesh);
  // The normals are those of the rounded positions.
  TriangleMesh low = mesh;
  low.normals.clear();
  save_draco(file_, low, quantisation);
  low = load_draco(file_);
  compute_vertex_normals(low);
  save_draco(file_, low, quantisation);
  return load_draco(file_);
}

Json repairs_to_json(const LoadRepairs& load, const ManifoldRepairs& manifold) {
  return {{"merged_vertices", load.merged_vertices},
          {"dropped_triangles", load.dropped_triangles + manifold.dropped_triangles},
          {"unused_vertices", load.unused_vertices},
          {"triangulated_polygons", load.triangulated_polygons},
          {"reversed_triangles", manifold.reversed_triangles},
          {"split_vertices", manifold.split_vertices}};
}

}  // namespace kiln
