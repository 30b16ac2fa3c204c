// SPDX-License-Identifier: GPL-3.0-or-later
// PLY files, the meaning of elements and properties: [Turk 1994]; strips of triangles after the Stanford 3D Scanning
// Repository's files; texture coordinates of corners and numbers of textures after MeshLab (vcglib,
// wrap/io_trimesh/import_ply.h).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "base/files.h"
#include "import/coordinates.h"
#include "import/ply_colors.h"
#include "import/ply_rows.h"
#include "import/readers.h"
#include "import/stored_colors.h"
#include "import/text_words.h"

namespace kiln {

namespace {

namespace fs = std::filesystem;

constexpr char expected_mesh[] = "a mesh of triangles or polygons";

using Indices = std::vector<std::size_t>;

Indices find_colors(const PlyElement& element) {
  return element.find_group(
      {{"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}});
}

Indices find_alpha(const PlyElement& element) { return element.find_group({{"alpha"}, {"diffuse_alpha"}, {"a"}}); }

std::optional<std::size_t> find_corners(const PlyElement& element) {
  for (const char* name : {"vertex_indices", "vertex_index"})
    if (const auto found = element.find(name, true)) return found;
  return std::nullopt;
}

PlyRow row_of(const PlyElement& element) {
  PlyRow row;
  row.scalars.resize(element.properties.size());
  row.lists.resize(element.properties.size());
  return row;
}

Eigen::Vector3d three(const PlyRow& row, const Indices& indices) {
  return {row.scalars[indices[0]], row.scalars[indices[1]], row.scalars[indices[2]]};
}

/// Properties of a face that are read, by their indices.
struct FaceProperties {
  std::size_t corners = 0;
  Indices color, alpha;
  std::optional<std::size_t> uvs, texture;
};

class PlyReader {
 public:
  PlyReader(const fs::path& file, std::string_view text)
      : path_(file),
        file_(file.string()),
        header_(read_ply_header(file_, text)),
        rows_(make_ply_rows(file_, header_, text)) {
    mesh_.warnings = header_.warnings;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertex_count_ = element.count;
      has_face_uvs_ |= element.name == "face" && element.count > 0 && element.find("texcoord", true);
    }
  }

  SourceMesh read() {
    for (const PlyElement& element : header_.elements) read_element(element);
    rows_->finish(mesh_.warnings);
    if (mesh_.faces.empty())
      throw BadInput(file_, mesh_.places.empty() ? "has no faces" : "has points and no faces", expected_mesh,
                     mesh_.places.empty() ? export_again : "make a mesh of the points first");
    find_precision();
    finish_normals();
    finish_uvs();
    finish_textures();
    finish_colors();
    return std::move(mesh_);
  }

 private:
  void read_element(const PlyElement& element) {
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face" && element.count > 0) return read_faces(element);
    if (element.name == "tristrips" && element.count > 0) return read_strips(element);
    rows_->skip(element);
    if (element.count > 0 && element.name != "face" && element.name != "tristrips")
      mesh_.warnings.push_back(counted(element.count, "row", "rows") + " of the element " + in_quotes(element.name) +
                               " are not used");
  }

  std::string where(const PlyElement& element) const { return file_ + ":" + std::to_string(element.line); }

  Indices find_places(const PlyElement& element) const {
    Indices found;
    for (const char* name : {"x", "y", "z"}) {
      const auto index = element.find(name, false);
      if (!index)
        throw BadInput(where(element), std::string("the vertices have no ") + name, "properties x, y and z of vertices",
                       export_again);
      found.push_back(*index);
    }
    return found;
  }

  void read_vertices(const PlyElement& element) {
    const Indices place = find_places(element), color = find_colors(element), alpha = find_alpha(element);
    const Indices normal = element.find_group({{"nx", "ny", "nz"}});
    Indices uv;
    if (!has_face_uvs_)
      uv = element.find_group({{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}});
    std::vector<PlyUse> uses(element.properties.size(), PlyUse::none);
    for (const Indices& wanted : {color, alpha, normal, uv})
      for (const std::size_t i : wanted) uses[i] = PlyUse::value;
    for (const std::size_t i : place) {
      uses[i] = PlyUse::coordinate;
      has_floats_ |= element.properties[i].type == PlyType::float32;
    }
    if (!color.empty()) vertex_colors_.emplace("vertices", element.properties[color[0]].type);
    reserve_vertices(element, !normal.empty(), !uv.empty());

    rows_->begin(element, uses);
    PlyRow row = row_of(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      rows_->next(row);
      mesh_.places.push_back(three(row, place));
      if (!normal.empty()) mesh_.normals.emplace_back(three(row, normal).cast<float>());
      if (!uv.empty()) mesh_.uvs.emplace_back(Eigen::Vector2d(row.scalars[uv[0]], row.scalars[uv[1]]).cast<float>());
      if (!color.empty()) vertex_colors_->add(row.scalars[color[0]], row.scalars[color[1]], row.scalars[color[2]]);
      if (!color.empty() && !alpha.empty()) vertex_colors_->add_alpha(row.scalars[alpha[0]]);
    }
  }

  void reserve_vertices(const PlyElement& element, bool has_normals, bool has_uvs) {
    const std::uint64_t most = rows_->most_rows(element);
    if (most >= SourceMesh::none)
      throw BadInput(where(element), std::to_string(element.count) + " vertices", "fewer than 4294967295",
                     "split the mesh");
    mesh_.places.reserve(most);
    if (has_normals) mesh_.normals.reserve(most);
    if (has_uvs) mesh_.uvs.reserve(most);
  }

  std::size_t corners_property(const PlyElement& element) const {
    if (const auto corners = find_corners(element)) return *corners;
    throw BadInput(where(element), "the element " + in_quotes(element.name) + " has no list of vertices",
                   "a property 'list uchar int vertex_indices'", export_again);
  }

  FaceProperties face_properties(const PlyElement& element, std::vector<PlyUse>& uses) const {
    FaceProperties found;
    found.corners = corners_property(element);
    found.color = find_colors(element);
    found.alpha = find_alpha(element);
    found.uvs = element.find("texcoord", true);
    found.texture = element.find("texnumber", false);
    uses.assign(element.properties.size(), PlyUse::none);
    uses[found.corners] = PlyUse::value;
    for (const Indices& wanted : {found.color, found.alpha})
      for (const std::size_t i : wanted) uses[i] = PlyUse::value;
    if (found.uvs) uses[*found.uvs] = PlyUse::value;
    if (found.texture) uses[*found.texture] = PlyUse::value;
    return found;
  }

  void read_faces(const PlyElement& element) {
    std::vector<PlyUse> uses;
    const FaceProperties properties = face_properties(element, uses);
    const Indices& color = properties.color;
    if (!color.empty() && !face_colors_) face_colors_.emplace("faces", element.properties[color[0]].type);
    mesh_.faces.reserve(mesh_.faces.size() + rows_->most_rows(element));
    mesh_.corners.reserve(mesh_.corners.size() + 3 * rows_->most_rows(element));

    rows_->begin(element, uses);
    PlyRow row = row_of(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      rows_->next(row);
      add_face(row.lists[properties.corners], row.line,
               [&] { return "face " + std::to_string(i + 1) + " of " + std::to_string(element.count); });
      if (properties.uvs) add_face_uvs(row.lists[*properties.uvs]);
      if (properties.texture) {
        textures_of_faces_.resize(mesh_.faces.size());
        textures_of_faces_.back() = row.scalars[*properties.texture];
      }
      if (color.empty()) continue;
      while (face_colors_->size() + 1 < mesh_.faces.size()) face_colors_->add_none();
      face_colors_->add(row.scalars[color[0]], row.scalars[color[1]], row.scalars[color[2]]);
      if (!properties.alpha.empty()) face_colors_->add_alpha(row.scalars[properties.alpha[0]]);
    }
    names_textures_ |= properties.texture.has_value();
  }

  template <class Name>
  std::uint32_t checked_vertex(double index, std::uint32_t line, const Name& name) const {
    if (index >= 0 && index < static_cast<double>(vertex_count_) && index == std::trunc(index))
      return static_cast<std::uint32_t>(index);
    const std::string where = line == 0 ? file_ : file_ + ":" + std::to_string(line);
    std::string text = std::to_string(index);
    if (index == std::trunc(index)) text.erase(text.find('.'));
    throw BadInput(where, name() + " refers to the vertex of index " + text,
                   "an index from 0 to below " + std::to_string(vertex_count_) + ", the number of vertices",
                   export_again);
  }

  template <class Name>
  void add_face(const std::vector<double>& corners, std::uint32_t line, const Name& name) {
    if (corners.size() < 3)
      throw BadInput(line == 0 ? file_ : file_ + ":" + std::to_string(line), name() + " has fewer than three corners",
                     "three corners or more", export_again);
    if (mesh_.corners.size() + corners.size() >= SourceMesh::none)
      throw BadInput(file_, name() + " is beyond 4294967294 corners", "fewer corners", "split the mesh");
    SourceMesh::Face face;
    face.first_corner = static_cast<std::uint32_t>(mesh_.corners.size());
    face.corner_count = static_cast<std::uint32_t>(corners.size());
    face.line = line;
    for (const double index : corners) mesh_.corners.push_back({.place = checked_vertex(index, line, name)});
    mesh_.faces.push_back(face);
  }

  /// Gives the last face the texture coordinates of its corners.
  void add_face_uvs(const std::vector<double>& uvs) {
    const SourceMesh::Face& face = mesh_.faces.back();
    if (uvs.size() != 2 * static_cast<std::size_t>(face.corner_count)) {
      faces_of_other_uvs_ += !uvs.empty();
      return;
    }
    for (std::uint32_t i = 0; i < face.corner_count; ++i) {
      mesh_.corners[face.first_corner + i].uv = static_cast<std::uint32_t>(mesh_.uvs.size());
      mesh_.uvs.emplace_back(Eigen::Vector2d(uvs[2 * i], uvs[2 * i + 1]).cast<float>());
    }
  }

  void read_strips(const PlyElement& element) {
    const std::size_t corners = corners_property(element);
    std::vector<PlyUse> uses(element.properties.size(), PlyUse::none);
    uses[corners] = PlyUse::value;
    rows_->begin(element, uses);
    PlyRow row = row_of(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      rows_->next(row);
      add_strip(row.lists[corners], row.line,
                [&] { return "strip " + std::to_string(i + 1) + " of " + std::to_string(element.count); });
    }
  }

  /// Adds the triangles of a strip, every second one reversed; -1 begins another strip.
  template <class Name>
  void add_strip(const std::vector<double>& strip, std::uint32_t line, const Name& name) {
    std::vector<double> triangle(3);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] == -1 || strip[i] == std::numeric_limits<std::uint32_t>::max()) {
        begin = i + 1;
        continue;
      }
      checked_vertex(strip[i], line, name);
      if (i < begin + 2) continue;
      triangle = {strip[i - 2], strip[i - 1], strip[i]};
      if ((i - begin) % 2 == 1) std::swap(triangle[0], triangle[1]);
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      add_face(triangle, line, name);
    }
  }

