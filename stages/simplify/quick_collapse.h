#pragma once

#include <span>
#include <vector>

#include "simplify/collapse.h"
#include "simplify/collapsing_mesh.h"

namespace kiln {

/// Appends to `sequence`, which has no collapses yet, those of its start by quadrics, down to `faces` triangles or as
/// far as it goes: several times faster and less exact than collapse_edges. Edges are collapsed in rounds, in each
/// those that are cheapest and share no end. Vertices on `lines` stay as they are. `weights` of the vertices, or none;
/// kept up. Garland and Heckbert, "Surface simplification using quadric error metrics" (1997); rounds after
/// meshoptimizer.
void collapse_quickly(CollapseSequence& sequence, std::span<const VertexPair> lines, std::vector<VertexWeight>& weights,
                      int faces, const ProgressFunction& progress);

}  // namespace kiln
