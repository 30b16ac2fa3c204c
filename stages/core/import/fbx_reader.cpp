// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <unordered_map>

#include "import/fbx_geometry.h"
#include "import/fbx_material.h"
#include "import/fbx_objects.h"
#include "import/mesh_transform.h"
#include "import/part_names.h"
#include "import/readers.h"

// The transform of a model follows the FBX SDK's reference, "Computing transformation matrices": T Roff Rp Rpre R
// Rpost^-1 Rp^-1 Soff Sp S Sp^-1. Beneath it is the transform of its geometry, which no other model inherits.

namespace kiln {

namespace {

using Object = FbxObjects::Object;
using Vector = Eigen::Vector3d;

Eigen::Affine3d moved(const Vector& by) { return Eigen::Affine3d(Eigen::Translation3d(by)); }

/// Returns the rotation by angles in degrees about x, y and z, in one of the SDK's orders: order 0 turns about x first,
/// then y, then z.
Eigen::Affine3d turned(const Vector& degrees, int order) {
  constexpr std::array<std::array<int, 3>, 7> orders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}, {0, 1, 2}}};
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (const int axis : orders[static_cast<std::size_t>(order)])
    result.prerotate(Eigen::AngleAxisd(degrees[axis] * std::numbers::pi / 180, Vector::Unit(axis)));
  return result;
}

Eigen::Matrix4d local_transform(const FbxProperties& properties) {
  const auto get = [&](const char* name) { return properties.vector(name).value_or(Vector::Zero()); };
  const Vector rotation_pivot = get("RotationPivot"), scaling_pivot = get("ScalingPivot");
  // Apply the order and the pre- and post-rotation only where the file says so.
  const bool is_active = properties.number("RotationActive").value_or(0) != 0;
  const double order = is_active ? properties.number("RotationOrder").value_or(0) : 0;
  Eigen::Affine3d rotation = turned(get("Lcl Rotation"), order >= 0 && order <= 6 ? static_cast<int>(order) : 0);
  if (is_active)
    rotation = turned(get("PreRotation"), 0) * rotation * turned(get("PostRotation"), 0).inverse(Eigen::Isometry);
  const Vector scaling = properties.vector("Lcl Scaling").value_or(Vector::Ones());
  const Eigen::Affine3d result = moved(get("Lcl Translation")) * moved(get("RotationOffset")) * moved(rotation_pivot) *
                                 rotation * moved(-rotation_pivot) * moved(get("ScalingOffset")) *
                                 moved(scaling_pivot) * Eigen::Scaling(scaling) * moved(-scaling_pivot);
  return result.matrix();
}

Eigen::Matrix4d geometric_transform(const FbxProperties& properties) {
  const auto get = [&](const char* name) { return properties.vector(name).value_or(Vector::Zero()); };
  const Vector scaling = properties.vector("GeometricScaling").value_or(Vector::Ones());
  const Eigen::Affine3d result =
      moved(get("GeometricTranslation")) * turned(get("GeometricRotation"), 0) * Eigen::Scaling(scaling);
  return result.matrix();
}

class FbxReader {
 public:
  explicit FbxReader(const std::filesystem::path& file)
      : document_(file), objects_(document_), materials_(document_, objects_) {}

  SourceMesh read() {
    read_axes();
    mesh_.is_unwelded = false;
    for (const Object& object : objects_.all()) {
      count_what_is_passed_by(object);
      if (object.kind() == "Model") place_model(object);
    }
    if (mesh_.faces.empty())
      document_.fail("has no polygons that a model places", "a mesh", "export the surface as a mesh");
    materials_.add_warnings(mesh_.warnings);
    mesh_.materials = std::move(materials_).all();
    mesh_.parts = std::move(parts_).all();
    add_warnings();
    return std::move(mesh_);
  }

 private:
  /// Reads the file's axes as rows: coordinate, up and front. The front axis is derived from the other two for a
  /// right-handed frame, since exporters differ in its sign.
  void read_axes() {
    const FbxProperties settings(document_.root().child("GlobalSettings"), nullptr);
    const auto axis = [&](const std::string& name, int absent) {
      const double number = settings.number(name).value_or(absent);
      const double sign = settings.number(name + "Sign").value_or(1) < 0 ? -1 : 1;
      const int index = number >= 0 && number <= 2 ? static_cast<int>(number) : absent;
      return Vector(sign * Vector::Unit(index));
    };
    const Vector up = axis("UpAxis", 1);
    Vector right = axis("CoordAxis", 0);
    if (std::abs(up.dot(right)) > 0.5) right = std::abs(up.x()) > 0.5 ? Vector(Vector::UnitY()) : Vector::UnitX();
    Eigen::Matrix3d rows;
    rows << right.transpose(), up.transpose(), right.cross(up).transpose();
    axes_.topLeftCorner<3, 3>() = rows;
    if (!up.isApprox(Vector::UnitY())) {
      const int index = std::abs(up.x()) > 0.5 ? 0 : std::abs(up.y()) > 0.5 ? 1 : 2;
      mesh_.warnings.push_back(std::string("The file has ") + (up.sum() < 0 ? "-" : "+") + "XYZ"[index] +
                               " up; it is turned so that +Y is up");
    }
    const double centimetres = settings.number("UnitScaleFactor").value_or(1);
    if (centimetres == 1)
      mesh_.warnings.emplace_back(
          "The file's unit is the centimetre, and its numbers are kept: --unit cm gives metres");
    else if (centimetres != 100) {
      std::ostringstream text;
      text << "The file's unit is " << centimetres << " cm, and its numbers are kept";
      mesh_.warnings.push_back(text.str());
    }
  }

