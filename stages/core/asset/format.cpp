// SPDX-License-Identifier: MIT
#include "asset/format.h"

#include <algorithm>
#include <fmt/format.h>

namespace kiln {

std::string plane_file(int channel, int coefficient) { return fmt::format("coeff_{}_{:02}.png", channel, coefficient); }

std::string level_file(int level) { return fmt::format("lod_{}.drc", level); }

std::string weight_file(int component) { return fmt::format("weight_{:02}.png", component); }

std::string plane_attribute(int channel, int group) { return fmt::format("kiln-prt-{}-{}", channel, group); }

bool is_plane_name(const std::string& name) {
  const bool is_numbered = name.starts_with("coeff_") || name.starts_with("weight_");
  return (is_numbered && name.ends_with(".png")) || name == vectors_name || name == cluster_ids_name;
}

bool is_level_name(const std::string& name) { return name.starts_with("lod_") && name.ends_with(".drc"); }

PlaneRange range_of(std::span<const float> values) {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  return {*lowest, *highest};
}

}  // namespace kiln
