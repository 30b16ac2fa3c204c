#include "mesh/uv_mesh_file.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/errors.h"
#include "base/outputs.h"
#include "mesh/draco_file.h"
#include "mesh/obj_file.h"

namespace kiln {

namespace {

constexpr char remedy[] = "export the mesh again, with its texture coordinates";

/// Corners of the same place and uv become one vertex; quads are cut along the shorter diagonal, as load_mesh does.
TriangleMesh read_uv_obj(const std::filesystem::path& file) {
  const ObjFile obj = read_obj(file);
  TriangleMesh mesh;
  std::map<std::array<float, 5>, std::uint32_t> vertices;
  const auto vertex = [&](const Eigen::Vector3f& place, const Eigen::Vector2f& uv) {
    const auto [found, inserted] = vertices.try_emplace({place.x(), place.y(), place.z(), uv.x(), uv.y()},
                                                        static_cast<std::uint32_t>(mesh.positions.size()));
    if (inserted) {
      mesh.positions.push_back(place);
      mesh.uvs.push_back(uv);
    }
    return found->second;
  };
  const auto apart = [&](std::uint32_t a, std::uint32_t b) {
    return (mesh.positions[a] - mesh.positions[b]).squaredNorm();
  };
  for (const ObjFile::Face& face : obj.faces) {
    std::vector<std::uint32_t> corners;
    for (const ObjFile::Corner& corner : obj.corners_of(face)) {
      if (corner.uv == ObjFile::Corner::none)
        throw BadInput(file.string() + ":" + std::to_string(face.line), "a face without texture coordinates",
                       "corners as VERTEX/UV or VERTEX/UV/NORMAL", remedy);
      corners.push_back(vertex(obj.places[corner.place], obj.uvs[corner.uv]));
    }
    if (corners.size() == 4 && apart(corners[1], corners[3]) < apart(corners[0], corners[2]))
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      mesh.triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }
  return mesh;
}

}  // namespace

void compute_seamless_normals(TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> at_place;
  std::vector<std::uint32_t> welded(mesh.positions.size());
  TriangleMesh whole;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3f& p = mesh.positions[v];
    const auto [found, inserted] = at_place.try_emplace({p.x() + 0.f, p.y() + 0.f, p.z() + 0.f},
                                                        static_cast<std::uint32_t>(whole.positions.size()));
    if (inserted) whole.positions.push_back(p);
    welded[v] = found->second;
  }
  for (const Triangle& t : mesh.triangles) whole.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
  compute_vertex_normals(whole);
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t v = 0; v < welded.size(); ++v) mesh.normals[v] = whole.normals[welded[v]];
}

TriangleMesh load_uv_mesh(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".drc")
    throw BadInput(file.string(), "has the extension '" + extension + "'", "obj or drc, which can hold uvs",
                   "convert the mesh");
  TriangleMesh mesh = extension == ".drc" ? load_draco(file) : read_uv_obj(file);
  if (mesh.uvs.empty())
    throw BadInput(file.string(), "has no texture coordinates", "a mesh with uvs", "leave --keep-uv out to make them");
  for (const Eigen::Vector2f& uv : mesh.uvs)
    if (!uv.allFinite())
      throw BadInput(file.string(), "has a texture coordinate that is not a finite number", "finite uvs", remedy);
  if (mesh.normals.empty()) compute_seamless_normals(mesh);
  return mesh;
}

}  // namespace kiln
