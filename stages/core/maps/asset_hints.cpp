// SPDX-License-Identifier: MIT
#include "maps/asset_hints.h"

#include <algorithm>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/json.h"
#include "import/low_import.h"

namespace kiln {

namespace {

Json read_result(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return Json::object();
  Json result = Json::parse(read_text(file), nullptr, false);
  if (!result.is_object())
    throw BadInput(file.string(), "not a JSON object", "the result of an earlier stage",
                   "run that stage again, or remove the file");
  return result;
}

/// Returns the number under `key` of the metrics, else of the settings; 0 where there is none above 0.
double positive_number(const Json& result, const char* key) {
  for (const Json& place : {result, result.value("settings", Json::object())})
    if (place.is_object() && place.contains(key) && place[key].is_number() && place[key].get<double>() > 0)
      return place[key].get<double>();
  return 0;
}

}  // namespace

AssetHints read_asset_hints(const std::filesystem::path& folder) {
  AssetHints hints;
  const std::filesystem::path atlas_file = folder / "atlas.json";
  const Json atlas = read_result(atlas_file);
  const double size = positive_number(atlas, "size");  // older records, of square atlases, have nothing else
  const double width = positive_number(atlas, "width"), height = positive_number(atlas, "height");
  if (std::max({size, width, height}) > 16384)
    throw BadInput(atlas_file.string(), "a size of more than 16384 texels", "1 to 16384", "run kiln-atlas again");
  const bool both = width >= 1 && height >= 1;
  hints.width = static_cast<int>(both ? width : size);
  hints.height = static_cast<int>(both ? height : size);
  hints.gap_texels = static_cast<int>(std::min(positive_number(atlas, "smallest_gap_texels"), 16384.0));
  hints.position_bits = static_cast<int>(std::min(positive_number(atlas, "position_bits"), 30.0));
  hints.uv_bits = static_cast<int>(std::min(positive_number(atlas, "uv_bits"), 30.0));
  const Json simplify = read_result(folder / "simplify.json");
  hints.hausdorff_distance = positive_number(simplify, "hausdorff_distance");
  if (simplify.contains("settings") && simplify["settings"].is_object()) {
    const Json& settings = simplify["settings"];
    hints.import = import_settings_of(settings);
    hints.low_import = low_import_settings_of(settings);
    if (settings.contains("low") && settings["low"].is_string())
      hints.low_file = path_of_text(settings["low"].get<std::string>());
  }
  if (simplify.contains("warnings") && simplify["warnings"].is_array())
    for (const Json& warning : simplify["warnings"])
      if (warning.is_string()) hints.warnings.push_back(warning.get<std::string>());
  return hints;
}

}  // namespace kiln
