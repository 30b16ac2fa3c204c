// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/setting_checks.h"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>

#include "bake/bake_settings.h"
#include "base/errors.h"
#include "base/json.h"
#include "compress/compress_settings.h"
#include "kiln/metrics.h"
#include "kiln/nearest.h"
#include "report/report_settings.h"
#include "sh/light_spec.h"
#include "simplify/simplify_settings.h"

namespace kiln {

namespace {

/// Checks of the settings of one asset.
class Checks {
 public:
  explicit Checks(const Asset& asset) : asset_(asset) {}

  void all() const {
    check_impossible();
    check_simplify();
    check_bake();
    check_subsurface();
    if (!text("bake", "spectrum").empty()) check_spectrum();
    check_low_receivers();
    if (bakes_vertices(asset_.settings)) check_vertices();
    if (asset_.settings.contains("compress")) check_compress();
    check_report();
  }

 private:
  Json value(const char* stage, const char* name) const { return effective_setting(asset_.settings, stage, name); }

  std::string text(const char* stage, const char* name) const {
    const Json found = value(stage, name);
    return found.is_string() ? found.get<std::string>() : found.dump();
  }

  /// Returns where the first of the settings that is given stands, else where the asset does.
  std::string where(const char* stage, std::initializer_list<const char*> names) const {
    const StageSettings& lines = asset_.setting_lines.at(stage);
    for (const char* name : names)
      if (const auto found = lines.find(name); found != lines.end()) return found->second;
    return asset_.where;
  }

  void require(bool good, const char* stage, const char* name, const std::string& expected,
               const std::string& remedy) const {
    if (!good)
      throw BadInput(where(stage, {name}), fmt::format("'{}' for {} of {}", text(stage, name), name, stage), expected,
                     remedy);
  }

  /// Parses settings as their stage does, and translates its refusals, which speak of the command line.
  void try_parsing(const std::string& line, const std::string& remedy, const std::function<void()>& parse) const {
    try {
      parse();
    } catch (const WrongUsage& error) {
      const std::string what = error.what(), expected = "; expected ";
      const std::size_t cut = what.find(expected);
      throw BadInput(line, what.substr(0, cut),
                     cut == std::string::npos ? "another" : what.substr(cut + expected.size()), remedy);
    }
  }

  /// Refuses settings that work on the command line but not in a pipeline.
  void check_impossible() const {
    const bool has_low = !text("simplify", "low").empty();
    const bool keeps_uvs = text("simplify", "keep").find("uv") != std::string::npos;
    require(
        value("atlas", "uv") != "keep" || has_low || keeps_uvs, "atlas", "uv",
        "a low mesh of the asset's own beside it, or 'keep: uv' for simplify, since kiln-simplify makes one without "
        "uvs otherwise",
        "add 'low: FILE' or 'simplify: {keep: uv}', or leave the line out");
    require(text("normals", "match") != "names" || has_low, "normals", "match",
            "a low mesh of the asset's own beside it, whose parts have names",
            "add 'low: FILE', or leave the line out");
    require(text("normals", "cage-mesh").empty() || has_low, "normals", "cage-mesh",
            "a low mesh of the asset's own beside it, whose cage it is", "add 'low: FILE', or leave the line out");
    require(text("normals", "part-cage").empty() || text("normals", "match") == "names", "normals", "part-cage",
            "'match: names' beside it", "add that, or leave the line out");
    require(value("bake", "size") == 0, "bake", "size",
            "none in a pipeline, where the maps of the normals stage say it", "set the size of atlas");
  }

  /// Applies the rules of kiln-simplify's command line to the settings that are given.
  void check_simplify() const {
    StageSettings given = asset_.settings.at("simplify");
    if (!given.contains("low"))  // defaults may say how the low meshes of other assets are read
      for (const char* name : {"low-up", "low-unit", "low-scale"}) given.erase(name);
    try_parsing(where("simplify", {"keep", "uv-overhang", "engine"}), "see kiln-simplify --help", [&] {
      check_options(settings_from(given, simplify_options),
                    [&](const std::string& name) { return given.contains(name); });
    });
    const double error = value("simplify", "max-error").get<double>();
    require(error == 0 || error >= 1e-4, "simplify", "max-error", "0, or 0.0001 to 1", "change the line");
  }

  void check_bake() const {
    try_parsing(where("bake", {"shadows"}), "change the line, or remove the other one",
                [&] { check_shadows(settings_from(asset_.settings.at("bake"), bake_options)); });
    const int bits = value("bake", "bits").get<int>();
    require(bits == 8 || bits == 16, "bake", "bits", "8 or 16", "change the line");
    for (const char* stage : {"bake", "report"}) {
      const std::string device = text(stage, "gl-device");
      const bool number = !device.empty() && device.find_first_not_of("0123456789") == std::string::npos;
      require(number || device == "auto" || device == "software", stage, "gl-device", "auto, software or a number",
              "change the line");
    }
  }

  void check_subsurface() const {
    const auto settings = settings_from(asset_.settings.at("bake"), bake_options);
    try_parsing(where("bake", {"subsurface", "subsurface-scattering", "subsurface-absorption", "subsurface-albedo",
                               "subsurface-mean-free-path", "subsurface-eta", "subsurface-model"}),
                "see kiln-bake --help", [&] { subsurface_profiles(settings.subsurface); });
    require(!settings.subsurface.wanted() || !settings.bake_albedo, "bake", "bake-albedo",
            "none beside subsurface, whose material has its own albedo", "remove one of them");
  }

