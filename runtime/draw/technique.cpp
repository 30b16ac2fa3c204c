// SPDX-License-Identifier: MIT
#include "runtime/draw/technique.h"

#include "base/errors.h"

namespace kiln {

std::string technique_name(Technique technique) {
  switch (technique) {
    case Technique::phong:
      return "phong";
    case Technique::normal_map:
      return "normal-map";
    case Technique::vertex_prt:
      return "vertex-prt";
    case Technique::textured_prt:
      return "textured-prt";
    case Technique::compressed:
      break;
  }
  return "compressed";
}

std::string technique_caption(Technique technique, const PrtAsset& asset) {
  const std::string bits = std::to_string(asset.bits) + " bits";
  switch (technique) {
    case Technique::phong:
      return "Phong";
    case Technique::normal_map:
      return "Phong with normal map";
    case Technique::vertex_prt:
      return "Per-vertex PRT, " + std::to_string(asset.mesh.positions.size()) + " vertices";
    case Technique::textured_prt:
      return "Textured PRT, " + std::to_string(asset.planes.size()) + " planes of " + bits;
    case Technique::compressed:
      break;
  }
  const int clusters = asset.clusters ? asset.clusters->count : 1;
  return "Compressed, " + std::to_string(clusters) + (clusters == 1 ? " basis of " : " bases of ") +
         std::to_string(asset.planes.size());
}

Technique natural_technique(const PrtAsset& asset) {
  if (asset.is_per_vertex()) return Technique::vertex_prt;
  return asset.clusters ? Technique::compressed : Technique::textured_prt;
}

void require_technique(Technique technique, const PrtAsset& asset) {
  const std::string place = asset.ranges_file.string();
  const auto fail = [&](const std::string& found, const std::string& expected) {
    throw WrongUsage("technique " + technique_name(technique) + ": found " + place + ", " + found + "; expected " +
                     expected);
  };
  const bool textured = technique == Technique::textured_prt || technique == Technique::compressed;
  if (asset.is_per_vertex() && (textured || technique == Technique::normal_map))
    fail("an asset without textures", "an asset baked into texels, or --technique vertex-prt");
  if (technique == Technique::textured_prt && asset.clusters)
    fail("a compressed asset", "the folder that it was compressed from");
  if (technique == Technique::compressed && !asset.clusters)
    fail("an asset that is not compressed", "the output of kiln-compress, or --compressed FOLDER");
  if (technique == Technique::normal_map && asset.normals_file.empty())
    fail("an asset without a normal map", "one baked with --detail, and with --ship normal=8 or normal=16");
}

}  // namespace kiln
