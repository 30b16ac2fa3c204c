// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/gl_objects.h"
#include "mesh/triangle_mesh.h"
#include "runtime/shadow/light_sources.h"
#include "runtime/shadow_gl/map_views.h"

namespace kiln {

/// A node in a map, as shaders/shadow_depth.vert reads it.
struct MapInstance {
  MapRows rows;
  std::int32_t layer;
  float nearest;  ///< distance along the map's axis from which on it is seen
  float unused[2];
};

/// A point before a light, as shaders/shadow_project.comp reads it, which says what each number is.
struct MapJob {
  std::array<float, 4> right, up, axis, ball;
  std::array<std::int32_t, 4> layers, more_layers, numbers;
};

/// Most jobs of a pass.
inline constexpr std::size_t most_jobs = 8192;

/// The GL side of VisibilityMaps: draws nodes into maps, looks up and projects.
class MapPasses {
 public:
  MapPasses(int texels, int layers);

  int layers() const { return layers_; }
  void set_meshes(std::span<const TriangleMesh* const> meshes);
  void set_lights(const LightSources& sources, const DirectionSet& sky, int bands);

  /// Draws `instances` (by mesh) into the first `layers` maps, which are cleared first; `depth_unit` is the
  /// distance up to which things count as equally near to lights that are not endlessly far. Looks up `jobs`, and
  /// writes what is found to `counts`, and to `sums` (job * coefficients + i) where a count is not 0.
  void run(std::span<const std::vector<MapInstance>> instances, std::span<const MapJob> jobs, float depth_unit,
           int layers, std::vector<std::uint32_t>& counts, std::vector<float>& sums);

 private:
  /// Where a mesh stands in the buffers of all.
  struct MeshRange {
    GLint first_vertex = 0;
    GLsizei indices = 0;
    std::uintptr_t first_index = 0;  ///< bytes
  };

  void draw(std::span<const std::vector<MapInstance>> instances, float depth_unit, int layers);

  int texels_, layers_, coefficients_ = 0;
  GlTexture maps_;
  GlFramebuffer framebuffer_;
  GlProgram depth_program_, project_program_;
  GlBuffer instances_, jobs_, counts_, sums_, positions_, triangles_, disc_, sky_, weights_;
  GlVertexArray occluders_;
  std::vector<MeshRange> meshes_;
};

}  // namespace kiln