  void count_what_is_passed_by(const Object& object) {
    if (object.kind() == "Deformer") {
      skins_ += object.kind_within() == "Skin";
      blend_shapes_ += object.kind_within() == "BlendShape";
    }
    animations_ += object.kind() == "AnimationStack";
    has_curves_ = has_curves_ || object.kind() == "AnimationCurve";
    curved_ += object.kind() == "Geometry" && object.kind_within() != "Mesh" && object.kind_within() != "Shape";
  }

  /// Returns the parent model; null beneath the root.
  const Object* parent_of(const Object& model) const {
    for (const FbxObjects::Link& link : objects_.parents(model.id)) {
      const Object* parent = link.property.empty() ? objects_.find(link.other) : nullptr;
      if (parent != nullptr && parent->kind() == "Model") return parent;
    }
    return nullptr;
  }

  const Eigen::Matrix4d& world_of(const Object& model) {
    std::vector<const Object*> chain;
    for (const Object* up = &model; up != nullptr && !worlds_.contains(up->id); up = parent_of(*up)) {
      chain.push_back(up);
      if (chain.size() > objects_.all().size())
        document_.fail("model '" + model.name() + "' is beneath itself", "models that form a tree");
    }
    std::reverse(chain.begin(), chain.end());
    for (const Object* link : chain) {
      const FbxProperties properties = objects_.properties(*link);
      const Object* parent = parent_of(*link);
      const Eigen::Matrix4d above = parent == nullptr ? axes_ : worlds_.at(parent->id);
      worlds_[link->id] = above * local_transform(properties);
      if (parent == nullptr) continue;
      // Models of other types than RSrs (1) ignore a part of their parents' scaling.
      const Vector scaling = objects_.properties(*parent).vector("Lcl Scaling").value_or(Vector::Ones());
      uninherited_ += properties.number("InheritType").value_or(1) != 1 && !scaling.isOnes();
    }
    return worlds_.at(model.id);
  }

  void place_model(const Object& model) {
    std::vector<std::int32_t> materials;
    std::vector<const Object*> geometries;
    for (const FbxObjects::Link& link : objects_.children(model.id)) {
      const Object* child = link.property.empty() ? objects_.find(link.other) : nullptr;
      if (child == nullptr) continue;
      if (child->kind() == "Material") materials.push_back(materials_.number_of(*child));
      if (child->kind() == "Geometry" && child->kind_within() == "Mesh") geometries.push_back(child);
    }
    if (geometries.empty()) return;
    const MeshTransform transform(world_of(model) * geometric_transform(objects_.properties(model)));
    for (const Object* geometry : geometries) add(geometry_of(*geometry), materials, transform, model);
  }

  const FbxGeometry& geometry_of(const Object& object) {
    const auto known = geometries_.find(object.id);
    if (known != geometries_.end()) return known->second;
    const FbxGeometry& geometry = geometries_.emplace(object.id, read_fbx_geometry(document_, object)).first->second;
    lines_ += geometry.lines;
    further_uv_sets_ += geometry.uv_sets > 1 ? geometry.uv_sets - 1 : 0;
    return geometry;
  }

