// SPDX-License-Identifier: MIT
#include "asset/read_description.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/json.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* bake_again = "bake the asset again with kiln-bake";
constexpr const char* compress_again = "compress the asset again with kiln-compress";

void read_normals(const Fields& fields, PrtDescription& asset) {
  if (!fields.has(key::normals)) return;
  asset.normals_file = fields.safe_path(key::normals);
  if (fields.has(key::normal_width) || fields.has(key::normal_height)) {
    asset.normal_width = fields.integer(key::normal_width, 1, largest_asset_side);
    asset.normal_height = fields.integer(key::normal_height, 1, largest_asset_side);
  }
  if (!fields.has(key::normal_space)) return;
  const std::string expected = "object or tangent", space = fields.text(key::normal_space, expected);
  if (space == "tangent") asset.normal_space = NormalSpace::tangent;
  if (!space.empty() && space != "object" && space != "tangent")
    fields.fail(fields.path(key::normal_space), space, expected);
}

PrtAlbedo read_albedo(const Fields& fields, bool has_pictures) {
  const std::string expected =
      has_pictures ? "the name of a picture, or three numbers of 0 to 1" : "three numbers of 0 to 1";
  if (!fields.has(key::albedo)) return {};
  const Json& value = *fields.find(key::albedo, expected);
  if (has_pictures && value.is_string()) return PrtAlbedo::of_picture(fields.safe_path(key::albedo));
  const auto is_share = [](const Json& v) { return v.is_number() && v >= 0 && v <= 1; };
  if (value.is_array() && value.size() == 3 && std::all_of(value.begin(), value.end(), is_share))
    return PrtAlbedo::of_constant({value[0].get<float>(), value[1].get<float>(), value[2].get<float>()});
  if (has_pictures && !value.is_array())
    fields.safe_path(key::albedo);
  else
    fields.fail(key::albedo, Fields::shown(value), expected);
  return {};
}

/// Reads a measured reflectance, which spans what is seen.
std::optional<PrtReflectance> read_measured(const Fields& entry) {
  PrtReflectance reflectance{entry.text(key::name, "a name"),
                             entry.integer(key::first_nm, shortest_wavelength_nm, longest_wavelength_nm),
                             entry.integer(key::step_nm, 1, widest_reflectance_step_nm, 1),
                             {}};
  const Json* values = entry.list(key::values, std::nullopt, "shares of 0 to 1");
  if (values == nullptr) return std::nullopt;
  for (const Json& value : *values) {
    if (!value.is_number() || value < 0 || value > 1) {
      entry.fail(entry.path(key::values), Fields::shown(value), "shares of 0 to 1");
      return std::nullopt;
    }
    reflectance.values.push_back(value.get<double>());
  }
  const auto last_nm = reflectance.first_nm + reflectance.step_nm * (static_cast<int>(reflectance.values.size()) - 1);
  if (reflectance.first_nm > 400 || last_nm < 700) {
    entry.fail(entry.path(key::values), fmt::format("{} to {} nm", reflectance.first_nm, last_nm),
               "400 to 700 nm or more");
    return std::nullopt;
  }
  return reflectance;
}

/// Reads the reflectance of all of the surface.
std::optional<PrtReflectance> read_reflectance(const Fields& fields, const PrtAlbedo& albedo) {
  if (!fields.has(key::reflectance)) return std::nullopt;
  const Json& object = *fields.find(key::reflectance, "");
  if (!object.is_object()) {
    fields.fail(key::reflectance, Fields::shown(object), "name, first_nm, step_nm and values");
    return std::nullopt;
  }
  if (!albedo.known || !albedo.file.empty())
    fields.fail(key::reflectance, "a reflectance without an albedo of three numbers", "the albedo that it is to RGB");
  return read_measured(fields.child(key::reflectance, object));
}

/// Reads the reflectances of materials, and where they are.
void read_reflectances(const Fields& fields, PrtAlbedo& albedo) {
  if (!fields.has(key::reflectances) && !fields.has(key::measured)) return;
  const Json* list = fields.list(key::reflectances, std::nullopt, "reflectances");
  if (list == nullptr) return;
  if (list->empty() || list->size() > most_reflectances)
    fields.fail(key::reflectances, fmt::format("{} reflectances", list->size()),
                fmt::format("1 to {}", most_reflectances));
  if (albedo.file.empty())
    fields.fail(key::reflectances, "reflectances of materials without a picture of the albedo",
                "the albedo that they are to RGB");
  for (std::size_t k = 0; k < list->size(); ++k)
    if (auto read = read_measured(fields.child(key::reflectances, k, (*list)[k])))
      albedo.reflectances.push_back(std::move(*read));
  albedo.measured_file = fields.safe_path(key::measured);
}