  void find_precision() {
    const double largest =
        largest_used_coordinate(file_, mesh_, [&](std::uint32_t place) { return vertex_name(mesh_, place); });
    const bool is_text = header_.format == PlyHeader::Format::ascii;
    const double text = rows_->text_precision(largest);
    if (is_text && text == 0) return;  // whole numbers
    mesh_.precision = std::max(text, has_floats_ ? float_precision(largest) : 0);
  }

  void finish_normals() {
    if (mesh_.normals.empty()) return;
    std::uint64_t broken = 0;
    for (SourceMesh::Corner& corner : mesh_.corners)
      if (mesh_.normals[corner.place].allFinite())
        corner.normal = corner.place;
      else
        ++broken;
    if (broken > 0)
      mesh_.warnings.push_back("normals at " + counted(broken, "corner", "corners") +
                               " are not finite numbers and are not used");
  }

  void finish_uvs() {
    if (mesh_.uvs.empty()) return;
    std::uint64_t broken = 0;
    for (SourceMesh::Corner& corner : mesh_.corners) {
      if (!has_face_uvs_) corner.uv = corner.place;
      if (corner.uv == SourceMesh::none || mesh_.uvs[corner.uv].allFinite()) continue;
      corner.uv = SourceMesh::none;
      ++broken;
    }
    if (broken > 0)
      mesh_.warnings.push_back("texture coordinates at " + counted(broken, "corner", "corners") +
                               " are not finite numbers and are not used");
    if (faces_of_other_uvs_ > 0)
      mesh_.warnings.push_back(counted(faces_of_other_uvs_, "face has", "faces have") +
                               " another number of texture coordinates than of corners, which are not used");
  }

