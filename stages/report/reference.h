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

/// The picture that an asset is compared with.
struct ReferenceView {
  Camera camera;
  int width = 0;
  int height = 0;
  int supersample = 2;           ///< samples per pixel along each axis
  float albedo = 0.8f;           ///< of the whole surface, times
  SurfaceAlbedo surface_albedo;  ///< the mesh's own
  TriangleMesh surroundings;     ///< casts shadows and is not seen
  int bands = 5;                 ///< that light is projected on
  LightWindow window = LightWindow::hann;
};

/// Pictures of a mesh under each of `lights`: the first hit of each sample's ray, shaded by the transfer integral over
/// `directions` (rays against the mesh itself, its normals interpolated, and what stands around) and projected on the
/// view's bands; a light near the mesh is that of every point. No atlas, no texture, no rasteriser: what the baked
/// asset approximates. RGBA in linear radiance, alpha is coverage and the colours are multiplied by it.
std::vector<Image<float>> reference_pictures(const TriangleMesh& mesh, const ReferenceView& view,
                                             std::span<const LightSpec> lights,
                                             std::span<const Eigen::Vector3f> directions,
                                             const ProgressFunction& progress = no_progress);

}  // namespace kiln
