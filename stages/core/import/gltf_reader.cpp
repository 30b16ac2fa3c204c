// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "import/gltf_buffers.h"
#include "import/gltf_document.h"
#include "import/gltf_material.h"
#include "import/gltf_primitive.h"
#include "import/gltf_scene.h"
#include "import/mesh_transform.h"
#include "import/part_names.h"
#include "import/readers.h"
#include "import/text_lines.h"

// All meshes are placed as in the scene, in double. Coordinates are metres, +Y up, as in glTF.

namespace kiln {

namespace {

class SceneAssembler {
 public:
  SceneAssembler(const GltfDocument& document, const GltfBuffers& buffers, SourceMesh& mesh)
      : document_(document), buffers_(buffers), mesh_(mesh) {
    mesh_.is_unwelded = true;
    mesh_.linear_colors = true;
  }

  /// Announces copies of a mesh before they are added. Throws BadInput where there are more than plausible.
  void expect(const std::vector<GltfPrimitive>& primitives, std::size_t copies) {
    std::size_t triangles = 0;
    for (const GltfPrimitive& primitive : primitives) triangles += primitive.triangles.size();
    const std::size_t most = buffers_.most_triangles();  // never decreases
    if (triangles > 0 && copies > (most - expected_triangles_) / triangles)
      document_.fail("places " + std::to_string(copies) + " copies of a mesh of " + std::to_string(triangles) +
                         " triangles, out of all proportion to the file's size",
                     "at most " + std::to_string(most) + " triangles in all", "split the file, or place fewer copies");
    expected_triangles_ += copies * triangles;
  }

  std::size_t expected_triangles() const { return expected_triangles_; }

  /// Hands over the names of the parts that were added.
  std::vector<std::string> part_names() && { return std::move(parts_).all(); }

  /// Adds one copy.
  void add(const GltfPrimitive& primitive, const GltfPlacement& placement) {
    const bool is_skinned = placement.joints != nullptr && primitive.influences > 0;
    const MeshTransform world(placement.world);
    first_place_ = static_cast<std::uint32_t>(mesh_.places.size());
    first_normal_ = static_cast<std::uint32_t>(mesh_.normals.size());
    const auto first_uv = static_cast<std::uint32_t>(mesh_.uvs.size());
    std::vector<bool> is_mirrored(is_skinned ? primitive.positions.size() : 0);
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
      if (!is_skinned) {
        add_vertex(primitive, i, world);
        continue;
      }
      const MeshTransform blended(blend(primitive, placement, i));
      is_mirrored[i] = blended.is_mirror();
      add_vertex(primitive, i, blended);
    }
    mesh_.uvs.insert(mesh_.uvs.end(), primitive.uvs.begin(), primitive.uvs.end());
    add_colors(primitive);
    const std::int32_t part = primitive.triangles.empty() ? -1 : parts_.number_of(placement.name);
    for (const auto& triangle : primitive.triangles) {
      mesh_.faces.push_back({static_cast<std::uint32_t>(mesh_.corners.size()), 3, primitive.material, 0, 0, part});
      const bool is_turned = is_skinned ? is_mirrored[triangle[0]] : world.is_mirror();
      for (const std::size_t k : {0, is_turned ? 2 : 1, is_turned ? 1 : 2})
        mesh_.corners.push_back({first_place_ + triangle[k],
                                 primitive.uvs.empty() ? SourceMesh::none : first_uv + triangle[k],
                                 primitive.normals.empty() ? SourceMesh::none : first_normal_ + triangle[k]});
    }
  }

 private:
  /// Blends the transforms of a vertex's joints in a skin.
  Eigen::Matrix4d blend(const GltfPrimitive& primitive, const GltfPlacement& placement, std::size_t vertex) const {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    double total = 0;
    for (std::size_t i = vertex * primitive.influences; i < (vertex + 1) * primitive.influences; ++i) {
      const double weight = primitive.weights[i];
      if (!(weight > 0)) continue;
      if (primitive.joints[i] >= placement.joints->size())
        document_.fail("vertex " + std::to_string(primitive.numbers[vertex]) + " of " + primitive.place +
                           " follows joint " + std::to_string(primitive.joints[i]),
                       "one of the skin's " + std::to_string(placement.joints->size()));
      sum += weight * (*placement.joints)[primitive.joints[i]];
      total += weight;
    }
    return total > 0 ? Eigen::Matrix4d(sum / total) : placement.world;
  }

