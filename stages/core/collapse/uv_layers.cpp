// SPDX-License-Identifier: GPL-3.0-or-later
#include "collapse/uv_layers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "collapse/uv_plane.h"
#include "mesh/disjoint_sets.h"
#include "mesh/same_position.h"

namespace kiln {

namespace {

constexpr int grid = 512;
constexpr std::uint32_t most_layers = 64;  // bits of a word; further charts share the last

/// Numbers the charts: triangles that share corners of the same place, uv and picture.
std::vector<std::uint32_t> charts_by_triangle(const TriangleMesh& mesh, std::span<const std::uint32_t> pictures) {
  std::vector<float> values;
  values.reserve(6 * mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3f& p = mesh.positions[v];
    const float picture = pictures.empty() ? 0 : static_cast<float>(pictures[v]);
    values.insert(values.end(), {p.x(), p.y(), p.z(), mesh.uvs[v].x(), mesh.uvs[v].y(), picture});
  }
  const std::vector<std::uint32_t> same = first_of_equals(values, 6);
  DisjointSets sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(same[t[0]], same[t[1]]);
    sets.join(same[t[0]], same[t[2]]);
  }
  std::vector<std::uint32_t> charts;
  charts.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) charts.push_back(sets.root(same[t[0]]));
  return charts;
}

/// Calls visit(place) for the places of the grid that lie within a triangle.
template <class Visit>
void visit_places(const std::array<Eigen::Vector2d, 3>& corners, const Visit& visit) {
  const Eigen::Vector2d lowest = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector2d highest = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  const double side = turn(corners[0], corners[1], corners[2]) < 0 ? -1 : 1;
  const auto first = [](double value) { return std::max(0, static_cast<int>(std::ceil(value - 0.5))); };
  const auto last = [](double value) { return std::min(grid - 1, static_cast<int>(std::floor(value - 0.5))); };
  for (int j = first(lowest.y()); j <= last(highest.y()); ++j)
    for (int i = first(lowest.x()); i <= last(highest.x()); ++i) {
      const Eigen::Vector2d place(i + 0.5, j + 0.5);
      if (side * turn(corners[0], corners[1], place) > 0 && side * turn(corners[1], corners[2], place) > 0 &&
          side * turn(corners[2], corners[0], place) > 0)
        visit(static_cast<std::size_t>(j) * grid + static_cast<std::size_t>(i));
    }
}

}  // namespace

std::vector<std::uint32_t> find_uv_layers(const TriangleMesh& mesh, std::span<const std::uint32_t> pictures) {
  const std::vector<std::uint32_t> charts = charts_by_triangle(mesh, pictures);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2f& uv : mesh.uvs) box.extend(uv.cast<double>());
  const Eigen::Vector2d scale = grid * box.sizes().cwiseMax(1e-30).cwiseInverse();
  const auto corners_of = [&](const Triangle& t) {
    std::array<Eigen::Vector2d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = (mesh.uvs[t[k]].cast<double>() - box.min()).cwiseProduct(scale);
    return corners;
  };
  const auto picture_of = [&](std::size_t triangle) {
    return pictures.empty() ? 0 : pictures[mesh.triangles[triangle][0]];
  };

  // Take the charts one after another, by picture, and give each the first layer that is free at all of its places.
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(picture_of(a), charts[a]) < std::pair(picture_of(b), charts[b]);
  });
  std::vector<std::uint32_t> layers(mesh.positions.size(), 0);
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(grid) * grid, 0);  // a bit for each layer of this picture
  std::uint32_t first_layer = 0, used = 0;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    if (begin > 0 && picture_of(order[begin]) != picture_of(order[begin - 1])) {
      std::fill(taken.begin(), taken.end(), 0);
      first_layer += used;
      used = 0;
    }
    std::uint64_t here = 0;
    for (end = begin; end < order.size() && charts[order[end]] == charts[order[begin]]; ++end)
      visit_places(corners_of(mesh.triangles[order[end]]), [&](std::size_t place) { here |= taken[place]; });
    std::uint32_t layer = 0;
    while (layer + 1 < most_layers && (here >> layer & 1) != 0) ++layer;
    used = std::max(used, layer + 1);
    for (std::size_t k = begin; k < end; ++k) {
      const Triangle& triangle = mesh.triangles[order[k]];
      visit_places(corners_of(triangle), [&](std::size_t place) { taken[place] |= std::uint64_t{1} << layer; });
      for (const std::uint32_t vertex : triangle) layers[vertex] = first_layer + layer;
    }
  }
  return layers;
}

}  // namespace kiln