  /// Refuses what is computed as red, green and blue beside light that bounces at wavelengths.
  void check_spectrum() const {
    require(text("bake", "bounces") != "0", "bake", "spectrum",
            "bounces beside it, since direct transfer is the same at all wavelengths",
            "add 'bounces: 2' or 'bounces: auto', or leave the line out");
    require(value("bake", "bake-albedo") == false, "bake", "bake-albedo",
            "none beside spectrum, since lamps decide the albedo's colour", "remove one of them");
    require(text("bake", "subsurface") == "none", "bake", "subsurface",
            "none beside spectrum, since materials are measured as red, green and blue", "remove one of them");
    if (asset_.settings.contains("probes"))
      require(text("probes", "bounces") == "0", "probes", "bounces",
              "0 beside spectrum of bake, since light bounces to probes as red, green and blue", "remove one of them");
    for (const std::string& light : list_of(text("report", "lights")))
      try_parsing(where("report", {"lights"}), "leave out the colour", [&] {
        const LightSpec spec = parse_light_spec(light);
        const auto is_grey = [](const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; };
        if (!is_grey(spec.color) || !is_grey(spec.ground))
          throw WrongUsage("'" + light +
                           "' of report; expected lights of one radiance beside spectrum of bake, since a "
                           "lamp's spectrum is their colour");
      });
  }

  /// Refuses low receivers with materials: the low mesh has none, and its uvs are not those of the textures.
  void check_low_receivers() const {
    if (text("bake", "receiver") != "low") return;
    const bool reflects = text("bake", "bounces") != "0" || value("bake", "bake-albedo") == true;
    if (!reflects || text("bake", "albedo") != "auto" || !text("bake", "reflectance").empty()) return;
    throw BadInput(where("bake", {"receiver"}), "'low' for receiver of bake, and light that its surface reflects",
                   "an albedo, one for all of it: the low mesh has no materials",
                   "set 'material: {albedo: ...}' or 'material: {reflectance: ...}', or receiver: high");
  }

  /// Refuses what is for texels where vertices are baked.
  void check_vertices() const {
    for (const char* stage : {"lod", "compress"})
      require(!asset_.settings.contains(stage), "bake", "per-vertex",
              fmt::format("none beside {}, which is for the texels of an atlas", stage), "remove one of them");
    require(value("bake", "adaptive") == 0, "bake", "adaptive",
            "0 beside per-vertex, since it goes by squares of texels", "remove one of them");
    const ShippedParts ship = settings_from(asset_.settings.at("bake"), bake_options).ship;
    require(!ship.all_maps && ship.maps.empty(), "bake", "ship",
            "no maps beside per-vertex, since they are looked up with the uvs of an atlas", "remove one of them");
  }

  void check_compress() const {
    const auto settings = settings_from(asset_.settings.at("compress"), compress_options);
    const int bands = value("bake", "bands").get<int>(), vector = bands * bands;
    if (text("bake", "subsurface") != "none" || text("bake", "bounces") != "0")
      return;  // such a bake has more channels
    require(settings.components <= vector, "compress", "pca",
            fmt::format("at most {}, the length of a transfer vector", vector), "lower it, or bake more bands");
  }

  void check_report() const {
    const auto settings = settings_from(asset_.settings.at("report"), report_options);
    const std::vector<std::string> lights = list_of(settings.lights);
    require(!lights.empty(), "report", "lights", "at least one light", "change the line");
    for (const std::string& light : lights)
      try_parsing(where("report", {"lights"}), "see kiln-report --help", [&] { parse_light_spec(light); });
    try_parsing(where("report", {"predicted"}), "see kiln-report --help", [&] { settings.predictions(); });
    if (settings.error_lights == "measured") return;
    for (const std::string& light : list_of(settings.error_lights))
      try_parsing(where("report", {"error-lights"}), "see kiln-report --help", [&] { parse_light_spec(light); });
  }

  const Asset& asset_;
};

}  // namespace

void check_settings(const Asset& asset) { Checks(asset).all(); }

void check_budgets(const Asset& asset, const std::map<std::string, Limits>& budgets) {
  const std::vector<std::string> known = metrics_of(asset.settings);
  for (const auto& [metric, limits] : budgets) {
    if (std::find(known.begin(), known.end(), metric) != known.end()) continue;
    const std::string stage = metric.substr(0, metric.find('.') + 1), nearest = nearest_of(metric, known);
    std::vector<std::string> names;
    for (const std::string& name : known)
      if (name.starts_with(stage)) names.push_back(name.substr(stage.size()));
    const std::string found = fmt::format("a budget for '{}', which no stage of asset '{}' writes", metric, asset.name);
    if (const std::string setting = setting_of_metric(metric); !setting.empty())
      throw BadInput(limits.where, found, "a metric of the stages as they are set", "set " + setting);
    if (names.empty())
      throw BadInput(limits.where, found, "a metric of a stage that the asset passes", "change or remove the budget");
    throw BadInput(limits.where, found,
                   nearest.empty() ? fmt::format("{} and one of {}", stage, fmt::join(names, ", "))
                                   : fmt::format("a metric, such as '{}'", nearest),
                   "see metrics.json beside a report, which has them all");
  }
}

void check_place(const std::string& text, const std::string& asset, const std::string& place) {
  try {
    parse_scene_place(text);
  } catch (const WrongUsage&) {
    throw BadInput(place, fmt::format("'{}' for the place of {}", text, asset),
                   "X,Y,Z[,AZIMUTH[,SCALE]], a scale above 0", "change the line");
  }
}

}  // namespace kiln
