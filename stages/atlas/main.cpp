// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas.h"
#include "atlas/drawing.h"
#include "atlas/keep_uv.h"
#include "atlas/load_meshes.h"
#include "base/asset_layout.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "maps/asset_hints.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-atlas", [&] {
    // Parse.
    CommandLine command("kiln-atlas", "Cuts a mesh into charts, flattens them and packs them into a texture atlas.");
    std::filesystem::path low_file, high_file, atlas_file;
    AtlasSettings settings;
    command.input("LOW", low_file, "The mesh (low.drc of kiln-simplify, or OBJ, PLY, STL, OFF)");
    command.output(atlas_file, "The mesh with uvs, a Draco file; atlas.png and atlas.json are written beside it");
    command.input_option("high", high_file, "The high mesh, whose transfer --density transfer then follows");
    command.options("Atlas", atlas_options(settings));
    bool keep_uv = false;
    command.flag("keep-uv", keep_uv, "Atlas", "The same as --uv keep");
    command.parse(argc, argv);
    if (keep_uv && command.given("uv")) throw WrongUsage("keep-uv: found --uv as well; expected one of them");
    if (keep_uv) settings.uv = UvChoice::keep;
    settings.seed = command.seed();
    check_size_settings(settings, command.given("size"));

    // Load.
    const AssetHints hints = read_asset_hints(folder_of(low_file));
    std::vector<std::string> warnings;
    const TriangleMesh low = load_low_mesh(low_file, settings, warnings);
    std::optional<TriangleMesh> high;
    if (!high_file.empty())
      high = load_high_mesh(high_file, inherit(settings.import, hints.import), low.frame, warnings);
    AtlasSettings in_frame = settings;
    in_frame.texels_per_unit *= low.frame.unit();
    const bool keep = keeps_uvs(low, in_frame, low_file.string(), warnings);
    command.warn(warnings, hints.warnings);
    OutputSet outputs(folder_of(atlas_file));

    // Run.
    const AtlasResult result =
        keep ? keep_uvs(low, in_frame, low_file.string())
             : make_atlas(low, in_frame, low_file.string(), command.progress("atlas"), high ? &*high : nullptr);

    // Save, and measure what was saved.
    const WrittenAtlas written = write_atlas(outputs.add(atlas_file.filename().string()), result);
    require_texels(written, result.size, low_file.string());
    write_png(outputs.add(layout::atlas_picture), draw_atlas(written.mesh, result.size, settings.gutter));
    Json metrics = written.to_json();
    metrics.update(result.to_json());
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
