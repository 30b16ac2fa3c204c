// SPDX-License-Identifier: MIT
#include "mesh/nearest_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kiln {

namespace {

struct FlatFace {
  Eigen::Vector3d a, ab, ac;
  std::uint32_t index;
  Eigen::Vector3f normal;  ///< unit

  Eigen::Vector3d middle() const { return a + (ab + ac) / 3; }
  Eigen::Vector3d unit_normal() const { return ab.cross(ac).normalized(); }
};

/// Cone of directions about an axis.
struct Cone {
  Eigen::Vector3f axis = Eigen::Vector3f::UnitZ();
  float cosine = -1,
        sine = 0;  ///< of the largest angle between the axis and a direction; cosine -1 means all directions

  /// Returns an upper bound of the cosine between the unit vector and a direction of the cone.
  float largest_cosine(const Eigen::Vector3f& direction) const {
    const float along = axis.dot(direction);
    if (along >= cosine) return 1;
    return along * cosine + std::sqrt(std::max(0.0f, 1 - along * along)) * sine;
  }
};

constexpr int width = 4;  // children of a node, whose boxes are tested at once

/// Node whose children are nodes, or runs of faces. Boxes are in local coordinates, where the mesh fits into
/// -1 to 1.
struct alignas(16) Node {
  std::array<Eigen::Array4f, 3> low, high;  ///< by axis, then child
  std::array<std::uint32_t, width> child;   ///< a node, or the first of its faces
  std::array<std::uint32_t, width> faces;   ///< number of faces; 0: a node
  int children = 0;
};

/// Margin of boxes in local coordinates, and factor of squared distances to them, that cover the rounding of float32: a
/// point within 2 is off by at most 3 * 2^-23, one farther away by less than 3 * 2^-22 of its distance.
constexpr float box_margin = 0x1p-21f;
constexpr float distance_factor = 1 - 0x1p-19f;

constexpr std::uint32_t leaf_faces = 2;

Eigen::Vector3d closest_on(const FlatFace& face, const Eigen::Vector3d& point) {
  const Eigen::Vector3d ap = point - face.a;
  const double d1 = face.ab.dot(ap), d2 = face.ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return face.a;
  const Eigen::Vector3d bp = ap - face.ab;
  const double d3 = face.ab.dot(bp), d4 = face.ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return face.a + face.ab;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return face.a + d1 / (d1 - d3) * face.ab;
  const Eigen::Vector3d cp = ap - face.ac;
  const double d5 = face.ab.dot(cp), d6 = face.ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return face.a + face.ac;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return face.a + d2 / (d2 - d6) * face.ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return face.a + face.ab + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (face.ac - face.ab);
  return face.a + (vb * face.ab + vc * face.ac) / (va + vb + vc);
}

}  // namespace

Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  return closest_on(FlatFace{a, b - a, c - a, 0, {}}, point);
}

struct NearestSurface::Hierarchy {
  std::vector<FlatFace> faces;
  std::vector<Node> nodes;
  std::vector<std::array<Cone, width>> cones;        ///< of the normals of each node's children
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of local coordinates
  double scale = 1;                                  ///< local units per unit of the mesh, a power of two

