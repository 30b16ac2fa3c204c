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

struct Face {
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

struct Node {
  Eigen::AlignedBox3d box;
  std::uint32_t begin = 0;  ///< first of its faces
  std::uint32_t end = 0;
  std::uint32_t right = 0;  ///< second child (the first is the next node); 0 for a leaf
  Cone normals;             ///< normals of its faces
};

constexpr std::uint32_t leaf_faces = 4;

Eigen::Vector3d closest_on(const Face& face, const Eigen::Vector3d& point) {
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
  return closest_on(Face{a, b - a, c - a, 0, {}}, point);
}

struct NearestSurface::Hierarchy {
  std::vector<Face> faces;
  std::vector<Node> nodes;

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

  /// Adds a node that halves its faces along the widest direction of their centres. Returns its number.
  std::uint32_t add(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    Node node;
    node.begin = begin;
    node.end = end;
    Eigen::AlignedBox3d middles;
    for (std::uint32_t i = begin; i < end; ++i) {
      node.box.extend(faces[i].a).extend(faces[i].a + faces[i].ab).extend(faces[i].a + faces[i].ac);
      middles.extend(faces[i].middle());
    }
    node.normals = cone_of(begin, end);
    nodes.push_back(node);
    if (end - begin <= leaf_faces) return index;
    Eigen::Index axis;
    middles.sizes().maxCoeff(&axis);
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(faces.begin() + begin, faces.begin() + half, faces.begin() + end,
                     [&](const Face& l, const Face& r) {
                       return std::pair(l.middle()[axis], l.index) < std::pair(r.middle()[axis], r.index);
                     });
    add(begin, half);
    nodes[index].right = add(half, end);
    return index;
  }
};

NearestSurface::NearestSurface(const TriangleMesh& mesh) : hierarchy_(std::make_unique<Hierarchy>()) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Eigen::Vector3d, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = mesh.positions[mesh.triangles[i][k]].cast<double>();
    Face face{corner[0], corner[1] - corner[0], corner[2] - corner[0], i, {}};
    if (!(face.ab.cross(face.ac).squaredNorm() > 0)) continue;
    face.normal = face.unit_normal().cast<float>();
    hierarchy_->faces.push_back(face);
  }
  if (hierarchy_->faces.empty()) throw std::invalid_argument("NearestSurface: the mesh has no area");
  hierarchy_->nodes.reserve(hierarchy_->faces.size());
  hierarchy_->add(0, static_cast<std::uint32_t>(hierarchy_->faces.size()));
}

NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

/// Finds into `hit` the nearest face for which count(face) holds, nearer than `within`. `may_count` tells whether any
/// face of a node may.
template <class Counts, class MayCount>
void NearestSurface::search(const Eigen::Vector3d& point, std::uint32_t hint, double within, Hit& hit,
                            const Counts& counts, const MayCount& may_count) const {
  const auto& [faces, nodes] = *hierarchy_;
  hit.squared_distance = within * within;
  const auto look_at = [&](std::uint32_t face) {
    const Eigen::Vector3d closest = closest_on(faces[face], point);
    const double squared = (closest - point).squaredNorm();
    if (squared < hit.squared_distance && counts(faces[face])) hit = {closest, squared, faces[face].index, face};
  };
  look_at(hint);

  // Visit the nearer child first; a stack of 64 is deep enough for halves of 2^32 faces.
  std::array<std::pair<double, std::uint32_t>, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {nodes[0].box.squaredExteriorDistance(point), 0};
  while (depth > 0) {
    const auto [squared, index] = stack[--depth];
    if (squared >= hit.squared_distance) continue;
    const Node& node = nodes[index];
    if (!may_count(node)) continue;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) look_at(i);
      continue;
    }
    std::pair<double, std::uint32_t> near{nodes[index + 1].box.squaredExteriorDistance(point), index + 1};
    std::pair<double, std::uint32_t> far{nodes[node.right].box.squaredExteriorDistance(point), node.right};
    if (far.first < near.first) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
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
  const float smallest = static_cast<float>(facing.smallest_cosine);
  constexpr float rounding = 1e-4f;  // slack for rounding of cones
  constexpr std::uint32_t none = ~0u;
  Hit hit;
  hit.hint = none;
  search(
      point, hint, facing.within, hit, [&](const Face& face) { return face.normal.dot(normal) >= smallest; },
      [&](const Node& node) { return node.normals.largest_cosine(normal) >= smallest - rounding; });
  if (hit.hint == none) return {};
  return hit;
}

Eigen::Vector3d NearestSurface::normal(const Hit& hit) const { return hierarchy_->faces[hit.hint].unit_normal(); }

}  // namespace kiln
