// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/fbx_geometry.h"

#include <algorithm>
#include <optional>

// Attributes are "layer elements": values mapped to corners, vertices, polygons or everything, directly or by indices
// (FBX SDK 2020, FbxLayerElement).

namespace kiln {

namespace {

enum class Mapping { corner, vertex, polygon, all };

class GeometryReader {
 public:
  GeometryReader(const FbxDocument& document, const FbxObjects::Object& object)
      : document_(document), record_(*object.record), place_("geometry '" + object.name() + "'") {}

  FbxGeometry read() {
    read_vertices();
    read_polygons();
    read_normals();
    read_uvs();
    read_colors();
    read_materials();
    drop_lines();
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    document_.fail(place_ + " " + found, expected);
  }

  void read_vertices() {
    const FbxRecord* record = record_.child("Vertices");
    if (record == nullptr) fail("has no Vertices", "some");
    const std::vector<double> numbers = document_.numbers(*record);
    if (numbers.size() % 3 != 0)
      fail("has " + std::to_string(numbers.size()) + " coordinates", "three for each vertex");
    result_.is_float = document_.holds_floats(*record, numbers);
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      result_.vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }

  /// Reads polygons, whose last corner is stored as -1 - vertex.
  void read_polygons() {
    const FbxRecord* record = record_.child("PolygonVertexIndex");
    if (record == nullptr) fail("has no PolygonVertexIndex", "one");
    const std::vector<std::int64_t> indices = document_.wholes(*record);
    if (indices.size() >= FbxGeometry::none) fail("has too many corners", "fewer than 2^32");
    result_.first_corner.push_back(0);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const bool is_last = indices[i] < 0;
      const std::int64_t vertex = is_last ? -1 - indices[i] : indices[i];
      if (vertex >= static_cast<std::int64_t>(result_.vertices.size()))
        fail("names vertex " + std::to_string(vertex) + " in corner " + std::to_string(i),
             "one of " + std::to_string(result_.vertices.size()) + ", counted from 0");
      const Eigen::Vector3d& position = result_.vertices[static_cast<std::size_t>(vertex)];
      if (!position.allFinite())
        fail("has the vertex " + std::to_string(vertex) + ", whose position is not finite", "finite numbers");
      result_.largest = std::max(result_.largest, position.cwiseAbs().maxCoeff());
      result_.corners.push_back({static_cast<std::uint32_t>(vertex)});
      polygon_of_.push_back(static_cast<std::uint32_t>(result_.first_corner.size() - 1));
      if (is_last) result_.first_corner.push_back(static_cast<std::uint32_t>(i + 1));
    }
    if (result_.first_corner.back() != indices.size()) fail("has a last polygon without an end", "a negative index");
  }

  std::size_t polygon_count() const { return result_.first_corner.size() - 1; }

  Mapping mapping_of(const FbxRecord& layer) const {
    const FbxRecord* record = layer.child("MappingInformationType");
    const std::string_view name = record == nullptr ? "" : record->text(0);
    if (name == "ByPolygonVertex") return Mapping::corner;
    if (name == "ByVertice" || name == "ByVertex") return Mapping::vertex;
    if (name == "ByPolygon") return Mapping::polygon;
    if (name == "AllSame") return Mapping::all;
    fail("maps " + std::string(layer.name) + " '" + std::string(name) + "'",
         "ByPolygonVertex, ByVertice, ByPolygon or AllSame");
  }

  static bool is_indexed(const FbxRecord& layer) {
    const FbxRecord* record = layer.child("ReferenceInformationType");
    return record != nullptr && (record->text(0) == "IndexToDirect" || record->text(0) == "Index");
  }

  /// Sets `member` of all corners to the index of their value in a layer of `count` values; a stored index of -1 means
  /// no value.
  void map(const FbxRecord& layer, const char* indices_name, std::size_t count,
           std::uint32_t FbxGeometry::Corner::*member) {
    const Mapping mapping = mapping_of(layer);
    std::optional<std::vector<std::int64_t>> indices;
    const FbxRecord* record = is_indexed(layer) ? layer.child(indices_name) : nullptr;
    if (record != nullptr) indices = document_.wholes(*record);
    for (std::size_t i = 0; i < result_.corners.size(); ++i) {
      FbxGeometry::Corner& corner = result_.corners[i];
      std::size_t at = 0;
      if (mapping == Mapping::corner) at = i;
      if (mapping == Mapping::vertex) at = corner.vertex;
      if (mapping == Mapping::polygon) at = polygon_of_[i];
      if (indices && at >= indices->size())
        fail("has " + std::to_string(indices->size()) + " indices of " + std::string(layer.name),
             "more than " + std::to_string(at) + ", one for each of what it is mapped to");
      const std::int64_t value = indices ? (*indices)[at] : static_cast<std::int64_t>(at);
      if (value == -1) continue;
      if (value < 0 || value >= static_cast<std::int64_t>(count))
        fail("names value " + std::to_string(value) + " of " + std::string(layer.name) + " in corner " +
                 std::to_string(i),
             "one of " + std::to_string(count) + ", counted from 0");
      corner.*member = static_cast<std::uint32_t>(value);
    }
  }