  SourceMaterial material_of(const PlyTexture& texture) const {
    const fs::path folder = folder_of(path_);
    fs::path picture = folder / texture.name;
    if (texture.name.find('\\') != std::string::npos && !fs::exists(picture)) {  // as Windows has it
      std::string name = texture.name;
      std::ranges::replace(name, '\\', '/');
      picture = folder / name;
    }
    SourceMaterial material;
    material.name = texture.name;
    material.place = file_ + ":" + std::to_string(texture.line);
    material.texture = SourceTexture{.picture = {picture, nullptr, texture.name}, .place = material.place};
    return material;
  }

  void finish_textures() {
    if (header_.textures.empty()) return;
    if (mesh_.uvs.empty()) {
      mesh_.warnings.push_back("the texture " + in_quotes(header_.textures[0].name) +
                               " is not used, because there are no texture coordinates");
      return;
    }
    if (header_.textures.size() > 1 && !names_textures_)
      mesh_.warnings.push_back("of " + std::to_string(header_.textures.size()) +
                               " textures the first alone is used, because faces have no 'texnumber'");
    for (const PlyTexture& texture : header_.textures) mesh_.materials.push_back(material_of(texture));
    textures_of_faces_.resize(mesh_.faces.size());
    std::uint64_t others = 0;
    for (std::size_t i = 0; i < mesh_.faces.size(); ++i) {
      const double number = textures_of_faces_[i];
      if (number >= 0 && number < static_cast<double>(mesh_.materials.size()))
        mesh_.faces[i].material = static_cast<std::int32_t>(number);
      else if (number != -1)
        ++others;
    }
    if (others > 0)
      mesh_.warnings.push_back(counted(others, "face has", "faces have") +
                               " the number of a texture that is not there, and no texture here");
  }

