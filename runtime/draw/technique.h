// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "asset/prt_asset.h"

namespace kiln {

/// Ways to draw an asset: those that Chapter 2010, table 6.1 compares, and ours in fewer bytes.
enum class Technique {
  phong,         ///< the low mesh's normals; no shadows
  normal_map,    ///< Phong with the high mesh's normals; no shadows
  vertex_prt,    ///< transfer at vertices, lit there, interpolated
  textured_prt,  ///< transfer in the texels of the atlas
  compressed,    ///< the same by principal components
};

inline constexpr std::array<Technique, 5> all_techniques = {
    Technique::phong, Technique::normal_map, Technique::vertex_prt, Technique::textured_prt, Technique::compressed};

/// Whether light is computed for every sample drawn, or once for each that is visible.
enum class Shading { forward, deferred };

/// As the command line has it: "phong", "normal-map", "vertex-prt", "textured-prt", "compressed".
std::string technique_name(Technique technique);

/// As a person reads it, of an asset: "Textured PRT, 25 planes of 8 bits".
std::string technique_caption(Technique technique, const PrtAsset& asset);

/// What an asset is made for: textured PRT, compressed, or per-vertex PRT.
Technique natural_technique(const PrtAsset& asset);

/// Whether the asset's folder has what the technique reads. If not, throws WrongUsage that says what it lacks.
void require_technique(Technique technique, const PrtAsset& asset);

}  // namespace kiln
