#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"

namespace kiln {

/// Of a vertex, or of several that became one.
struct VertexWeight {
  double sum = 1, count = 1;

  double mean() const { return sum / count; }
  VertexWeight& operator+=(const VertexWeight& other) {
    sum += other.sum;
    count += other.count;
    return *this;
  }
};

/// Collapses are computed in a frame where the bounding box is centred on the origin with a diagonal of 1: quadrics of
/// far away or tiny objects lose their digits, and tolerances get a meaning.
struct UnitFrame {
  Eigen::Vector3d centre;
  double diagonal;

  explicit UnitFrame(const TriangleMesh& mesh);
  Eigen::Vector3d to_object(const Eigen::Vector3d& p) const { return centre + diagonal * p; }
  Eigen::Vector3d from_object(const Eigen::Vector3f& p) const { return (p.cast<double>() - centre) / diagonal; }
};

/// Finds for each vertex the height below which its triangles are too thin, in a frame where `diagonal` is 1. A
/// component has what 16 bits can tell in its own box, but not less than what 24 bits, the most that a file has, can in
/// the mesh's.
std::vector<float> thinnest_heights(const TriangleMesh& mesh, double diagonal);

/// The triangles around each vertex of an oriented manifold whose edges are collapsed one by one. Positions are up to
/// whoever holds it.
class CollapsingMesh {
 public:
  CollapsingMesh(const TriangleMesh& mesh, std::span<const VertexPair> feature_edges);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::span<const std::uint32_t> triangles_of(std::uint32_t vertex) const {
    return {pool_.data() + around_[vertex].begin, around_[vertex].size};
  }
  bool is_removed(std::uint32_t vertex) const { return around_[vertex].size == 0; }
  int faces() const { return faces_; }

  /// How many feature lines end in or pass (twice) a vertex; it lies inside a line where that is 2.
  int lines_at(std::uint32_t vertex) const { return lines_at_[vertex]; }
  /// Whether corner k of the triangle and the next are joined by a feature line.
  bool is_line(std::uint32_t triangle, int corner) const { return (line_bits_[triangle] >> corner & 1) != 0; }
  /// The line's edges at `vertex` as other ends; each once.
  void line_neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& neighbours) const;

  /// What there is to know of an edge before it is collapsed.
  struct Edge {
    int triangles = 0;            ///< on it: 1 at a border
    std::uint32_t at[2] = {};     ///< those triangles
    bool line = false;            ///< a feature line
    bool keeps_topology = false;  ///< and does not make two lines one
  };
  Edge edge(std::uint32_t a, std::uint32_t b) const;

  /// Makes `removed` into `kept`. Needs edge(removed, kept).keeps_topology.
  void collapse(std::uint32_t removed, std::uint32_t kept);

 private:
  struct Around {
    std::uint32_t begin = 0, size = 0, capacity = 0;
  };
  std::uint32_t opposite_line(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const;
  void mark_line(std::uint32_t a, std::uint32_t b);
  bool has_line(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const;

  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> line_bits_;
  std::vector<std::uint8_t> lines_at_;
  std::vector<Around> around_;
  std::vector<std::uint32_t> pool_;
  int faces_ = 0;
  mutable std::vector<std::uint32_t> mark_;
  mutable std::uint32_t mark_now_ = 0;
};

}  // namespace kiln
