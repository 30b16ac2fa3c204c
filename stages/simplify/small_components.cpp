// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/small_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>

#include "mesh/mesh_components.h"

namespace kiln {

namespace {

struct Component {
  double size = 0;  ///< diagonal of its box
  double area = 0;
  int triangles = 0;
};

std::vector<Component> measure(const TriangleMesh& mesh, const Components& components) {
  std::vector<Component> all(components.count);
  const std::vector<BoundingBox> boxes = component_boxes(mesh, components);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].size = boxes[i].diagonal();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Component& component = all[components.of_triangle[i]];
    component.area += 0.5 * area_normal(mesh, mesh.triangles[i]).norm();
    ++component.triangles;
  }
  return all;
}

/// Returns how many triangles the least surface has that a component can become: a tetrahedron's 4, or what it has.
int least_triangles(const Component& component) { return std::min(component.triangles, 4); }

/// Returns the edge of an equilateral triangle where `faces` of them have this area.
double mean_edge(double area, int faces) { return std::sqrt(area / faces * 4 / std::sqrt(3.0)); }

/// Lists the components that `may_go` and have less than a hundredth of `area`, the smallest first, as many as have no
/// more than `largest_share` of it together.
template <class MayGo>
std::vector<std::uint32_t> specks(const std::vector<Component>& components, double area, double largest_share,
                                  const MayGo& may_go) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < components.size(); ++i)
    if (components[i].area < 0.01 * area && may_go(components[i])) found.push_back(i);
  std::stable_sort(found.begin(), found.end(),
                   [&](std::uint32_t l, std::uint32_t r) { return components[l].size < components[r].size; });
  double together = 0;
  const auto end = std::find_if(found.begin(), found.end(), [&](std::uint32_t i) {
    together += components[i].area;
    return together > largest_share * area;
  });
  found.erase(end, found.end());
  return found;
}

/// Counts: "1 component", "2 components".
std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// Writes a number rounded up to two digits.
std::string rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  std::ostringstream text;
  text << std::ceil(value / unit * (1 - 1e-9)) * unit;
  return text.str();
}

}  // namespace

std::string DroppedComponents::text() const {
  std::ostringstream stream;
  stream.precision(3);
  stream << "dropped " << counted(static_cast<std::size_t>(components), "component") << " of "
         << counted(static_cast<std::size_t>(triangles), "triangle") << " in all, " << 100 * area_share
         << " % of the surface, none larger than " << largest_size << "; --drop-components 0 keeps them";
  return stream.str();
}

DroppedComponents drop_small_components(TriangleMesh& mesh, const SimplifySettings& settings) {
  DroppedComponents dropped;
  const std::optional<double> size = settings.drop_size();
  const bool by_error = settings.max_error > 0;
  if (size ? *size == 0 : by_error || mesh.triangles.size() <= static_cast<std::size_t>(settings.faces)) return dropped;
  const Components components = find_components(mesh);
  if (components.count < 2) return dropped;
  const std::vector<Component> all = measure(mesh, components);
  double area = 0;
  for (const Component& component : all) area += component.area;
  std::vector<std::uint32_t> gone;
  if (size) {
    const double largest = *size * bounding_box(mesh).diagonal();
    gone = specks(all, area, 0.5, [&](const Component& component) { return component.size <= largest; });
  } else {
    const double largest = 0.1 * mean_edge(area, settings.faces);
    constexpr double texel = 1 / (0.6 * 512 * 512);  // share of the surface in the default atlas
    gone = specks(all, area, 0.01, [&](const Component& component) {
      return component.size <= largest || component.area <= 0.01 * texel * area;
    });
    long long needed = 0;
    for (const std::uint32_t i : gone) needed += least_triangles(all[i]);
    if (needed * 10 <= settings.faces) return dropped;
  }

  std::vector<bool> is_gone(all.size(), false);
  for (const std::uint32_t i : gone) {
    is_gone[i] = true;
    ++dropped.components;
    dropped.triangles += all[i].triangles;
    dropped.area_share += all[i].area / area;
    dropped.largest_size = std::max(dropped.largest_size, all[i].size);
  }
  std::vector<Triangle> left;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (!is_gone[components.of_triangle[i]]) left.push_back(mesh.triangles[i]);
  mesh.triangles = std::move(left);
  return dropped;
}

std::string why_no_fewer(const TriangleMesh& low, int faces, const TriangleMesh& high) {
  const std::vector<Component> all = measure(low, find_components(low));
  std::vector<double> sizes;
  int most = 0;
  for (const Component& component : all)
    if (component.triangles <= 4) {
      sizes.push_back(component.size);
      most = std::max(most, component.triangles);
    }
  const std::string other = "no further collapse keeps the surface from folding over or leaving the input's";
  if (sizes.empty() || all.size() < 2) return other;
  std::string reason = counted(sizes.size(), "component") + " of " +
                       (most == 4 ? "4" : "at most " + std::to_string(most)) + " triangles each cannot vanish";
  // Find the size that would do, and what it would drop; the largest of all stays.
  std::sort(sizes.begin(), sizes.end());
  const std::size_t excess = low.triangles.size() - static_cast<std::size_t>(faces);
  const std::size_t enough = std::min(sizes.size(), (excess + 3) / 4);
  const std::string size = rounded_up(1.01 * sizes[enough - 1] / bounding_box(high).diagonal());
  SimplifySettings settings;
  settings.faces = faces;
  settings.drop_components = size;
  TriangleMesh dropping{high.positions, high.triangles, {}, {}};
  const int dropped = drop_small_components(dropping, settings).components;
  if (dropped > 0)
    reason += "; --drop-components " + size + " drops " + counted(static_cast<std::size_t>(dropped), "component");
  return reason;
}

}  // namespace kiln
