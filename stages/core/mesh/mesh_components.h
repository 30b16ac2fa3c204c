#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Which of the numbers 0 to n - 1 belong together (union-find with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size);
  std::uint32_t root(std::uint32_t member);

  /// The lesser of the two roots stands for both.
  void join(std::uint32_t a, std::uint32_t b);

  /// The root of every member, in order.
  std::vector<std::uint32_t> roots();

 private:
  std::vector<std::uint32_t> parent_;
};

/// Parts of a mesh that share no vertex, numbered in the order of their first triangles.
struct Components {
  std::size_t count = 0;
  std::vector<std::uint32_t> of_triangle;
};

Components find_components(const TriangleMesh& mesh);

/// The box of each component.
std::vector<BoundingBox> component_boxes(const TriangleMesh& mesh, const Components& components);

/// Turns the closed components of negative volume that lie in no other closed one; a cavity's wall faces inwards
/// rightly. `mesh` is an oriented manifold. Returns how many were turned and sets how many components there are.
int turn_inside_out_components(TriangleMesh& mesh, int& components);

}  // namespace kiln
