// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/polygon_triangles.h"

namespace kiln {

namespace {

using Corners = std::vector<std::uint32_t>;  ///< indices of SourceMesh::corners

class Cutter {
 public:
  Cutter(const SourceMesh& source, std::vector<CutTriangle>& triangles) : source_(source), triangles_(triangles) {}

  void cut(std::uint32_t face) {
    face_ = face;
    const SourceMesh::Face& f = source_.faces[face];
    Corners corners(f.corner_count);
    for (std::uint32_t k = 0; k < f.corner_count; ++k) corners[k] = f.first_corner + k;
    if (corners.size() == 4) return cut_fan(corners, first_of_quad(corners));
    if (corners.size() <= 4 || !cut_polygon(corners)) cut_fan(corners, 0);
  }

 private:
  const Eigen::Vector3d& at(std::uint32_t corner) const { return source_.places[source_.corners[corner].place]; }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.push_back({face_, {a, b, c}}); }

  void cut_fan(const Corners& corners, std::size_t first) {
    const auto corner = [&](std::size_t i) { return corners[(first + i) % corners.size()]; };
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) add(corner(0), corner(i), corner(i + 1));
  }

  /// Returns the corner that a quad's diagonal starts at.
  std::size_t first_of_quad(const Corners& corners) const {
    const auto place = [&](std::size_t i) -> const Eigen::Vector3d& { return at(corners[i % 4]); };
    const auto folds = [&](std::size_t i) {  // fold at the diagonal from corner i
      const Eigen::Vector3d diagonal = place(i + 2) - place(i);
      return (place(i + 1) - place(i)).cross(diagonal).dot(diagonal.cross(place(i + 3) - place(i))) < 0;
    };
    if (folds(0) != folds(1)) return folds(0);
    const double first = (place(0) - place(2)).norm(), second = (place(1) - place(3)).norm();
    // Equal diagonals: take the least corner, whatever corner the quad begins with, so that a quad and its back are cut
    // alike.
    if (std::abs(first - second) <= 1e-6 * first) return least_of(corners) % 2;
    return second < first;
  }

  std::size_t least_of(const Corners& corners) const {
    const auto is_less = [&](std::uint32_t a, std::uint32_t b) {
      return std::lexicographical_compare(at(a).begin(), at(a).end(), at(b).begin(), at(b).end());
    };
    return static_cast<std::size_t>(std::min_element(corners.begin(), corners.end(), is_less) - corners.begin());
  }

  bool cut_polygon(const Corners& corners) {
    std::vector<Eigen::Vector3d> places;
    for (const std::uint32_t corner : corners) places.push_back(at(corner));
    const std::vector<Triangle> cut = triangulate_polygon(places);
    for (const Triangle& t : cut) add(corners[t[0]], corners[t[1]], corners[t[2]]);
    return !cut.empty();
  }

  const SourceMesh& source_;
  std::vector<CutTriangle>& triangles_;
  std::uint32_t face_ = 0;
};

}  // namespace

std::vector<CutTriangle> triangulate(const SourceMesh& source, int* polygons) {
  std::vector<CutTriangle> triangles;
  triangles.reserve(source.corners.size() - 2 * source.faces.size());
  Cutter cutter(source, triangles);
  for (std::uint32_t face = 0; face < source.faces.size(); ++face) {
    if (polygons != nullptr) *polygons += source.faces[face].corner_count > 3;
    if (source.faces[face].corner_count == 3) {
      const std::uint32_t first = source.faces[face].first_corner;
      triangles.push_back({face, {first, first + 1, first + 2}});
    } else {
      cutter.cut(face);
    }
  }
  return triangles;
}

Eigen::AlignedBox3d box_of(const SourceMesh& source, const std::vector<CutTriangle>& triangles) {
  Eigen::AlignedBox3d box;
  for (const CutTriangle& triangle : triangles)
    for (const std::uint32_t corner : triangle.corners) box.extend(source.places[source.corners[corner].place]);
  return box;
}

}  // namespace kiln
