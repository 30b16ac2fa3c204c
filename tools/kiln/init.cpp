// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/init.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "base/files.h"
#include "base/outputs.h"
#include "kiln/asset_names.h"
#include "kiln/file_checks.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* head =
    R"(# What `kiln build` makes: every stage of every asset here whose inputs or settings changed.
#
# What is left out has its default. A stage's block holds its settings, named as in `kiln-STAGE --help`, which says
# default, unit and range. What stands with an asset comes before the defaults.

output: out                 # folder for what is made, relative to this file; out/index.html shows all of it

defaults:
  simplify:
    faces: 2000             # triangles of the small mesh
  atlas:
    size: 512               # texels a side
  bake:
    bands: 5                # of spherical harmonics: 25 coefficients a texel
  report:
    lights: ["45,30", "-60,20", "ambient:1"]  # azimuth (0 is +Z, 90 is +X) and elevation in degrees; the same light from all sides
# import: {up: +z, unit: mm}  # how the mesh files are read, where they are not +Y up
# material: {albedo: 0.8}     # what share of light the surfaces reflect, where the files do not say

# What every asset must reach, of the metrics in out/NAME/metrics.json; exit status 4 where one does not.
# budgets:
#   simplify.hausdorff: {max: 0.01}     # fraction of the bounding box's diagonal
#   report.relative_l2: {max: 0.08}     # of pictures in linear radiance, the worst light

# One name for each; or patterns, as a list: `assets: [scans/*.ply]`.
assets:
)";

/// Returns a mesh's path as seen from the folder of the pipeline file: relative if it lies in that folder or beside it.
fs::path seen_from(const fs::path& folder, const fs::path& mesh) {
  if (mesh.is_absolute()) return mesh.lexically_normal();
  const fs::path whole = fs::weakly_canonical(fs::absolute(folder_of(mesh))) / mesh.filename();
  return whole.lexically_relative(fs::weakly_canonical(fs::absolute(folder)));
}

}  // namespace

std::string yaml_quoted(const std::string& text) {
  static const std::set<std::string> words = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 || c == '_' || c == '-' || c == '.' || c == '/';
  };
  const bool begins_plain = !text.empty() && text[0] != '-' && text[0] != '.' && !words.contains(text);
  // Plain digits would be read as a number, which may be a name all the same.
  if ((begins_plain || text.starts_with("../")) && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      quoted += std::string("\\") + c;
    else if (byte < 0x20 || byte == 0x7f)
      quoted += fmt::format("\\x{:02x}", byte);
    else
      quoted += c;
  }
  return quoted + "\"";
}

void init_pipeline(const std::vector<fs::path>& meshes, const fs::path& file) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(file, error)))
    throw BadInput(file.string(), "is there already", "a new file", "remove it, or choose another name with -o");
  std::string text = head;
  std::set<std::string> names;
  std::set<fs::path> seen;
  for (const fs::path& mesh : meshes) {
    if (const std::string fault = fault_of_mesh(mesh); !fault.empty())
      throw BadInput(mesh.string(), fault, what_a_mesh_is, "check the path, or convert the mesh");
    if (!seen.insert(fs::weakly_canonical(mesh)).second)
      throw BadInput(mesh.string(), "is given twice", "each mesh once", "leave it out once");
    const std::string base = name_of_mesh(mesh);
    std::string name = base;
    for (int count = 2; !names.insert(name).second; ++count) name = fmt::format("{}_{}", base, count);
    text +=
        fmt::format("  {}:\n    mesh: {}\n", yaml_quoted(name), yaml_quoted(seen_from(folder_of(file), mesh).string()));
  }
  OutputSet outputs(folder_of(file));
  outputs.add_text(file.filename().string(), text);
  outputs.commit();
}

}  // namespace kiln
