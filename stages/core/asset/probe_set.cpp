#include "asset/probe_set.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "asset/asset_parts.h"
#include "asset/fields.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* matrices_name = "matrices.png";
constexpr const char* remedy = "make the probes again with kiln-probes";
constexpr double white = 65535;
constexpr std::size_t nearest_probes = 8;
constexpr int largest_grid = 1024;

using Weights = std::vector<std::pair<std::size_t, float>>;

/// Three finite numbers.
Eigen::Vector3f read_vector(const Fields& fields, const nlohmann::json& value, const std::string& what) {
  const bool fits = value.is_array() && value.size() == 3 && std::all_of(value.begin(), value.end(), [](const auto& x) {
                      return x.is_number() && std::isfinite(x.template get<float>());
                    });
  if (!fits) fields.fail(what, value.dump().substr(0, 60), "three finite numbers");
  return {value[0].get<float>(), value[1].get<float>(), value[2].get<float>()};
}

ProbeGrid read_grid(const Fields& fields) {
  ProbeGrid grid;
  const nlohmann::json& size = fields.get("size", "three whole numbers");
  const bool fits = size.is_array() && size.size() == 3 && std::all_of(size.begin(), size.end(), [](const auto& n) {
                      return n.is_number_unsigned() && n.template get<std::uint64_t>() >= 1 &&
                             n.template get<std::uint64_t>() <= largest_grid;
                    });
  if (!fits)
    fields.fail(fields.path("size"), size.dump().substr(0, 60),
                "three whole numbers of 1 to " + std::to_string(largest_grid));
  for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = size[axis].get<int>();
  if (grid.count() > most_probes)
    fields.fail(fields.path("size"), size.dump(), "at most " + std::to_string(most_probes) + " points");
  grid.lower = read_vector(fields, fields.get("lower", "three numbers"), fields.path("lower"));
  grid.upper = read_vector(fields, fields.get("upper", "three numbers"), fields.path("upper"));
  if (!(grid.lower.array() <= grid.upper.array()).all())
    fields.fail(fields.path("lower"), "above upper", "lower <= upper along every axis");
  return grid;
}

void normalise(Weights& weights) {
  float sum = 0;
  for (const auto& [probe, weight] : weights) sum += weight;
  for (auto& [probe, weight] : weights) weight /= sum;
}

Weights grid_weights(const ProbeSet& probes, const Eigen::Vector3f& position) {
  const ProbeGrid& grid = *probes.grid;
  std::array<int, 3> cell{};
  Eigen::Vector3f within = Eigen::Vector3f::Zero();  // 0 at the cell's lower corner, 1 at its upper one
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const float length = grid.upper[axis] - grid.lower[axis];
    if (grid.size[a] == 1 || !(length > 0)) continue;
    const float place =
        std::clamp((position[axis] - grid.lower[axis]) / length, 0.f, 1.f) * static_cast<float>(grid.size[a] - 1);
    cell[a] = std::min(static_cast<int>(place), grid.size[a] - 2);
    within[axis] = place - static_cast<float>(cell[a]);
  }
  Weights weights;
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1;
    std::size_t index = 0, stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int up = corner >> axis & 1;
      weight *= up == 1 ? within[axis] : 1 - within[axis];
      index += stride * static_cast<std::size_t>(cell[a] + up);
      stride *= static_cast<std::size_t>(grid.size[a]);
    }
    // The upper corner of an axis of one point weighs nothing, and is not there.
    if (weight > 0 && probes.valid[index] != 0) weights.emplace_back(index, weight);
  }
  return weights;
}

