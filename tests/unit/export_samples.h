// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "asset/write_asset.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "sh/basis.h"

/// Baked folders for tests of what is made of them.
namespace kiln::test {

/// An asset whose transfer is that of an open surface, times `open`.
struct Sample {
  TriangleMesh mesh;
  int side = 32, bands = 2, bits = 8;
  std::vector<float> open = {1};  ///< per channel
  PrtDescription description = {};
};

inline Image<float> constant_plane(const Sample& sample, float value) { return {sample.side, sample.side, 1, value}; }

/// Writes the asset without what only `description` has; pictures beside planes are the caller's.
inline void write(const std::filesystem::path& folder, Sample sample) {
  OutputSet outputs(folder);
  PrtDescription& asset = sample.description;
  asset.bands = sample.bands;
  asset.channels = static_cast<int>(sample.open.size());
  asset.bits = sample.bits;
  asset.width = asset.height = sample.side;
  asset.mesh_file = atlas_mesh_name;
  asset.origin = sample.mesh.frame.origin;
  save_draco(outputs.add(atlas_mesh_name), sample.mesh);
  const TriangleMesh stored = load_draco(outputs.staging() / atlas_mesh_name);
  const UvRaster raster = rasterise_uvs(stored, sample.side, sample.side);
  const ShBasis basis(sample.bands);
  for (int c = 0; c < asset.channels; ++c)
    for (int i = 0; i < basis.size(); ++i) {
      Image<float> plane = constant_plane(sample, 0);
      for (std::size_t k = 0; k < raster.texels.size(); ++k)
        if (raster.texels[k].covered())
          plane.values()[k] =
              sample.open[static_cast<std::size_t>(c)] *
              unoccluded_transfer(
                  basis,
                  interpolate(stored, stored.normals, raster.texels[k]).normalized())[static_cast<std::size_t>(i)];
      asset.planes.push_back(write_plane(outputs, c, i, plane, range_of(plane.values()), sample.bits));
    }
  write_description(outputs, asset);
  outputs.commit();
}

}  // namespace kiln::test
