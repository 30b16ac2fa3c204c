// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "simplify/collapse.h"
#include "simplify/vertex_weight.h"

namespace kiln {

/// Appends to `sequence`, which has no collapses yet, those of its start by quadrics, down to `faces` triangles or as
/// far as it goes: several times faster and less exact than collapse_edges. Edges are collapsed in rounds, in each
/// those that are cheapest and share no end. Vertices of `features` stay as they are. `weights` are those of the
/// vertices, or empty; they are kept up. Quadrics are those of [Garland 1997], rounds those of meshoptimizer.
void collapse_quickly(CollapseSequence& sequence, std::span<const VertexPair> features,
                      std::vector<VertexWeight>& weights, int faces, const ProgressFunction& progress);

}  // namespace kiln
