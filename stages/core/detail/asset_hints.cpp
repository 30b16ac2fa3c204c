#include "detail/asset_hints.h"

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/outputs.h"

namespace kiln {

namespace {

nlohmann::json read_result(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return nlohmann::json::object();
  nlohmann::json result = nlohmann::json::parse(read_text(file), nullptr, false);
  if (!result.is_object())
    throw BadInput(file.string(), "not a JSON object", "the result of an earlier stage",
                   "run that stage again, or remove the file");
  return result;
}

/// The number under `key`, of the metrics or else of the settings; 0 where there is none above 0.
double positive_number(const nlohmann::json& result, const char* key) {
  for (const nlohmann::json& place : {result, result.value("settings", nlohmann::json::object())})
    if (place.is_object() && place.contains(key) && place[key].is_number() && place[key].get<double>() > 0)
      return place[key].get<double>();
  return 0;
}

}  // namespace

AssetHints read_asset_hints(const std::filesystem::path& folder) {
  AssetHints hints;
  const std::filesystem::path atlas_file = folder / "atlas.json";
  const double size = positive_number(read_result(atlas_file), "size");
  if (size > 16384)
    throw BadInput(atlas_file.string(), "a size of more than 16384 texels", "1 to 16384", "run kiln-atlas again");
  hints.size = static_cast<int>(size);
  hints.hausdorff_distance = positive_number(read_result(folder / "simplify.json"), "hausdorff_distance");
  return hints;
}

}  // namespace kiln
