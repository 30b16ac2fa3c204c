// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/setting_checks.h"

#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>

#include "bake/bake_settings.h"
#include "base/errors.h"
#include "base/numbers.h"
#include "compress/compress_settings.h"
#include "kiln/metrics.h"
#include "kiln/nearest.h"
#include "report/report_settings.h"
#include "sh/light_spec.h"

namespace kiln {

namespace {

/// What is asked of the settings of one asset.
class Checks {
 public:
  explicit Checks(const Asset& asset) : asset_(asset) {}

  void all() const {
    check_impossible();
    check_simplify();
    check_bake();
    check_subsurface();
    check_low_receivers();
    if (asset_.settings.contains(Stage::compress)) check_compress();
    check_report();
  }

 private:
  Json value(Stage stage, const char* name) const { return effective_setting(asset_.settings, stage, name); }

  std::string text(Stage stage, const char* name) const {
    const Json found = value(stage, name);
    return found.is_string() ? found.get<std::string>() : found.dump();
  }

  /// Where the first of the settings that is given stands; else where the asset does.
  std::string place(Stage stage, std::initializer_list<const char*> names) const {
    const StageSettings& places = asset_.setting_places.at(stage);
    for (const char* name : names)
      if (const auto found = places.find(name); found != places.end()) return found->second;
    return asset_.place;
  }

  void require(bool good, Stage stage, const char* name, const std::string& expected, const std::string& remedy) const {
    if (!good)
      throw BadInput(place(stage, {name}), fmt::format("'{}' for {} of {}", text(stage, name), name, stage_name(stage)),
                     expected, remedy);
  }

  /// Runs what a stage parses its settings with, whose refusals are of the command line.
  void try_parsing(const std::string& where, const std::string& remedy, const std::function<void()>& parse) const {
    try {
      parse();
    } catch (const WrongUsage& error) {
      const std::string what = error.what(), expected = "; expected ";
      const std::size_t cut = what.find(expected);
      throw BadInput(where, what.substr(0, cut),
                     cut == std::string::npos ? "another" : what.substr(cut + expected.size()), remedy);
    }
  }

  template <class Settings>
  Settings filled(Stage stage, OptionSet (*options_of)(Settings&)) const {
    Settings settings;
    const OptionSet options = options_of(settings);
    for (const auto& [name, given] : asset_.settings.at(stage))
      if (const Option* option = options.find(name)) option->set(given);
    return settings;
  }

  /// What works by hand and not here.
  void check_impossible() const {
    require(value(Stage::atlas, "keep-uv") == false, Stage::atlas, "keep-uv",
            "none in a pipeline, where kiln-simplify makes the mesh anew, without uvs",
            "leave it out, or run kiln-atlas --keep-uv on your mesh by hand");
    require(value(Stage::bake, "per-vertex") == false, Stage::bake, "per-vertex",
            "none in a pipeline, whose other stages are for texels", "leave it out, or run kiln-bake by hand");
    require(value(Stage::bake, "size") == 0, Stage::bake, "size",
            "none in a pipeline, where the maps of the normals stage say it", "set the size of atlas");
  }

  void check_simplify() const {
    const double error = value(Stage::simplify, "max-error").get<double>();
    require(error == 0 || error >= 1e-4, Stage::simplify, "max-error", "0, or 0.0001 to 1", "change the line");
  }

  void check_bake() const {
    const int bits = value(Stage::bake, "bits").get<int>();
    require(bits == 8 || bits == 16, Stage::bake, "bits", "8 or 16", "change the line");
    const std::string error = text(Stage::bake, "max-error");
    require(error == "none" || error == "auto" || is_number(error, 0, 1, false), Stage::bake, "max-error",
            "none, auto or a number above 0 and below 1", "change the line");
    check_place(text(Stage::bake, "place"), asset_.name, place(Stage::bake, {"place"}));
    const std::string ground = text(Stage::bake, "ground");
    if (ground != "none") {
      const std::vector<double> numbers = parse_numbers("ground", ground, -1e6, 1e6);
      require(numbers.size() < 2 || numbers[1] > 0, Stage::bake, "ground", "HEIGHT[,HALF-SIZE], a size above 0",
              "change the line");
    }
    for (const Stage stage : {Stage::bake, Stage::report}) {
      const std::string device = text(stage, "gl-device");
      const bool number = !device.empty() && device.find_first_not_of("0123456789") == std::string::npos;
      require(number || device == "auto" || device == "software", stage, "gl-device", "auto, software or a number",
              "change the line");
    }
  }

