// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/gl_objects.h"
#include "image/image.h"
#include "mesh/camera.h"
#include "runtime/shading/asset_maps.h"
#include "runtime/shading/frame_tables.h"
#include "runtime/shading/light_points.h"
#include "runtime/shading/part_times.h"
#include "runtime/shading/scene_uploads.h"
#include "runtime/shading/shaded_frame.h"
#include "runtime/shading/shaded_scene.h"
#include "runtime/shading/shader_programs.h"
#include "runtime/shading/shading_settings.h"

namespace kiln {

/// Draws a scene whose nodes have shaders of their own. The GL context that is current at construction must be current
/// in every call and at destruction.
class ShadedRenderer {
 public:
  /// Uploads the scene and compiles the shaders that its materials name. Throws BadInput for faults of these, and as
  /// the functions of scene_uploads.h do.
  ShadedRenderer(ShadedScene scene, const std::vector<SurfaceShader>& shaders, const ShadingSettings& settings);

  /// Takes other shaders, whose files have changed, say. Throws as the constructor does; the old ones then stay.
  void set_shaders(const std::vector<SurfaceShader>& shaders);

  /// Moves nodes: places of all, in their order.
  void set_placements(std::span<const Placement> placements);
  void set_lights(const SceneLights& lights);
  /// Takes the light of all nodes at their points, with whatever shadows it has, in place of that of the scene's lights
  /// as if each stood alone; until it is set again, empty for the latter. `direct` of the settings says whether lights
  /// with a direction are among it. Throws std::invalid_argument for other numbers of nodes or points.
  void set_node_light(std::vector<NodeLight> light);
  void set_way(ShadingWay way) { settings_.way = way; }

  const ShadedScene& scene() const { return scene_; }
  const ShadingSettings& settings() const { return settings_; }
  const ShaderPrograms& programs() const { return *programs_; }

  /// Makes a frame for pictures of this size.
  ShadedFrame make_frame(int width, int height) const;

  /// Draws a picture: tables first, then sample after sample. `seconds` and `frame_number` are what shaders know as
  /// `time` and `frame`. `times`, if given, receives the parts.
  void draw(const Camera& camera, const ShadedFrame& frame, double seconds = 0, int frame_number = 0,
            PartTimes* times = nullptr);

  /// Returns how often uniform parameters were computed, over all materials, since the shaders were set.
  unsigned uniform_evaluations() const;

  /// Returns the texture of reflections that the last frame had.
  const ShadedFrame* reflection() const { return reflection_ ? &*reflection_ : nullptr; }
  const ShadowTable& shadows() const { return shadows_; }

 private:
  struct View;
  ShadedFrame::Extras extras() const;
  /// Uploads nodes and lights, if they have changed.
  void upload_moment();
  void upload_nodes();
  void upload_lights();
  void compute_uniforms();
  void draw_shadows();
  void draw_reflection(const Camera& camera, double seconds, int frame_number);
  /// Draws one sample of a view into a frame.
  void draw_sample(const ShadedFrame& frame, const View& view, bool is_only_sample, int skipped_node, PartTimes* times);
  void draw_nodes(bool forward, int skipped_node);
  void shade_tiles(const ShadedFrame& frame, bool adds, PartTimes* times);
  void set_view(const View& view);
  void bind_tables(const GlTexture& reflection) const;

  ShadedScene scene_;
  ShadingSettings settings_;
  std::vector<UploadedShape> shapes_;
  std::vector<BoundingBox> boxes_;
  UploadedPlanes planes_;
  LightPoints points_;
  AssetMaps maps_;
  std::vector<NodeLight> given_light_;
  bool is_uploaded_ = false;
  UploadedNodeLight node_light_;
  std::unique_ptr<ShaderPrograms> programs_;
  UploadedMaterials materials_;
  std::vector<GlTexture> pictures_;
  GlBuffer nodes_, view_, lights_, evaluations_;
  ShadowTable shadows_;
  std::vector<ShadowView> shadow_views_;
  std::optional<ShadedFrame> reflection_;
  GlTexture node_vectors_, material_values_;
  GlTexture no_reflection_;
  GlVertexArray no_vertices_;
};

/// Reads the picture of a frame: linear exit radiance RGB times coverage, and coverage, rows from the bottom.
Image<float> read_back(const ShadedFrame& frame);

/// Draws a picture and reads it back.
Image<float> shaded_picture(ShadedRenderer& renderer, const Camera& camera, int width, int height, double seconds = 0);

}  // namespace kiln
