// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "runtime/shadow/visibility_engine.h"

namespace kiln {

struct VisibilityMapSettings {
  int texels = 64;  ///< side of a map, 8 to 1,024: around a cone of light, or of each face of a cube before skies
  std::size_t most_bytes = 32u << 20;  ///< of all maps that are in memory at a time; no bit depends on it
};

/// What visibility maps did since they were made.
struct VisibilityMapWork {
  std::size_t maps = 0, drawn_nodes = 0, jobs = 0, passes = 0;  ///< a pass: maps drawn, looked up and read back at once
};

/// Finds what is blocked by small depth maps: from each point one along each cone or ball of light, up to six of a cube
/// before skies, drawn in layers, many points in a pass. Nodes that no map may see are not drawn. A compute shader
/// looks the light's directions up in them and projects what is blocked; sums are read back. A direction counts as
/// blocked if the middle of the texel that it falls into is; what touches a point (touching_share) blocks nothing
/// there.
///
/// Needs the OpenGL 4.5 context in which it was made to be current whenever it is used, also when it ends. Sets back
/// the state that it changes (KeptGlState), but bindings of shader storage buffers 0 to 5 and of texture unit 0.
///
/// GPU memory: maps of `most_bytes` (at least six maps, at most 2,048); 2 MiB; 4 (bands^2 + 1) bytes for each of the
/// 8,192 jobs that a pass may have; 32 bytes for each of the `directions`, and 12 more for each sky; and the meshes, 12
/// bytes a vertex and a triangle. None of it grows with the number of points.
class VisibilityMaps final : public VisibilityEngine {
 public:
  /// Throws MachineLacks where the context has no OpenGL 4.5 or cannot draw in layers from vertex shaders
  /// (GL_ARB_shader_viewport_layer_array), and WrongUsage for sizes out of range.
  explicit VisibilityMaps(const VisibilityMapSettings& settings = {});
  ~VisibilityMaps() override;
  VisibilityMaps(const VisibilityMaps&) = delete;
  VisibilityMaps& operator=(const VisibilityMaps&) = delete;

  std::string renderer() const override;
  void set_meshes(std::span<const TriangleMesh* const> meshes) override;
  void set_lights(const LightSources& sources, const DirectionSet& sky, int bands) override;
  /// Throws MachineLacks if the device runs out of memory.
  VisibilityTable find(const ShadowStage& stage, const LightSources& sources,
                       std::span<const VisibilityTask> tasks) override;

  const VisibilityMapWork& work() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
