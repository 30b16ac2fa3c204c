// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/sweep/sweep_grid.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

#include "base/errors.h"
#include "kiln/overrides.h"

namespace kiln {

namespace {

std::vector<std::string> settings_of(const StageInfo& stage) {
  std::vector<std::string> names;
  const StageOptions options = stage.options();
  for (const Option& option : options.all()) names.push_back(option.name);
  return names;
}

[[noreturn]] void fail(const std::string& text, const std::string& expected) {
  throw WrongUsage(fmt::format("set: found '{}'; expected {}", text, expected));
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace

SweepAxis parse_axis(const std::string& text) {
  const std::size_t dot = text.find('.'), equals = text.find('=');
  if (dot == std::string::npos || equals == std::string::npos || dot > equals)
    fail(text, "STAGE.SETTING=VALUE,VALUE, as in bake.directions=256,1024");
  SweepAxis axis{text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), {}};
  const StageInfo* stage = find_stage(axis.stage);
  if (stage == nullptr) fail(text, fmt::format("a stage of {}", fmt::join(stage_names(), ", ")));
  const StageOptions options = stage->options();
  const Option* option = options.find(axis.setting);
  if (option == nullptr)
    fail(text, fmt::format("a setting of {}: {}", axis.stage, fmt::join(settings_of(*stage), ", ")));
  // Separates values by semicolons where there is one: they may have commas of their own then.
  const std::string values = text.substr(equals + 1);
  axis.values = split(values, values.find(';') == std::string::npos ? ',' : ';');
  for (const std::string& value : axis.values) {
    option->set(value);  // throws WrongUsage, which names the setting
    if (std::ranges::count(axis.values, value) > 1) fail(text, fmt::format("each value once, not '{}' again", value));
  }
  return axis;
}

std::vector<SweepPoint> grid_points(std::vector<SweepAxis> axes) {
  std::set<std::string> names;
  for (const SweepAxis& axis : axes)
    if (!names.insert(axis.name()).second)
      throw WrongUsage(fmt::format("set: found {} twice; expected all its values in one --set", axis.name()));
  std::ranges::stable_sort(axes, {}, [](const SweepAxis& axis) { return stage_position(axis.stage).value_or(0); });
  std::vector<SweepPoint> points(1);
  for (const SweepAxis& axis : axes) {
    std::vector<SweepPoint> longer;
    for (const SweepPoint& point : points)
      for (const std::string& value : axis.values) {
        longer.push_back(point);
        longer.back().settings.emplace_back(axis.name(), value);
      }
    points = std::move(longer);
  }
  return points;
}

std::vector<SweepPoint> historic_points() {
  const std::vector<std::pair<std::string, std::string>> thesis = {
      {"atlas.size", "512"},    {"bake.bands", "5"}, {"bake.directions", "10000"}, {"bake.sampling", "stratified"},
      {"bake.receiver", "low"}, {"bake.bits", "8"},  {"bake.backend", "egl"},      {"bake.shadow-depth", "32f"},
  };
  SweepPoint of_thesis{"thesis", thesis}, of_patent{"patent", thesis};
  of_patent.settings.back().second = "16";
  return {of_thesis, of_patent};
}

Pipeline pipeline_at(const Pipeline& pipeline, const SweepPoint& point) {
  Pipeline changed = pipeline;
  for (Asset& asset : changed.assets) {
    asset.budgets.clear();
    try {
      override_settings(asset, point.settings, "--set");
    } catch (const BadInput& fault) {
      throw WrongUsage(fault.what());
    }
  }
  return changed;
}

std::string point_label(const SweepPoint& point) {
  if (!point.name.empty()) return point.name;
  std::vector<std::string> parts;
  for (const auto& [name, value] : point.settings) parts.push_back(name + " " + value);
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace kiln
