// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/progress.h"
#include "image/image.h"
#include "material/surface_albedo.h"
#include "mesh/camera.h"
#include "mesh/triangle_mesh.h"
#include "sh/light_spec.h"

namespace kiln {

/// View of the reference picture that an asset is compared with.
struct ReferenceView {
  Camera camera;
  int width = 0;
  int height = 0;
  int supersample = 2;           ///< samples per pixel along each axis
  float albedo = 0.8f;           ///< factor of the surface's albedo
  SurfaceAlbedo surface_albedo;  ///< albedo of the mesh itself
  TriangleMesh surroundings;     ///< casts shadows but is not seen
  int bands = 5;                 ///< number of bands that light is projected on
  LightWindow window = LightWindow::hann;
};

/// Draws pictures of a mesh under each of `lights`: the first hit of each sample's ray is shaded by the transfer
/// integral over `directions` (rays against the mesh, with interpolated normals, and its surroundings), projected on
/// the view's bands. The samples of a pixel share the directions among them: sample s of n takes every n-th from the
/// s-th on, so the pixel's mean is over all of them at the price of one sample (interleaved sampling,
/// [Keller 2001]). A light near the mesh is evaluated at every point. Without atlas, textures or rasteriser, this is
/// what the baked asset approximates. RGBA in linear radiance; alpha is coverage and colours are multiplied by it.
std::vector<Image<float>> reference_pictures(const TriangleMesh& mesh, const ReferenceView& view,
                                             std::span<const LightSpec> lights,
                                             std::span<const Eigen::Vector3f> directions,
                                             const ProgressFunction& progress = no_progress);

}  // namespace kiln
