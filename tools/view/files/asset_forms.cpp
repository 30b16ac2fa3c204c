// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/files/asset_forms.h"

#include <algorithm>
#include <array>

#include "base/errors.h"
#include "runtime/decode/plane_weights.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

bool is_compressed_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / pca_name, error);
}

bool is_asset_folder(const fs::path& folder) {
  std::error_code error;
  return is_compressed_folder(folder) || fs::is_regular_file(folder / ranges_name, error);
}

/// Finds a compressed form: the first by name, so that the choice does not vary.
fs::path compressed_folder_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_compressed_folder(entry.path())) found.push_back(entry.path());
  return found.empty() ? fs::path() : *std::min_element(found.begin(), found.end());
}

/// Names an asset: "bunny" for out/bunny, for out/bunny/prt, and for other folders beside prt/.
std::string name_of(const fs::path& folder) {
  std::error_code error;
  fs::path whole = fs::weakly_canonical(folder, error);
  if (whole.empty()) whole = folder;
  if (!whole.has_filename()) whole = whole.parent_path();
  const bool is_part = is_asset_folder(whole) && is_asset_folder(whole.parent_path() / "prt");
  return (is_part ? whole.parent_path() : whole).filename().string();
}

/// Throws BadInput if the asset has no colours.
void require_colors(const PrtAsset& asset) { rgb_readers(asset, {1, 1, 1}); }

}  // namespace

AssetFolders find_asset_folders(const fs::path& folder, const fs::path& compressed) {
  std::error_code error;
  AssetFolders found{name_of(folder), {}, compressed};
  if (is_compressed_folder(folder)) {
    if (!compressed.empty())
      throw WrongUsage("compressed: found " + folder.string() + ", which is compressed itself; expected a folder of " +
                       "kiln-bake to go with --compressed");
    found.compressed = folder;
  } else if (is_asset_folder(folder)) {
    found.plain = folder;
  } else if (is_asset_folder(folder / "prt")) {
    found.plain = folder / "prt";
    if (compressed.empty()) found.compressed = compressed_folder_in(folder);
  } else {
    const bool is_folder = fs::is_directory(folder, error);
    throw BadInput(folder.string(),
                   is_folder ? "has no ranges.json, no pca.json and no prt/ with one of them" : "is no folder",
                   "an asset's folder, or the output folder of kiln-bake or kiln-compress",
                   "run kiln build or kiln-bake, or name their output folder");
  }
  return found;
}

const PrtAsset& AssetForms::of(Technique technique) const {
  return technique == Technique::compressed && compressed ? *compressed : main();
}

AssetForms load_asset_forms(const AssetFolders& folders) {
  AssetForms forms;
  if (!folders.plain.empty()) forms.plain = load_prt_asset(folders.plain);
  if (!folders.compressed.empty())
    forms.compressed =
        forms.plain ? load_other_form(folders.compressed, *forms.plain) : load_prt_asset(folders.compressed);
  for (const auto* form : {&forms.plain, &forms.compressed})
    if (*form) require_colors(**form);
  return forms;
}

ViewLimits limits_of(const AssetForms& forms) {
  ViewLimits limits;
  for (const Technique technique : all_techniques) try {
      require_technique(technique, forms.of(technique));
      limits.techniques.push_back(technique);
    } catch (const WrongUsage&) {
      continue;  // the folder lacks the technique's data
    }
  limits.bands = forms.main().bands;
  limits.channels = forms.main().channels;
  limits.has_reference = forms.plain && !forms.plain->clusters;
  limits.has_charts = !forms.main().is_per_vertex();
  return limits;
}

}  // namespace kiln