/// Reads the wavelengths of the channels, and the lamps that show them.
std::optional<PrtSpectrum> read_spectrum(const Fields& fields, int channels) {
  if (!fields.has(key::spectrum)) return std::nullopt;
  const Json& object = *fields.find(key::spectrum, "");
  if (!object.is_object()) {
    fields.fail(key::spectrum, Fields::shown(object), "wavelengths_nm and lamps");
    return std::nullopt;
  }
  if (channels < fewest_wavelengths)
    fields.fail(key::channels, fmt::format("{} wavelengths", channels), fmt::format("{} or more", fewest_wavelengths));
  const Fields entry = fields.child(key::spectrum, object);
  const auto count = static_cast<std::size_t>(channels);
  PrtSpectrum spectrum;
  for (const double nm : entry.numbers(key::wavelengths_nm, count)) {
    const bool rises = spectrum.wavelengths_nm.empty() || nm > spectrum.wavelengths_nm.back();
    if (nm != std::floor(nm) || nm < shortest_wavelength_nm || nm > longest_wavelength_nm || !rises)
      entry.fail(entry.path(key::wavelengths_nm), fmt::format("{:g}", nm), "whole wavelengths that rise");
    spectrum.wavelengths_nm.push_back(static_cast<int>(nm));
  }
  const Json* lamps = entry.list(key::lamps, std::nullopt, "lamps");
  if (lamps != nullptr && lamps->empty()) entry.fail(entry.path(key::lamps), "none", "at least one lamp");
  for (std::size_t l = 0; lamps != nullptr && l < lamps->size(); ++l) {
    const Fields lamp = entry.child(key::lamps, l, (*lamps)[l]);
    PrtSpectrum::Lamp& read = spectrum.lamps.emplace_back();
    read.name = lamp.text(key::name, "a name");
    const Json* rows = lamp.list(key::xyz, 3, "rows: of X, Y and Z");
    for (std::size_t row = 0; rows != nullptr && row < rows->size(); ++row) {
      const Json& numbers = (*rows)[row];
      const bool fits = numbers.is_array() && numbers.size() == count &&
                        std::all_of(numbers.begin(), numbers.end(), &is_finite_float);
      if (!fits)
        lamp.fail(lamp.path(key::xyz), Fields::shown(numbers), fmt::format("rows of {} numbers", channels));
      else
        read.xyz_from_channels.push_back(numbers.get<std::vector<double>>());
    }
  }
  return spectrum;
}

Eigen::Vector3d read_origin(const Fields& fields) {
  if (!fields.has(key::origin)) return Eigen::Vector3d::Zero();
  const std::vector<double> origin = fields.numbers(key::origin, 3);
  return origin.empty() ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(origin[0], origin[1], origin[2]);
}

std::vector<PrtMap> read_maps(const Fields& fields) {
  if (!fields.has(key::maps)) return {};
  const Json& object = *fields.find(key::maps, "");
  if (!object.is_object()) {
    fields.fail(key::maps, Fields::shown(object), "maps by their names");
    return {};
  }
  std::vector<PrtMap> maps;
  for (const auto& [name, entry] : object.items()) {
    const Fields map = fields.child(key::maps, entry);
    maps.push_back({name, map.safe_path(key::file), std::nullopt});
    if (map.has(key::lowest)) maps.back().range = read_range(map);
  }
  return maps;
}

/// Reads what both descriptions have: bands, channels, mesh, normals, albedo, opacity.
void read_shared(const Fields& fields, PrtDescription& asset) {
  if (asset.vertices == 0) {
    asset.width = fields.integer(key::width, 1, largest_asset_side);
    asset.height = fields.integer(key::height, 1, largest_asset_side);
  }
  asset.mesh_file = fields.safe_path(key::mesh);
  read_normals(fields, asset);
  asset.albedo = read_albedo(fields, asset.vertices == 0);
  if (!asset.albedo.file.empty() && (fields.has(key::albedo_width) || fields.has(key::albedo_height))) {
    asset.albedo.width = fields.integer(key::albedo_width, 1, largest_asset_side);
    asset.albedo.height = fields.integer(key::albedo_height, 1, largest_asset_side);
  }
  asset.albedo.reflectance = read_reflectance(fields, asset.albedo);
  if (asset.vertices == 0) read_reflectances(fields, asset.albedo);
  asset.spectrum = read_spectrum(fields, asset.channels);
  if (asset.vertices == 0 && fields.has(key::opacity)) asset.opacity_file = fields.safe_path(key::opacity);
  asset.maps = read_maps(fields);
  asset.origin = read_origin(fields);
  if (asset.vertices == 0) asset.levels = read_levels(fields);
}

