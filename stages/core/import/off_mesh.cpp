// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/off_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "import/readers.h"
#include "import/stored_colors.h"
#include "import/text_words.h"

namespace kiln {

OffMesh::OffMesh(const std::filesystem::path& file, const OffHeader& header, std::size_t byte_count)
    : path_(file), file_(file.string()), header_(header) {
  constexpr std::size_t least_of_vertex = 5, least_of_face = 7;  // bytes: "0 0 0", "3 0 0 0"
  const auto most = [&](std::uint64_t count, std::size_t least) { return std::min(count, byte_count / least + 1); };
  if (most(header.vertex_count, least_of_vertex) >= SourceMesh::none)
    throw BadInput(file_, std::to_string(header.vertex_count) + " vertices", "fewer than 4294967295", "split the mesh");
  mesh_.places.reserve(most(header.vertex_count, least_of_vertex));
  mesh_.faces.reserve(most(header.face_count, least_of_face));
  mesh_.corners.reserve(3 * most(header.face_count, least_of_face));
}

std::size_t OffMesh::place_size() const { return 3u + (header_.has_weights ? 1 : 0) + (header_.has_normals ? 3 : 0); }

void OffMesh::add_vertex(std::span<const double> numbers) {
  const double weight = header_.has_weights ? numbers[3] : 1;
  mesh_.places.emplace_back(numbers[0] / weight, numbers[1] / weight, numbers[2] / weight);
  if (!header_.has_normals) return;
  const auto normal = numbers.last(3);
  mesh_.normals.emplace_back(Eigen::Vector3d(normal[0], normal[1], normal[2]).cast<float>());
}

void OffMesh::add_uv(double u, double v) { mesh_.uvs.emplace_back(Eigen::Vector2d(u, v).cast<float>()); }

std::string OffMesh::where() const {
  const std::uint32_t line = mesh_.faces.back().line;
  return line == 0 ? file_ : file_ + ":" + std::to_string(line);
}

void OffMesh::begin_face(double corner_count, std::size_t room, std::uint32_t line) {
  SourceMesh::Face face;
  face.first_corner = static_cast<std::uint32_t>(mesh_.corners.size());
  face.line = line;
  mesh_.faces.push_back(face);
  const auto name = [&] { return face_name(mesh_.faces.size() - 1); };
  if (!(corner_count >= 3) || corner_count != std::trunc(corner_count))
    throw BadInput(where(), name() + " has fewer than three corners", "three corners or more", export_again);
  if (corner_count > static_cast<double>(room)) throw_truncated(name());
  if (mesh_.corners.size() + static_cast<std::size_t>(corner_count) >= SourceMesh::none)
    throw BadInput(where(), name() + " is beyond 4294967294 corners", "fewer corners", "split the mesh");
}

void OffMesh::add_corner(double index) {
  const bool is_there = index >= 0 && index < static_cast<double>(mesh_.places.size()) && index == std::trunc(index);
  if (!is_there)
    throw BadInput(where(),
                   face_name(mesh_.faces.size() - 1) + " refers to the vertex of index " +
                       std::to_string(static_cast<std::int64_t>(index)),
                   "an index from 0 to below " + std::to_string(mesh_.places.size()) + ", the number of vertices",
                   export_again);
  mesh_.corners.push_back({.place = static_cast<std::uint32_t>(index)});
  ++mesh_.faces.back().corner_count;
}

std::string OffMesh::next_vertex_name() const {
  return "vertex " + std::to_string(mesh_.places.size() + 1) + " of " + std::to_string(header_.vertex_count);
}

std::string OffMesh::face_name(std::size_t face) const {
  return "face " + std::to_string(face + 1) + " of " + std::to_string(header_.face_count);
}

void OffMesh::throw_truncated(const std::string& name) const {
  throw BadInput(file_, "is truncated: it ends before or within " + name, "a whole OFF file", export_again);
}

void OffMesh::take_colors() {
  if (vertex_colors.any_negative() && !header_.has_colors) {
    warnings.emplace_back("the numbers behind the coordinates of vertices are no colours and are not used");
  } else if (vertex_colors.count() > 0 && vertex_colors.count() < mesh_.places.size()) {
    warnings.push_back("the colours of vertices are not used, because " + std::to_string(vertex_colors.count()) +
                       " of " + std::to_string(mesh_.places.size()) + " alone have one");
  } else if (vertex_colors.count() > 0) {
    mesh_.colors = vertex_colors.take(mesh_.places.size(), color_scale);
    check_vertex_colors(file_, mesh_);
  }
  if (mapped_colors_ > 0)
    warnings.push_back("the colours of " + counted(mapped_colors_, "face", "faces") +
                       " are indices into a map of colours that is not in the file, and are not used");
  if (face_colors.count() > 0 && !mesh_.colors.empty())
    warnings.emplace_back("the colours of faces are not used, because there are colours of vertices");
  else if (face_colors.count() > 0)
    use_face_colors(mesh_, face_colors.take(mesh_.faces.size(), color_scale),
                    path_.filename().string() + ": colours of faces");
  color_scale.add_warnings(warnings);
}

SourceMesh OffMesh::take() {
  if (mesh_.faces.empty())
    throw BadInput(file_, mesh_.places.empty() ? "has no faces" : "has points and no faces",
                   "a mesh of triangles or polygons",
                   mesh_.places.empty() ? export_again : "make a mesh of the points first");
  const double largest =
      largest_used_coordinate(file_, mesh_, [&](std::uint32_t place) { return vertex_name(mesh_, place); });
  mesh_.precision = header_.is_binary ? float_precision(largest) : text_precision.of(largest);
  std::uint64_t broken = 0;
  for (SourceMesh::Corner& corner : mesh_.corners) {
    if (!mesh_.uvs.empty() && mesh_.uvs[corner.place].allFinite()) corner.uv = corner.place;
    if (!mesh_.normals.empty() && mesh_.normals[corner.place].allFinite()) corner.normal = corner.place;
    broken += (!mesh_.uvs.empty() && corner.uv == SourceMesh::none) ||
              (!mesh_.normals.empty() && corner.normal == SourceMesh::none);
  }
  if (broken > 0)
    warnings.push_back("normals or texture coordinates at " + counted(broken, "corner", "corners") +
                       " are not finite numbers and are not used");
  take_colors();
  mesh_.warnings.insert(mesh_.warnings.begin(), warnings.begin(), warnings.end());
  return std::move(mesh_);
}

}  // namespace kiln
