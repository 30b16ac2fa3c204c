// SPDX-License-Identifier: MIT
#include "asset/write_asset.h"

#include <algorithm>

#include "asset/read_description.h"
#include "base/json.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"
#include "sh/basis.h"

namespace kiln {

namespace {

Json range_json(const PlaneRange& range) { return {{key::lowest, range.lowest}, {key::highest, range.highest}}; }

/// Makes the keys at the start of every description.
Json head_of(const PrtDescription& asset) {
  Json head = {{key::format, asset.pca ? pca_format : prt_format}, {key::version, format_version}};
  head[key::required] = Json::array();
  for (const std::string& name : requirements(asset)) head[key::required].push_back(name);
  head[key::bands] = asset.bands;
  head[key::channels] = asset.channels;
  return head;
}

void add_albedo(Json& head, const PrtAlbedo& albedo) {
  const Eigen::Vector3f& constant = albedo.constant;
  if (!albedo.known) return;
  if (albedo.has_own_size()) {
    head[key::albedo_width] = albedo.width;
    head[key::albedo_height] = albedo.height;
  }
  if (!albedo.file.empty())
    head[key::albedo] = albedo.file;
  else if (albedo.within_transfer)
    head[key::albedo] = {1, 1, 1};
  else
    head[key::albedo] = {constant.x(), constant.y(), constant.z()};
}

Json to_json(const PrtReflectance& reflectance) {
  return {{key::name, reflectance.name},
          {key::first_nm, reflectance.first_nm},
          {key::step_nm, reflectance.step_nm},
          {key::values, reflectance.values}};
}

void add_spectra(Json& head, const PrtDescription& asset) {
  if (const auto& reflectance = asset.albedo.reflectance) head[key::reflectance] = to_json(*reflectance);
  for (const PrtReflectance& reflectance : asset.albedo.reflectances)
    head[key::reflectances].push_back(to_json(reflectance));
  if (!asset.albedo.measured_file.empty()) head[key::measured] = asset.albedo.measured_file;
  if (!asset.spectrum) return;
  Json lamps = Json::array();
  for (const PrtSpectrum::Lamp& lamp : asset.spectrum->lamps)
    lamps.push_back({{key::name, lamp.name}, {key::xyz, lamp.xyz_from_channels}});
  head[key::spectrum] = {{key::wavelengths_nm, asset.spectrum->wavelengths_nm}, {key::lamps, lamps}};
}

/// Adds the sizes, and the files that both descriptions name.
void add_shared(Json& head, const PrtDescription& asset) {
  if (asset.vertices > 0) {
    head[key::vertices] = asset.vertices;
  } else {
    head[key::width] = asset.width;
    head[key::height] = asset.height;
  }
  head[key::basis] = basis_name;
  head[key::mesh] = asset.mesh_file;
  if (!asset.normals_file.empty()) head[key::normals] = asset.normals_file;
  if (asset.normal_width > 0) {
    head[key::normal_width] = asset.normal_width;
    head[key::normal_height] = asset.normal_height;
  }
  if (!asset.normals_file.empty() && asset.normal_space == NormalSpace::tangent) head[key::normal_space] = "tangent";
  add_albedo(head, asset.albedo);
  add_spectra(head, asset);
  if (!asset.opacity_file.empty()) head[key::opacity] = asset.opacity_file;
  for (const PrtMap& map : asset.maps) {
    Json& entry = head[key::maps][map.name] = {{key::file, map.file}};
    if (map.range) entry.update(range_json(*map.range));
  }
  if (!asset.origin.isZero(0)) head[key::origin] = {asset.origin.x(), asset.origin.y(), asset.origin.z()};
  for (const PrtLevel& level : asset.levels)
    head[key::levels].push_back({{key::mesh, level.mesh_file},
                                 {key::triangles, level.triangles},
                                 {key::error, level.error},
                                 {key::distance, level.distance}});
}

Json coefficient_json(const PrtPlane& plane) {
  Json json;
  if (plane.attribute.empty())
    json[key::file] = plane.file;
  else
    json = {{key::attribute, plane.attribute}, {key::unique_id, plane.unique_id}, {key::component, plane.component}};
  json[key::channel] = plane.channel;
  json[key::coefficient] = plane.coefficient;
  json.update(range_json(plane.range));
  return json;
}

Json weight_json(const PrtPlane& plane) {
  Json json = {{key::file, plane.file}, {key::bits, plane.bits}};
  json.update(range_json(plane.range));
  return json;
}

void add_tables(Json& head, const PcaTables& tables, std::size_t components) {
  head[key::clusters] = tables.clusters;
  head[key::components] = components;
  if (tables.clusters > 1) head[key::cluster_ids] = tables.ids_file;
  head[key::coefficient_scales] = tables.coefficient_scales;
  head[key::vectors_file] = tables.vectors_file;
  head[key::vector_ranges] = Json::array();
  for (const PlaneRange& range : tables.vector_ranges) head[key::vector_ranges].push_back(range_json(range));
}

template <class Stored>
Image<Stored> stored_plane(const Image<float>& values, const PlaneRange& range, int bits) {
  Image<Stored> stored(values.width(), values.height(), 1);
  std::transform(values.values().begin(), values.values().end(), stored.values().begin(),
                 [&](float value) { return static_cast<Stored>(range.store(value, bits)); });
  return stored;
}

/// Makes an empty attribute for the next coefficients of a channel.
IntegerAttribute new_attribute(const PrtDescription& asset, int channel, int coefficient, std::size_t vertices) {
  const int left = coefficient_count(asset.bands) - coefficient;
  IntegerAttribute attribute{plane_attribute(channel, coefficient / attribute_components),
                             std::min(attribute_components, left),
                             asset.bits,
                             {},
                             0};
  attribute.values.resize(vertices * static_cast<std::size_t>(attribute.components));
  return attribute;
}

/// Returns the files of further maps that a folder's description names; none where there is no whole one.
std::vector<std::string> maps_of_earlier_run(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  try {
    for (const PrtMap& map : load_prt_description(folder).maps) files.push_back(map.file);
  } catch (const BadInput&) {
    files.clear();
  }
  return files;
}

}  // namespace

std::string description_text(const PrtDescription& asset) {
  Json head = head_of(asset);
  if (!asset.pca) head[key::bits] = asset.bits;
  add_shared(head, asset);
  if (asset.pca) add_tables(head, *asset.pca, asset.planes.size());
  Json& planes = head[key::planes] = Json::array();
  for (const PrtPlane& plane : asset.planes) planes.push_back(asset.pca ? weight_json(plane) : coefficient_json(plane));
  return head.dump(2) + "\n";
}

void write_description(OutputSet& outputs, const PrtDescription& asset) {
  outputs.add_text(asset.pca ? pca_name : ranges_name, description_text(asset));
  remove_stale_planes(outputs);
}

void remove_stale_planes(OutputSet& outputs) {
  const std::vector<std::string>& written = outputs.names();
  for (const std::string& name : maps_of_earlier_run(outputs.folder()))
    if (std::find(written.begin(), written.end(), name) == written.end()) outputs.remove_stale(name);
  const bool was_compressed = std::filesystem::exists(outputs.folder() / pca_name);
  for (const auto& entry : std::filesystem::directory_iterator(outputs.folder())) {
    const std::string name = entry.path().filename().string();
    const bool is_plane = is_plane_name(name) && (was_compressed || name.starts_with("coeff_"));
    if (!is_plane && !is_level_name(name) && name != ranges_name && name != pca_name) continue;
    if (std::find(written.begin(), written.end(), name) == written.end()) outputs.remove_stale(name);
  }
}

PrtPlane write_plane(OutputSet& outputs, int channel, int coefficient, const Image<float>& values,
                     const PlaneRange& range, int bits) {
  PrtPlane plane{plane_file(channel, coefficient), channel, coefficient, range, bits};
  if (bits == 8)
    write_png(outputs.add(plane.file), stored_plane<std::uint8_t>(values, range, bits));
  else
    write_png(outputs.add(plane.file), stored_plane<std::uint16_t>(values, range, bits));
  return plane;
}

std::vector<std::uint32_t> write_vertex_asset(OutputSet& outputs, PrtDescription asset, const TriangleMesh& mesh,
                                              const std::function<VertexPlane(int, int)>& plane_at) {
  std::vector<IntegerAttribute> attributes;
  for (int channel = 0; channel < asset.channels; ++channel)
    for (int i = 0; i < coefficient_count(asset.bands); ++i) {
      const int component = i % attribute_components;
      if (component == 0) attributes.push_back(new_attribute(asset, channel, i, mesh.positions.size()));
      IntegerAttribute& attribute = attributes.back();
      const VertexPlane plane = plane_at(channel, i);
      for (std::size_t v = 0; v < plane.values.size(); ++v)
        attribute.values[v * static_cast<std::size_t>(attribute.components) + static_cast<std::size_t>(component)] =
            static_cast<std::uint16_t>(plane.range.store(plane.values[v], asset.bits));
      asset.planes.push_back({"", channel, i, plane.range, asset.bits, attribute.name, 0, component});
    }
  asset.mesh_file = vertex_mesh_name;
  asset.origin = mesh.frame.origin;
  const std::filesystem::path file = outputs.add(asset.mesh_file);
  const std::vector<std::uint32_t> sources = save_attributed_draco(file, mesh, attributes);
  asset.vertices = static_cast<int>(sources.size());

  // Looks up the ids that Draco gave the attributes.
  for (const IntegerAttribute& written : load_attributed_draco(file).attributes)
    for (PrtPlane& plane : asset.planes)
      if (plane.attribute == written.name) plane.unique_id = written.unique_id;
  write_description(outputs, asset);
  return sources;
}

}  // namespace kiln
