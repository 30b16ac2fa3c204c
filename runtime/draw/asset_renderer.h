// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "runtime/draw/asset_uploads.h"
#include "runtime/draw/scene_view.h"
#include "runtime/draw/surface_colors.h"
#include "runtime/draw/technique.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// GPU memory that a technique takes, in bytes, itemised as in [Chapter 2010], table 6.2.
struct GpuMemory {
  std::uint64_t per_mesh = 0;    ///< textures, and the light
  std::uint64_t per_vertex = 0;  ///< attributes of one vertex, transfer included
  std::uint64_t indices = 0;     ///< indices of the triangles
};

/// Light of an asset at one place, on the GPU.
struct UploadedLight {
  AssetLight light;
  SurfaceLook look;
  UploadedTexture planes, vertices;  ///< for transfer in planes, and for transfer at vertices
};

/// Draws an asset on the GPU, by any technique under any light, with shaders/render_*. Draws into the bound
/// framebuffer, with the current depth test and state (draw/frame.h). The GL context that is current at construction
/// must be current in every call and at destruction.
class AssetRenderer {
 public:
  /// Uploads the mesh. `incident_samples`, 1 to most_incident_samples or samples_at_vertices, is the number of points
  /// at which the incident light is computed.
  explicit AssetRenderer(const PrtAsset& asset, int incident_samples = 1);

  const PrtAsset& asset() const { return asset_; }
  const IncidentSamples& samples() const { return samples_; }

  /// Loads the data of a technique, which draw() otherwise does on first use. Throws WrongUsage if the asset cannot be
  /// drawn by it, BadInput, and MachineLacks if the device does not support such textures.
  void prepare(Technique technique);

  /// Draws by spectra from now on, or by RGB without colours: lights that are uploaded afterwards have their functions
  /// as channels.
  void set_colors(std::shared_ptr<const SurfaceColors> colors);

  /// Sets the light of all following draws; its number of samples must be incident_samples. Throws as cluster_weights
  /// and rgb_readers do.
  void set_light(const AssetLight& light, const SurfaceLook& look) { use_light(upload_asset_light(light, look)); }

  /// Does the same in two steps, for an asset that stands at several places: its light there is uploaded once, and
  /// used whenever it is drawn there.
  std::shared_ptr<const UploadedLight> upload_asset_light(const AssetLight& light, const SurfaceLook& look) const;
  void use_light(std::shared_ptr<const UploadedLight> light) { lit_ = std::move(light); }

  /// Draws all triangles, both sides. `clip_from_object` is a matrix for column vectors, `eye_object` the camera's
  /// position.
  void draw(Technique technique, const Eigen::Matrix4f& clip_from_object, const Eigen::Vector3f& eye_object);

  /// Passes of deferred shading, for the textured and the compressed technique only. The first writes what shading
  /// needs into the three colour attachments (shaders/render_appearance.frag); the second shades the samples that have
  /// `number` there, which it reads from textures (AppearanceFrame).
  void draw_appearance(const Eigen::Matrix4f& clip_from_object, int number);
  void shade_appearance(int number);

  /// Returns the memory of a technique that was prepared, with a light that was set.
  GpuMemory memory(Technique technique) const;

 private:
  enum class Pass { phong, normal_map, vertex_prt, prt, appearance, deferred };
  const GlProgram& program(Pass pass);
  void bind_prt(const GlProgram& program, const UploadedTexture& light, int layers, int clusters) const;
  std::array<float, 3> albedo(const SurfaceLook& look) const;
  LightReaders readers(const SurfaceLook& look) const;
  bool differs_by_albedo() const { return colors_ && colors_->readers.empty(); }
  bool has_measured_materials() const { return differs_by_albedo() && !colors_->measured.empty(); }
  std::vector<float> phong_buffer(const Eigen::Vector3f& eye) const;
  /// Binds the albedo, the opacity and the table of colours, for what the program computes by the table.
  void bind_surface_maps(const GlProgram& program, bool by_table) const;
  void bind_planes(const GlProgram& program) const;
  void draw_triangles(const GlProgram& program, const Eigen::Matrix4f& clip_from_object) const;
  void draw_corners(const GlProgram& program, const Eigen::Matrix4f& clip_from_object) const;
  bool is_clustered() const { return asset_.clusters && asset_.clusters->count > 1; }

  const PrtAsset& asset_;
  IncidentSamples samples_;
  UploadedMesh mesh_;
  UploadedCorners corners_;  // if light is computed at vertices
  std::map<Pass, GlProgram> programs_;
  UploadedTexture planes_, cluster_ids_, normal_map_, albedo_map_, white_, opacity_map_;
  UploadedVertexTransfer vertex_transfer_;
  std::shared_ptr<const SurfaceColors> colors_;
  UploadedTexture color_table_, material_numbers_, measured_colors_;
  GlBuffer phong_lights_;
  std::shared_ptr<const UploadedLight> lit_;
};

}  // namespace kiln
