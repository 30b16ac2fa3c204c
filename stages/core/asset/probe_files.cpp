// SPDX-License-Identifier: MIT
#include <algorithm>

#include "asset/fields.h"
#include "asset/probe_set.h"
#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* probe_again = "make the probes again with kiln-probes";
constexpr int stored_bits = 16;

/// Finds the range of every matrix entry over all valid points.
std::vector<PlaneRange> entry_ranges(const ProbeSet& probes) {
  const std::size_t entries = probes.entries();
  std::vector<PlaneRange> ranges(entries);
  bool is_first = true;
  for (std::size_t k = 0; k < probes.positions.size(); ++k) {
    if (probes.valid[k] == 0) continue;
    for (std::size_t e = 0; e < entries; ++e) {
      const double value = probes.matrices[k * entries + e];
      ranges[e].lowest = is_first ? value : std::min(ranges[e].lowest, value);
      ranges[e].highest = is_first ? value : std::max(ranges[e].highest, value);
    }
    is_first = false;
  }
  return ranges;
}

Image<std::uint16_t> stored_matrices(const ProbeSet& probes, const std::vector<PlaneRange>& ranges) {
  const std::size_t entries = probes.entries(), count = probes.positions.size();
  Image<std::uint16_t> stored(static_cast<int>(entries), static_cast<int>(count), 1);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t e = 0; e < entries && probes.valid[k] != 0; ++e)
      stored.at(static_cast<int>(e), static_cast<int>(count - 1 - k)) =
          static_cast<std::uint16_t>(ranges[e].store(probes.matrices[k * entries + e], stored_bits));
  return stored;
}

/// Reads three finite numbers; zeros if faulty.
Eigen::Vector3f read_vector(const Fields& fields, const Json& value, const std::string& what) {
  if (value.is_array() && value.size() == 3 && std::all_of(value.begin(), value.end(), is_finite_float))
    return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
  fields.fail(what, Fields::shown(value), "three finite numbers");
  return Eigen::Vector3f::Zero();
}

Eigen::Vector3f read_vector(const Fields& fields, const char* name) {
  const Json* value = fields.find(name, "three finite numbers");
  return value != nullptr ? read_vector(fields, *value, fields.path(name)) : Eigen::Vector3f(0, 0, 0);
}

/// Reads the grid; nothing if there is none or it is faulty.
std::optional<ProbeGrid> read_grid(const Fields& fields) {
  ProbeGrid grid;
  const auto is_count = [](const Json& n) {
    return n.is_number_unsigned() && n.get<std::uint64_t>() >= 1 && n.get<std::uint64_t>() <= largest_probe_grid;
  };
  const std::string expected = "three whole numbers of 1 to " + std::to_string(largest_probe_grid);
  const Json* size = fields.find(key::size, expected);
  grid.lower = read_vector(fields, key::lower);
  grid.upper = read_vector(fields, key::upper);
  if (!(grid.lower.array() <= grid.upper.array()).all())
    fields.fail(fields.path(key::lower), "above upper", "lower <= upper along every axis");
  if (size == nullptr) return std::nullopt;
  if (!size->is_array() || size->size() != 3 || !std::all_of(size->begin(), size->end(), is_count)) {
    fields.fail(fields.path(key::size), Fields::shown(*size), expected);
    return std::nullopt;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = (*size)[axis].get<int>();
  if (grid.count() <= most_probes) return grid;
  fields.fail(fields.path(key::size), size->dump(), "at most " + std::to_string(most_probes) + " points");
  return std::nullopt;
}

std::vector<Eigen::Vector3f> read_positions(const Fields& fields) {
  const std::string what = "points, 1 to " + std::to_string(most_probes) + " of them, or a grid";
  const Json* list = fields.list(key::positions, std::nullopt, what);
  if (list == nullptr) return {};
  std::vector<Eigen::Vector3f> positions;
  if (list->empty() || list->size() > most_probes)
    fields.fail(key::positions, std::to_string(list->size()) + " entries", "a list of " + what);
  else
    for (std::size_t k = 0; k < list->size(); ++k)
      positions.push_back(read_vector(fields, (*list)[k], "positions[" + std::to_string(k) + "]"));
  return positions;
}

std::vector<std::uint8_t> read_valid(const Fields& fields, std::size_t count) {
  std::vector<std::uint8_t> valid(count, 1);
  const std::string expected = "numbers of points, 0 to " + std::to_string(count - 1);
  const Json* invalid = fields.list(key::invalid, std::nullopt, expected);
  if (invalid == nullptr) return valid;
  for (const Json& index : *invalid)
    if (index.is_number_unsigned() && index.get<std::uint64_t>() < count)
      valid[index.get<std::size_t>()] = 0;
    else
      fields.fail(key::invalid, Fields::shown(index), expected);
  return valid;
}

void read_matrices(const fs::path& file, const std::vector<PlaneRange>& ranges, ProbeSet& probes) {
  const std::size_t count = probes.positions.size(), entries = probes.entries();
  const Image<std::uint16_t> stored =
      read_grey<std::uint16_t>(file, static_cast<int>(entries), static_cast<int>(count), probe_again);
  probes.matrices.resize(count * entries);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t e = 0; e < entries; ++e)
      probes.matrices[k * entries + e] = static_cast<float>(
          ranges[e].recover(stored.at(static_cast<int>(e), static_cast<int>(count - 1 - k)), stored_bits));
}