  Cone cone_of(std::uint32_t begin, std::uint32_t end) const {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::uint32_t i = begin; i < end; ++i) sum += faces[i].normal;
    if (!(sum.squaredNorm() > 0)) return {};
    const Eigen::Vector3f axis = sum.normalized();
    float smallest = 1;
    for (std::uint32_t i = begin; i < end; ++i) smallest = std::min(smallest, axis.dot(faces[i].normal));
    if (smallest <= -0.9f) return {};
    return {axis, smallest, std::sqrt(std::max(0.0f, 1 - smallest * smallest))};
  }

  /// Halves a run of faces along the widest direction of their centres; returns the first of the second half.
  std::uint32_t halve(std::uint32_t begin, std::uint32_t end) {
    Eigen::AlignedBox3d middles;
    for (std::uint32_t i = begin; i < end; ++i) middles.extend(faces[i].middle());
    Eigen::Index axis;
    middles.sizes().maxCoeff(&axis);
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(faces.begin() + begin, faces.begin() + half, faces.begin() + end,
                     [&](const FlatFace& l, const FlatFace& r) {
                       return std::pair(l.middle()[axis], l.index) < std::pair(r.middle()[axis], r.index);
                     });
    return half;
  }

  /// Writes the box of a run of faces, rounded outwards, as that of a node's child.
  void set_box(Node& node, int k, std::uint32_t begin, std::uint32_t end) const {
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = begin; i < end; ++i)
      box.extend(faces[i].a).extend(faces[i].a + faces[i].ab).extend(faces[i].a + faces[i].ac);
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][k] = static_cast<float>((box.min()[axis] - origin[axis]) * scale) - box_margin;
      node.high[axis][k] = static_cast<float>((box.max()[axis] - origin[axis]) * scale) + box_margin;
    }
  }

  /// Adds a node of a run of faces, quartered. Returns its number.
  std::uint32_t add(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    cones.emplace_back();
    std::vector<std::uint32_t> bounds = {begin, end};
    if (end - begin > leaf_faces) {
      const std::uint32_t half = halve(begin, end);
      bounds = {begin, half, end};
      if (end - half > leaf_faces) bounds.insert(bounds.end() - 1, halve(half, end));
      if (half - begin > leaf_faces) bounds.insert(bounds.begin() + 1, halve(begin, half));
    }
    Node node;
    node.children = static_cast<int>(bounds.size()) - 1;
    for (int k = 0; k < width; ++k) {
      for (int axis = 0; axis < 3; ++axis) node.low[axis][k] = node.high[axis][k] = 0;
      node.child[k] = node.faces[k] = 0;
      if (k >= node.children) continue;
      const std::uint32_t first = bounds[k], last = bounds[k + 1];
      set_box(node, k, first, last);
      cones[index][k] = cone_of(first, last);
      const bool is_leaf = last - first <= leaf_faces;
      node.faces[k] = is_leaf ? last - first : 0;
      node.child[k] = is_leaf ? first : add(first, last);
    }
    nodes[index] = node;
    return index;
  }

  /// Returns lower bounds of the squared distances from a point in local coordinates to the children of a node, in
  /// local units. `Number` is float, or double for points so far away that float's squares would overflow.
  template <class Number>
  static Eigen::Array<Number, width, 1> squared_bounds(const Node& node, const Eigen::Matrix<Number, 3, 1>& point) {
    using Lanes = Eigen::Array<Number, width, 1>;
    Lanes squared = Lanes::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Lanes below = node.low[axis].template cast<Number>() - point[axis];
      const Lanes above = point[axis] - node.high[axis].template cast<Number>();
      squared += below.max(above).max(Lanes::Zero()).square();
    }
    return squared * Number{distance_factor};
  }
};

NearestSurface::NearestSurface(const TriangleMesh& mesh) : hierarchy_(std::make_unique<Hierarchy>()) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Eigen::Vector3d, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = mesh.positions[mesh.triangles[i][k]].cast<double>();
    FlatFace face{corner[0], corner[1] - corner[0], corner[2] - corner[0], i, {}};
    if (!(face.ab.cross(face.ac).squaredNorm() > 0)) continue;
    face.normal = face.unit_normal().cast<float>();
    hierarchy_->faces.push_back(face);
  }
  if (hierarchy_->faces.empty()) throw std::invalid_argument("NearestSurface: the mesh has no area");
  Eigen::AlignedBox3d box;
  for (const FlatFace& face : hierarchy_->faces) box.extend(face.a).extend(face.a + face.ab).extend(face.a + face.ac);
  hierarchy_->origin = box.center();
  hierarchy_->scale = std::exp2(-std::ceil(std::log2(box.sizes().maxCoeff())));
  hierarchy_->nodes.reserve(hierarchy_->faces.size() / 2 + 1);
  hierarchy_->add(0, static_cast<std::uint32_t>(hierarchy_->faces.size()));
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

