// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/draw/asset_uploads.h"
#include "runtime/draw/scene_view.h"
#include "runtime/draw/technique.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// What a technique takes on the GPU, in bytes, as in Chapter 2010, table 6.2.
struct GpuMemory {
  std::uint64_t per_mesh = 0;    ///< textures, and the light
  std::uint64_t per_vertex = 0;  ///< attributes of one vertex, transfer included
  std::uint64_t indices = 0;     ///< of the triangles
};

/// An asset on the GPU, drawn by any technique under any light by shaders/render_*. Draws into the framebuffer that is
/// bound, with the depth test and the state that is set (draw/frame.h). The GL context that is current at construction
/// must be current in every call and at destruction.
class AssetRenderer {
 public:
  /// Uploads the mesh. `incident_samples` of 1 to most_incident_samples: points at which the incident light is
  /// computed.
  explicit AssetRenderer(const PrtAsset& asset, int incident_samples = 1);

  const PrtAsset& asset() const { return asset_; }
  const IncidentSamples& samples() const { return samples_; }

  /// Loads what the technique needs, which otherwise draw() does when it comes to it. Throws WrongUsage where the asset
  /// cannot be drawn so, BadInput, and MachineLacks where the device takes no such texture.
  void prepare(Technique technique);

  /// Sets the light, of as many samples as this has, for all draws that follow. Throws as cluster_weights does.
  void set_light(const AssetLight& light, const SurfaceLook& look);

  /// Draws all triangles, both sides. `clip_from_object` is a column-vector matrix, `eye_object` where the camera
  /// stands.
  void draw(Technique technique, const Eigen::Matrix4f& clip_from_object, const Eigen::Vector3f& eye_object);

  /// The two passes of deferred shading, textured and compressed alone: writes what to shade into the three colour
  /// attachments (shaders/render_appearance.frag), and shades the samples that have `number` there, which are read from
  /// textures (AppearanceFrame).
  void draw_appearance(const Eigen::Matrix4f& clip_from_object, int number);
  void shade_appearance(int number);

  /// Of a technique that was prepared, with a light that was set.
  GpuMemory memory(Technique technique) const;

 private:
  enum class Pass { phong, normal_map, vertex_prt, prt, appearance, deferred };
  const GlProgram& program(Pass pass);
  void bind_prt(const GlProgram& program, const UploadedTexture& light, int layers, int clusters) const;
  std::array<float, 3> albedo() const;
  void bind_albedo() const;
  void bind_planes(const GlProgram& program) const;
  void draw_triangles(const GlProgram& program, const Eigen::Matrix4f& clip_from_object) const;
  bool is_clustered() const { return asset_.clusters && asset_.clusters->count > 1; }

  const PrtAsset& asset_;
  IncidentSamples samples_;
  UploadedMesh mesh_;
  std::map<Pass, GlProgram> programs_;
  UploadedTexture planes_, cluster_ids_, normal_map_, albedo_map_, white_;
  UploadedVertexTransfer vertex_transfer_;
  UploadedTexture light_, vertex_light_;
  GlBuffer phong_lights_;
  std::optional<AssetLight> set_light_;
  SurfaceLook look_;
};

}  // namespace kiln
