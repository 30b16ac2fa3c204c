// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/readers.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "base/errors.h"

namespace kiln {

SourceMesh read_source_mesh(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".obj") return read_obj(file);
  if (extension == ".ply") return read_ply(file);
  if (extension == ".stl") return read_stl(file);
  if (extension == ".off") return read_off(file);
  if (extension == ".drc") return read_drc(file);
  if (extension == ".gltf" || extension == ".glb") return read_gltf(file);
  if (extension == ".fbx") return read_fbx(file);
  throw BadInput(file.string(), "has the unknown extension '" + extension + "'",
                 "obj, ply, stl, off, drc, gltf, glb or fbx", "convert the mesh");
}

void turn_and_scale(SourceMesh& source, const ImportSettings& settings) {
  const double factor = settings.factor();
  if (settings.up == UpAxis::plus_y && factor == 1) return;
  for (Eigen::Vector3d& place : source.places) place = factor * settings.turned(place);
  for (Eigen::Vector3f& normal : source.normals) normal = settings.turned(normal.cast<double>()).cast<float>();
  source.precision *= factor;
}

}  // namespace kiln
