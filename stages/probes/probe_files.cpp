// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/probe_files.h"

#include <optional>

#include "base/command_line.h"
#include "base/errors.h"
#include "import/import_mesh.h"
#include "material/cut_out.h"
#include "material/load_albedo.h"

namespace kiln {

SceneMesh load_probe_scene(const std::vector<std::filesystem::path>& files, const ProbesSettings& settings,
                           CommandLine& command) {
  SceneMesh scene;
  std::optional<MeshFrame> frame;  // that of the first mesh
  for (const std::filesystem::path& file : files) {
    const ImportedMesh imported = import_mesh(file, settings.import, frame);
    command.warn(imported.warnings);
    frame = imported.mesh.frame;
    if (*frame != MeshFrame())
      throw BadInput(file.string(),
                     "lies many times its size from the origin, or is a million times larger or smaller than one unit",
                     "a mesh whose probes can be told as floats", "move it, or give --scale");
    const LoadedOpacity opacity = load_opacity(imported, settings.material);
    command.warn(opacity.warnings);
    command.also_read(opacity.files);
    TriangleMesh mesh = imported.mesh;
    if (!settings.bounces.any()) {
      SurfaceAlbedo none;
      cut_occluder(mesh, none, opacity.opacity, file.string());
      scene.add(mesh);
      continue;
    }
    LoadedAlbedo loaded = load_albedo(imported, settings.material);
    if (loaded.albedo.source() == SurfaceAlbedo::Source::none)
      throw WrongUsage("bounces: found no albedo in " + file.string() +
                       "; expected materials, colours of vertices, --albedo or --albedo-texture");
    command.warn(loaded.warnings());
    command.also_read(loaded.files);
    cut_occluder(mesh, loaded.albedo, opacity.opacity, file.string());
    scene.add(mesh, loaded.albedo);
  }
  return scene;
}

}  // namespace kiln
