#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"

namespace kiln {

/// One edge collapse: its vertex `removed` became `kept`, which moved to `position`.
struct Collapse {
  std::uint32_t removed = 0;
  std::uint32_t kept = 0;
  int faces = 0;  ///< triangles left after it
  Eigen::Vector3f position;
};

/// A mesh and the collapses that simplify it, in order; every prefix of them is a mesh.
struct CollapseSequence {
  TriangleMesh start;
  std::vector<Collapse> collapses;
  std::size_t close_count = 0;  ///< so many kept within the closest limits; the rest had wider ones
  bool met_envelope = false;    ///< some collapse was refused as it would have left the envelope (collapse_by_cgal)

  /// Triangles after the first `count` collapses.
  int faces_after(std::size_t count) const;
  /// The fewest collapses that leave at most `faces` triangles, or all.
  std::size_t count_for(int faces) const;
  /// The mesh after the first `count` collapses, without the vertices they removed. `vertex_origins`: of each of its
  /// vertices, that of the start which it was.
  TriangleMesh after(std::size_t count, std::vector<std::uint32_t>* vertex_origins = nullptr) const;
};

/// Which of the given edges of the start are left after the first `count` collapses, as vertices of after(count): each
/// once, the smaller vertex first, sorted. An edge whose ends became one vertex is gone; several may have become one.
std::vector<VertexPair> surviving_edges(const CollapseSequence& sequence, std::size_t count,
                                        std::span<const VertexPair> edges);

/// How edges are collapsed.
struct CollapseSettings {
  int faces = 4;              ///< triangles to stop at
  double crease_degrees = 0;  ///< edges of a larger dihedral angle are feature edges; 0: none
  /// Edges of the input that are feature edges whatever their angle is.
  std::span<const VertexPair> feature_edges = {};
  /// From this many triangles on, those of a collapse are compared with the input, or with a large one that was
  /// simplified quickly: they may not leave that surface, nor face against it. 0: never.
  int compared_faces = std::numeric_limits<int>::max();
  /// Of every vertex of the input, or empty for 1: an edge's cost is multiplied by the mean of its ends' weights. A
  /// vertex that stands for several has the mean of theirs.
  std::span<const double> vertex_weights = {};
};

/// Collapses edges of an oriented manifold, cheapest first, until at most settings.faces triangles are left or no
/// collapse is left that keeps the topology, folds nothing over, stays near the input and leaves no triangle too thin
/// for the file. Feature edges (borders, creases and those given) are collapsed along their lines only; where these
/// branch or end, the vertex stays. Lindstrom and Turk, "Fast and memory efficient polygonal simplification" (1998).
/// Costs are computed when they are needed: an edge's is renewed when it is next in the queue.
CollapseSequence collapse_edges(TriangleMesh mesh, const CollapseSettings& settings,
                                const ProgressFunction& progress = no_progress);

/// The same, but down to `quick_faces` triangles by quadrics in rounds, which is several times faster and less exact
/// (collapse_quickly).
CollapseSequence collapse_edges_in_two_steps(TriangleMesh mesh, int quick_faces, const CollapseSettings& settings,
                                             const ProgressFunction& progress = no_progress);

}  // namespace kiln
