// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_settings.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/errors.h"
#include "base/json.h"

namespace kiln {

namespace {

std::optional<double> positive_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value) && value > 0;
  return is_number ? std::optional(value) : std::nullopt;
}

std::string text_of(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string text_of(const NormalChoice& choice) {
  switch (choice.kind) {
    case NormalChoice::Kind::file:
      return "file";
    case NormalChoice::Kind::smooth:
      return "smooth";
    case NormalChoice::Kind::angle:
      return "angle:" + text_of(choice.degrees);
    case NormalChoice::Kind::automatic:
      break;
  }
  return "auto";
}

std::string text_of(const WeldChoice& choice) {
  if (choice.kind == WeldChoice::Kind::off) return "off";
  return choice.kind == WeldChoice::Kind::distance ? text_of(choice.distance) : "auto";
}

}  // namespace

double ImportSettings::factor() const {
  constexpr double metres[] = {1, 1e-3, 1e-2, 1, 0.0254};  // metres per unit, in the order of LengthUnit
  return scale * metres[static_cast<int>(unit)];
}

NormalChoice parse_normal_choice(const std::string& text) {
  if (text == "auto") return {};
  if (text == "file") return {NormalChoice::Kind::file, 0};
  if (text == "smooth") return {NormalChoice::Kind::smooth, 0};
  if (const std::string_view prefix = "angle:"; text.starts_with(prefix)) {
    const std::optional<double> degrees = positive_number(std::string_view(text).substr(prefix.size()));
    if (degrees && *degrees <= 180) return {NormalChoice::Kind::angle, *degrees};
  }
  throw WrongUsage("normals: found '" + text + "'; expected auto, file, smooth or angle:DEGREES, above 0 to 180");
}

WeldChoice parse_weld_choice(const std::string& text) {
  if (text == "auto") return {};
  if (text == "off") return {WeldChoice::Kind::off, 0};
  if (const std::optional<double> distance = positive_number(text)) return {WeldChoice::Kind::distance, *distance};
  throw WrongUsage("weld: found '" + text + "'; expected auto, off or a distance above 0");
}

void add_import_options(OptionSet& options, ImportSettings& settings) {
  options.choice<UpAxis>("up", settings.up,
                         {{"+x", UpAxis::plus_x},
                          {"-x", UpAxis::minus_x},
                          {"+y", UpAxis::plus_y},
                          {"-y", UpAxis::minus_y},
                          {"+z", UpAxis::plus_z},
                          {"-z", UpAxis::minus_z},
                          {"x", UpAxis::plus_x},
                          {"y", UpAxis::plus_y},
                          {"z", UpAxis::plus_z}},
                         "The axis of the mesh file that points up; it becomes +Y");
  options.choice<LengthUnit>("unit", settings.unit,
                             {{"none", LengthUnit::none},
                              {"mm", LengthUnit::millimetres},
                              {"cm", LengthUnit::centimetres},
                              {"m", LengthUnit::metres},
                              {"in", LengthUnit::inches}},
                             "What the mesh file counts in; it becomes metres");
  options.number("scale", settings.scale, 1e-12, 1e12, "What the mesh file's coordinates are multiplied with besides");
  options.parsed(
      "normals", "auto, file, smooth or angle:DEGREES",
      "Normals of the mesh: the file's (auto: where it has them, or smoothing groups), smooth, or hard across edges of "
      "a larger dihedral angle",
      [&settings](const std::string& text) { settings.normals = parse_normal_choice(text); },
      [&settings] { return text_of(settings.normals); });
  options.parsed(
      "weld", "auto, off or a distance above 0",
      "Vertices on borders that become one: auto, those that differ in the file's last digits alone, or those nearer "
      "than a distance, in the result's units",
      [&settings](const std::string& text) { settings.weld = parse_weld_choice(text); },
      [&settings] { return text_of(settings.weld); });
  options.choice<bool>("orientation", settings.keeps_orientation, {{"mend", false}, {"keep", true}},
                       "Closed parts that are inside out: turned, or kept, as a room is meant to be");
  options.choice<bool>("backs", settings.keeps_backs, {{"drop", false}, {"keep", true}},
                       "The back of a sheet that has both sides as triangles: dropped, or kept");
  options.integer("fill-holes", settings.fill_hole_edges, 0, 10'000,
                  "Close holes of the mesh of at most so many edges; 0 leaves them open, as a scan's bottom may be");
}

ImportSettings import_settings_of(const Json& recorded) {
  ImportSettings settings;
  OptionSet options;
  add_import_options(options, settings);
  for (const Option& option : options.options())
    if (recorded.is_object() && recorded.contains(option.name)) {
      const Json& value = recorded[option.name];
      option.set(value.is_string() ? value.get<std::string>() : value.dump());
    }
  return settings;
}

ImportSettings inherit(const ImportSettings& own, const ImportSettings& earlier) {
  ImportSettings defaults, given = own, past = earlier, result = own;
  OptionSet of_default, of_own, of_earlier, of_result;
  add_import_options(of_default, defaults);
  add_import_options(of_own, given);
  add_import_options(of_earlier, past);
  add_import_options(of_result, result);
  for (const Option& option : of_own.options()) {
    const Json value = option.get(), from_earlier = of_earlier.find(option.name)->get();
    if (value != of_default.find(option.name)->get() || value == from_earlier) continue;
    of_result.find(option.name)->set(from_earlier.is_string() ? from_earlier.get<std::string>() : from_earlier.dump());
  }
  return result;
}

}  // namespace kiln