/// Reads the plane at `index` of the list, which has each plane once, in order.
PrtPlane read_plane(const Fields& fields, const PrtDescription& asset, int index) {
  const int coefficients = asset.bands * asset.bands;
  PrtPlane plane;
  plane.bits = asset.bits;
  if (asset.vertices == 0) {
    plane.file = fields.safe_path(key::file);
  } else {
    plane.attribute = fields.text(key::attribute, "the name of an attribute of the mesh");
    plane.component = fields.integer(key::component, 0, attribute_components - 1);
    if (fields.has(key::unique_id))
      plane.unique_id = static_cast<std::uint32_t>(fields.integer(key::unique_id, 0, most_asset_vertices));
  }
  plane.channel = fields.integer(key::channel, 0, asset.channels - 1, -1);
  plane.coefficient = fields.integer(key::coefficient, 0, coefficients - 1, -1);
  const bool is_known = plane.channel >= 0 && plane.coefficient >= 0;
  if (is_known && (plane.channel != index / coefficients || plane.coefficient != index % coefficients))
    fields.fail(fields.path(key::coefficient), fmt::format("{} of channel {}", plane.coefficient, plane.channel),
                fmt::format("coefficient {} of channel {} (each plane once, in order)", index % coefficients,
                            index / coefficients));
  plane.range = read_range(fields);
  return plane;
}

/// Reads what only ranges.json has.
void read_ranges(const Fields& fields, PrtDescription& asset) {
  asset.bits = fields.bits(key::bits);
  if (fields.has(key::vertices)) asset.vertices = fields.integer(key::vertices, 1, most_asset_vertices, 1);
  read_shared(fields, asset);
  if (asset.vector_length() == 0) return;  // a faulty size gives no number of planes
  const Json* planes = fields.list(key::planes, asset.vector_length(), "planes");
  for (std::size_t k = 0; planes != nullptr && k < planes->size(); ++k)
    asset.planes.push_back(read_plane(fields.child(key::planes, k, (*planes)[k]), asset, static_cast<int>(k)));
}

/// Reads what only pca.json has.
void read_pca(const Fields& fields, PrtDescription& asset) {
  read_shared(fields, asset);
  const int length = static_cast<int>(asset.vector_length());
  PcaTables& tables = asset.pca.emplace();
  tables.clusters = fields.integer(key::clusters, 1, most_clusters, 1);
  const int components = length > 0 ? fields.integer(key::components, 1, length) : 0;
  if (asset.bands > 0)
    tables.coefficient_scales =
        fields.numbers(key::coefficient_scales, static_cast<std::size_t>(asset.bands) * asset.bands);
  tables.vectors_file = fields.safe_path(key::vectors_file);
  if (tables.clusters > 1) tables.ids_file = fields.safe_path(key::cluster_ids);
  if (components == 0) return;

  asset.bits = 8;
  const Json* planes = fields.list(key::planes, static_cast<std::size_t>(components), "planes");
  for (std::size_t k = 0; planes != nullptr && k < planes->size(); ++k) {
    const Fields plane = fields.child(key::planes, k, (*planes)[k]);
    asset.planes.push_back({plane.safe_path(key::file), 0, static_cast<int>(k), read_range(plane)});
    asset.planes.back().bits = plane.bits(key::bits);
    asset.bits = std::max(asset.bits, asset.planes.back().bits);
  }
  const Json* ranges = fields.list(key::vector_ranges, static_cast<std::size_t>(components) + 1,
                                   "ranges: the means', then the basis vectors'");
  for (std::size_t k = 0; ranges != nullptr && k < ranges->size(); ++k)
    tables.vector_ranges.push_back(read_range(fields.child(key::vector_ranges, k, (*ranges)[k])));
}

}  // namespace

FormatHead read_head(const Fields& fields, const char* format, const std::vector<std::string>& known) {
  FormatHead head;
  fields.constant(key::format, format);
  head.version = fields.integer(key::version, oldest_format_version, format_version);
  // Version 1 has no `origin`: a key of that name is unknown there, and ignored.
  if (head.version >= 2) {
    const std::string expected = known.empty() ? "nothing" : fmt::format("none but {}", fmt::join(known, ", "));
    const Json* list = fields.list(key::required, std::nullopt, "names of what a reader must know");
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      const Json& entry = (*list)[k];
      if (entry.is_string() && std::find(known.begin(), known.end(), entry) != known.end())
        head.required.push_back(entry);
      else
        fields.tell(BadInput(fields.file(), "requires " + Fields::shown(entry) + ", which this version does not know",
                             expected, "take a later version of Kiln, or " + fields.remedy()));
    }
  }
  fields.constant(key::basis, basis_name);
  return head;
}

