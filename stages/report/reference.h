// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "image/image.h"
#include "material/scene_mesh.h"
#include "material/surface_albedo.h"
#include "mesh/camera.h"
#include "mesh/triangle_mesh.h"
#include "report/picture_difference.h"
#include "scatter/profile.h"
#include "sh/light_spec.h"

namespace kiln {

/// Wavelengths that light is computed at, and what a picture shows of them.
struct SpectralView {
  std::vector<int> wavelengths_nm = {};
  Eigen::Matrix3Xf rgb_from_wavelengths = {};  ///< linear red, green and blue of a white surface in one lamp's light
};

/// View of the reference picture that an asset is compared with.
struct ReferenceView {
  Camera camera;
  int width = 0;
  int height = 0;
  int supersample = 2;           ///< samples per pixel along each axis
  float albedo = 0.8f;           ///< factor of the surface's albedo
  SurfaceAlbedo surface_albedo;  ///< albedo of the mesh itself
  SceneMesh scene;               ///< casts shadows, and reflects where light bounces: the mesh first, then what
                                 ///< surrounds it, which is not seen; empty: the mesh alone
  int bounces = 0;               ///< how often light bounces off the scene, which then has albedos
  std::optional<SpectralView> spectral = {};  ///< by wavelengths, in place of red, green and blue; without scattering
  std::vector<ScatterProfile> scattering;  ///< light beneath the mesh's surface, for one colour or three; none: empty
  double mm_per_unit = 1000;               ///< millimetres to an object unit
  int bands = 5;                           ///< number of bands that light is projected on
  LightWindow window = LightWindow::hann;
};

/// Pictures of the reference under one light, two estimates of each: RGBA in linear radiance; alpha is coverage and
/// colours are multiplied by it.
struct ReferencePicture {
  PictureEstimates in_bands;  ///< under the light as the asset's bands and window have it
  PictureEstimates in_full;   ///< under the light itself, as far as it arrives directly
};

/// Rays that a reference casts from every pixel.
struct ReferenceRays {
  int directions = 1024;  ///< half of them in each of two Fibonacci sets, turned apart at random, for the two estimates
  std::uint64_t seed = 1;
};

/// Draws pictures of a mesh under each of `lights`: the first hit of each sample's ray is shaded by the transfer
/// integral over the directions of `rays` (against the view's scene, with interpolated normals), and by paths for light
/// that bounces (report/bounce_paths.h) or scatters beneath the surface (report/scatter_paths.h), projected on the
/// view's bands. By wavelengths, each point's transfer is multiplied by what its surface reflects and read as red,
/// green and blue; lights have no colour then. The samples of a pixel share the directions among them: sample s of n
/// takes every n-th of a set from the s-th on, so the pixel's mean is over all of them at the price of one sample
/// (interleaved sampling, [Keller 2001]). A light near the mesh is evaluated at every point. Without atlas, textures or
/// rasteriser, this is what the baked asset approximates.
std::vector<ReferencePicture> reference_pictures(const TriangleMesh& mesh, const ReferenceView& view,
                                                 std::span<const LightSpec> lights, const ReferenceRays& rays,
                                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
