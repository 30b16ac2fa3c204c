// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>

#include "asset/prt_asset.h"

namespace kiln {

/// Ways to draw an asset: those that [Chapter 2010], table 6.1 compares, and a compressed one.
enum class Technique {
  phong,         ///< the low mesh's normals; no shadows
  normal_map,    ///< Phong with the high mesh's normals; no shadows
  vertex_prt,    ///< transfer at vertices, lit there, interpolated
  textured_prt,  ///< transfer in the texels of the atlas
  compressed,    ///< transfer in the texels of the atlas, by principal components
};

inline constexpr std::array<Technique, 5> all_techniques = {
    Technique::phong, Technique::normal_map, Technique::vertex_prt, Technique::textured_prt, Technique::compressed};

/// Order of drawing and shading: light is computed for every sample drawn, or once for each visible sample.
enum class Shading { forward, deferred };

/// Returns the command-line name: "phong", "normal-map", "vertex-prt", "textured-prt", "compressed".
std::string technique_name(Technique technique);

/// Returns the caption of an asset drawn so: "Textured PRT, 25 planes of 8 bits".
std::string technique_caption(Technique technique, const PrtAsset& asset);

/// Returns the technique that an asset is made for: textured PRT, compressed, or per-vertex PRT.
Technique natural_technique(const PrtAsset& asset);

/// Throws WrongUsage, naming what is missing, unless the asset's folder has the data of the technique.
void require_technique(Technique technique, const PrtAsset& asset);

}  // namespace kiln
