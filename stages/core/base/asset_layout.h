// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

/// Names in the folder of an asset, as `kiln build` lays it out and kiln-report reads it.
namespace kiln::layout {

inline constexpr const char* low_mesh = "low.drc";
inline constexpr const char* atlas_mesh = "atlas.drc";
inline constexpr const char* atlas_picture = "atlas.png";
inline constexpr const char* normals_folder = "normals";
inline constexpr const char* baked_folder = "prt";
inline constexpr const char* lod_folder = "lod";
inline constexpr const char* compressed_folder = "small";
inline constexpr const char* probes_folder = "probes";
inline constexpr const char* report_page = "report.html";

/// Maps in the folder of the normals.
inline constexpr const char* normal_map = "normal.png";
inline constexpr const char* own_normal_map = "normal_of_own_size.png";  ///< where that is not the size of the maps
inline constexpr const char* position_map = "position.exr";
inline constexpr const char* coverage_map = "coverage.png";
inline constexpr const char* match_map = "match.png";
inline constexpr const char* albedo_map = "albedo.png";    ///< where the albedo varies
inline constexpr const char* opacity_map = "opacity.png";  ///< where the high mesh is not opaque everywhere

/// The record that a stage writes into `folder`, its outputs' own.
inline std::filesystem::path record_in(const std::filesystem::path& folder, const std::string& stage) {
  return folder / (stage + ".json");
}

/// The folder of a stage's outputs in that of the asset.
inline std::filesystem::path stage_folder(const std::filesystem::path& asset, const std::string& stage) {
  if (stage == "normals") return asset / normals_folder;
  if (stage == "bake") return asset / baked_folder;
  if (stage == "lod") return asset / lod_folder;
  if (stage == "compress") return asset / compressed_folder;
  if (stage == "probes") return asset / probes_folder;
  return asset;
}

/// Where a bake into a folder keeps its checkpoints until it is done.
inline std::filesystem::path checkpoint_folder(const std::filesystem::path& baked) {
  return baked.string() + ".checkpoint";
}

/// The record of a stage in the folder of an asset.
inline std::filesystem::path record(const std::filesystem::path& asset, const std::string& stage) {
  return record_in(stage_folder(asset, stage), stage);
}

}  // namespace kiln::layout
