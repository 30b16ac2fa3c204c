// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/files.h"
#include "import/readers.h"
#include "mesh/draco_decode.h"

// Draco joins its attributes to points, so a vertex appears once for every set of attributes, and is returned so.

namespace kiln {

namespace {

constexpr char encode_again[] = "encode the mesh again, or run the stage that writes it";

/// Calls `take` with the numbers of every point in turn: `components` of them, 0 where the attribute has fewer.
template <int components, class Take>
void for_each_value(const draco::Mesh& source, const draco::PointAttribute& attribute, const Take& take) {
  for (std::uint32_t i = 0; i < source.num_points(); ++i) {
    Eigen::Matrix<double, components, 1> value = Eigen::Matrix<double, components, 1>::Zero();
    attribute.ConvertValue<double>(attribute.mapped_index(draco::PointIndex(i)), components, value.data());
    take(value);
  }
}

/// Returns the divisor of stored colours: whole numbers are normalised even where the file does not say so.
double color_range(const draco::PointAttribute& attribute) {
  if (attribute.normalized()) return 1;
  switch (attribute.data_type()) {
    case draco::DT_UINT8:
      return 255;
    case draco::DT_UINT16:
      return 65535;
    default:
      return 1;
  }
}

void read_attributes(const draco::Mesh& source, SourceMesh& mesh) {
  using draco::GeometryAttribute;
  if (const auto* positions = source.GetNamedAttribute(GeometryAttribute::POSITION))
    for_each_value<3>(source, *positions, [&](const Eigen::Vector3d& value) { mesh.places.push_back(value); });
  if (const auto* normals = source.GetNamedAttribute(GeometryAttribute::NORMAL))
    for_each_value<3>(source, *normals, [&](const Eigen::Vector3d& v) { mesh.normals.emplace_back(v.cast<float>()); });
  if (const auto* uvs = source.GetNamedAttribute(GeometryAttribute::TEX_COORD))
    for_each_value<2>(source, *uvs, [&](const Eigen::Vector2d& value) { mesh.uvs.emplace_back(value.cast<float>()); });
  if (const auto* colors = source.GetNamedAttribute(GeometryAttribute::COLOR)) {
    const bool is_grey = colors->num_components() < 3;
    const double range = color_range(*colors);
    for_each_value<3>(source, *colors, [&](const Eigen::Vector3d& value) {
      const Eigen::Vector3d color = is_grey ? Eigen::Vector3d::Constant(value[0]) : value;
      mesh.colors.emplace_back((color / range).cwiseMax(0).cwiseMin(1).cast<float>());
    });
  }
}

void require_finite(const SourceMesh& mesh, const std::string& name) {
  const auto fail = [&name](const char* what, std::uint32_t point) {
    throw BadInput(name, std::string(what) + " of point " + std::to_string(point) + " is not finite", "finite numbers",
                   encode_again);
  };
  for (const SourceMesh::Corner& corner : mesh.corners) {
    if (!mesh.places[corner.place].allFinite()) fail("the position", corner.place);
    if (!mesh.normals.empty() && !mesh.normals[corner.place].allFinite()) fail("the normal", corner.place);
    if (!mesh.uvs.empty() && !mesh.uvs[corner.place].allFinite()) fail("the texture coordinate", corner.place);
  }
}

}  // namespace

SourceMesh read_drc(const std::filesystem::path& file) {
  const std::string bytes = read_text(file);
  const std::string name = file.string();
  const auto source =
      decode_draco({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name, encode_again);
  SourceMesh mesh;
  mesh.is_unwelded = true;
  read_attributes(*source, mesh);
  if (source->NumNamedAttributes(draco::GeometryAttribute::TEX_COORD) > 1)
    mesh.warnings.emplace_back("only the first of its sets of texture coordinates is used");
  if (mesh.places.empty() || source->num_faces() == 0)
    throw BadInput(name, "has no triangles", "a Draco mesh of triangles", encode_again);
  for (std::uint32_t i = 0; i < source->num_faces(); ++i) {
    mesh.faces.push_back({3 * i, 3, -1, 0, 0});
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t point = source->face(draco::FaceIndex(i))[corner].value();
      if (point >= source->num_points())
        throw BadInput(name, "triangle " + std::to_string(i) + " names point " + std::to_string(point),
                       "one of " + std::to_string(source->num_points()) + " points", encode_again);
      mesh.corners.push_back(
          {point, mesh.uvs.empty() ? SourceMesh::none : point, mesh.normals.empty() ? SourceMesh::none : point});
    }
  }
  require_finite(mesh, name);
  // Kiln's own files may name the origin of their coordinates.
  const Eigen::Vector3d origin = draco_origin(*source);
  double largest = 0;
  for (const SourceMesh::Corner& corner : mesh.corners)
    largest = std::max(largest, mesh.places[corner.place].cwiseAbs().maxCoeff());
  mesh.precision = std::ldexp(largest, -23);
  if (!origin.isZero(0))
    for (Eigen::Vector3d& place : mesh.places) place += origin;
  return mesh;
}

}  // namespace kiln
