// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "runtime/shadow/combined_shadows.h"
#include "runtime/shadow/shadow_settings.h"

namespace kiln {

/// Sum over the directions that a node's siblings block, each basis function times the solid angle of a direction:
/// what a filter loses on its way from the node's parent to the node ([Chapter 2010], 5.1.6). Empty: nothing.
using BlockedSum = std::vector<double>;

/// What may block a node's filter: its siblings.
struct SiblingOccluders {
  std::vector<int> meshes;  ///< mesh nodes that rays are cast at
  std::vector<int> balls;   ///< composite nodes of which only the ball around them counts
};

/// Finds the siblings of `node`. A composite sibling is all its meshes, or with `composite_balls` the ball around them
/// where that is clear of the node's own (5.3). `for_static`: for static nodes, whose bakes hold the shadows of other
/// static ones.
SiblingOccluders sibling_occluders(const ShadowStage& stage, int node, bool composite_balls, bool for_static);

/// Computes what siblings block at a point (scene's space), in the bands of the stage's directions.
BlockedSum blocked_by(const ShadowStage& stage, const SiblingOccluders& siblings, const Eigen::Vector3d& point);

/// Returns the filter that is left of light from everywhere when the sums of a node and of all above it are taken.
std::vector<float> filter_of(const BlockedSum& blocked);

/// Multiplies light with a filter as `thesis`, `product` or `subtraction` does ([Chapter 2010], 5.1.7). Both have
/// `bands` bands.
///
/// thesis: the triple product with both factors under the Hann window; `light` has been given its own window already,
/// which Kiln scales so that a facing surface keeps its radiance. product: the triple product. subtraction: what the
/// filter lacks, times the mean of the light's channel, is taken from it (the thesis leaves the scale open; this makes
/// it right for light from everywhere).
LightCoefficients filtered_light(ShadowMethod method, const LightCoefficients& light, std::span<const float> filter);

/// Multiplies the lights at `position` (scene's space) with a filter of more than `bands` bands, each light in as many
/// before its window, and cuts only the products to `bands`, each of which then gets its light's window.
LightCoefficients product_of_many_bands(const SceneLights& lights, std::span<const float> filter, int bands,
                                        const Eigen::Vector3d& position);

}  // namespace kiln