  void add(const FbxGeometry& geometry, const std::vector<std::int32_t>& materials, const MeshTransform& transform,
           const Object& model) {
    // Real files have few copies of a geometry; files with many are made to take all memory.
    const std::size_t most = 12'000'000 + 24 * document_.file_size() + geometry.corners.size();
    if (geometry.corners.size() + mesh_.corners.size() > most || geometry.vertices.size() + mesh_.places.size() > most)
      document_.fail("places copies of its geometries out of all proportion to its size",
                     "at most " + std::to_string(most) + " corners", "split the file, or place fewer copies");
    const auto first_place = static_cast<std::uint32_t>(mesh_.places.size());
    const auto first_normal = static_cast<std::uint32_t>(mesh_.normals.size());
    const auto first_uv = static_cast<std::uint32_t>(mesh_.uvs.size());
    for (const Vector& vertex : geometry.vertices) mesh_.places.push_back(transform.place(vertex));
    for (const Vector& normal : geometry.normals) mesh_.normals.push_back(transform.normal(normal));
    mesh_.uvs.insert(mesh_.uvs.end(), geometry.uvs.begin(), geometry.uvs.end());
    if (geometry.is_float)
      mesh_.precision = std::max(mesh_.precision, std::ldexp(geometry.largest * transform.largest_scale(), -23));

    const auto first_corner = static_cast<std::uint32_t>(mesh_.corners.size());
    for (const FbxGeometry::Corner& corner : geometry.corners) {
      if (!mesh_.places[first_place + corner.vertex].allFinite())
        document_.fail(
            "model '" + model.name() + "' puts vertex " + std::to_string(corner.vertex) + " infinitely far away",
            "finite places");
      mesh_.corners.push_back({first_place + corner.vertex,
                               corner.uv == FbxGeometry::none ? SourceMesh::none : first_uv + corner.uv,
                               corner.normal == FbxGeometry::none ? SourceMesh::none : first_normal + corner.normal});
    }
    add_colors(geometry, first_place, first_corner);
    const std::int32_t part = geometry.first_corner.size() > 1 ? parts_.number_of(model.name()) : -1;
    for (std::size_t i = 0; i + 1 < geometry.first_corner.size(); ++i) {
      const std::uint32_t first = first_corner + geometry.first_corner[i];
      const std::uint32_t count = geometry.first_corner[i + 1] - geometry.first_corner[i];
      const std::int64_t material = geometry.materials[i];
      const bool is_known = material >= 0 && material < static_cast<std::int64_t>(materials.size());
      mesh_.faces.push_back({first, count, is_known ? materials[static_cast<std::size_t>(material)] : -1, 0, 0, part});
      if (transform.is_mirror()) std::reverse(mesh_.corners.begin() + first + 1, mesh_.corners.begin() + first + count);
    }
  }

  /// Adds colours. FBX has colours per corner, and SourceMesh per place: where the corners of a vertex differ in
  /// colour, the vertex is added once for each colour. Must be called before corners are turned.
  void add_colors(const FbxGeometry& geometry, std::uint32_t first_place, std::uint32_t first_corner) {
    if (geometry.colors.empty() && mesh_.colors.empty()) return;
    mesh_.colors.resize(mesh_.places.size(), Eigen::Vector3f::Ones());
    if (geometry.colors.empty()) return;
    std::unordered_map<std::uint64_t, std::uint32_t> place_of;  // key: vertex and colour
    std::vector<bool> is_taken(geometry.vertices.size(), false);
    for (std::size_t i = 0; i < geometry.corners.size(); ++i) {
      const FbxGeometry::Corner& corner = geometry.corners[i];
      const Eigen::Vector3f color =
          corner.color == FbxGeometry::none ? Eigen::Vector3f(Eigen::Vector3f::Ones()) : geometry.colors[corner.color];
      const std::uint32_t own = first_place + corner.vertex;
      if (!is_taken[corner.vertex]) mesh_.colors[own] = color;
      is_taken[corner.vertex] = true;
      if (mesh_.colors[own] == color) continue;
      const auto [place, is_new] =
          place_of.try_emplace(std::uint64_t{corner.vertex} << 32 | corner.color, mesh_.places.size());
      if (is_new) {
        mesh_.places.emplace_back(mesh_.places[own]);
        mesh_.colors.push_back(color);
        mesh_.is_unwelded = true;
      }
      mesh_.corners[first_corner + i].place = place->second;
    }
  }

  void add_warnings() {
    const auto add = [this](std::size_t count, const std::string& thing, const std::string& what) {
      if (count > 0) mesh_.warnings.push_back(std::to_string(count) + " " + thing + (count == 1 ? "" : "s") + what);
    };
    add(lines_, "polygon", " of fewer than three corners, left out");
    add(curved_, "geometry record", " of curves or curved surfaces, not used");
    add(further_uv_sets_, "further set", " of texture coordinates, not used");
    add(skins_, "skin", ", taken at rest: vertices stand as the mesh itself has them");
    add(blend_shapes_, "blend shape", ", taken at rest: not used");
    add(has_curves_ ? animations_ : 0, "animation", ", not used: models stand as the file has them");
    add(uninherited_, "model", " that should not inherit a scaling wholly, and does");
  }

  FbxDocument document_;
  FbxObjects objects_;
  FbxMaterials materials_;
  SourceMesh mesh_;
  PartNames parts_;
  Eigen::Matrix4d axes_ = Eigen::Matrix4d::Identity();
  std::map<std::int64_t, Eigen::Matrix4d> worlds_;
  std::map<std::int64_t, FbxGeometry> geometries_;
  std::size_t lines_ = 0, curved_ = 0, further_uv_sets_ = 0, skins_ = 0, blend_shapes_ = 0, animations_ = 0,
              uninherited_ = 0;
  bool has_curves_ = false;  // animation curves
};

}  // namespace

SourceMesh read_fbx(const std::filesystem::path& file) { return FbxReader(file).read(); }

}  // namespace kiln
