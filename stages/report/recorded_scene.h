// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json.h"
#include "base/options.h"
#include "import/import_mesh.h"
#include "material/material_settings.h"
#include "material/scene_mesh.h"
#include "report/records.h"
#include "report/report_settings.h"

namespace kiln {

/// Returns settings as the record of a stage has them; an empty text there is the default. `add_options` makes the
/// options that hold them.
template <class Settings>
Settings settings_of(const Json& record, void (*add_options)(OptionSet&, Settings&)) {
  Settings settings;
  OptionSet options;
  add_options(options, settings);
  const Json recorded = record.value("settings", Json::object());
  for (const Option& option : options.options()) {
    const auto value = recorded.find(option.name);
    if (value == recorded.end()) continue;
    const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
    if (!text.empty()) option.set(text);
  }
  return settings;
}

MaterialSettings material_of(const Json& record);

/// Returns where the albedo that an asset ships, or has within its transfer, is from: the bake's settings where they
/// give one, else those of the normals stage.
MaterialSettings surface_material(const AssetFolder& asset);

/// Returns the settings by which the surface's maps were made: those of the normals stage, of vertices the bake's.
MaterialSettings map_material(const AssetFolder& asset);

/// Tells whether the bake's receivers are on the low mesh.
bool is_on_low(const AssetFolder& asset);

/// Tells whether the high mesh was among the occluders of the bake.
bool high_casts_shadows(const AssetFolder& asset);

/// Returns a mesh and the bake's surroundings, with the albedos of the bake's settings where light bounces.
SceneMesh scene_of(const AssetFolder& asset, const ImportedMesh& own_mesh, bool bounces);

/// Returns how often light bounces in what the error is measured against.
int error_bounces(const AssetFolder& asset, const ReportSettings& settings);

}  // namespace kiln