Weights nearest_weights(const ProbeSet& probes, const Eigen::Vector3f& position, std::size_t most) {
  Weights nearest;  // with squared distances, nearest first
  for (std::size_t k = 0; k < probes.positions.size(); ++k) {
    if (probes.valid[k] == 0) continue;
    const float distance = (probes.positions[k] - position).squaredNorm();
    if (nearest.size() == most && distance >= nearest.back().second) continue;
    if (nearest.size() == most) nearest.pop_back();
    const auto farther =
        std::find_if(nearest.begin(), nearest.end(), [&](const auto& other) { return distance < other.second; });
    nearest.insert(farther, {k, distance});
  }
  if (nearest.empty()) return nearest;
  if (nearest.front().second == 0) return {{nearest.front().first, 1.f}};
  const float least = nearest.front().second;  // so that no weight overflows
  for (auto& [probe, weight] : nearest) weight = least / weight;
  return nearest;
}

}  // namespace

Eigen::Vector3f ProbeGrid::position(std::size_t index) const {
  Eigen::Vector3f result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto points = static_cast<std::size_t>(size[static_cast<std::size_t>(axis)]);
    const auto place = static_cast<float>(index % points);
    const float share = points == 1 ? 0.5f : place / static_cast<float>(points - 1);
    result[axis] = lower[axis] + share * (upper[axis] - lower[axis]);
    index /= points;
  }
  return result;
}

void save_probes(OutputSet& outputs, const ProbeSet& probes) {
  const std::size_t entries = probes.entries(), count = probes.positions.size();
  std::vector<float> lowest(entries, 0), highest(entries, 0);
  bool first = true;
  for (std::size_t k = 0; k < count; ++k) {
    if (probes.valid[k] == 0) continue;
    for (std::size_t e = 0; e < entries; ++e) {
      const float value = probes.matrices[k * entries + e];
      lowest[e] = first ? value : std::min(lowest[e], value);
      highest[e] = first ? value : std::max(highest[e], value);
    }
    first = false;
  }
  Image<std::uint16_t> stored(static_cast<int>(entries), static_cast<int>(count), 1);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t e = 0; e < entries; ++e) {
      const double range = static_cast<double>(highest[e]) - lowest[e];
      if (probes.valid[k] == 0 || range <= 0) continue;
      stored.at(static_cast<int>(e), static_cast<int>(count - 1 - k)) =
          static_cast<std::uint16_t>(std::lround((probes.matrices[k * entries + e] - lowest[e]) / range * white));
    }
  write_png(outputs.add(matrices_name), stored);

  const auto triple = [](const Eigen::Vector3f& v) { return nlohmann::ordered_json::array({v.x(), v.y(), v.z()}); };
  nlohmann::ordered_json json = {{"format", "kiln-probes"},
                                 {"version", 1},
                                 {"bands", probes.bands},
                                 {"channels", probes.channels},
                                 {"basis", "real-sh-orthonormal"}};
  if (probes.grid) {
    json["grid"] = {
        {"size", probes.grid->size}, {"lower", triple(probes.grid->lower)}, {"upper", triple(probes.grid->upper)}};
  } else {
    json["positions"] = nlohmann::ordered_json::array();
    for (const Eigen::Vector3f& position : probes.positions) json["positions"].push_back(triple(position));
  }
  json["invalid"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < count; ++k)
    if (probes.valid[k] == 0) json["invalid"].push_back(k);
  json["matrices_file"] = matrices_name;
  json["ranges"] = nlohmann::ordered_json::array();
  for (std::size_t e = 0; e < entries; ++e) json["ranges"].push_back({{"min", lowest[e]}, {"max", highest[e]}});
  outputs.add_text(probes_name, json.dump(1) + "\n");
}

