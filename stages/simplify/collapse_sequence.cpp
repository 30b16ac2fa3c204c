#include <algorithm>
#include <utility>

#include "simplify/collapse.h"
#include "simplify/collapsing_mesh.h"

namespace kiln {

int CollapseSequence::faces_after(std::size_t count) const {
  return count == 0 ? static_cast<int>(start.triangles.size()) : collapses[count - 1].faces;
}

std::size_t CollapseSequence::count_for(int faces) const {
  if (faces_after(0) <= faces) return 0;
  const auto found =
      std::partition_point(collapses.begin(), collapses.end(), [&](const Collapse& c) { return c.faces > faces; });
  return found == collapses.end() ? collapses.size() : static_cast<std::size_t>(found - collapses.begin()) + 1;
}

// The vertices and triangles that are left keep their order.
TriangleMesh CollapseSequence::after(std::size_t count, std::vector<std::uint32_t>* vertex_origins) const {
  std::vector<Eigen::Vector3f> positions = start.positions;
  std::vector<std::uint32_t> became(positions.size());
  for (std::uint32_t i = 0; i < became.size(); ++i) became[i] = i;
  for (std::size_t i = 0; i < count; ++i) {
    became[collapses[i].removed] = collapses[i].kept;
    positions[collapses[i].kept] = collapses[i].position;
  }
  // A vertex may have gone through several others.
  const auto now = [&](std::uint32_t vertex) {
    std::uint32_t last = vertex;
    while (became[last] != last) last = became[last];
    while (became[vertex] != last) vertex = std::exchange(became[vertex], last);
    return last;
  };
  TriangleMesh mesh;
  std::vector<std::uint32_t> new_index(positions.size(), 0);
  for (const Triangle& triangle : start.triangles) {
    const Triangle left = {now(triangle[0]), now(triangle[1]), now(triangle[2])};
    if (left[0] == left[1] || left[1] == left[2] || left[2] == left[0]) continue;
    for (std::uint32_t vertex : left) new_index[vertex] = 1;
    mesh.triangles.push_back(left);
  }
  if (vertex_origins != nullptr) vertex_origins->clear();
  for (std::uint32_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == 0) continue;
    new_index[i] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(positions[i]);
    if (vertex_origins != nullptr) vertex_origins->push_back(i);
  }
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
  return mesh;
}

}  // namespace kiln
