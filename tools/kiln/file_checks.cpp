// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/file_checks.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <set>

#include "base/json.h"
#include "kiln/made_meshes.h"
#include "kiln/stage_state.h"
#include "material/material_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Says why a file cannot be read at all; empty if it can.
std::string fault_of_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return "does not exist";
  if (fs::is_directory(file, error)) return "is a folder";
  if (fs::is_regular_file(file, error) && fs::file_size(file, error) == 0) return "is empty";
  if (!std::ifstream(file, std::ios::binary)) return fmt::format("cannot be opened ({})", std::strerror(errno));
  return "";
}

std::string fault_of_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  constexpr std::string_view known[] = {".obj", ".ply", ".stl", ".off", ".drc", ".gltf", ".glb", ".fbx"};
  if (std::find(std::begin(known), std::end(known), extension) != std::end(known)) return "";
  return extension.empty() ? "has no extension" : fmt::format("has the unknown extension '{}'", extension);
}

/// Tests whether a mesh was taken out of an archive before: then it is there, and the next build checks whether the
/// archive is the same.
bool was_extracted(const Pipeline& pipeline, const Asset& asset) {
  const fs::path file = pipeline.folder / pipeline.output / ".kiln" / asset.name / "extract.state.json";
  std::optional<StageState> state = load_state(file);
  if (!state || !state->inputs.contains(asset.archive)) return false;
  FileHashes hashes(pipeline.folder);
  const FileStamp& before = state->inputs.at(asset.archive);
  const std::optional<FileStamp> now = hashes.stamp(asset.archive, &before);
  return now && now->hash == before.hash && state->key.find(shell_quoted(asset.member)) != std::string::npos;
}

void check_mesh(const Pipeline& pipeline, const Asset& asset, std::vector<BadInput>& faults) {
  if (!asset.square.empty()) return;
  const bool packed = !asset.archive.empty();
  const fs::path source = packed ? asset.archive : asset.mesh;
  const auto fail = [&](const std::string& fault, const std::string& expected, const std::string& remedy) {
    faults.emplace_back(
        asset.where,
        fmt::format("the {} of '{}', {}, {}", packed ? "archive" : "mesh", asset.name, source.string(), fault),
        expected, remedy);
  };
  const char* check_path = "check the path, or install the package it comes from (tools/setup)";
  if (const std::string fault = fault_of_file(pipeline.folder / source); !fault.empty())
    return fail(fault, packed ? "a tar file" : "a file", check_path);
  const fs::path mesh = packed ? fs::path(asset.member) : asset.mesh;
  if (const std::string fault = fault_of_extension(mesh); !fault.empty())
    return fail((packed ? "has the member '" + asset.member + "', which " : "") + fault, what_a_mesh_is,
                "convert the mesh");
  if (packed && !was_extracted(pipeline, asset) && !has_member(fs::absolute(pipeline.folder / source), asset.member))
    fail(fmt::format("has no member '{}'", asset.member), "a tar file with that member",
         fmt::format("see tar --list --file {}", shell_quoted(source.string())));
}

/// Checks the files that settings name, each path once: usually all stages get a texture from the same line.
void check_named_files(const Pipeline& pipeline, const Asset& asset, std::vector<BadInput>& faults,
                       bool textures_alone = false) {
  std::set<std::string> seen;
  for (const StageInfo* stage : all_stages()) {
    const auto settings = asset.settings.find(stage->name);
    if (settings == asset.settings.end()) continue;
    const StageOptions options = stage->options();
    for (const auto& [name, file] : settings->second) {
      if (name == "reflectance-of" && seen.insert(file).second)
        for (const auto& [material, of_material] : reflectances_of_materials(file))
          if (const std::string fault = fault_of_file(pipeline.folder / of_material);
              !fault.empty() && !is_test_sample(of_material))
            faults.emplace_back(asset.setting_lines.at(stage->name).at(name),
                                fmt::format("the reflectance of material '{}' of '{}', {}, {}", material, asset.name,
                                            of_material, fault),
                                "a file", "check the path");
      const bool is_texture = name == "albedo-texture" || name == "opacity-texture";
      if (name == "reflectance" && is_test_sample(file)) continue;
      if (!options.find(name)->names_file || (textures_alone && !is_texture && name != "reflectance") ||
          !seen.insert(file).second)
        continue;
      const bool is_mesh = name == "low" || name == "cage-mesh";
      const fs::path path = pipeline.folder / file;
      const std::string fault = is_mesh ? fault_of_mesh(path) : fault_of_file(path);
      if (fault.empty()) continue;
      const std::string what = is_texture ? "texture" : name == "low" ? "low mesh" : name;
      faults.emplace_back(asset.setting_lines.at(stage->name).at(name),
                          fmt::format("the {} of '{}', {}, {}", what, asset.name, file, fault),
                          is_texture ? "a picture"
                          : is_mesh  ? what_a_mesh_is
                                     : "a file",
                          "check the path");
    }
  }
}

}  // namespace

std::string fault_of_mesh(const fs::path& file) {
  const std::string fault = fault_of_file(file);
  return fault.empty() ? fault_of_extension(file) : fault;
}

std::vector<BadInput> file_faults(const Pipeline& pipeline, const Asset& asset) {
  std::vector<BadInput> faults;
  check_mesh(pipeline, asset, faults);
  check_named_files(pipeline, asset, faults);
  if (!pipeline.places.contains(asset.name)) return faults;
  for (const Asset& other : pipeline.assets) {
    if (other.name == asset.name || !pipeline.places.contains(other.name)) continue;
    check_mesh(pipeline, other, faults);
    if (effective_setting(asset.settings, "bake", "bounces") != "0") check_named_files(pipeline, other, faults, true);
  }
  return faults;
}

}  // namespace kiln
