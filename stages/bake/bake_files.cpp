#include "bake/bake_files.h"

#include <optional>

#include "bake/coefficient_planes.h"
#include "base/errors.h"
#include "detail/asset_hints.h"
#include "detail/detail_maps.h"
#include "mesh/draco_file.h"
#include "mesh/mesh_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int default_size_texels = 512;

/// The size that kiln-atlas packed for, from the record beside the atlas.
int packed_size(const fs::path& atlas) {
  const AssetHints hints = read_asset_hints(folder_of(atlas));
  return hints.size > 0 ? hints.size : default_size_texels;
}

}  // namespace

BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings) {
  if (settings.bits != 8 && settings.bits != 16)
    throw WrongUsage("bits: found '" + std::to_string(settings.bits) + "'; expected 8 or 16");
  if (settings.receiver == BakeReceiver::high && paths.detail.empty())
    throw WrongUsage("receiver high: found no --detail FOLDER; expected the output of kiln-normals, or --receiver low");
  const TriangleMesh atlas = load_atlas(paths.atlas);
  std::optional<DetailMaps> detail;
  if (!paths.detail.empty()) detail = load_detail_maps(paths.detail, atlas);

  BakeScene scene;
  if (settings.receiver == BakeReceiver::high) {
    scene.receivers = receivers_on_high(*detail);
  } else {
    const int size = settings.size > 0 ? settings.size : packed_size(paths.atlas);
    scene.receivers = receivers_on_low(atlas, detail ? detail->width : size, detail ? detail->height : size,
                                       detail ? &*detail : nullptr);
  }
  if (scene.receivers.texels.empty())
    throw BadInput(paths.atlas.string(), "covers no texel", "an atlas packed for this size", "bake at a larger size");

  std::vector<TriangleMesh> meshes;
  for (const fs::path& occluder : paths.occluders) meshes.push_back(load_mesh(occluder));
  if (meshes.empty()) meshes.push_back(load_mesh(paths.atlas));
  scene.occluders = join_occluders(meshes);
  return scene;
}

Json save_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
               const BakeSettings& settings, const CommandLine& command) {
  AssetFiles files{"atlas.drc", ""};
  fs::copy_file(paths.atlas, outputs.add(files.mesh), fs::copy_options::overwrite_existing);
  if (!paths.detail.empty()) {
    files.normals = "normal.png";
    fs::copy_file(paths.detail / files.normals, outputs.add(files.normals), fs::copy_options::overwrite_existing);
  } else {
    outputs.remove_stale("normal.png");
  }
  write_planes(outputs, {result.transfer}, scene.receivers, settings.bits, files);
  const TransferVectors stored = read_planes(outputs.staging(), scene.receivers).front();

  const double texel_directions = static_cast<double>(scene.receivers.texels.size()) * settings.directions;
  Json metrics = {{"renderer", result.renderer},
                  {"software_renderer", result.software_renderer},
                  {"texels", scene.receivers.texels.size()},
                  {"directions", settings.directions},
                  {"texel_directions_per_second", texel_directions / result.seconds},
                  {"width", scene.receivers.width},
                  {"height", scene.receivers.height},
                  {"coefficients", result.transfer.coefficients},
                  {"occluder_triangles", scene.occluders.mesh.triangles.size()},
                  {"occluders_closed", scene.occluders.closed},
                  {"quantisation_error", relative_l2(stored, result.transfer)}};
  if (settings.verify_directions > 0) {
    const BakeVerification v = verify(result, stored, scene.receivers, scene.occluders, settings, command.seed(),
                                      command.threads(), command.progress("verify"));
    metrics["verification"] = {{"other_backend", v.other_backend},
                               {"backend_difference", v.backend_difference},
                               {"reference_directions", v.reference_directions},
                               {"reference_texels", v.reference_texels},
                               {"integration_error", v.integration_error},
                               {"error", v.error},
                               {"relighting_error", v.relighting_error}};
  }
  return metrics;
}

}  // namespace kiln
