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

Eigen::Vector3d turned_upright(const Eigen::Vector3d& p, UpAxis up) {
  switch (up) {
    case UpAxis::plus_x:
      return {-p.y(), p.x(), p.z()};
    case UpAxis::minus_x:
      return {p.y(), -p.x(), p.z()};
    case UpAxis::minus_y:
      return {p.x(), -p.y(), -p.z()};
    case UpAxis::plus_z:
      return {p.x(), p.z(), -p.y()};
    case UpAxis::minus_z:
      return {p.x(), -p.z(), p.y()};
    case UpAxis::plus_y:
      break;
  }
  return p;
}

void turn_and_scale(SourceMesh& source, const ImportSettings& settings) {
  const double factor = settings.factor();
  if (settings.up == UpAxis::plus_y && factor == 1) return;
  for (Eigen::Vector3d& place : source.places) place = factor * turned_upright(place, settings.up);
  for (Eigen::Vector3f& normal : source.normals)
    normal = turned_upright(normal.cast<double>(), settings.up).cast<float>();
  source.precision *= factor;
}

}  // namespace kiln
