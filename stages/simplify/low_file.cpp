// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/low_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/errors.h"
#include "base/json.h"
#include "mesh/hard_edges.h"
#include "mesh/mesh_components.h"

namespace kiln {

namespace {

constexpr int most_bits = 24;  // as many as a float's mantissa
constexpr double wanted_steps = 256, least_steps = 32;

double longest_side(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  return (box.highest - box.lowest).cast<double>().maxCoeff();
}

double step(double side, int bits) { return side / (std::exp2(bits) - 1); }

/// Returns the diagonal of the smallest component's box that is not a point.
double smallest_component(const TriangleMesh& mesh) {
  double smallest = longest_side(mesh);
  for (const BoundingBox& box : component_boxes(mesh, find_components(mesh)))
    if (box.diagonal() > 0) smallest = std::min<double>(smallest, box.diagonal());
  return smallest;
}

/// Returns the fewest bits of position, 16 to 24, that leave every triangle its area and winding when each corner moves
/// by the rounding, and every component its shape.
int sufficient_position_bits(const TriangleMesh& mesh) {
  const double side = longest_side(mesh);
  int bits = DracoQuantisation().position_bits;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
    const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
    const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
    const double height = (b - a).cross(c - a).norm() / std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(height > 0)) continue;  // it has no area to keep
    // Corners move by sqrt(3)/2 steps at most, the height by that of its tip and of its foot.
    while (bits < most_bits && height < std::sqrt(3.0) * step(side, bits)) ++bits;
  }
  const double smallest = smallest_component(mesh);
  while (bits < most_bits && smallest < wanted_steps * step(side, bits)) ++bits;
  return bits;
}

}  // namespace

void LowFile::keep_colors(const TriangleMesh& high) {
  colored_ = &high;
  colored_surface_.emplace(high);
}

DracoQuantisation LowFile::quantisation_for(const TriangleMesh& mesh) {
  DracoQuantisation quantisation;
  quantisation.position_bits = position_bits_ = sufficient_position_bits(mesh);
  const double steps = smallest_component(mesh) / step(longest_side(mesh), most_bits);
  too_few_steps_ = steps < least_steps ? steps : 0;
  return quantisation;
}

TriangleMesh LowFile::save(const TriangleMesh& mesh, const DracoQuantisation& quantisation,
                           const std::vector<IntegerAttribute>& attributes) const {
  if (attributes.empty())
    save_draco(file_, mesh, quantisation);
  else
    save_attributed_draco(file_, mesh, attributes, quantisation);
  TriangleMesh saved = load_draco(file_);
  if (!(surface_area(saved) > 0))
    throw BadInput(source_, "is so thin that no triangle has an area in steps of 24 bits of its longest side",
                   "a surface", "check the units of its axes, or simplify its parts on their own");
  return saved;
}

TriangleMesh LowFile::write(const TriangleMesh& mesh) {
  const DracoQuantisation quantisation = quantisation_for(mesh);
  // Compute the normals from the rounded positions.
  TriangleMesh low = split_at_hard_edges(mesh);
  low.normals.clear();
  low.colors.clear();
  low = save(low, quantisation);
  compute_vertex_normals(low);
  if (colored_ != nullptr) low.colors = nearest_colors(*colored_, *colored_surface_, low.positions);
  return save(low, quantisation);
}

TriangleMesh LowFile::write_as_it_is(const TriangleMesh& mesh, const std::vector<IntegerAttribute>& attributes) {
  DracoQuantisation quantisation = quantisation_for(mesh);
  quantisation.uv_bits = sufficient_uv_bits(mesh.uvs);
  TriangleMesh low = mesh;
  low.colors.clear();
  if (colored_ != nullptr) low.colors = nearest_colors(*colored_, *colored_surface_, low.positions);
  low = save(low, quantisation, attributes);
  // A file's frame is by its own size.
  if (low.frame != mesh.frame)
    for (Eigen::Vector3f& position : low.positions)
      position = mesh.frame.from_file(low.frame.to_file(position.cast<double>())).cast<float>();
  low.frame = mesh.frame;
  return low;
}

std::vector<Eigen::Vector3f> nearest_colors(const TriangleMesh& mesh, const NearestSurface& surface,
                                            const std::vector<Eigen::Vector3f>& positions) {
  std::vector<Eigen::Vector3f> colors;
  std::uint32_t hint = 0;
  for (const Eigen::Vector3f& position : positions) {
    const NearestSurface::Hit hit = surface.nearest(position.cast<double>(), hint);
    hint = hit.hint;
    std::array<Eigen::Vector3d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = mesh.positions[mesh.triangles[hit.triangle][k]].cast<double>();
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    Eigen::Vector3d color = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &next = corner[(k + 1) % 3], &last = corner[(k + 2) % 3];
      const double share = (next - hit.point).cross(last - hit.point).dot(normal) / normal.squaredNorm();
      color += share * mesh.colors[mesh.triangles[hit.triangle][k]].cast<double>();
    }
    colors.emplace_back(color.cwiseMax(0).cwiseMin(1).cast<float>());
  }
  return colors;
}

}  // namespace kiln