  void add_vertex(const GltfPrimitive& primitive, std::size_t i, const MeshTransform& transform) {
    const Eigen::Vector3d place = transform.place(primitive.positions[i]);
    if (!place.allFinite())
      document_.fail("vertex " + std::to_string(primitive.numbers[i]) + " of " + primitive.place +
                         " is put infinitely far away by its node",
                     "finite places");
    mesh_.places.push_back(place);
    mesh_.precision = std::max(mesh_.precision, std::ldexp(primitive.largest * transform.largest_scale(), -23));
    if (!primitive.normals.empty()) mesh_.normals.push_back(transform.normal(primitive.normals[i]));
  }

  /// Adds colours, which all places must have or none: where other primitives have them, a primitive without is white.
  void add_colors(const GltfPrimitive& primitive) {
    if (primitive.colors.empty() && mesh_.colors.empty()) return;
    mesh_.colors.resize(first_place_, Eigen::Vector3f::Ones());
    for (const Eigen::Vector3f& color : primitive.colors) mesh_.colors.emplace_back(color.cwiseMax(0).cwiseMin(1));
    mesh_.colors.resize(mesh_.places.size(), Eigen::Vector3f::Ones());
  }

  const GltfDocument& document_;
  const GltfBuffers& buffers_;
  SourceMesh& mesh_;
  PartNames parts_;
  std::size_t expected_triangles_ = 0;
  std::uint32_t first_place_ = 0, first_normal_ = 0;
};

void add_warnings(const GltfDocument& document, const GltfPassedBy& passed_by, std::vector<std::string>& warnings) {
  if (passed_by.points + passed_by.lines > 0)
    warnings.push_back(counted(passed_by.points + passed_by.lines, "primitive") +
                       " of points or lines, which are no surface and are not used");
  if (passed_by.without_positions > 0)
    warnings.push_back(counted(passed_by.without_positions, "primitive") + " without positions, not used");
  if (passed_by.morphed > 0)
    warnings.push_back(counted(passed_by.morphed, "primitive") + " with morph targets, taken at the file's weights");
  if (const std::size_t animations = document.count("animations"); animations > 0)
    warnings.push_back(counted(animations, "animation") + ", not used: nodes stand as the file has them");
  if (document.unused_extensions().empty()) return;
  std::string names;
  for (const std::string& name : document.unused_extensions()) names += (names.empty() ? "" : ", ") + name;
  warnings.push_back("The file uses " + names + ", which Kiln does not");
}

}  // namespace

SourceMesh read_gltf(const std::filesystem::path& file) {
  const GltfDocument document(file);
  GltfBuffers buffers(document);
  SourceMesh mesh;
  const std::vector<GltfMaterial> materials = read_gltf_materials(document, buffers, mesh.warnings);
  for (const GltfMaterial& material : materials) mesh.materials.push_back(material.material);
  const std::vector<GltfPlacement> placements = place_gltf_meshes(document, buffers, mesh.warnings);

  // Read a mesh once for all nodes of the same morph weights, and keep it until the last of them.
  using Key = std::pair<std::size_t, std::vector<double>>;
  std::map<Key, std::size_t> uses;
  for (const GltfPlacement& placement : placements) ++uses[{placement.mesh, placement.morph_weights}];
  std::map<Key, std::vector<GltfPrimitive>> meshes;
  GltfPassedBy passed_by;
  SceneAssembler assembler(document, buffers, mesh);
  for (const GltfPlacement& placement : placements) {
    const Key key{placement.mesh, placement.morph_weights};
    auto found = meshes.find(key);
    if (found == meshes.end()) {
      found = meshes
                  .emplace(key, read_gltf_mesh(document, buffers, placement.mesh, placement.morph_weights, materials,
                                               assembler.expected_triangles(), passed_by))
                  .first;
      assembler.expect(found->second, uses[key]);
    }
    for (const GltfPrimitive& primitive : found->second) assembler.add(primitive, placement);
    if (--uses[key] == 0) meshes.erase(found);
  }
  mesh.parts = std::move(assembler).part_names();
  add_warnings(document, passed_by, mesh.warnings);
  mesh.further_files = buffers.files();
  if (mesh.faces.empty()) {
    const bool has_others = passed_by.points + passed_by.lines > 0;
    document.fail(has_others ? "holds points or lines and no triangles" : "has no triangles in its scene",
                  "a scene with a mesh of triangles", "export the surface");
  }
  return mesh;
}

}  // namespace kiln
