#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "simplify/simplify_settings.h"

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

  /// The mesh after the first `count` collapses, without the vertices they removed.
  TriangleMesh after(std::size_t count) const;
};

/// Collapses edges of an oriented manifold, cheapest first, until at most `faces` triangles are left or no collapse is
/// left that keeps the topology, folds nothing over and leaves no triangle too thin for a Draco file of 16 bits. Border
/// edges are collapsed along the border only. Lindstrom and Turk, "Fast and memory efficient polygonal simplification"
/// (1998); Garland and Heckbert, "Surface simplification using quadric error metrics" (1997); Trettner and Kobbelt,
/// "Fast and robust QEF minimization using probabilistic quadrics" (2020).
CollapseSequence collapse_edges(TriangleMesh mesh, CollapseCost cost, int faces,
                                const ProgressFunction& progress = no_progress);

}  // namespace kiln