  /// Returns the numbers of a layer's values, `components` each; nothing where it has none.
  std::vector<double> values(const FbxRecord& layer, const char* name, std::size_t components) const {
    const FbxRecord* record = layer.child(name);
    if (record == nullptr) return {};
    std::vector<double> numbers = document_.numbers(*record);
    if (numbers.size() % components != 0)
      fail("has " + std::to_string(numbers.size()) + " numbers of " + name,
           std::to_string(components) + " for each value");
    return numbers;
  }

  template <class Values>
  void require_finite(const Values& all, std::uint32_t FbxGeometry::Corner::*member, const char* name) const {
    for (const FbxGeometry::Corner& corner : result_.corners)
      if (corner.*member != FbxGeometry::none && !all[corner.*member].allFinite())
        fail(std::string("has a value of ") + name + " that is not finite: " + std::to_string(corner.*member),
             "finite numbers");
  }

  void read_normals() {
    const FbxRecord* layer = record_.child("LayerElementNormal");
    if (layer == nullptr) return;
    const std::vector<double> numbers = values(*layer, "Normals", 3);
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      result_.normals.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    if (result_.normals.empty()) return;
    map(*layer, "NormalsIndex", result_.normals.size(), &FbxGeometry::Corner::normal);
    require_finite(result_.normals, &FbxGeometry::Corner::normal, "Normals");
  }

  void read_uvs() {
    for (const FbxRecord& child : record_.children) result_.uv_sets += child.name == "LayerElementUV";
    const FbxRecord* layer = record_.child("LayerElementUV");
    if (layer == nullptr) return;
    const std::vector<double> numbers = values(*layer, "UV", 2);
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      result_.uvs.emplace_back(static_cast<float>(numbers[i]), static_cast<float>(numbers[i + 1]));
    if (result_.uvs.empty()) return;
    map(*layer, "UVIndex", result_.uvs.size(), &FbxGeometry::Corner::uv);
    require_finite(result_.uvs, &FbxGeometry::Corner::uv, "UV");
  }

  void read_colors() {
    const FbxRecord* layer = record_.child("LayerElementColor");
    if (layer == nullptr) return;
    const std::vector<double> numbers = values(*layer, "Colors", 4);
    for (std::size_t i = 0; i < numbers.size(); i += 4)
      result_.colors.emplace_back(Eigen::Vector3d(numbers[i], numbers[i + 1], numbers[i + 2]).cast<float>());
    if (result_.colors.empty()) return;
    map(*layer, "ColorIndex", result_.colors.size(), &FbxGeometry::Corner::color);
    require_finite(result_.colors, &FbxGeometry::Corner::color, "Colors");
    for (Eigen::Vector3f& color : result_.colors) color = color.cwiseMax(0).cwiseMin(1);
  }

  void read_materials() {
    result_.materials.assign(polygon_count(), 0);
    const FbxRecord* layer = record_.child("LayerElementMaterial");
    const FbxRecord* record = layer == nullptr ? nullptr : layer->child("Materials");
    if (record == nullptr) return;
    const std::vector<std::int64_t> materials = document_.wholes(*record);
    const Mapping mapping = mapping_of(*layer);
    if (mapping == Mapping::all && !materials.empty()) result_.materials.assign(polygon_count(), materials.front());
    if (mapping != Mapping::polygon) return;
    if (materials.size() < polygon_count())
      fail("has " + std::to_string(materials.size()) + " materials of polygons",
           std::to_string(polygon_count()) + ", one for each");
    result_.materials.assign(materials.begin(), materials.begin() + static_cast<std::ptrdiff_t>(polygon_count()));
  }

  void drop_lines() {
    std::vector<FbxGeometry::Corner> corners;
    std::vector<std::uint32_t> first_corner{0};
    std::vector<std::int64_t> materials;
    for (std::size_t i = 0; i < polygon_count(); ++i) {
      const std::uint32_t first = result_.first_corner[i], end = result_.first_corner[i + 1];
      if (end - first < 3) {
        ++result_.lines;
        continue;
      }
      corners.insert(corners.end(), result_.corners.begin() + first, result_.corners.begin() + end);
      first_corner.push_back(static_cast<std::uint32_t>(corners.size()));
      materials.push_back(result_.materials[i]);
    }
    if (result_.lines == 0) return;
    result_.corners = std::move(corners);
    result_.first_corner = std::move(first_corner);
    result_.materials = std::move(materials);
  }

  const FbxDocument& document_;
  const FbxRecord& record_;
  std::string place_;
  std::vector<std::uint32_t> polygon_of_;  // per corner
  FbxGeometry result_;
};

}  // namespace

FbxGeometry read_fbx_geometry(const FbxDocument& document, const FbxObjects::Object& object) {
  return GeometryReader(document, object).read();
}

}  // namespace kiln
