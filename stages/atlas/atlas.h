// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "atlas/atlas_settings.h"
#include "atlas/measure.h"
#include "base/extent.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

struct AtlasResult {
  TriangleMesh mesh;  ///< positions, normals, uvs, and texture uvs where the mesh came with uvs that are not the
                      ///< atlas; vertices are split at seams
  Extent size;        ///< texels
  int gutter = 0;
  int unfolded_charts = 0;  ///< number of charts by what their map started from: here their parts, laid side by side
  int lscm_charts = 0;
  int arap_charts = 0;
  int mean_value_charts = 0;
  bool kept = false;         ///< the uvs are those that the mesh came with
  double density_order = 0;  ///< with density transfer: the power of the spacing that squared errors grow with; else 0
  int split_charts = 0;      ///< charts taken apart because no way of flattening gave a valid map
  int degenerate_triangles = 0;  ///< triangles without area: they shrink to a point of the atlas and cover nothing
  double seconds = 0;
  double chart_seconds = 0;  ///< part of the time spent on cutting and flattening
  double density_seconds = 0;
  double pack_seconds = 0;

  Json to_json() const;
};

/// Cuts a mesh into charts, flattens and packs them. Every triangle lands in the atlas once, in the mesh's order; none
/// is flipped and none overlaps another. Normals are kept, or computed where there are none; colours are kept; uvs of
/// the mesh become texture uvs, whose seams need not be seams of the atlas. `high`, which may be null, is the mesh
/// whose transfer decides density; it needs normals. Throws WrongUsage where the atlas is too small for the charts, or
/// would be too large at a given density; BadInput (naming `name`) where no triangle has an area.
AtlasResult make_atlas(const TriangleMesh& low, const AtlasSettings& settings, const std::string& name = "the mesh",
                       const ProgressFunction& progress = no_progress, const TriangleMesh* high = nullptr);

/// Atlas as a file holds it, with what was measured of it.
struct WrittenAtlas {
  TriangleMesh mesh;
  AtlasMeasures measures;
  int position_bits = 0;
  int uv_bits = 0;

  Json to_json() const;
};

/// Writes the atlas as a Draco file and measures what the file holds. Positions and uvs get 16 bits, or more where
/// rounding to 16 would flatten or flip a triangle or narrow the gutter. Throws std::runtime_error where two triangles
/// cover one texel or the gutter is not kept: a defect of Kiln.
WrittenAtlas write_atlas(const std::filesystem::path& file, const AtlasResult& atlas);

/// Throws BadInput, which names the mesh, where its atlas of this size is so thin that it covers the centre of no
/// texel.
void require_texels(const WrittenAtlas& atlas, const Extent& size, const std::string& name);

}  // namespace kiln
