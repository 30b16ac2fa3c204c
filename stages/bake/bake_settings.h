// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "asset/shipped.h"
#include "bake/engines/shadow_settings.h"
#include "base/extent.h"
#include "base/options.h"
#include "import/import_settings.h"
#include "maps/seam_choice.h"
#include "material/bounce_settings.h"
#include "material/material_settings.h"
#include "material/surroundings_settings.h"
#include "scatter/subsurface_settings.h"
#include "sh/sampling.h"

namespace kiln {

enum class BakeBackend {
  automatic,  ///< egl where EGL has a GPU, else mixed
  egl,        ///< depth maps
  mixed,      ///< beams for receivers for which they are cheaper than rays, else rays: the fast way on a CPU
  beams,      ///< Kiln's beams, rays in bundles
  embree      ///< Embree, ray by ray: the reference
};

/// Returns the name that the command line has for a backend.
std::string backend_name(BakeBackend backend);

/// Surface that receives light: the high mesh at the point that a texel or vertex stands for, or the low mesh.
enum class BakeReceiver { high, low };

/// Treatment of receivers that stand inside another part of the occluders, where no one sees them.
enum class BuriedChoice {
  fill,  ///< fills them from their neighbours, so that nothing black bleeds into visible texels
  keep   ///< bakes them as they are
};

/// Error of integration that decides how many directions a bake takes.
struct ErrorTarget {
  bool wanted = false;  ///< whether it decides; else BakeSettings::directions does
  bool floor = false;   ///< take the quantisation error at the chosen bits as the target
  double error = 0;     ///< relative L2 of transfer vectors; ignored if `floor`

  bool operator==(const ErrorTarget&) const = default;
};

/// Parses --max-error: "none", "auto" or a number above 0 and below 1. Throws WrongUsage.
ErrorTarget parse_error_target(const std::string& text);

struct BakeSettings {
  int bands = 5;  ///< bands^2 coefficients
  int directions = 1024;
  ErrorTarget max_error;       ///< target that decides the number of directions, if wanted
  int max_directions = 65536;  ///< most directions that max_error may take
  double adaptive = 0;         ///< relative L2 that interpolating texels may cost; 0 bakes every texel
  Sampling sampling = Sampling::fibonacci;
  int bits = 8;  ///< bits of a stored coefficient
  ShippedParts ship;
  BuriedChoice buried = BuriedChoice::fill;
  SeamChoice seams = SeamChoice::equalise;
  BounceTarget bounces;        ///< auto: until a bounce adds less than the quantisation error of `bits`
  bool bake_albedo = false;    ///< whether the stored transfer has the receivers' albedo in it
  Surroundings surroundings;   ///< neighbours and ground of the asset in its scene
  ImportSettings import = {};  ///< import of the occluders, and of a mesh whose vertices are baked
  MaterialSettings material;   ///< albedo of the occluders, and of receivers if no detail folder has it
  std::string spectrum = {};   ///< file of kiln-spectrum: light bounces at its wavelengths; empty: as RGB
  double bounce_edge = 0.01;   ///< longest edge of the surface that light bounces off, fraction of its diagonal
  int bounce_memory = 512;     ///< MB of rays that bounces may keep; changes no result
  BakeBackend backend = BakeBackend::automatic;
  BakeReceiver receiver = BakeReceiver::high;
  bool casts_shadows = true;  ///< whether occluders shadow; else transfer is that of free receivers, in closed form
  bool per_vertex = false;    ///< vertices receive light instead of texels
  Extent size;                ///< texels, if no detail folder says it; 0: the size that the atlas was packed for
  std::string gl_device = "auto";
  int shadow_size = 1024;            ///< texels; 0: the smallest size whose error is under that of storing
  ShadowMapSettings shadows;         ///< except size_texels, which shadow_size replaces
  std::optional<double> ray_offset;  ///< fraction of the occluders' bounding box diagonal; none: rounding_offset
  SubsurfaceSettings subsurface;
  int verify_directions = 0;  ///< 0: no verification
  int verify_texels = 2048;
};

/// Throws WrongUsage where settings ask for no shadows and for what follows rays.
void check_shadows(const BakeSettings& settings);

/// Returns the settings as options, for the command line, pipeline.yaml and the report.
OptionSet bake_options(BakeSettings& settings);

}  // namespace kiln