/// Reads everything in matrices.json except its head and the matrices.
ProbeSet read_set(const fs::path& folder, const Json& document, const Fields& fields, Faults& faults) {
  ProbeSet probes;
  probes.bands = fields.integer(key::bands, 1, most_probe_bands);
  probes.channels = fields.integer(key::channels, 1, 3);
  if (probes.channels == 2) fields.fail(key::channels, "2", "1 or 3");
  if (fields.has(key::grid)) {
    probes.grid = read_grid(fields.child(key::grid, document[key::grid]));
    for (std::size_t k = 0; probes.grid && k < probes.grid->count(); ++k)
      probes.positions.push_back(probes.grid->position(k));
  } else {
    probes.positions = read_positions(fields);
  }
  const std::string matrices = fields.safe_path(key::matrices_file);
  const std::size_t entries = probes.entries();
  if (probes.positions.empty() || entries == 0) return probes;  // faulty sizes say nothing about the matrices
  probes.valid = read_valid(fields, probes.positions.size());
  std::vector<PlaneRange> ranges;
  const Json* list = fields.list(key::ranges, entries, "ranges");
  for (std::size_t e = 0; list != nullptr && e < entries; ++e)
    ranges.push_back(read_range(fields.child(key::ranges, e, (*list)[e])));
  if (ranges.size() == entries && !matrices.empty())
    faults.guard([&] { read_matrices(folder / matrices, ranges, probes); });
  return probes;
}

}  // namespace

void save_probes(OutputSet& outputs, const ProbeSet& probes) {
  const std::vector<PlaneRange> ranges = entry_ranges(probes);
  write_png(outputs.add(matrices_png_name), stored_matrices(probes, ranges));

  const auto triple = [](const Eigen::Vector3f& v) { return Json::array({v.x(), v.y(), v.z()}); };
  Json json = {{key::format, probes_format}, {key::version, format_version}};
  json[key::required] = Json::array();
  json[key::bands] = probes.bands;
  json[key::channels] = probes.channels;
  json[key::basis] = basis_name;
  if (probes.grid) {
    json[key::grid] = {{key::size, probes.grid->size},
                       {key::lower, triple(probes.grid->lower)},
                       {key::upper, triple(probes.grid->upper)}};
  } else {
    json[key::positions] = Json::array();
    for (const Eigen::Vector3f& position : probes.positions) json[key::positions].push_back(triple(position));
  }
  json[key::invalid] = Json::array();
  for (std::size_t k = 0; k < probes.positions.size(); ++k)
    if (probes.valid[k] == 0) json[key::invalid].push_back(k);
  json[key::matrices_file] = matrices_png_name;
  json[key::ranges] = Json::array();
  for (const PlaneRange& range : ranges)
    json[key::ranges].push_back({{key::lowest, range.lowest}, {key::highest, range.highest}});
  outputs.add_text(probes_json_name, json.dump(1) + "\n");
}

std::pair<ProbeSet, int> read_probes(const fs::path& folder, Faults& faults) {
  const fs::path file = folder / probes_json_name;
  Json document;
  if (!faults.guard([&] { document = parse_json(file, "kiln-probes", probe_again); })) return {};
  const Fields fields(file.string(), "", document, probe_again, &faults);
  const int version = read_head(fields, probes_format, {}).version;
  return {read_set(folder, document, fields, faults), version};
}

ProbeSet load_probes(const fs::path& folder) {
  Faults first;
  return read_probes(folder, first).first;
}

}  // namespace kiln