std::vector<PrtLevel> read_levels(const Fields& fields) {
  std::vector<PrtLevel> levels;
  if (!fields.has(key::levels)) return levels;
  const Json* list = fields.list(key::levels, std::nullopt, "levels of detail");
  if (list != nullptr && list->size() > most_levels)
    fields.fail(key::levels, fmt::format("a list of {}", list->size()), fmt::format("{} levels at most", most_levels));
  for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
    const Fields entry = fields.child(key::levels, k, (*list)[k]);
    PrtLevel level{entry.safe_path(key::mesh), entry.integer(key::triangles, 1, most_asset_triangles),
                   entry.number(key::error), entry.number(key::distance)};
    if (level.error < 0) entry.fail(entry.path(key::error), fmt::format("{:g}", level.error), "0 or more");
    const PrtLevel* before = levels.empty() ? nullptr : &levels.back();
    if (before != nullptr && before->triangles > 0 && level.triangles >= before->triangles)
      entry.fail(entry.path(key::triangles), std::to_string(level.triangles),
                 fmt::format("fewer than {}, those of the level before", before->triangles));
    if (level.distance < (before == nullptr ? 0 : before->distance))
      entry.fail(
          entry.path(key::distance), fmt::format("{:g}", level.distance),
          before == nullptr ? "0 or more" : fmt::format("{:g}, that of the level before, or more", before->distance));
    levels.push_back(std::move(level));
  }
  return levels;
}

PlaneRange read_range(const Fields& fields) {
  const PlaneRange range{fields.number(key::lowest), fields.number(key::highest)};
  if (range.lowest > range.highest)
    fields.fail(fields.path(key::lowest), fmt::format("{:g}, above max {:g}", range.lowest, range.highest),
                "min <= max");
  return range;
}

std::pair<PrtDescription, FormatHead> read_description(const fs::path& file, Faults& faults) {
  PrtDescription asset;
  asset.ranges_file = file;
  const bool is_pca = file.filename() == pca_name;
  const std::string remedy = is_pca ? compress_again : bake_again;
  Json document;
  if (!faults.guard([&] { document = parse_json(file, is_pca ? "kiln-compress" : "kiln-bake", remedy); }))
    return {asset, {}};
  const Fields fields(file.string(), "", document, remedy, &faults);
  std::vector<std::string> known = {requirement::albedo,  requirement::albedo_size, requirement::normal_size,
                                    requirement::opacity, requirement::spectrum,    requirement::tangent_normals};
  if (!is_pca) known.emplace_back(requirement::vertices);
  const FormatHead head = read_head(fields, is_pca ? pca_format : prt_format, known);
  asset.bands = fields.integer(key::bands, 1, most_asset_bands);
  asset.channels = fields.integer(key::channels, 1, most_asset_channels);
  is_pca ? read_pca(fields, asset) : read_ranges(fields, asset);
  return {asset, head};
}

std::vector<std::string> requirements(const PrtDescription& asset) {
  std::vector<std::string> required;
  if (asset.albedo.known) required.emplace_back(requirement::albedo);
  if (asset.albedo.has_own_size()) required.emplace_back(requirement::albedo_size);
  if (asset.normal_width > 0) required.emplace_back(requirement::normal_size);
  if (!asset.opacity_file.empty()) required.emplace_back(requirement::opacity);
  if (asset.spectrum) required.emplace_back(requirement::spectrum);
  if (!asset.normals_file.empty() && asset.normal_space == NormalSpace::tangent)
    required.emplace_back(requirement::tangent_normals);
  if (asset.vertices > 0) required.emplace_back(requirement::vertices);
  return required;
}

std::string remedy_for(const PrtDescription& asset) {
  if (asset.pca) return compress_again;
  return asset.vertices > 0 ? std::string(bake_again) + " --per-vertex" : bake_again;
}

std::vector<std::string> named_files(const PrtDescription& asset) {
  std::vector<std::string> files = {asset.mesh_file, asset.normals_file, asset.albedo.file, asset.albedo.measured_file,
                                    asset.opacity_file};
  for (const PrtLevel& level : asset.levels) files.push_back(level.mesh_file);
  for (const PrtMap& map : asset.maps) files.push_back(map.file);
  for (const PrtPlane& plane : asset.planes) files.push_back(plane.file);
  if (asset.pca) files.insert(files.end(), {asset.pca->vectors_file, asset.pca->ids_file});
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  std::erase(files, "");
  return files;
}

fs::path description_file(const fs::path& folder) {
  std::error_code error;
  for (const char* name : {pca_name, ranges_name})
    if (fs::is_regular_file(folder / name, error)) return folder / name;
  throw BadInput(folder.string(),
                 fs::is_directory(folder, error) ? std::string("has no ") + ranges_name : std::string("is no folder"),
                 "the output folder of kiln-bake or kiln-compress", "run kiln-bake, or name its output folder");
}

}  // namespace kiln
