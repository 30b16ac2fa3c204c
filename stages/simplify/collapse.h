// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"

namespace kiln {

/// Collapse of an edge: its vertex `removed` (v0) became `kept` (v1), which moved to `position`. The triangles on the
/// edge are gone, with them an edge to either opposite vertex, vl and vr:
///
///            vl                     vl
///           /  \                     |
///          /    \                    |
///        v0 ---- v1       ->     kept (v1)
///          \    /                    |
///           \  /                     |
///            vr                     vr
///
/// The two edges of v0 and v1 to vl have become one, and so have those to vr. At a border only one of both is there.
struct Collapse {
  std::uint32_t removed = 0;  ///< v0
  std::uint32_t kept = 0;     ///< v1
  int faces = 0;              ///< triangles left after this collapse
  Eigen::Vector3f position;   ///< of `kept` from now on, in object space
};

/// Mesh and the collapses that simplify it, in order; after any number of them, what is left is a mesh.
struct CollapseSequence {
  TriangleMesh start;
  std::vector<Collapse> collapses;
  std::size_t close_count = 0;  ///< collapses within the closest limits; the rest had wider ones
  bool met_envelope =
      false;  ///< true where a collapse was refused as it would have left the envelope (collapse_by_cgal)

  /// Returns the number of triangles after the first `count` collapses.
  int faces_after(std::size_t count) const;
  /// Returns the fewest collapses that leave at most `faces` triangles, or the number of all.
  std::size_t count_for(int faces) const;
  /// Builds the mesh after the first `count` collapses, without the vertices that they removed. `vertex_origins`, if
  /// given, becomes the start's vertex that each of its vertices was.
  TriangleMesh after(std::size_t count, std::vector<std::uint32_t>* vertex_origins = nullptr) const;
};

/// Finds which of the given edges of the start are left after the first `count` collapses, as vertices of after(count):
/// each once, the smaller vertex first, sorted. An edge whose ends became one vertex is gone; several may have become
/// one.
std::vector<VertexPair> surviving_edges(const CollapseSequence& sequence, std::size_t count,
                                        std::span<const VertexPair> edges);

/// Settings of edge collapse.
struct CollapseSettings {
  int faces = 4;              ///< triangles to stop at
  double crease_degrees = 0;  ///< dihedral angle beyond which edges are feature edges; 0: none are
  /// Edges of the input that are feature edges whatever their angle is.
  std::span<const VertexPair> feature_edges = {};
  /// Number of triangles from which on those of a collapse are compared with the input (or what a large one was
  /// simplified to quickly): they may not leave that surface, nor face against it. 0: never.
  int compared_faces = std::numeric_limits<int>::max();
  /// Weights of the input's vertices, or empty where all are 1: an edge's cost is multiplied by the mean of its ends'.
  /// A vertex that stands for several has the mean of theirs.
  std::span<const double> vertex_weights = {};
};

/// Collapses edges of an oriented manifold, cheapest first, until at most settings.faces triangles are left or no
/// collapse is left that keeps the topology, folds nothing over, stays near the input and leaves no triangle too thin
/// for the file. Feature edges (borders, creases and those given) are collapsed along their lines only; where these
/// branch or end, the vertex stays. Places and costs are those of [Lindstrom 1998]. Costs are computed when they are
/// needed: an edge's is renewed when it is next in the queue.
CollapseSequence collapse_edges(TriangleMesh mesh, const CollapseSettings& settings,
                                const ProgressFunction& progress = no_progress);

/// Collapses edges as collapse_edges does, but down to `quick_faces` triangles by quadrics in rounds, which is several
/// times faster and less exact (collapse_quickly).
CollapseSequence collapse_edges_in_two_steps(TriangleMesh mesh, int quick_faces, const CollapseSettings& settings,
                                             const ProgressFunction& progress = no_progress);

}  // namespace kiln
