// SPDX-License-Identifier: MIT
#include "runtime/shading/light_points.h"

#include <array>

#include "gpu/program.h"
#include "runtime/draw/asset_uploads.h"

namespace kiln {

std::vector<Eigen::Vector3f> light_points(const ShadedMesh& mesh, int incident_samples) {
  return place_incident_samples(*mesh.mesh, incident_samples).points;
}

LightPoints upload_light_points(std::span<const ShadedMesh> meshes, int incident_samples) {
  LightPoints uploaded;
  std::vector<Triangle> triangles;
  std::vector<std::array<float, 4>> vectors;  // of vertices: the place; then contributions, unless it is a point
  int vertices = 0;
  for (const ShadedMesh& shaded : meshes) {
    LightPoints::Place place{static_cast<int>(triangles.size()), vertices, 1};
    if (shaded.has_transfer() && incident_samples != 1) {
      const TriangleMesh& mesh = *shaded.mesh;
      const IncidentSamples samples = place_incident_samples(mesh, incident_samples);
      const auto count = static_cast<std::size_t>(samples.count());
      place.points = samples.count();
      triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
      vertices += static_cast<int>(mesh.positions.size());
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Eigen::Vector3f& at = mesh.positions[v];
        vectors.push_back({at.x(), at.y(), at.z(), 0});
        if (incident_samples == samples_at_vertices) continue;
        std::array<float, most_incident_samples> shares = {};
        for (std::size_t k = 0; k < count; ++k) shares[k] = samples.contributions[v * count + k];
        vectors.push_back({shares[0], shares[1], shares[2], shares[3]});
        vectors.push_back({shares[4], shares[5], shares[6], shares[7]});
      }
    }
    uploaded.places.push_back(place);
  }
  if (triangles.empty()) return uploaded;
  require_at_most(GL_MAX_TEXTURE_BUFFER_SIZE, static_cast<int>(std::max(triangles.size(), vectors.size())),
                  "buffer textures with texels");
  uploaded.triangles = make_buffer(std::span<const Triangle>(triangles));
  uploaded.vertices = make_buffer(std::span<const std::array<float, 4>>(vectors));
  uploaded.triangle_vertices = make_texture(GL_TEXTURE_BUFFER);
  uploaded.vertex_vectors = make_texture(GL_TEXTURE_BUFFER);
  glTextureBuffer(uploaded.triangle_vertices.name(), GL_RGB32UI, uploaded.triangles.name());
  glTextureBuffer(uploaded.vertex_vectors.name(), GL_RGBA32F, uploaded.vertices.name());
  check_gl("uploading the points of light");
  return uploaded;
}

}  // namespace kiln