/// Finds into `hit` the nearest face for which count(face) holds, no farther than `within`; of several at the same
/// distance the first of the mesh. `may_count` tells whether any face of a cone of normals may.
template <class Number, class Counts, class MayCount>
void NearestSurface::search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit,
                            const Counts& counts, const MayCount& may_count) const {
  const Hierarchy& tree = *hierarchy_;
  const Eigen::Matrix<Number, 3, 1> local = ((point - tree.origin) * tree.scale).template cast<Number>();
  const double local_squares = tree.scale * tree.scale;
  hit.squared_distance = within * within;
  hit.triangle = ~0u;
  Number limit{};  // the squared distance in local units, rounded up
  const auto set_limit = [&] {
    limit = std::nextafter(static_cast<Number>(hit.squared_distance * local_squares),
                           std::numeric_limits<Number>::infinity());
  };
  const auto look_at = [&](std::uint32_t number) {
    const FlatFace& face = tree.faces[number];
    const Eigen::Vector3d closest = closest_on(face, point);
    const double squared = (closest - point).squaredNorm();
    const bool is_nearer = squared < hit.squared_distance;
    if (!is_nearer && !(squared == hit.squared_distance && face.index < hit.triangle)) return;
    if (!counts(face)) return;
    hit = {closest, squared, face.index, number};
    set_limit();
  };
  set_limit();
  look_at(hint);

  // Visit the nearest child first; each node replaces itself by at most four, and quarters of 2^32 faces are 16 deep.
  struct Entry {
    Number squared;
    std::uint32_t child, faces;
  };
  std::array<Entry, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, 0, 0};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.squared > limit) continue;
    if (entry.faces > 0) {
      for (std::uint32_t i = 0; i < entry.faces; ++i) look_at(entry.child + i);
      continue;
    }
    const Node& node = tree.nodes[entry.child];
    const Eigen::Array<Number, width, 1> squared = Hierarchy::squared_bounds(node, local);
    const std::size_t bottom = depth;
    for (int k = 0; k < node.children; ++k) {
      if (squared[k] > limit || !may_count(tree.cones[entry.child][k])) continue;
      const Entry next{squared[k], node.child[k], node.faces[k]};
      std::size_t place = depth++;
      for (; place > bottom && stack[place - 1].squared < next.squared; --place) stack[place] = stack[place - 1];
      stack[place] = next;
    }
  }
}

/// Calls search() in float, or in double for points beyond float's squares.
template <class Counts, class MayCount>
void NearestSurface::search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit,
                            const Counts& counts, const MayCount& may_count) const {
  constexpr double far = 1e9;  // local units
  if (((point - hierarchy_->origin) * hierarchy_->scale).cwiseAbs().maxCoeff() < far)
    search<float>(point, hint, within, hit, counts, may_count);
  else
    search<double>(point, hint, within, hit, counts, may_count);
}

NearestSurface::Hit NearestSurface::nearest(const Eigen::Vector3d& point, std::uint32_t hint) const {
  Hit hit;
  const auto all = [](const auto&) { return true; };
  search(point, hint, std::numeric_limits<double>::infinity(), hit, all, all);
  return hit;
}

std::optional<NearestSurface::Hit> NearestSurface::nearest_facing(const Eigen::Vector3d& point, const Facing& facing,
                                                                  std::uint32_t hint) const {
  const Eigen::Vector3f normal = facing.normal.normalized().cast<float>();
  const auto smallest = static_cast<float>(facing.smallest_cosine);
  constexpr float rounding = 1e-4f;  // slack for rounding of cones
  constexpr std::uint32_t none = ~0u;
  Hit hit;
  hit.hint = none;
  search(
      point, hint, facing.within, hit, [&](const FlatFace& face) { return face.normal.dot(normal) >= smallest; },
      [&](const Cone& normals) { return normals.largest_cosine(normal) >= smallest - rounding; });
  if (hit.hint == none) return {};
  return hit;
}

Eigen::Vector3d NearestSurface::normal(const Hit& hit) const { return hierarchy_->faces[hit.hint].unit_normal(); }

}  // namespace kiln
