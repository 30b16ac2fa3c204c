// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "material/scene_mesh.h"
#include "material/surface_albedo.h"
#include "report/error_causes.h"
#include "report/records.h"
#include "report/render_asset.h"
#include "report/report_settings.h"
#include "sh/light_spec.h"

namespace kiln {

/// High mesh of an asset as its bake had it.
struct HighScene {
  const TriangleMesh& mesh;     ///< cut out by its opacity
  const SurfaceAlbedo& albedo;  ///< of that mesh
  const SceneMesh& scene;       ///< it and what surrounds it, with albedos where light bounces
};

/// Measures the error of an asset's folder, and its causes. `low` is the mesh that it ships. Throws BadInput as
/// load_prt_asset and load_detail_maps do, WrongUsage for lights that are none.
ErrorSplit split_error(const AssetFolder& asset, const TriangleMesh& low, const HighScene& high,
                       const ReportSettings& settings, const ComparisonRun& run, const ProgressFunction& progress);

/// Parses the lights of an option, at least one. Throws WrongUsage, naming it.
std::vector<LightSpec> parse_lights(const std::string& option, const std::vector<std::string>& texts);

}  // namespace kiln
