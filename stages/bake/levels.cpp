// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/levels.h"

#include <algorithm>

#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/hashes.h"
#include "base/json.h"

namespace kiln {

namespace fs = std::filesystem;

std::vector<PrtLevel> load_levels(const fs::path& folder, const fs::path& atlas_file) {
  const fs::path file = layout::record_in(folder, "lod");
  const std::string remedy = "run kiln-lod on " + atlas_file.string();
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw BadInput(folder.string(), "has no lod.json", "the output folder of kiln-lod", remedy);
  const Json record = parse_json(file, "kiln-lod", remedy);
  const Fields fields(file.string(), "", record, remedy);
  std::vector<PrtLevel> levels = read_levels(fields);
  if (levels.empty()) throw BadInput(file.string(), "lists no levels", "one at least", remedy);

  const Json inputs = record.value("inputs", Json::object());
  const std::string hash = hash_file(atlas_file);
  if (std::none_of(inputs.begin(), inputs.end(), [&](const Json& input) { return input == hash; }))
    throw BadInput(file.string(), "is of another atlas", "levels of " + atlas_file.string(), remedy);
  PrtDescription described;
  described.ranges_file = file;
  for (const PrtLevel& level : levels) read_level_mesh(folder, described, level);
  return levels;
}

void ship_levels(OutputSet& outputs, const fs::path& folder, const std::vector<PrtLevel>& levels) {
  for (const PrtLevel& level : levels)
    fs::copy_file(folder / level.mesh_file, outputs.add(level.mesh_file), fs::copy_options::overwrite_existing);
}

}  // namespace kiln