  void finish_colors() {
    if (vertex_colors_) {
      mesh_.colors = vertex_colors_->take(mesh_.warnings);
      check_vertex_colors(file_, mesh_);
    }
    if (!face_colors_) return;
    const auto unused = [&](const std::string& other) {
      mesh_.warnings.push_back("the colours of faces are not used, because there are " + other);
    };
    if (!mesh_.materials.empty()) return unused("textures");
    if (!mesh_.colors.empty()) return unused("colours of vertices");
    while (face_colors_->size() < mesh_.faces.size()) face_colors_->add_none();
    use_face_colors(mesh_, face_colors_->take(mesh_.warnings), path_.filename().string() + ": colours of faces");
  }

  const fs::path path_;
  const std::string file_;
  const PlyHeader header_;
  const std::unique_ptr<PlyRows> rows_;
  SourceMesh mesh_;
  std::uint64_t vertex_count_ = 0;
  bool has_face_uvs_ = false, has_floats_ = false, names_textures_ = false;
  std::optional<PlyColors> vertex_colors_, face_colors_;
  std::vector<double> textures_of_faces_;  ///< texture number of each face; trailing ones may be left out
  std::uint64_t faces_of_other_uvs_ = 0;
};

}  // namespace

SourceMesh read_ply(const fs::path& file) {
  const std::string text = read_text(file);
  if (text.empty()) throw BadInput(file.string(), "is empty", expected_mesh, export_again);
  return PlyReader(file, text).read();
}

}  // namespace kiln