ProbeSet load_probes(const fs::path& folder) {
  const fs::path file = folder / probes_name;
  const nlohmann::json document = parse_json(file, "kiln-probes", remedy);
  const Fields fields(file.string(), "", document, remedy);
  fields.constant("format", "kiln-probes");
  fields.integer("version", 1, 1);
  fields.constant("basis", "real-sh-orthonormal");
  ProbeSet probes;
  probes.bands = fields.integer("bands", 1, most_probe_bands);
  probes.channels = fields.integer("channels", 1, 3);
  if (probes.channels == 2) fields.fail("channels", "2", "1 or 3");
  if (fields.has("grid")) {
    probes.grid = read_grid(Fields(file.string(), "grid", document["grid"], remedy));
    for (std::size_t k = 0; k < probes.grid->count(); ++k) probes.positions.push_back(probes.grid->position(k));
  } else {
    const std::string expected = "a list of 1 to " + std::to_string(most_probes) + " points, or a grid";
    const nlohmann::json& list = fields.get("positions", expected);
    if (!list.is_array() || list.empty() || list.size() > most_probes)
      fields.fail("positions", list.is_array() ? std::to_string(list.size()) + " entries" : "no list", expected);
    for (std::size_t k = 0; k < list.size(); ++k)
      probes.positions.push_back(read_vector(fields, list[k], "positions[" + std::to_string(k) + "]"));
  }
  const std::size_t count = probes.positions.size(), entries = probes.entries();
  probes.valid.assign(count, 1);
  const nlohmann::json& invalid = fields.get("invalid", "a list of points that are not valid");
  const std::string number_expected = "numbers of points, 0 to " + std::to_string(count - 1);
  if (!invalid.is_array()) fields.fail("invalid", "no list", number_expected);
  for (const nlohmann::json& index : invalid) {
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= count)
      fields.fail("invalid", index.dump().substr(0, 60), number_expected);
    probes.valid[index.get<std::size_t>()] = 0;
  }
  const std::string ranges_expected = "a list of " + std::to_string(entries) + " ranges";
  const nlohmann::json& ranges = fields.get("ranges", ranges_expected);
  if (!ranges.is_array() || ranges.size() != entries)
    fields.fail("ranges", ranges.is_array() ? std::to_string(ranges.size()) + " entries" : "no list", ranges_expected);

  const Image<std::uint16_t> stored = read_grey<std::uint16_t>(
      folder / fields.safe_path("matrices_file"), static_cast<int>(entries), static_cast<int>(count), remedy);
  probes.matrices.resize(count * entries);
  for (std::size_t e = 0; e < entries; ++e) {
    const Fields range(file.string(), "ranges[" + std::to_string(e) + "]", ranges[e], remedy);
    const double lowest = range.number("min"), highest = range.number("max");
    if (lowest > highest) range.fail(range.path("min"), fmt::format("{:g}, above max", lowest), "min <= max");
    for (std::size_t k = 0; k < count; ++k)
      probes.matrices[k * entries + e] = static_cast<float>(
          lowest + stored.at(static_cast<int>(e), static_cast<int>(count - 1 - k)) / white * (highest - lowest));
  }
  return probes;
}

Weights probe_weights(const ProbeSet& probes, const Eigen::Vector3f& position) {
  Weights weights = probes.grid ? grid_weights(probes, position) : nearest_weights(probes, position, nearest_probes);
  if (weights.empty()) weights = nearest_weights(probes, position, 1);
  if (!weights.empty()) normalise(weights);
  return weights;
}

LightCoefficients light_at(const ProbeSet& probes, const Eigen::Vector3f& position, const LightCoefficients& source) {
  const std::size_t sources = source.channels.size(), matrices = static_cast<std::size_t>(probes.channels);
  if (sources != matrices && sources != 1 && matrices != 1)
    throw std::invalid_argument("a light of other channels than the probes");
  const Weights weights = probe_weights(probes, position);
  const auto size = static_cast<std::size_t>(probes.coefficients());
  LightCoefficients light{probes.bands, {}};
  for (std::size_t c = 0; c < std::max(sources, matrices); ++c) {
    std::vector<float> from = source.channels[std::min(c, sources - 1)];
    from.resize(size, 0.f);
    std::vector<float>& to = light.channels.emplace_back(size, 0.f);
    for (const auto& [probe, weight] : weights) {
      const std::span<const float> matrix = probes.matrix(probe, static_cast<int>(std::min(c, matrices - 1)));
      for (std::size_t i = 0; i < size; ++i) {
        float sum = 0;
        for (std::size_t j = 0; j < size; ++j) sum += matrix[i * size + j] * from[j];
        to[i] += weight * sum;
      }
    }
    if (weights.empty()) to = from;
  }
  return light;
}

}  // namespace kiln