  void check_subsurface() const {
    const auto settings = filled<BakeSettings>(Stage::bake, bake_options);
    try_parsing(place(Stage::bake, {"subsurface", "subsurface-scattering", "subsurface-absorption", "subsurface-albedo",
                                    "subsurface-mean-free-path", "subsurface-eta", "subsurface-model"}),
                "see kiln-bake --help", [&] { subsurface_profiles(settings.subsurface); });
    require(!settings.subsurface.wanted() || !settings.bake_albedo, Stage::bake, "bake-albedo",
            "none beside subsurface, whose material has its own albedo", "remove one of them");
  }

  /// A low mesh has no materials, and other uvs than its textures.
  void check_low_receivers() const {
    if (text(Stage::bake, "receiver") != "low") return;
    const bool reflects = text(Stage::bake, "bounces") != "0" || value(Stage::bake, "bake-albedo") == true;
    if (!reflects || text(Stage::bake, "albedo") != "auto") return;
    throw BadInput(place(Stage::bake, {"receiver"}), "'low' for receiver of bake, and light that its surface reflects",
                   "an albedo, one for all of it: the low mesh has no materials",
                   "set 'material: {albedo: ...}', or receiver: high");
  }

  void check_compress() const {
    const auto settings = filled<CompressSettings>(Stage::compress, compress_options);
    try_parsing(place(Stage::compress, {"max-error"}), "change the line", [&] { target_error(settings); });
    const int bands = value(Stage::bake, "bands").get<int>(), vector = bands * bands;
    if (text(Stage::bake, "subsurface") != "none" || text(Stage::bake, "bounces") != "0") return;  // of more channels
    require(settings.components <= vector, Stage::compress, "pca",
            fmt::format("at most {}, the length of a transfer vector", vector), "lower it, or bake more bands");
  }

  void check_report() const {
    const auto settings = filled<ReportSettings>(Stage::report, report_options);
    const std::vector<std::string> lights = list_of_lights(settings);
    require(!lights.empty(), Stage::report, "lights", "at least one light", "change the line");
    for (const std::string& light : lights)
      try_parsing(place(Stage::report, {"lights"}), "see kiln-report --help", [&] { parse_light_spec(light); });
  }

  /// A number between bounds, which are in the range or not.
  static bool is_number(const std::string& text, double lowest, double highest, bool inclusive) {
    double number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc() || end != text.data() + text.size()) return false;
    return inclusive ? number >= lowest && number <= highest : number > lowest && number < highest;
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
      throw BadInput(limits.place, found, "a metric of the stages as they are set", "set " + setting);
    throw BadInput(limits.place, found,
                   nearest.empty() ? fmt::format("{} and one of {}", stage, fmt::join(names, ", "))
                                   : fmt::format("a metric, such as '{}'", nearest),
                   "see metrics.json beside a report, which has them all");
  }
}

void check_place(const std::string& text, const std::string& asset, const std::string& place) {
  constexpr const char* expected = "X,Y,Z[,AZIMUTH[,SCALE]], a scale above 0";
  const auto fail = [&] {
    throw BadInput(place, fmt::format("'{}' for the place of {}", text, asset), expected, "change the line");
  };
  try {
    const std::vector<double> numbers = parse_numbers("place", text, -1e6, 1e6);
    if (numbers.size() < 3 || numbers.size() > 5 || (numbers.size() == 5 && !(numbers[4] > 0))) fail();
  } catch (const WrongUsage&) {
    fail();
  }
}

}  // namespace kiln
