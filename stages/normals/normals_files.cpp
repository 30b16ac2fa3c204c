// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normals_files.h"

#include "base/asset_layout.h"
#include "base/json.h"
#include "image/image_file.h"

namespace kiln {

namespace {

/// Writes a picture, or removes that of an earlier run where there is none.
template <class Texel>
void write_or_remove(OutputSet& outputs, const char* name, const Image<Texel>* picture) {
  if (picture != nullptr)
    write_png(outputs.add(name), *picture);
  else
    outputs.remove_stale(name);
}

}  // namespace

Json write_all_maps(OutputSet& outputs, const NormalsResult& result, const MapSettings& settings,
                    const MaterialIds& materials) {
  write_png(outputs.add(layout::normal_map), result.normal);
  write_or_remove(outputs, layout::own_normal_map, result.own_normal ? &*result.own_normal : nullptr);
  write_exr(outputs.add(layout::position_map), result.position);
  write_png(outputs.add(layout::coverage_map), result.coverage);
  write_png(outputs.add(layout::match_map), result.match);
  write_or_remove(outputs, layout::albedo_map, result.albedo_map ? &result.albedo_map->picture : nullptr);
  write_or_remove(outputs, layout::opacity_map, result.opacity_map ? &result.opacity_map->picture : nullptr);
  return write_maps(outputs, result.maps, settings, materials);
}

}  // namespace kiln
